//! Sides that lie in the plane of another surface and face as one of its sides does.
//!
//! Models have floors that go on below a wall, and walls with bottoms of their own: where these are two-sided, what is inside sees two or
//! three floors in one place, and each would reflect all that falls there. So of such sides one radiates: that of an emitter, or else of the
//! first surface.

use super::face::Face;
use super::{Piece, Splitter};
use crate::geometry::polygon;
use crate::scene::Sides;

/// The least cosine of the angle between planes that are one.
const PARALLEL: f64 = 1.0 - 1e-6;

impl Splitter<'_> {
    /// Which sides of a piece, its front and its back, lie in a surface that comes before it.
    pub(super) fn covered(&self, piece: &Piece) -> [bool; 2] {
        let corners = piece.corners();
        let centre = polygon::centroid(corners);
        let rank = |surface: u32| (!self.shapes.emits(surface), self.regions.first(surface));
        let own = rank(piece.surface);
        let mut covered = [false; 2];
        for other in self.neighbours.of(&[centre], self.reach) {
            if rank(other) >= own {
                continue;
            }
            let Some(face) = Face::new(&self.shapes.corners(other), self.reach) else {
                continue;
            };
            let facing = face.facing(corners);
            let foot = [face.flatten(centre)];
            if facing.abs() < PARALLEL
                || face.height(centre).abs() > face.thickness
                || face.beside(&foot)
            {
                continue;
            }
            let sides = self.shapes.surfaces[other as usize].sides;
            let [same, opposite] = match facing > 0.0 {
                true => [0, 1],
                false => [1, 0],
            };
            covered[same] = true;
            covered[opposite] |= sides == Sides::Both;
        }
        covered
    }
}
