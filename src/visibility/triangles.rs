//! The triangles that an engine is built over, and what they must be.

use super::{COORDINATE_LIMIT, VisibilityError, in_range};
use glam::Vec3;

/// The triangles that can occlude, in a frame that suits single precision.
#[derive(Debug, Clone, Default)]
pub struct Triangles {
    /// Finite positions.
    pub vertices: Vec<Vec3>,
    /// Indices into `vertices`; counter-clockwise seen from the front.
    pub indices: Vec<[u32; 3]>,
}

impl Triangles {
    /// Refuses what an engine would drop or choke on without a word: coordinates that are not finite
    /// or beyond [`COORDINATE_LIMIT`], indices of vertices that do not exist, and too many triangles.
    /// Degenerate triangles are fine: nothing hits them.
    pub fn validate(&self) -> Result<(), VisibilityError> {
        if self.indices.len() > i32::MAX as usize {
            return Err(VisibilityError::TooManyTriangles(self.indices.len()));
        }
        if let Some(vertex) = self.vertices.iter().position(|&v| !in_range(v)) {
            let position = self.vertices[vertex];
            return Err(VisibilityError::Coordinate {
                vertex,
                position,
                limit: COORDINATE_LIMIT,
            });
        }
        let vertices = self.vertices.len();
        for (triangle, corners) in self.indices.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices) {
                return Err(VisibilityError::Index {
                    triangle,
                    index,
                    vertices,
                });
            }
        }
        Ok(())
    }

    /// The corners of triangle `i`.
    pub(super) fn corners(&self, i: usize) -> [Vec3; 3] {
        self.indices[i].map(|k| self.vertices[k as usize])
    }
}
