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
    point_to_polygon_from(normal, DVec3::ZERO, corners)
}

/// [`point_to_polygon`] with the point elsewhere than in the origin.
pub fn point_to_polygon_from(normal: DVec3, point: DVec3, corners: &[DVec3]) -> f64 {
    match *corners {
        [a, b, c, d] => point_to_quad(normal, [a, b, c, d].map(|corner| corner - point)),
        [a, b, c] => point_to_quad(normal, [a, b, c, a].map(|corner| corner - point)),
        // Four edges at a time; what is over at the end are edges without length.
        _ => (0..corners.len())
            .step_by(4)
            .map(|first| {
                let corner = |k: usize| match first + k {
                    place if place < corners.len() => corners[place] - point,
                    _ => corners[0] - point,
                };
                four_edges(normal, std::array::from_fn(corner), corner(4))
            })
            .sum(),
    }
}

/// Eq. (2) for four corners; a triangle repeats one, whose edge then has no length and gives nothing.
#[inline(always)]
pub(super) fn point_to_quad(normal: DVec3, corners: [DVec3; 4]) -> f64 {
    let [x, y, z] = directions(corners);
    let next = |list: &[f64; 4]| [list[1], list[2], list[3], list[0]];
    edges(normal, [&x, &y, &z], [next(&x), next(&y), next(&z)])
}

/// What the four edges between five corners add to Eq. (2).
#[inline(always)]
fn four_edges(normal: DVec3, corners: [DVec3; 4], last: DVec3) -> f64 {
    let [x, y, z] = directions(corners);
    let last = last / last.length().max(f64::MIN_POSITIVE.sqrt());
    let next = |list: &[f64; 4], last: f64| [list[1], list[2], list[3], last];
    let ends = [next(&x, last.x), next(&y, last.y), next(&z, last.z)];
    edges(normal, [&x, &y, &z], ends)
}

/// Unit vectors by component.
#[inline(always)]
fn directions(corners: [DVec3; 4]) -> [[f64; 4]; 3] {
    let x = corners.map(|r| r.x);
    let y = corners.map(|r| r.y);
    let z = corners.map(|r| r.z);
    let square: [f64; 4] = std::array::from_fn(|i| x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    let scale = square.map(|square| 1.0 / square.max(f64::MIN_POSITIVE).sqrt());
    [x, y, z].map(|list| std::array::from_fn(|i| list[i] * scale[i]))
}

/// The terms of four edges between unit vectors, from the first to the second of each.
#[inline(always)]
fn edges(normal: DVec3, [x, y, z]: [&[f64; 4]; 3], [u, v, w]: [[f64; 4]; 3]) -> f64 {
    let cosines = std::array::from_fn(|i| x[i] * u[i] + y[i] * v[i] + z[i] * w[i]);
    let cross = |i: usize| {
        [
            y[i] * w[i] - z[i] * v[i],
            z[i] * u[i] - x[i] * w[i],
            x[i] * v[i] - y[i] * u[i],
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
