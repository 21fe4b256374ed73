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
    let starts = directions(&by_axis(corners));
    let ends = starts.map(|list| [list[1], list[2], list[3], list[0]]);
    edges(normal, &starts, &ends).iter().sum()
}

/// [`point_to_quad`] for four polygons at once, axis by axis: the first corners of all, then the second ones, and so on.
#[inline(always)]
pub(super) fn point_to_quads(normal: DVec3, corners: &[[f64; 16]; 3]) -> [f64; 4] {
    let starts = directions(corners);
    let mut ends = starts;
    for list in &mut ends {
        list.rotate_left(4);
    }
    let terms = edges(normal, &starts, &ends);
    std::array::from_fn(|i| terms[i] + terms[4 + i] + terms[8 + i] + terms[12 + i])
}

/// What the four edges between five corners add to Eq. (2).
#[inline(always)]
fn four_edges(normal: DVec3, corners: [DVec3; 4], last: DVec3) -> f64 {
    let starts = directions(&by_axis(corners));
    let last = last / last.length().max(f64::MIN_POSITIVE.sqrt());
    let end = |axis: usize| {
        let [_, b, c, d]: [f64; 4] = starts[axis];
        [b, c, d, last[axis]]
    };
    edges(normal, &starts, &[end(0), end(1), end(2)])
        .iter()
        .sum()
}

#[inline(always)]
fn by_axis(corners: [DVec3; 4]) -> [[f64; 4]; 3] {
    [
        corners.map(|c| c.x),
        corners.map(|c| c.y),
        corners.map(|c| c.z),
    ]
}

/// Vectors divided by their lengths, axis by axis.
#[inline(always)]
fn directions<const N: usize>(vectors: &[[f64; N]; 3]) -> [[f64; N]; 3] {
    let mut unit = *vectors;
    let [x, y, z] = &mut unit;
    for i in 0..N {
        let square = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        let scale = 1.0 / square.max(f64::MIN_POSITIVE).sqrt();
        x[i] *= scale;
        y[i] *= scale;
        z[i] *= scale;
    }
    unit
}

/// The terms of Eq. (2) of edges between unit vectors.
#[inline(always)]
fn edges<const N: usize>(
    normal: DVec3,
    [x, y, z]: &[[f64; N]; 3],
    [u, v, w]: &[[f64; N]; 3],
) -> [f64; N] {
    let (mut cosines, mut squared_sines, mut heights) = ([0.0; N], [0.0; N], [0.0; N]);
    for i in 0..N {
        cosines[i] = x[i] * u[i] + y[i] * v[i] + z[i] * w[i];
        let cross_x = y[i] * w[i] - z[i] * v[i];
        let cross_y = z[i] * u[i] - x[i] * w[i];
        let cross_z = x[i] * v[i] - y[i] * u[i];
        squared_sines[i] = cross_x * cross_x + cross_y * cross_y + cross_z * cross_z;
        heights[i] = normal.x * cross_x + normal.y * cross_y + normal.z * cross_z;
    }
    let mut terms = angles_over_sines(&cosines, &squared_sines);
    for i in 0..N {
        terms[i] *= heights[i] * (-0.5 / PI);
    }
    terms
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
