//! Splitting elements, keeping the quadtree balanced, and the topology that follows.

use super::build::centre_of;
use super::{Element, Lattice, Mesh, NONE, Patch, Vertex};
use crate::geometry::SURFACE_OFFSET;
use glam::DVec3;
use rayon::prelude::*;

/// A vertex on the border of its patch is evaluated this fraction of the way to the centre of the element that made it …
const INWARDS: f64 = 1e-3;

/// … or more, so that it is this fraction of the scene's extent away from a wall that stands on the border: rays are not tested on
/// the first hundred-thousandth of their way, and would pass through the wall …
const CLEARANCE: f64 = 2.0 * SURFACE_OFFSET;

/// … but never more than this fraction …
const MOST_INWARDS: f64 = 0.15;

/// … or this one, if it is beside a thin gap that it must not look into. Narrow strips lie in such gaps.
const MOST_BESIDE_GAP: f64 = 0.5;

/// The deepest level of an element: the lattice has 28 halvings, and a grid of the coarsest level takes up to ten of them.
pub(super) const DEEPEST: u32 = 17;

impl Mesh {
    /// Length of the longest side of an element, in frame units.
    pub fn longest_side(&self, element: u32) -> f64 {
        let of = self.element(element);
        let (corners, count) = self.corner_positions(&self.patch(of.patch), &of);
        let square = |i: usize| corners[i].distance_squared(corners[(i + 1) % count]);
        (0..count).map(square).fold(0.0, f64::max).sqrt()
    }

    /// Whether the limits allow an element to be split.
    pub fn may_split(&self, element: u32) -> bool {
        self.may_split_above(element, self.limits.min_size)
    }

    /// Whether an element may be split, were it as small as this fraction of the scene's extent that none may.
    pub fn may_split_above(&self, element: u32, min_size: f64) -> bool {
        let level = u32::from(self.element(element).level);
        level < self.limits.max_depth.min(DEEPEST)
            && self.longest_side(element) > min_size * self.frame.extent()
    }

    /// Whether a patch is one element, which the limits do not allow to be split.
    pub fn is_small(&self, patch: &Patch) -> bool {
        let root = patch.roots.start;
        let is_whole = patch.roots.len() == 1 && self.elements.is_leaf(root);
        is_whole && !self.may_split(root)
    }

    /// Splits a leaf into four; returns the first child.
    pub fn split(&mut self, element: u32) -> u32 {
        let parent = self.element(element);
        debug_assert!(parent.is_leaf());
        self.touch(parent.patch);
        let first = self.elements.len() as u32;
        let count = parent.corners().len();
        let last = count - 1;
        let corners = [0, 1, 2, last].map(|i| self.lattice_of(parent.corners[i]));
        let children = quarters(&corners[..count], self.lattice_of(parent.centre));
        for corners in &children {
            let corners = &corners[..count];
            let mut child = Element {
                corners: [NONE; 4],
                level: parent.level + 1,
                hanging: [NONE; 4],
                ..parent
            };
            for (slot, corner) in child.corners.iter_mut().zip(corners) {
                *slot = self.vertex_or_new(parent.patch, *corner);
            }
            child.centre = self.vertex_or_new(parent.patch, centre_of(corners));
            self.elements.push(child);
        }
        self.elements.change(
            element,
            Element {
                children: first,
                ..parent
            },
        );
        first
    }

    /// The vertex at a lattice point; if there is none it is made, for the next element.
    fn vertex_or_new(&mut self, patch: u32, lattice: Lattice) -> u32 {
        if let Some(vertex) = self.vertex_at(patch, lattice) {
            return vertex;
        }
        let vertex = self.vertices.push(Vertex {
            patch,
            lattice,
            maker: self.elements.len() as u32,
        });
        self.later.entry(patch).or_default().push(vertex);
        self.at.insert((patch, lattice), vertex);
        vertex
    }

    /// A position on the border of a patch, moved towards the centre of one of its elements.
    pub(super) fn inwards(&self, patch: &Patch, element: u32, position: DVec3) -> DVec3 {
        let of = self.element(element);
        let (corners, count) = self.corner_positions(patch, &of);
        let centre = patch.position(self.lattice_of(of.centre));
        let depth = |i: usize| {
            let [a, b] = [i, (i + 1) % count].map(|i| corners[i]);
            (b - a).normalize_or_zero().cross(centre - a).length()
        };
        let nearest = (0..count).map(depth).fold(f64::INFINITY, f64::min);
        let from_wall = CLEARANCE * self.frame.extent() / nearest;
        let from_gap = self
            .clearances
            .get(&of.patch)
            .map_or(0.0, |c| f64::from(*c) / nearest);
        let clear = from_wall.clamp(INWARDS, MOST_INWARDS);
        position.lerp(centre, clear.max(from_gap.min(MOST_BESIDE_GAP)))
    }

    /// The positions of the corners of an element of a patch, and how many there are.
    fn corner_positions(&self, patch: &Patch, of: &Element) -> ([DVec3; 4], usize) {
        let mut corners = [DVec3::ZERO; 4];
        for (corner, vertex) in corners.iter_mut().zip(of.corners()) {
            *corner = patch.position(self.lattice_of(*vertex));
        }
        (corners, of.corners().len())
    }

    /// The leaves that must be split so that neighbours differ by at most one level: those with a vertex at a quarter of a side.
    pub fn unbalanced(&self) -> Vec<u32> {
        let is_unbalanced = |e: &u32| {
            let element = self.element(*e);
            element.is_leaf() && self.has_quarter_vertex(&element)
        };
        let elements = self.elements_on(&self.touched()).into_par_iter();
        let unbalanced = elements.with_min_len(256).filter(is_unbalanced);
        let mut unbalanced: Vec<u32> = unbalanced.collect();
        unbalanced.sort_unstable();
        unbalanced
    }

    /// A patch changes.
    fn touch(&mut self, patch: u32) {
        if self.touched.last() != Some(&patch) {
            self.touched.push(patch);
        }
    }

    /// The patches that have changed since vertices were last weighed, in order: few, when a mesh is nearly done.
    fn touched(&self) -> Vec<u32> {
        let mut touched = self.touched.clone();
        touched.sort_unstable();
        touched.dedup();
        touched
    }

    /// All elements of some patches.
    pub(super) fn elements_on(&self, patches: &[u32]) -> Vec<u32> {
        patches
            .par_iter()
            .flat_map_iter(|patch| self.elements_of(&self.patch(*patch)))
            .collect()
    }

    fn has_quarter_vertex(&self, element: &Element) -> bool {
        element.sides().any(|(_, a, b)| {
            let [a, b] = [a, b].map(|v| self.lattice_of(v));
            let middle = a.midpoint(b);
            self.vertex_at(element.patch, middle).is_some()
                && [a, b].iter().any(|end| {
                    self.vertex_at(element.patch, end.midpoint(middle))
                        .is_some()
                })
        })
    }

    /// Finds the hanging vertices on some patches.
    fn find_hanging(&mut self, patches: &[u32]) {
        let elements = self.elements_on(patches).into_par_iter();
        let other = |e: u32| {
            let of = self.element(e);
            let hanging = self.hanging(&of);
            (hanging != of.hanging).then_some((e, Element { hanging, ..of }))
        };
        let others: Vec<_> = elements.with_min_len(256).filter_map(other).collect();
        for (number, element) in others {
            self.elements.change(number, element);
        }
    }

    /// The vertex in the middle of each side of a leaf, if there is one.
    fn hanging(&self, of: &Element) -> [u32; 4] {
        let mut hanging = [NONE; 4];
        for (side, a, b) in of.sides().filter(|_| of.is_leaf()) {
            let [a, b] = [a, b].map(|v| self.lattice_of(v));
            hanging[side] = self.vertex_at(of.patch, a.midpoint(b)).unwrap_or(NONE);
        }
        hanging
    }

    /// Finds hanging vertices, takes in which of the vertices from `first` on are buried (those not spoken of are open), and weighs
    /// what has changed; to be called after splits, before light is interpolated.
    pub fn finish_topology(&mut self, first: u32, buried: &[bool]) {
        let touched = self.touched();
        self.find_hanging(&touched);
        self.buried.resize(self.vertices.len(), false);
        let buried = buried.iter().copied().chain(std::iter::repeat(false));
        for (vertex, now) in (first as usize..self.vertices.len()).zip(buried) {
            if self.buried[vertex] != now {
                self.buried[vertex] = now;
                self.touch(self.vertices.patch_of(vertex as u32));
            }
        }
        let touched = self.touched();
        self.plan_continuation(&touched);
        self.integrate(&touched);
        self.touched = Vec::new();
    }
}

/// The corners of the four parts of an element with these corners and this centre; of a triangle's parts the first three.
pub(super) fn quarters(corners: &[Lattice], centre: Lattice) -> [[Lattice; 4]; 4] {
    let [a, b, c] = [0, 1, 2].map(|i| corners[i]);
    let (ab, bc) = (a.midpoint(b), b.midpoint(c));
    if let Some(&d) = corners.get(3) {
        let (cd, da) = (c.midpoint(d), d.midpoint(a));
        return [
            [a, ab, centre, da],
            [ab, b, bc, centre],
            [centre, bc, c, cd],
            [da, centre, cd, d],
        ];
    }
    let ca = c.midpoint(a);
    [
        [a, ab, ca, a],
        [ab, b, bc, a],
        [ca, bc, c, a],
        [bc, ca, ab, a],
    ]
}
