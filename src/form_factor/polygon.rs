//! Eq. (2): the exact form factor from a point to a polygon.

use super::edge::angle_over_sine;
use crate::geometry::polygon::{Clipped, clip};
use glam::DVec3;
use std::f64::consts::PI;

/// Form factor from the point at the origin with unit `normal` to the polygon with the given corners, all of it above
/// the horizon: `F = -(1/2π) Σ n·Γ_g`, corners counter-clockwise seen from the side that radiates.
///
/// Positive where that side faces the point; the sign flips behind the polygon, where the true form factor is 0: see
/// [`point_to_visible_polygon`]. An edge that runs through the point contributes 0, which is its limit.
pub fn point_to_polygon(normal: DVec3, corners: &[DVec3]) -> f64 {
    let unit = |r: DVec3| r / r.length_squared().max(f64::MIN_POSITIVE).sqrt();
    let mut sum = 0.0;
    let mut from = unit(corners[corners.len() - 1]);
    for &corner in corners {
        let to = unit(corner);
        sum += normal.dot(from.cross(to)) * angle_over_sine(from.dot(to));
        from = to;
    }
    -sum / (2.0 * PI)
}

/// Eq. (2) with its traps taken care of, for corners relative to the point: the polygon is clipped to the horizon of
/// the point first, and 0 is returned from behind the polygon. Also gives what the point sees of the polygon.
pub fn point_to_visible_polygon(normal: DVec3, corners: &[DVec3]) -> (f64, Clipped) {
    let visible = clip(corners, |corner| normal.dot(corner));
    if visible.corners().len() < 3 {
        return (0.0, visible);
    }
    (point_to_polygon(normal, visible.corners()).max(0.0), visible)
}
