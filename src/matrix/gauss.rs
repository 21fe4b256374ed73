//! Gauss–Legendre rules on an interval and on convex polygons.

use super::convex::Convex;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The largest number of points of a rule.
pub(super) const MOST_POINTS: usize = 16;

/// Points in (0, 1) and weights that sum up to 1.
pub(super) type Rule = Vec<(f64, f64)>;

static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| (0..=MOST_POINTS).map(legendre).collect());

/// The rule of `points` points, 1 to [`MOST_POINTS`].
pub(super) fn rule(points: usize) -> &'static [(f64, f64)] {
    &RULES[points.clamp(1, MOST_POINTS)]
}

/// Newton's method on the Legendre polynomial, from the usual first guess.
fn legendre(count: usize) -> Rule {
    let n = count as f64;
    let point = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=count {
                let k = k as f64;
                (before, value) = (
                    value,
                    ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k,
                );
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(point).collect()
}

/// Calls `node` with each point and weight of the product rule with `points`² points on a triangle or convex quad; the weights
/// sum up to its area. A triangle is a quad with two corners in one.
pub(super) fn each_node(tile: &Convex, points: usize, mut node: impl FnMut(DVec3, f64)) {
    let corners = tile.quad();
    for (v, wv) in rule(points) {
        for (u, wu) in rule(points) {
            let (point, area) = place(corners, *u, *v);
            node(point, wu * wv * area);
        }
    }
}

/// Five points that make nine of equal weight with the four of the product rule of two points, exact to the third degree too: the
/// middle, and one towards each side. With the weights that they have among the nine.
pub(super) fn each_more(tile: &Convex, mut node: impl FnMut(DVec3, f64)) {
    // ⟨x²⟩ = 1/3 on [-1, 1] asks for 2 x² + 4/3 = 9/3 of them.
    let aside = 0.5 * (5.0f64 / 6.0).sqrt();
    let corners = tile.quad();
    for [u, v] in [
        [0.0, 0.0],
        [-aside, 0.0],
        [aside, 0.0],
        [0.0, -aside],
        [0.0, aside],
    ] {
        let (point, area) = place(corners, 0.5 + u, 0.5 + v);
        node(point, area / 9.0);
    }
}

/// A point of a bilinear quad, with the area for which it stands if it has all the weight.
pub(super) fn place([a, b, c, d]: [DVec3; 4], u: f64, v: f64) -> (DVec3, f64) {
    let (left, right) = (a.lerp(d, v), b.lerp(c, v));
    let along_u = right - left;
    let along_v = (d - a).lerp(c - b, u);
    (left + along_u * u, along_u.cross(along_v).length())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials_exactly() {
        for points in 1..=MOST_POINTS {
            for power in 0..2 * points as i32 {
                let sum: f64 = rule(points).iter().map(|(x, w)| w * x.powi(power)).sum();
                let exact = 1.0 / f64::from(power + 1);
                assert!(
                    (sum - exact).abs() < 1e-13,
                    "{points} points, x^{power}: {sum}"
                );
            }
        }
    }

    #[test]
    fn weights_sum_up_to_the_area() {
        let triangle = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y];
        let trapezium = [
            DVec3::ZERO,
            DVec3::X * 3.0,
            DVec3::new(2.0, 1.0, 0.0),
            DVec3::Y,
        ];
        for (corners, area, moment) in [
            (&triangle[..], 1.0, 2.0 / 3.0),
            (&trapezium, 2.5, 19.0 / 6.0),
        ] {
            let (mut sum, mut x) = (0.0, 0.0);
            let mut add = |p: DVec3, w: f64| {
                sum += w;
                x += w * p.x;
            };
            each_node(&Convex::new(corners), 3, &mut add);
            // Four of nine equal weights.
            each_node(&Convex::new(corners), 2, |p, w| add(p, 4.0 / 9.0 * w));
            each_more(&Convex::new(corners), &mut add);
            assert!(
                (sum - 2.0 * area).abs() < 1e-12 && (x - 2.0 * moment).abs() < 1e-12,
                "{sum} {x}"
            );
        }
    }
}
