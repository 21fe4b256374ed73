//! A cell of the quadtree.

use crate::radiometry::Spectrum;

/// No such vertex or element.
pub const NONE: u32 = u32::MAX;

/// A cell of the quadtree of a patch: the piece that receives and is interpolated over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Element {
    /// The patch that it is a part of.
    pub patch: u32,
    /// Corner vertices in order; the last is [`NONE`] for a triangle.
    pub corners: [u32; 4],
    /// The vertex at its centre.
    pub centre: u32,
    /// For a leaf, the vertex in the middle of each side that a finer neighbour has there, or [`NONE`].
    pub hanging: [u32; 4],
    /// The first of its four children, or [`NONE`] for a leaf.
    pub children: u32,
    /// Its depth in the quadtree.
    pub level: u8,
}

impl Element {
    /// Whether it is not split.
    pub fn is_leaf(&self) -> bool {
        self.children == NONE
    }

    /// Its three or four corner vertices.
    pub fn corners(&self) -> &[u32] {
        if self.corners[3] == NONE {
            &self.corners[..3]
        } else {
            &self.corners
        }
    }

    /// Its corners, then its centre.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        self.corners().iter().copied().chain([self.centre])
    }

    /// How far a quantity at its centre is from the mean of that at its corners.
    pub fn residual(&self, value: impl Fn(u32) -> Spectrum) -> Spectrum {
        let corners = self.corners();
        let sum: Spectrum = corners.iter().map(|v| value(*v)).sum();
        (value(self.centre) - sum / corners.len() as f32).abs()
    }

    /// The triangles of its fan if it is a leaf: its centre, then two vertices that follow one another on its boundary, from the first corner on.
    pub fn fan(self) -> impl Iterator<Item = [u32; 3]> {
        let count = self.corners().len();
        (0..count).flat_map(move |side| {
            let (a, b) = (self.corners[side], self.corners[(side + 1) % count]);
            let (first, second) = match self.hanging[side] {
                NONE => (b, None),
                middle => (middle, Some([self.centre, middle, b])),
            };
            std::iter::once([self.centre, a, first]).chain(second)
        })
    }

    /// Its four children; none for a leaf.
    pub fn parts(&self) -> std::ops::Range<u32> {
        if self.is_leaf() {
            0..0
        } else {
            self.children..self.children + 4
        }
    }

    /// Its sides: number, first vertex, second vertex.
    pub fn sides(&self) -> impl Iterator<Item = (usize, u32, u32)> + '_ {
        let corners = self.corners();
        (0..corners.len()).map(move |i| (i, corners[i], corners[(i + 1) % corners.len()]))
    }
}
