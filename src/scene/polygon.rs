//! Planarity, convexity and area of small polygons in space.

use crate::geometry::bounds;
use glam::DVec3;

/// A polygon whose corners lie no farther from its plane than this fraction of its size is planar.
///
/// Models carry six or seven digits, so corners meant to be in one plane miss it by about 1e-6 of the
/// model; shading and shadows show a bend from about 1e-4.
pub(super) const PLANARITY: f64 = 1e-5;

/// The sine of the angle by which the boundary turns at a corner must exceed this for the polygon to
/// count as strictly convex there: a straight corner makes the bilinear map of a quad singular.
pub(super) const CONVEXITY: f64 = 1e-3;

/// Twice the area times the unit normal: Newell's sum, taken from the first corner, so that far from the
/// origin no digits are lost.
pub(super) fn doubled_area_vector(corners: &[DVec3]) -> DVec3 {
    let Some((&first, rest)) = corners.split_first() else {
        return DVec3::ZERO;
    };
    rest.windows(2)
        .map(|edge| (edge[0] - first).cross(edge[1] - first))
        .sum()
}

/// The area of a planar polygon.
pub(super) fn area(corners: &[DVec3]) -> f64 {
    doubled_area_vector(corners).length() / 2.0
}

/// The longest side of the box around the corners.
pub(super) fn size(corners: &[DVec3]) -> f64 {
    let (low, high) = bounds(corners.iter().copied());
    (high - low).max_element()
}

/// Whether the polygon has too little area for a normal.
///
/// Either it is a needle of 1e-12 of its length, or the rounding of its coordinates is as large as its area.
pub(super) fn has_no_area(corners: &[DVec3]) -> bool {
    let size = size(corners);
    let farthest = corners
        .iter()
        .map(|p| p.abs().max_element())
        .fold(0.0, f64::max);
    doubled_area_vector(corners).length()
        <= size * f64::max(1e-12 * size, 4.0 * f64::EPSILON * farthest)
}

/// Whether all corners lie in the plane through their centre with the polygon's mean normal.
pub(super) fn is_planar(corners: &[DVec3]) -> bool {
    let normal = doubled_area_vector(corners).normalize_or_zero();
    let centre = corners.iter().copied().sum::<DVec3>() / corners.len() as f64;
    let tolerance = PLANARITY * size(corners);
    corners
        .iter()
        .all(|corner| normal.dot(*corner - centre).abs() <= tolerance)
}

/// Whether the boundary turns left, seen from the front, at every corner, and once around in all.
///
/// For a quad the first implies the second.
pub(super) fn is_strictly_convex(corners: &[DVec3]) -> bool {
    let normal = doubled_area_vector(corners).normalize_or_zero();
    let n = corners.len();
    let edge = |i: usize| (corners[(i + 1) % n] - corners[i % n]).normalize_or_zero();
    let mut turn = 0.0;
    let convex = (0..n).all(|i| {
        let (before, after) = (edge(i), edge(i + 1));
        let sine = normal.dot(before.cross(after));
        turn += sine.atan2(before.dot(after));
        sine > CONVEXITY
    });
    convex && turn < 1.5 * std::f64::consts::TAU
}
