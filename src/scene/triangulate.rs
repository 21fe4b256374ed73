//! Triangles of a polygon with any number of corners: ears are cut off, then edges flipped until the
//! triangulation is Delaunay within the polygon, then neighbours joined to quads.

use super::ears;
use super::polygon::{doubled_area_vector, has_no_area, is_planar, is_strictly_convex};
use super::split::Piece;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Splits a polygon with an area into triangles whose corners are places in `corners`, oriented as it is.
///
/// `None` if its boundary crosses itself. It may touch itself, as where a hole is tied to the rim by a cut.
pub(super) fn triangulate(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let points = project(corners);
    if crosses_itself(&points) {
        return None;
    }
    let mut triangles = ears::cut(&points)?;
    flip_to_delaunay(&points, &mut triangles);
    triangles.retain(|triangle| !has_no_area(&triangle.map(|corner| corners[corner])));
    Some(triangles)
}

/// Coordinates in the polygon's mean plane, in which it runs counter-clockwise.
fn project(corners: &[DVec3]) -> Vec<DVec2> {
    let (u, v) = doubled_area_vector(corners)
        .normalize_or(DVec3::Z)
        .any_orthonormal_pair();
    let origin = corners[0];
    corners
        .iter()
        .map(|p| DVec2::new(u.dot(*p - origin), v.dot(*p - origin)))
        .collect()
}

/// Twice the signed area of a triangle: positive if it runs counter-clockwise.
pub(super) fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether two segments cross, each end farther than a rounding error from the other segment's line.
///
/// Boundaries that touch, as where a hole is tied to the rim by a cut, must not count as crossing.
pub(super) fn cross_properly([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    const ROUNDING: f64 = 1e-9;
    let reach = ROUNDING * (b - a).length() * (d - c).length();
    let apart = |p: f64, q: f64| (p > reach && q < -reach) || (p < -reach && q > reach);
    apart(orient(a, b, c), orient(a, b, d)) && apart(orient(c, d, a), orient(c, d, b))
}

fn crosses_itself(points: &[DVec2]) -> bool {
    let n = points.len();
    let edge = |i: usize| [points[i], points[(i + 1) % n]];
    (0..n).any(|i| (i + 2..n).any(|j| (j + 1) % n != i && cross_properly(edge(i), edge(j))))
}

/// Flips edges between triangles as long as the two angles that face them add up to more than 180°.
fn flip_to_delaunay(points: &[DVec2], triangles: &mut [[usize; 3]]) {
    let mut owner = BTreeMap::new();
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        owner.extend([((*a, *b), index), ((*b, *c), index), ((*c, *a), index)]);
    }
    let mut pending: Vec<(usize, usize)> = owner.keys().copied().collect();
    // Each flip improves the whole, so the loop ends; the bound only guards against rounding.
    let mut flips_left = 16 * triangles.len() * triangles.len();
    while let Some((a, b)) = pending.pop() {
        let (Some(&left), Some(&right)) = (owner.get(&(a, b)), owner.get(&(b, a))) else {
            continue;
        };
        let (c, d) = (apex(triangles[left], a, b), apex(triangles[right], a, b));
        if flips_left == 0 || !should_flip([a, b, c, d].map(|i| points[i])) {
            continue;
        }
        flips_left -= 1;
        owner.remove(&(a, b));
        owner.remove(&(b, a));
        triangles[left] = [a, d, c];
        triangles[right] = [d, b, c];
        owner.extend([((a, d), left), ((d, c), left), ((c, a), left)]);
        owner.extend([((d, b), right), ((b, c), right), ((c, d), right)]);
        pending.extend([(a, d), (d, b), (b, c), (c, a)]);
    }
}

fn apex(triangle: [usize; 3], a: usize, b: usize) -> usize {
    triangle
        .into_iter()
        .find(|corner| *corner != a && *corner != b)
        .unwrap_or(a)
}

/// Whether the triangles (a, b, c) and (b, a, d) are better with the edge from c to d.
fn should_flip([a, b, c, d]: [DVec2; 4]) -> bool {
    if orient(a, d, c) <= 0.0 || orient(d, b, c) <= 0.0 {
        return false;
    }
    let angle = |apex: DVec2| {
        let (p, q) = (a - apex, b - apex);
        p.perp_dot(q).abs().atan2(p.dot(q))
    };
    angle(c) + angle(d) > std::f64::consts::PI + 1e-9
}

/// The smallest angle of a triangle.
pub(super) fn minimum_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let angle = |apex: DVec3, p: DVec3, q: DVec3| (p - apex).angle_between(q - apex);
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}

/// Joins neighbouring triangles to quads, the squarest first.
///
/// A quad must be planar and convex with angles of 30° to 150°: a flat one would have worse elements than
/// its two halves.
pub(super) fn merge_into_quads(corners: &[DVec3], triangles: &[[usize; 3]]) -> Vec<Piece> {
    let mut owner = BTreeMap::new();
    let mut candidates = Vec::new();
    for (index, triangle) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
            if let Some(&other) = owner.get(&(b, a)) {
                let quad = [a, apex(triangles[other], a, b), b, apex(*triangle, a, b)];
                candidates.extend(
                    squareness(quad.map(|i| corners[i])).map(|s| (s, quad, [other, index])),
                );
            }
            owner.insert((a, b), index);
        }
    }
    // The sort is stable: equals stay in the order of the triangles.
    candidates.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut joined = vec![None; triangles.len()];
    for (_, quad, [first, second]) in candidates {
        if joined[first].is_none() && joined[second].is_none() {
            joined[first] = Some(Some(Piece::Quad(quad)));
            joined[second] = Some(None);
        }
    }
    let pieces = joined.iter().zip(triangles);
    pieces
        .filter_map(|(joined, triangle)| joined.unwrap_or(Some(Piece::Triangle(*triangle))))
        .collect()
}

/// How far the angle farthest from a right one is from being flat; `None` for a quad not worth having.
fn squareness(quad: [DVec3; 4]) -> Option<f64> {
    if !is_planar(&quad) || !is_strictly_convex(&quad) {
        return None;
    }
    let angle = |i: usize| (quad[(i + 3) % 4] - quad[i]).angle_between(quad[(i + 1) % 4] - quad[i]);
    let flatness = |i: usize| f64::min(angle(i), std::f64::consts::PI - angle(i));
    let least = (0..4).map(flatness).fold(f64::INFINITY, f64::min);
    (least >= 30f64.to_radians()).then_some(least)
}
