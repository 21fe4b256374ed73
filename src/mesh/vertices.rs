//! All vertices of a mesh as they are kept.

use super::{Lattice, Mesh};

/// A vertex: a corner or the centre of elements of one patch. Where it is in the frame is found when it is asked for: kept, that would
/// be more than all the rest of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The patch that it belongs to.
    pub patch: u32,
    /// Where it is on its patch.
    pub lattice: Lattice,
    /// The first element that has it, for which it was made.
    pub(super) maker: u32,
}

/// The vertices of a mesh, in the order of their making: those of the coarsest grids, patch by patch, and then those of splits.
#[derive(Debug, Clone, Default)]
pub struct Vertices {
    /// The patches of those of the coarsest grids: in a large scene that is nearly all of them, and the rest follows.
    first: Vec<u32>,
    later: Vec<Vertex>,
}

impl Vertices {
    /// Those of coarsest grids, by the number that each patch has of them.
    pub(super) fn of_grids(counts: impl Iterator<Item = u32> + Clone) -> Self {
        let count = counts.clone().sum::<u32>() as usize;
        let mut first = Vec::with_capacity(count);
        for (patch, count) in (0..).zip(counts) {
            first.extend(std::iter::repeat_n(patch, count as usize));
        }
        // What is not written to takes no memory, but growing into a new place takes that of the old one too.
        let later = Vec::with_capacity(count);
        Self { first, later }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.first.len() + self.later.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How many there is room for.
    pub(super) fn room(&self) -> usize {
        self.first.len() + self.later.capacity()
    }

    /// The patch of one of them.
    #[inline(always)]
    pub fn patch_of(&self, number: u32) -> u32 {
        match self.first.get(number as usize) {
            Some(patch) => *patch,
            None => self.later[number as usize - self.first.len()].patch,
        }
    }

    /// The patches of all of them.
    pub fn patches(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        let later = self.later.iter().map(|vertex| vertex.patch);
        self.first.iter().copied().chain(later)
    }

    /// Adds one that is not of a coarsest grid. Returns its number.
    pub(super) fn push(&mut self, vertex: Vertex) -> u32 {
        self.later.push(vertex);
        self.len() as u32 - 1
    }
}

impl Mesh {
    /// The vertex with a number. Who asks for a part of it pays for little more if this is compiled where it is asked for.
    #[inline(always)]
    pub fn vertex(&self, number: u32) -> Vertex {
        let Vertices { first, later } = &self.vertices;
        match first.get(number as usize) {
            Some(patch) => self.patches.first_vertex(*patch, number),
            None => later[number as usize - first.len()],
        }
    }

    /// Where a vertex is on its patch.
    #[inline(always)]
    pub fn lattice_of(&self, vertex: u32) -> Lattice {
        self.vertex(vertex).lattice
    }
}
