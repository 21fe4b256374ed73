//! What two facets exchange with nothing between them: the cheapest formula that is accurate at their distance.

use super::contour;
use super::facet::Facet;
use super::gauss::each_node;
use crate::form_factor::point_to_polygon_from;
use glam::DVec3;
use std::borrow::Cow;
use std::f64::consts::PI;

/// The error of Gauss's rule with n² points a tile falls like c / (d + 1.4)²ⁿ, where d is the distance between the facets in radii; c was
/// fitted to the worst of random pairs, 1 : 1 to 1 : 5 long. First for points on the smaller facet that see all of the other (Eq. 2),
/// in radii of the smaller; from 2 points on.
const OVER_ONE: [f64; 4] = [1.7, 0.32, 0.063, 0.02];

/// The same for points on both, in radii of the larger.
const OVER_BOTH: [f64; 2] = [2.5, 0.8];

/// The same for the midpoints of the sides of triangles on the facet that is seen from one point, in its own radii.
const AFAR: f64 = 6.0;

/// Nearer than this many radii of the smaller facet the double integral along the edges is used in any case.
const NEAR: f64 = 0.75;

/// The points of a facet with which far ones replace it, with their share of the area: four a tile, and nine.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes([Vec<(DVec3, f64)>; 2]);

impl Nodes {
    pub fn new(facet: &Facet) -> Self {
        Self([2, 3].map(|points| {
            let mut nodes = Vec::with_capacity(points * points);
            for tile in facet.shape.tiles() {
                each_node(&tile, points, |x, w| nodes.push((x, w)));
            }
            nodes
        }))
    }
}

/// A_i F_ij of two facets each of which lies in front of the other, to `accuracy`, relative; `nodes` are theirs, if at hand.
pub(super) fn exchange(a: &Facet, b: &Facet, nodes: [Option<&Nodes>; 2], accuracy: f64) -> f64 {
    let gap = a.centroid.distance(b.centroid) - a.radius - b.radius;
    let (small, large) = if a.radius <= b.radius { (a, b) } else { (b, a) };
    let suits = |k: usize, c: f64, radius: f64| {
        let distance = gap.max(0.0) / radius + 1.4;
        distance.powi(2 * (k as i32 + 2)) * accuracy > c
    };
    let mut over_both = (0..).zip(OVER_BOTH);
    if let Some((k, _)) = over_both.find(|(k, c)| suits(*k, *c, large.radius)) {
        let made = [(a, nodes[0]), (b, nodes[1])].map(|(facet, at_hand)| {
            at_hand.map_or_else(|| Cow::Owned(Nodes::new(facet)), Cow::Borrowed)
        });
        return between_nodes(a, &made[0].0[k], b, &made[1].0[k]);
    }
    let mut over_one_of = (0..).zip(OVER_ONE);
    let is_near = gap <= NEAR * small.radius;
    match over_one_of.find(|(k, c)| !is_near && suits(*k, *c, small.radius)) {
        Some((k, _)) => over_one(small, large, k + 2),
        None => contour::exchange(a.corners(), b.corners()).max(0.0),
    }
}

/// Whether [`seen_afar`] is accurate to `tolerance`, relative, for a facet `gap` away.
pub(super) fn is_afar(gap: f64, of: &Facet, tolerance: f64) -> bool {
    let distance = gap.max(0.0) / of.radius + 1.4;
    distance.powi(4) * tolerance > AFAR
}

fn between_nodes(a: &Facet, of_a: &[(DVec3, f64)], b: &Facet, of_b: &[(DVec3, f64)]) -> f64 {
    let mut sum = 0.0;
    for (x, wx) in of_a {
        for (y, wy) in of_b {
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
    point_to_polygon_from(normal, from, corners).max(0.0)
}

/// The same from afar, to a polygon with the unit normal `of`: the integrand at the midpoints of the sides of triangles.
pub(super) fn seen_afar(normal: DVec3, from: DVec3, of: DVec3, corners: &[DVec3]) -> f64 {
    let Some((first, others)) = corners.split_first() else {
        return 0.0;
    };
    let first = *first - from;
    let mut sum = 0.0;
    for side in others.windows(2) {
        let (second, third) = (side[0] - from, side[1] - from);
        let twice_area = (second - first).cross(third - first).dot(of);
        let twice_middles = [first + second, second + third, third + first];
        // Twice the middle, eight times the integrand less the height of the eye, which they share.
        sum += twice_area
            * twice_middles
                .map(|m| normal.dot(m).max(0.0) / m.length_squared().powi(2))
                .iter()
                .sum::<f64>();
    }
    8.0 / (6.0 * PI) * sum * -of.dot(first)
}

#[cfg(test)]
mod tests {
    use super::super::convex::Convex;
    use super::*;

    fn facet(at: DVec3, u: DVec3, v: DVec3) -> Facet {
        Facet::new(Convex::new(&[at, at + u, at + u + v, at + v])).expect("has an area")
    }

    /// The largest relative difference between the rules and the contour integral, at all distances, orientations and shapes.
    fn worst(accuracy: f64) -> f64 {
        let mut random = fastrand::Rng::with_seed(7);
        let mut worst: f64 = 0.0;
        for i in 0..600 {
            let distance = 1.1f64.powi(i / 10) * 0.05;
            let size = [1.0, 0.4, 0.1][random.usize(0..3)];
            let (long, turn) = ([1.0, 5.0][random.usize(0..2)], random.f64() * 6.3);
            let a = facet(DVec3::ZERO, DVec3::X, DVec3::Y * long);
            let (along, slant) = (
                DVec3::new(turn.cos(), turn.sin(), 0.0),
                2.8 * random.f64() - 1.4,
            );
            let across = DVec3::Z.cross(along) * slant.cos() + DVec3::Z * slant.sin();
            let (u, v) = (across * size * long, along * size);
            let aside = DVec3::new(random.f64() - 0.5, random.f64() - 0.5, 0.3).normalize();
            let far = a.radius * (1.0 + distance) + 2.0 * size * long;
            let b = facet(a.centroid + aside * far, u, v);
            let shown = [a.in_front_of(&b, 1e-9), b.in_front_of(&a, 1e-9)];
            if !shown
                .iter()
                .all(|part| part.as_ref().is_some_and(|part| part.is_whole()))
            {
                continue;
            }
            let exact = contour::exchange(a.corners(), b.corners());
            let quick = exchange(&a, &b, [None, None], accuracy);
            worst = worst.max((quick / exact - 1.0).abs());
        }
        worst
    }

    #[test]
    fn all_formulas_agree_with_the_contour_integral() {
        let fine = worst(1e-5);
        assert!(fine < 1e-5, "{fine:e}");
        let coarse = worst(1e-3);
        assert!(coarse < 1e-3 && coarse > fine, "{coarse:e}");
    }

    #[test]
    fn midpoints_are_enough_from_afar() {
        let mut random = fastrand::Rng::with_seed(3);
        for tolerance in [1e-3, 1e-4] {
            let afar = (AFAR / tolerance).powf(0.25) - 1.4;
            let (mut worst, mut nearer): (f64, f64) = (0.0, 0.0);
            for _ in 0..2000 {
                let long = [1.0, 5.0][random.usize(0..2)];
                let of = facet(DVec3::ZERO, DVec3::X * long, DVec3::Y);
                let mut towards = || DVec3::new(random.f64() - 0.5, random.f64() - 0.5, 0.3);
                let (aside, normal) = (towards().normalize(), -towards().normalize());
                let error = |distance: f64| {
                    let from = of.centroid + aside * of.radius * (1.0 + distance);
                    let above = |c: &DVec3| normal.dot((*c - from).normalize()) > 0.05;
                    if !of.corners().iter().all(above) {
                        return 0.0;
                    }
                    let exact = seen(normal, from, of.corners());
                    seen_afar(normal, from, of.normal, of.corners()) / exact - 1.0
                };
                assert!(is_afar(1.0001 * afar * of.radius, &of, tolerance));
                assert!(!is_afar(0.9999 * afar * of.radius, &of, tolerance));
                worst = worst.max(error(afar).abs());
                nearer = nearer.max(error(0.3 * afar).abs());
            }
            assert!(
                worst < tolerance && nearer > tolerance,
                "{worst:e} {nearer:e}"
            );
        }
    }
}
