//! Where many small patches make one surface: corners of patches that meet are one *site*, which receives once, with one normal.
//!
//! Two patches belong together along a side that they and nobody else share, if their normals differ little and nothing can stand on
//! that side: it is no line of contact, and the patches are curved or small. The site of a corner is made of all patches around
//! it that belong together, with the mean of their normals by angle. Small patches receive at their corners only. So curved
//! surfaces have no facets, and light is asked for once where it used to be asked for by each patch.

use super::sides::{Side, Sides};
use super::{Lattice, Mesh, NONE, Patch, UNIT};
use crate::geometry::Sets;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Patches of which each is smooth with the next if their normals differ by no more than this.
const SMOOTH: f64 = 35.0;

/// … and curved if they differ by more than this: nobody puts a wall exactly on the side of a facet.
const CURVED: f64 = 0.5;

/// Patches shorter than this many times the smallest element are small.
const SMALL: f64 = 8.0;

/// A site whose patches face away from its normal by more than this cosine is none.
const FACING: f64 = 0.3;

/// In place of the number of a site: the vertex receives for itself.
const ALONE: u32 = u32::MAX;

/// … or does not receive: it follows the corners of its element.
const FOLLOWS: u32 = ALONE - 1;

/// What is welded. Empty: each vertex receives for itself.
#[derive(Debug, Clone, Default)]
pub(super) struct Weld {
    /// By vertex there was: the number of its site, [`ALONE`] or [`FOLLOWS`].
    site_of: Vec<u32>,
    sites: Vec<Site>,
    /// Elements whose centres follow.
    followed: Vec<u32>,
}

/// Where corners receive as one, and with which normal.
#[derive(Debug, Clone)]
struct Site {
    point: DVec3,
    normal: Vec3,
    /// The vertex that receives.
    leader: u32,
}

impl Mesh {
    /// Welds what makes one surface, or takes it apart.
    pub fn weld_if(&mut self, welded: bool) {
        let is_welded = !self.weld.site_of.is_empty();
        match (welded, is_welded) {
            (true, false) => self.weld(),
            (false, true) => self.weld = Weld::default(),
            _ => {}
        }
    }

    fn weld(&mut self) {
        let mut joined = Sets::new(self.vertices.len());
        let sides = Sides::new(self, |patch, side| patch.side_key(side).0);
        let shared = sides.list.par_chunk_by(|_, side| side.is_one_with_last);
        let ends = shared.flat_map_iter(|sides| self.smooth_ends(sides));
        let ends: Vec<[u32; 2]> = ends.collect();
        drop(sides);
        for [a, b] in ends {
            joined.join(a, b);
        }
        let members = joined.members();
        let sites = members.par_chunk_by(|a, b| a.0 == b.0);
        let mut weld = Weld {
            sites: sites.filter_map(|site| self.settled(site)).collect(),
            site_of: vec![ALONE; self.vertices.len()],
            followed: Vec::new(),
        };
        weld.sites.shrink_to_fit();
        let mut numbered = (0..).zip(&weld.sites).peekable();
        for site in members.chunk_by(|a, b| a.0 == b.0) {
            if let Some((number, _)) = numbered.next_if(|(_, of)| of.leader == site[0].0) {
                for (_, vertex) in site {
                    weld.site_of[*vertex as usize] = number;
                }
            }
        }
        for patch in self.patches.iter().filter(|patch| self.is_small(patch)) {
            let root = patch.roots.start;
            weld.site_of[self.element(root).centre as usize] = FOLLOWS;
            weld.followed.push(root);
        }
        self.weld = weld;
    }

    /// Whether a vertex receives for itself, and for its site.
    pub fn receives(&self, vertex: u32) -> bool {
        match self.weld.site_of.get(vertex as usize) {
            Some(&FOLLOWS) => false,
            _ => self.receiver_for(vertex) == vertex,
        }
    }

    /// The vertex that receives for a vertex: itself, unless it has a site; what follows has none.
    pub fn receiver_for(&self, vertex: u32) -> u32 {
        self.site(vertex).map_or(vertex, |site| site.leader)
    }

    /// Where a vertex receives, and the normal with which it does.
    pub fn receiver(&self, vertex: u32) -> (DVec3, DVec3) {
        if let Some(site) = self.site(vertex) {
            return (site.point, site.normal.as_dvec3());
        }
        let of = self.vertex(vertex);
        let patch = self.patch(of.patch);
        let normal = if self.weld.sites.is_empty() {
            patch.normal
        } else {
            self.interpolated_normal(&patch, of.patch, of.lattice)
        };
        (self.point_on(&patch, &of), normal)
    }

    fn site(&self, vertex: u32) -> Option<&Site> {
        let number = self.weld.site_of.get(vertex as usize)?;
        self.weld.sites.get(*number as usize)
    }

    /// Gives the values of vertices that receive to those that they receive for; `mean` is that of three or four corners.
    pub fn share<T: Copy>(&self, values: &mut [T], mean: impl Fn(&[T]) -> T) {
        for (vertex, number) in self.weld.site_of.iter().enumerate() {
            if let Some(site) = self.weld.sites.get(*number as usize) {
                values[vertex] = values[site.leader as usize];
            }
        }
        for element in &self.weld.followed {
            let of = self.element(*element);
            let corners = of.corners();
            let around = [0, 1, 2, corners.len() - 1].map(|i| values[corners[i] as usize]);
            values[of.centre as usize] = mean(&around[..corners.len()]);
        }
    }

    /// Of all patches on one side, the corners at either end of those of two surfaces that belong together: both fronts, or both backs. The
    /// side between two pieces of one surface is a line of contact: something stands there.
    fn smooth_ends(&self, sides: &[Side]) -> Vec<[u32; 2]> {
        let patch = |side: &Side| self.patch(side.patch);
        let mut surfaces: Vec<u32> = sides.iter().map(|side| patch(side).surface).collect();
        surfaces.dedup();
        if surfaces.len() != 2 {
            return Vec::new();
        }
        let mut ends = Vec::new();
        for (i, a) in sides.iter().enumerate() {
            for b in &sides[i + 1..] {
                if patch(a).surface != patch(b).surface
                    && self.belong_together(&patch(a), &patch(b))
                {
                    let ([a, c], [b, d]) = (self.ends(a), self.ends(b));
                    ends.extend([[a, b], [c, d]]);
                }
            }
        }
        ends
    }

    /// The vertices at the ends of a side, in the same order from every patch that has it.
    fn ends(&self, side: &Side) -> [u32; 2] {
        let patch = self.patch(side.patch);
        let (_, turned) = patch.side_key(side.number());
        let count = patch.corners().len();
        let ends = [side.number(), (side.number() + 1) % count];
        let [a, b] = ends.map(|corner| self.corner_vertex(&patch, side.patch, corner));
        if turned { [b, a] } else { [a, b] }
    }

    /// The vertex in a corner of a patch.
    fn corner_vertex(&self, patch: &Patch, number: u32, corner: usize) -> u32 {
        if patch.roots.len() == 1 {
            return self.element(patch.roots.start).corners[corner];
        }
        let (u, v) = [(0, 0), (UNIT, 0), (UNIT, UNIT), (0, UNIT)][corner];
        let vertex = self.vertex_at(number, Lattice::new(u, v));
        vertex.unwrap_or(NONE)
    }

    fn belong_together(&self, a: &Patch, b: &Patch) -> bool {
        let cosine = a.normal.dot(b.normal);
        let curved = cosine < CURVED.to_radians().cos();
        let small = SMALL * self.limits.min_size * self.frame.extent();
        let is_small = |patch: &Patch| crate::geometry::polygon::diameter(patch.corners()) < small;
        let facing = cosine >= SMOOTH.to_radians().cos();
        facing && (curved || is_small(a) && is_small(b)) && a.exitance == b.exitance
    }

    /// The site of corners that are joined, if they can receive as one.
    fn settled(&self, site: &[(u32, u32)]) -> Option<Site> {
        let vertices = || site.iter().map(|(_, vertex)| *vertex);
        let patch_of = |v: u32| self.patch(self.vertices.patch_of(v));
        let position = self.position(site[0].1);
        let angled = |v: u32| patch_of(v).normal * angle_at(&patch_of(v), position);
        let normal = vertices().map(angled).sum::<DVec3>().normalize_or_zero();
        let faces_away = |v: u32| patch_of(v).normal.dot(normal) < FACING;
        if vertices().any(faces_away) {
            return None;
        }
        let moved = vertices().map(|v| self.point(v) - position);
        let mean = moved.sum::<DVec3>() / site.len() as f64;
        // Not below any of its patches.
        let below = |v: u32| -mean.dot(patch_of(v).normal) / normal.dot(patch_of(v).normal);
        let up = vertices().map(below).fold(0.0, f64::max);
        Some(Site {
            point: position + mean + normal * up,
            normal: normal.as_vec3(),
            leader: site[0].0,
        })
    }

    /// The normal inside a patch whose corners have normals of their own.
    fn interpolated_normal(&self, patch: &Patch, number: u32, at: Lattice) -> DVec3 {
        let (u, v) = at.unit();
        let corner = |place: Lattice| {
            let vertex = self.vertex_at(number, place);
            let site = vertex.and_then(|v| self.site(v));
            site.map_or(patch.normal, |site| site.normal.as_dvec3())
        };
        let [a, b, c, d] =
            [(0, 0), (UNIT, 0), (UNIT, UNIT), (0, UNIT)].map(|(u, v)| Lattice::new(u, v));
        let mixed = if patch.is_triangle() {
            corner(a) * (1.0 - u - v) + corner(b) * u + corner(d) * v
        } else {
            (corner(a) * (1.0 - u) + corner(b) * u) * (1.0 - v)
                + (corner(d) * (1.0 - u) + corner(c) * u) * v
        };
        mixed.normalize_or(patch.normal)
    }
}

/// The angle of a patch at one of its corners.
fn angle_at(patch: &Patch, position: DVec3) -> f64 {
    let corners = patch.corners();
    let distance = |i: &usize| corners[*i].distance_squared(position);
    let count = corners.len();
    let nearest = (0..count).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let at = nearest.unwrap_or(0);
    let [before, after] = [at + count - 1, at + 1].map(|i| corners[i % count] - corners[at]);
    before.angle_between(after)
}
