//! Eq. (2): the exact form factor from a point to a polygon.

use super::edge::angles_over_sines;
use crate::geometry::polygon::{Clipped, clip};
use glam::DVec3;
use std::f64::consts::PI;

/// Form factor from the point at the origin with unit `normal` to the polygon with the given corners, all of it above
/// the horizon: `F = -(1/2π) Σ n·Γ_g`, corners counter-clockwise seen from the side that radiates.
///
/// Positive where that side faces the point; the sign flips behind the polygon, where the true form factor is 0: see
/// [`point_to_visible_polygon`]. An edge that runs through the point contributes 0, which is its limit.
pub fn point_to_polygon(normal: DVec3, corners: &[DVec3]) -> f64 {
    // Triangles and quads go in one step; longer polygons are fans of quads from the first corner.
    let first = corners[0];
    let mut sum = 0.0;
    let mut rest = &corners[1..];
    while rest.len() >= 2 {
        let last = *rest.get(2).unwrap_or(&first);
        sum += point_to_quad(normal, [first, rest[0], rest[1], last]);
        rest = rest.get(2..).unwrap_or(&[]);
    }
    sum
}

/// Eq. (2) for four corners; a triangle repeats one, whose edge then has no length and gives nothing.
#[inline(always)]
pub(super) fn point_to_quad(normal: DVec3, corners: [DVec3; 4]) -> f64 {
    let x = corners.map(|r| r.x);
    let y = corners.map(|r| r.y);
    let z = corners.map(|r| r.z);
    let square: [f64; 4] = std::array::from_fn(|i| x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    let scale = square.map(|square| 1.0 / square.max(f64::MIN_POSITIVE).sqrt());
    let x: [f64; 4] = std::array::from_fn(|i| x[i] * scale[i]);
    let y: [f64; 4] = std::array::from_fn(|i| y[i] * scale[i]);
    let z: [f64; 4] = std::array::from_fn(|i| z[i] * scale[i]);
    let next = |i: usize| (i + 1) % 4;
    let cosines =
        std::array::from_fn(|i| x[i] * x[next(i)] + y[i] * y[next(i)] + z[i] * z[next(i)]);
    let cross = |i: usize| {
        let j = next(i);
        [
            y[i] * z[j] - z[i] * y[j],
            z[i] * x[j] - x[i] * z[j],
            x[i] * y[j] - y[i] * x[j],
        ]
    };
    let crosses: [[f64; 3]; 4] = std::array::from_fn(cross);
    let heights = crosses.map(|[x, y, z]| normal.x * x + normal.y * y + normal.z * z);
    let squared_sines = crosses.map(|[x, y, z]| x * x + y * y + z * z);
    let angles = angles_over_sines(cosines, squared_sines);
    let sum: f64 = std::array::from_fn::<f64, 4, _>(|i| heights[i] * angles[i])
        .iter()
        .sum();
    -sum / (2.0 * PI)
}

/// Eq. (2) with its traps taken care of, for corners relative to the point: the polygon is clipped to the horizon of
/// the point first, and 0 is returned from behind the polygon. Also gives what the point sees of the polygon.
pub fn point_to_visible_polygon(normal: DVec3, corners: &[DVec3]) -> (f64, Clipped) {
    let visible = clip(corners, |corner| normal.dot(corner));
    if visible.corners().len() < 3 {
        return (0.0, visible);
    }
    (
        point_to_polygon(normal, visible.corners()).max(0.0),
        visible,
    )
}
