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
mod elements;
mod fan;
mod grid;
mod integral;
mod lattice;
mod missing;
mod patch;
mod patches;
mod refine;
mod restore;
mod sides;
mod stored;
mod vertices;
mod weld;

pub use build::MeshLimits;
pub(crate) use contact::FINEST;
pub use contact::{Piece, Pieces, Regions, pieces as split_at_contacts, regions};
pub use element::{Element, NONE};
pub use elements::Elements;
pub use lattice::{Lattice, UNIT};
pub use patch::{Patch, SideKey};
pub use patches::Patches;
pub use sides::{Side, Sides};
pub use stored::StoredMesh;
pub use vertices::{Vertex, Vertices};

use crate::geometry::Frame;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// The adaptive mesh of a scene, without the light on it.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// From scene to mesh coordinates.
    pub frame: Frame,
    /// The radiating sides, in the order of the scene's surfaces, of which each may be in several pieces.
    pub patches: Patches,
    /// All elements, parents included; see [`Mesh::element`].
    pub elements: Elements,
    /// All vertices; see [`Mesh::vertex`].
    pub vertices: Vertices,
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
    /// These vertices by place.
    at: FxHashMap<(u32, Lattice), u32>,
    limits: MeshLimits,
    /// How far from the border of patches beside thin gaps light is evaluated, at least; in the frame.
    clearances: FxHashMap<u32, f32>,
    /// Surfaces that could not be split along the lines in which others meet them: light may leak there.
    pub unsplit_contacts: usize,
    /// Surfaces that could not be cut along the rims of thin gaps in front of them: light may end there in teeth.
    pub uncut_gaps: usize,
    /// Sides of pieces that have no patch, as they lie in another surface that radiates to the same side.
    pub covered_sides: usize,
}

impl Mesh {
    /// The leaves: elements that are not split.
    pub fn leaves(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.elements.len() as u32).filter(|e| self.elements.is_leaf(*e))
    }

    /// The leaves of a patch.
    pub fn leaves_of(&self, patch: &Patch) -> Vec<u32> {
        let is_leaf = |e: &u32| self.elements.is_leaf(*e);
        self.elements_of(patch).filter(is_leaf).collect()
    }

    /// The elements of a patch, each before its parts.
    fn elements_of(&self, patch: &Patch) -> impl Iterator<Item = u32> + use<'_> {
        let mut open: Vec<u32> = patch.roots.clone().rev().collect();
        std::iter::from_fn(move || {
            let element = open.pop()?;
            open.extend(self.element(element).parts().rev());
            Some(element)
        })
    }

    /// A cut through the quadtree of a patch: the largest elements no longer than `longest`, and leaves where there are none.
    pub fn cut(&self, patch: &Patch, longest: f64) -> Vec<u32> {
        let mut open: Vec<u32> = patch.roots.clone().rev().collect();
        let mut cut = Vec::new();
        while let Some(element) = open.pop() {
            let of = self.element(element);
            if of.is_leaf() || self.longest_side(element) <= longest {
                cut.push(element);
            } else {
                open.extend(of.parts().rev());
            }
        }
        cut
    }

    /// How many leaves there are.
    pub fn leaf_count(&self) -> usize {
        self.elements.leaves()
    }

    /// How many vertices there is room for, also for what is kept by vertex, before anything has to be moved.
    fn vertex_room(&self) -> usize {
        self.vertices.room()
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
        let first = self.patches.first_vertices(patch);
        first.chain(self.later_of(patch))
    }

    /// How many vertices a patch has.
    pub fn vertex_count(&self, patch: u32) -> usize {
        let first = self.patches.first_vertices(patch);
        first.len() + self.later_of(patch).len()
    }

    fn later_of(&self, patch: u32) -> impl ExactSizeIterator<Item = u32> + Clone + '_ {
        let later = self.later.get(&patch).map_or(&[][..], Vec::as_slice);
        later.iter().copied()
    }

    /// The vertex of a patch at a lattice point, if there is one.
    pub fn vertex_at(&self, patch: u32, lattice: Lattice) -> Option<u32> {
        let first = self.patches.first_at(patch, lattice);
        first.or_else(|| self.at.get(&(patch, lattice)).copied())
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
        let vertex = self.vertex(vertex);
        self.patch(vertex.patch).position(vertex.lattice)
    }

    /// Where light is evaluated at a vertex, in the frame: its position, moved a hair inwards on the border of its patch.
    pub fn point(&self, vertex: u32) -> DVec3 {
        let of = self.vertex(vertex);
        self.point_on(&self.patch(of.patch), &of)
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
        let levels = (0..self.elements.len() as u32).map(|e| u32::from(self.element(e).level));
        levels.max().unwrap_or(0)
    }
}
