//! Patches, the quadtree of elements on each, and the vertices that elements share.
//!
//! A [`Patch`] is one radiating side of a surface, or of a piece of it where others meet it; triangles that continue one another in a
//! plane are one surface. Its elements form a quadtree,
//! kept balanced: neighbours differ by one level. Every element has a vertex at each corner and one at its centre, so light is known at 2n + 1 … points without
//! asking, and the interpolant is linear on the *fan* of triangles around the centre, hanging corners of finer neighbours
//! included. That fan is the solution: it is what shoots, what is integrated, probed and exported.
//! Imports `geometry`, `radiometry` and `scene`.

mod build;
mod buried;
mod contact;
mod element;
mod fan;
mod integral;
mod lattice;
mod patch;
mod patches;
mod refine;
mod restore;
mod sides;
mod stored;
mod weld;

pub use build::MeshLimits;
pub use contact::{Piece, Pieces, Regions, pieces as split_at_contacts, regions};
pub use element::{Element, NONE};
pub use lattice::{Lattice, UNIT};
pub use patch::{Patch, SideKey};
pub use patches::Patches;
pub use sides::{Side, Sides};
pub use stored::StoredMesh;

use crate::geometry::Frame;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A patch with no more vertices than one element has is searched through: most patches of a large scene are such, and an index of theirs
/// would be as large as they are.
const FEW: usize = 5;

/// A vertex: a corner or the centre of elements of one patch. Where it is in the frame is found when it is asked for: kept, that would
/// be more than all the rest of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The patch that it belongs to.
    pub patch: u32,
    /// Where it is on its patch.
    pub lattice: Lattice,
    /// The first element that has it, for which it was made.
    maker: u32,
}

/// The adaptive mesh of a scene, without the light on it.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// From scene to mesh coordinates.
    pub frame: Frame,
    /// The radiating sides, in the order of the scene's surfaces, of which each may be in several pieces.
    pub patches: Patches,
    /// All elements, parents included; children follow one another.
    pub elements: Vec<Element>,
    /// All vertices, in the order of their making.
    pub vertices: Vec<Vertex>,
    /// Vertices inside a solid; see [`Mesh::continue_to_buried`].
    pub buried: Vec<bool>,
    /// The area that each vertex stands for, 0 if it is buried: the integral of a quantity over what is open is Σ weight · value,
    /// exact to the second degree.
    pub weights: Vec<f64>,
    /// The area that each buried vertex would stand for.
    buried_weights: FxHashMap<u32, f64>,
    continuation: buried::Continuation,
    weld: weld::Weld,
    /// Patches that have changed since hanging vertices were last found and vertices weighed; some more than once.
    touched: Vec<u32>,
    /// The vertices that a patch got after those of its coarsest grid, which follow one another, if it got any.
    later: FxHashMap<u32, Vec<u32>>,
    /// The vertices of patches that have more than [`FEW`], by place.
    at: FxHashMap<(u32, Lattice), u32>,
    limits: MeshLimits,
    /// How far from the border of patches beside thin gaps light is evaluated, at least; in the frame.
    clearances: FxHashMap<u32, f32>,
    /// Surfaces that could not be split along the lines in which others meet them: light may leak there.
    pub unsplit_contacts: usize,
}

impl Mesh {
    /// The leaves: elements that are not split.
    pub fn leaves(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.elements.len() as u32).filter(|e| self.elements[*e as usize].is_leaf())
    }

    /// The leaves of a patch.
    pub fn leaves_of(&self, patch: &Patch) -> Vec<u32> {
        let is_leaf = |e: &u32| self.elements[*e as usize].is_leaf();
        self.elements_of(patch).filter(is_leaf).collect()
    }

    /// The elements of a patch, each before its parts.
    fn elements_of(&self, patch: &Patch) -> impl Iterator<Item = u32> + use<'_> {
        let mut open: Vec<u32> = patch.roots.clone().rev().collect();
        std::iter::from_fn(move || {
            let element = open.pop()?;
            open.extend(self.elements[element as usize].parts().rev());
            Some(element)
        })
    }

    /// A cut through the quadtree of a patch: the largest elements no longer than `longest`, and leaves where there are none.
    pub fn cut(&self, patch: &Patch, longest: f64) -> Vec<u32> {
        let mut open: Vec<u32> = patch.roots.clone().rev().collect();
        let mut cut = Vec::new();
        while let Some(element) = open.pop() {
            let of = &self.elements[element as usize];
            if of.is_leaf() || self.longest_side(element) <= longest {
                cut.push(element);
            } else {
                open.extend(of.parts().rev());
            }
        }
        cut
    }

    /// How many leaves there are: a split makes four elements of one.
    pub fn leaf_count(&self) -> usize {
        let roots = self.patches.iter().next_back();
        let roots = roots.map_or(0, |patch| patch.roots.end) as usize;
        roots + (self.elements.len() - roots) / 4 * 3
    }

    /// How many vertices there is room for, also for what is kept by vertex, before anything has to be moved.
    fn vertex_room(&self) -> usize {
        self.vertices.capacity()
    }

    /// A value for each vertex, with room for those of vertices to come.
    pub fn by_vertex<T: Clone>(&self, value: T) -> Vec<T> {
        let mut values = Vec::with_capacity(self.vertex_room());
        values.resize(self.vertices.len(), value);
        values
    }

    /// The patch with a number.
    #[inline(always)]
    pub fn patch(&self, number: u32) -> Patch {
        self.patches.at(number as usize)
    }

    /// The vertices of a patch, in the order of their making.
    pub fn vertices_of(&self, patch: u32) -> impl Iterator<Item = u32> + Clone + '_ {
        let first = self.patches.first_vertices(patch as usize);
        first.chain(self.later_of(patch))
    }

    /// How many vertices a patch has.
    pub fn vertex_count(&self, patch: u32) -> usize {
        let first = self.patches.first_vertices(patch as usize);
        first.len() + self.later_of(patch).len()
    }

    fn later_of(&self, patch: u32) -> impl ExactSizeIterator<Item = u32> + Clone + '_ {
        let later = self.later.get(&patch).map_or(&[][..], Vec::as_slice);
        later.iter().copied()
    }

    /// The vertex of a patch at a lattice point, if there is one.
    pub fn vertex_at(&self, patch: u32, lattice: Lattice) -> Option<u32> {
        if self.is_indexed(patch) {
            return self.at.get(&(patch, lattice)).copied();
        }
        let is_there = |v: &u32| self.vertices[*v as usize].lattice == lattice;
        let mut first = self.patches.first_vertices(patch as usize);
        first.find(is_there)
    }

    /// Whether a patch has more than [`FEW`] vertices.
    fn is_indexed(&self, patch: u32) -> bool {
        let first = self.patches.first_vertices(patch as usize);
        first.len() > FEW || self.later.contains_key(&patch)
    }

    /// Takes a vertex into the index.
    fn index(&mut self, vertex: u32) {
        let Vertex { patch, lattice, .. } = self.vertices[vertex as usize];
        self.at.insert((patch, lattice), vertex);
    }

    /// The area that a vertex stands for, buried or not.
    pub fn full_weight(&self, vertex: u32) -> f64 {
        if self.buried[vertex as usize] {
            return self.buried_weights.get(&vertex).copied().unwrap_or(0.0);
        }
        self.weights[vertex as usize]
    }

    /// Position of a vertex in the frame.
    pub fn position(&self, vertex: u32) -> DVec3 {
        let vertex = &self.vertices[vertex as usize];
        self.patch(vertex.patch).position(vertex.lattice)
    }

    /// Where light is evaluated at a vertex, in the frame: its position, moved a hair inwards on the border of its patch.
    pub fn point(&self, vertex: u32) -> DVec3 {
        let of = &self.vertices[vertex as usize];
        self.point_on(&self.patch(of.patch), of)
    }

    /// That of a vertex of a patch which is at hand.
    fn point_on(&self, patch: &Patch, of: &Vertex) -> DVec3 {
        let position = patch.position(of.lattice);
        if patch.on_border(of.lattice) {
            self.inwards(patch, of.maker, position)
        } else {
            position
        }
    }

    /// How far from their border light is evaluated on patches beside thin gaps, at least; in the frame, in the order of the patches.
    pub fn clearances(&self) -> Vec<(u32, f32)> {
        let of = self.clearances.iter();
        let mut clearances: Vec<_> = of.map(|(patch, clearance)| (*patch, *clearance)).collect();
        clearances.sort_by_key(|(patch, _)| *patch);
        clearances
    }

    /// The deepest level of any element.
    pub fn depth(&self) -> u32 {
        self.elements
            .iter()
            .map(|e| u32::from(e.level))
            .max()
            .unwrap_or(0)
    }
}
