//! The border of a region of triangles: any number of closed lines in its plane.

use super::lines::Line;
use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

/// Closed lines around a region, and the holes in it.
pub(super) struct Border {
    pub lines: Vec<Line>,
    /// Where the ends of the lines are in the frame, by their bits: they keep their places exactly.
    corners: FxHashMap<[u64; 2], DVec3>,
    /// Normal of the region, as long as its area.
    pub vector_area: DVec3,
}

impl Border {
    pub fn new(sides: &[[DVec3; 2]], vector_area: DVec3, flatten: impl Fn(DVec3) -> DVec2) -> Self {
        let ends = sides.iter().flatten();
        Self {
            lines: sides.iter().map(|side| side.map(&flatten)).collect(),
            corners: ends.map(|end| (bits(flatten(*end)), *end)).collect(),
            vector_area,
        }
    }

    /// Whether a point that is not on the border lies in the region.
    pub fn encloses(&self, point: DVec2) -> bool {
        let crossed = self.lines.iter().filter(|[a, b]| {
            (a.y > point.y) != (b.y > point.y)
                && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)
        });
        crossed.count() % 2 == 1
    }

    /// Whether a segment runs along the border.
    pub fn runs_along(&self, [a, b]: Line, reach: f64) -> bool {
        let is_on = |point: DVec2| {
            self.lines.iter().any(|[from, to]| {
                let along = *to - *from;
                let place = (point - *from).dot(along) / along.length_squared();
                (0.0..=1.0).contains(&place) && from.lerp(*to, place).distance(point) <= reach
            })
        };
        [0.25, 0.5, 0.75]
            .iter()
            .all(|place| is_on(a.lerp(b, *place)))
    }

    /// The place in the frame of an end of its lines.
    pub fn corner(&self, at: DVec2) -> Option<DVec3> {
        self.corners.get(&bits(at)).copied()
    }
}

fn bits(at: DVec2) -> [u64; 2] {
    at.to_array().map(f64::to_bits)
}
