//! What two facets exchange with nothing between them: the cheapest formula that is accurate at their distance.

use super::contour;
use super::facet::Facet;
use super::gauss::each_node;
use crate::form_factor::point_to_polygon;
use glam::DVec3;
use std::f64::consts::PI;

/// Relative error that the choices below are made for; measured by the test at the end of this file.
pub(super) const ACCURACY: f64 = 2e-5;

/// Beyond this multiple of the larger facet's radius between them, both are replaced by four points a tile.
const FAR: f64 = 7.0;

/// Up to this many times the smaller facet's radius between them, the double integral along the edges is used.
const NEAR: f64 = 1.2;

/// The points of a facet with which far ones replace it, with their share of the area.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes(Vec<(DVec3, f64)>);

impl Nodes {
    pub fn new(facet: &Facet) -> Self {
        let mut nodes = Vec::with_capacity(4);
        for tile in facet.shape.tiles() {
            each_node(&tile, 2, |x, w| nodes.push((x, w)));
        }
        Self(nodes)
    }
}

/// A_i F_ij of two facets each of which lies in front of the other; `nodes` are theirs, if at hand.
pub(super) fn exchange(a: &Facet, b: &Facet, nodes: [Option<&Nodes>; 2]) -> f64 {
    let gap = a.centroid.distance(b.centroid) - a.radius - b.radius;
    let (small, large) = if a.radius <= b.radius { (a, b) } else { (b, a) };
    if gap > FAR * large.radius {
        if let [Some(of_a), Some(of_b)] = nodes {
            return between_nodes(a, of_a, b, of_b);
        }
        return between_nodes(a, &Nodes::new(a), b, &Nodes::new(b));
    }
    match points_at(gap / small.radius) {
        Some(points) => over_one(small, large, points),
        None => contour::exchange(a.corners(), b.corners()).max(0.0),
    }
}

/// Points of the product rule over a facet from which another lies this many of its radii away.
fn points_at(distance: f64) -> Option<usize> {
    match distance {
        d if d > FAR => Some(2),
        d if d > 2.5 => Some(3),
        d if d > NEAR => Some(5),
        _ => None,
    }
}

fn between_nodes(a: &Facet, of_a: &Nodes, b: &Facet, of_b: &Nodes) -> f64 {
    let mut sum = 0.0;
    for (x, wx) in &of_a.0 {
        for (y, wy) in &of_b.0 {
            let r = *y - *x;
            let square = r.length_squared();
            sum += wx * wy * a.normal.dot(r) * -b.normal.dot(r) / (square * square);
        }
    }
    (sum / PI).max(0.0)
}

/// Eq. (2) from points of one facet to all of the other.
fn over_one(outer: &Facet, inner: &Facet, points: usize) -> f64 {
    let mut sum = 0.0;
    for tile in outer.shape.tiles() {
        each_node(&tile, points, |x, w| {
            sum += w * seen(outer.normal, x, inner.corners())
        });
    }
    sum
}

/// Eq. (2) from one point to a polygon above its horizon and facing it.
pub(super) fn seen(normal: DVec3, from: DVec3, corners: &[DVec3]) -> f64 {
    let mut relative = [DVec3::ZERO; super::convex::Convex::MOST];
    for (slot, corner) in relative.iter_mut().zip(corners) {
        *slot = *corner - from;
    }
    point_to_polygon(normal, &relative[..corners.len()]).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::super::convex::Convex;
    use super::*;

    fn facet(at: DVec3, u: DVec3, v: DVec3) -> Facet {
        Facet::new(Convex::new(&[at, at + u, at + u + v, at + v])).expect("has an area")
    }

    #[test]
    fn all_formulas_agree_with_the_contour_integral() {
        let mut worst: f64 = 0.0;
        for i in 0..60 {
            let distance = 1.15f64.powi(i) * 0.05;
            for (slant, size) in [(0.0, 1.0), (0.6, 0.4), (1.2, 1.0)] {
                let a = facet(DVec3::ZERO, DVec3::X, DVec3::Y);
                let (sine, cosine) = f64::sin_cos(slant);
                let shift = DVec3::new(0.3 * distance, 0.5 * distance, distance + size);
                let b = facet(shift, DVec3::Y * size, DVec3::new(cosine, 0.0, sine) * size);
                let exact = contour::exchange(a.corners(), b.corners());
                let quick = exchange(&a, &b, [None, None]);
                worst = worst.max((quick / exact - 1.0).abs());
            }
        }
        assert!(worst < ACCURACY, "{worst:e}");
    }
}
