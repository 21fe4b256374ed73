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
mod refine;
mod restore;
mod weld;

pub use build::MeshLimits;
pub use contact::{Piece, Pieces, Regions, pieces as split_at_contacts, regions};
pub use element::{Element, NONE};
pub use lattice::{Lattice, UNIT};
pub use patch::{Patch, SideKey};

use crate::geometry::Frame;
use glam::DVec3;
use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

/// A patch with no more vertices than one element has is searched through: most patches of a large scene are such, and an index of theirs
/// would be as large as they are.
const FEW: usize = 5;

/// A vertex: a corner or the centre of elements of one patch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Vertex {
    /// The patch that it belongs to.
    pub patch: u32,
    /// Where it is on its patch.
    pub lattice: Lattice,
    /// Where light is evaluated, in the frame: the position, moved a hair inwards on the border of the patch.
    pub point: DVec3,
}

/// The adaptive mesh of a scene, without the light on it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Mesh {
    /// From scene to mesh coordinates.
    pub frame: Frame,
    /// The radiating sides, in the order of the scene's surfaces, of which each may be in several pieces.
    pub patches: Vec<Patch>,
    /// All elements, parents included; children follow one another.
    pub elements: Vec<Element>,
    /// All vertices, in the order of their making.
    pub vertices: Vec<Vertex>,
    /// Vertices inside a solid; see [`Mesh::continue_to_buried`].
    pub buried: Vec<bool>,
    /// The area that each vertex stands for, 0 if it is buried: the integral of a quantity over what is open is Σ weight · value,
    /// exact to the second degree.
    #[serde(skip)]
    pub weights: Vec<f64>,
    /// The area that each buried vertex would stand for.
    #[serde(skip)]
    buried_weights: FxHashMap<u32, f64>,
    #[serde(skip)]
    continuation: buried::Continuation,
    #[serde(skip)]
    weld: weld::Weld,
    /// Patches that were split since hanging vertices were last found.
    #[serde(skip)]
    touched: Vec<bool>,
    /// The vertices of patches that have more than [`FEW`], by place.
    #[serde(skip)]
    at: FxHashMap<(u32, Lattice), u32>,
    limits: MeshLimits,
    /// Surfaces that could not be split along the lines in which others meet them: light may leak there.
    #[serde(skip)]
    pub unsplit_contacts: usize,
}

impl Mesh {
    /// The leaves: elements that are not split.
    pub fn leaves(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.elements.len() as u32).filter(|e| self.elements[*e as usize].is_leaf())
    }

    /// The leaves of a patch.
    pub fn leaves_of(&self, patch: &Patch) -> Vec<u32> {
        self.cut(patch, 0.0)
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
        let roots = self.patches.last().map_or(0, |patch| patch.roots.end);
        let roots = roots as usize;
        roots + (self.elements.len() - roots) / 4 * 3
    }

    /// The vertex of a patch at a lattice point, if there is one.
    pub fn vertex_at(&self, patch: u32, lattice: Lattice) -> Option<u32> {
        let vertices = &self.patches[patch as usize].vertices;
        if vertices.len() > FEW {
            return self.at.get(&(patch, lattice)).copied();
        }
        let is_there = |v: &u32| self.vertices[*v as usize].lattice == lattice;
        vertices.iter().copied().find(is_there)
    }

    /// Takes the vertices of a patch into the index from its `number`th on.
    fn index(&mut self, patch: u32, number: usize) {
        let vertices = &self.patches[patch as usize].vertices;
        let from = match vertices.len() {
            0..=FEW => return,
            // Those before it were few.
            count if count == FEW + 1 => 0,
            _ => number,
        };
        for vertex in &vertices[from..] {
            let lattice = self.vertices[*vertex as usize].lattice;
            self.at.insert((patch, lattice), *vertex);
        }
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
        self.patches[vertex.patch as usize].position(vertex.lattice)
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
