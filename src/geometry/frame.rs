//! The frame of a solve: the scene recentred and scaled so that single precision serves it.

use super::bounds;
use glam::DVec3;

/// Maps scene coordinates to solve coordinates: subtract the centre, multiply by a power of two.
///
/// In the frame the longest side of the bounding box lies in [64, 128), so a shoebox and a stadium, here or a
/// million extents from the origin, are solved with the same numbers.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Frame {
    centre: DVec3,
    scale: f64,
    extent: f64,
}

impl Frame {
    /// The frame of a set of finite points; one point, or none, gives an extent of 64.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        let (low, high) = bounds(points);
        if low.x > high.x {
            return Self {
                centre: DVec3::ZERO,
                scale: 1.0,
                extent: 64.0,
            };
        }
        let longest = (high - low).max_element();
        let scale = if longest > 0.0 {
            (6.0 - longest.log2().floor()).exp2()
        } else {
            1.0
        };
        let extent = if longest > 0.0 { longest * scale } else { 64.0 };
        Self {
            centre: low + (high - low) * 0.5,
            scale,
            extent,
        }
    }

    /// Whether it maps numbers to numbers; one that was read may not.
    pub fn is_sound(&self) -> bool {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        self.centre.is_finite() && positive(self.scale) && positive(self.extent)
    }

    /// The longest side of the scene's bounding box, in frame units.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// Scene coordinates to frame coordinates.
    pub fn enter(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    /// Frame coordinates to scene coordinates.
    pub fn leave(&self, point: DVec3) -> DVec3 {
        point / self.scale + self.centre
    }

    /// Frame units in one scene unit.
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn size_and_place_do_not_matter() {
        let box_at =
            |size: f64, at: DVec3| Frame::of([at, at + DVec3::new(size, 0.5 * size, 0.1 * size)]);
        for (size, at) in [
            (1e-6, DVec3::ZERO),
            (1.0, DVec3::splat(1e6)),
            (3e7, DVec3::new(-1e9, 0.0, 5.0)),
        ] {
            let frame = box_at(size, at);
            assert!(
                (64.0..128.0001).contains(&frame.extent()),
                "{}",
                frame.extent()
            );
            let p = at + DVec3::splat(0.05 * size);
            assert!(frame.leave(frame.enter(p)).distance(p) <= 1e-15 * (at.length() + size));
        }
    }

    #[test]
    fn a_point_and_nothing_have_a_frame() {
        assert_eq!(Frame::of([]).extent(), 64.0);
        assert_eq!(Frame::of([DVec3::ONE]).enter(DVec3::ONE), DVec3::ZERO);
    }
}
