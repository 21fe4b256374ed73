//! The frame in which rays are traced: single precision serves there, wherever the scene lies.

use crate::geometry::bounds;
use glam::{DVec3, Vec3};

/// How far the box around everything reaches beyond it, in units of the frame (whose extent is 64 to 128).
const MARGIN: f64 = 1.0;

/// Centred on the scene and scaled by a power of two, so that its longest side measures 64 to 128 and scaling loses no bit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    centre: DVec3,
    scale: f64,
    /// Half the size of the box around everything.
    reach: DVec3,
}

impl Frame {
    /// The frame of these positions.
    pub(super) fn around(positions: impl Iterator<Item = DVec3>) -> Self {
        let (low, high) = bounds(positions);
        let size = high - low;
        let extent = size.max_element();
        if !(extent.is_finite() && extent > 0.0) {
            return Self {
                centre: DVec3::ZERO,
                scale: 1.0,
                reach: DVec3::splat(MARGIN),
            };
        }
        let scale = (6.0 - extent.log2().floor()).exp2();
        Self {
            centre: low + 0.5 * size,
            scale,
            reach: 0.5 * scale * size + MARGIN,
        }
    }

    /// A position of the scene in the frame.
    pub(super) fn place(&self, position: DVec3) -> Vec3 {
        ((position - self.centre) * self.scale).as_vec3()
    }

    /// Where a ray from `origin` (in the scene) along the unit `direction` enters the box around everything, in the
    /// frame: `origin` itself if inside, `None` if the ray passes by. Far cameras keep their precision by it.
    pub(super) fn enter(&self, origin: DVec3, direction: DVec3) -> Option<Vec3> {
        let origin = (origin - self.centre) * self.scale;
        let (a, b) = (
            (-self.reach - origin) / direction,
            (self.reach - origin) / direction,
        );
        let near = a.min(b).max_element().max(0.0);
        let far = a.max(b).min_element();
        (near <= far).then(|| (origin + near * direction).as_vec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_extent_becomes_64_to_128() {
        for extent in [1e-9, 0.999, 1.0, 1.001, 64.0, 127.0, 3e12] {
            let corners = [DVec3::splat(1e5), DVec3::splat(1e5) + extent];
            let frame = Frame::around(corners.into_iter());
            let size = (frame.place(corners[1]) - frame.place(corners[0])).x;
            assert!((64.0..=128.0).contains(&size), "{extent} became {size}");
            assert_eq!(frame.scale.log2().fract(), 0.0);
        }
    }

    #[test]
    fn rays_start_at_the_box_or_inside_it_or_not_at_all() {
        let frame = Frame::around([DVec3::ZERO, DVec3::ONE].into_iter());
        let centre = DVec3::splat(0.5);
        assert_eq!(frame.enter(centre, DVec3::X), Some(Vec3::ZERO));
        assert_eq!(
            frame.enter(centre - 1e6 * DVec3::X, DVec3::X),
            Some(Vec3::new(-33.0, 0.0, 0.0))
        );
        assert_eq!(frame.enter(centre - 1e6 * DVec3::X, DVec3::NEG_X), None);
        assert_eq!(frame.enter(centre + 5.0 * DVec3::Y, DVec3::X), None);
    }

    #[test]
    fn a_point_or_nothing_has_a_frame() {
        assert_eq!(
            Frame::around(std::iter::empty()).place(DVec3::ONE),
            Vec3::ONE
        );
        assert_eq!(
            Frame::around([DVec3::ONE].into_iter()).place(DVec3::ONE),
            Vec3::ONE
        );
    }
}
