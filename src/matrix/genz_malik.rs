//! A rule for integrals over a square that tells how far it may be off, and in which direction.
//!
//! The rule of degree 7 of Genz and Malik ("An adaptive algorithm for numerical integration over an n-dimensional rectangular region",
//! 1980), held against theirs of degree 5 on the same 17 points. None of these is nearer to the border than a fortieth of the width, where
//! what is seen through a slit may rise from nothing to all: so the corners are looked from too, and held against what the points inside
//! foretell.

use std::sync::LazyLock;

/// The middle; two on each axis near it; two on each axis and four on the diagonals far from it; four on the diagonals between; the
/// corners.
pub(super) const POINTS: usize = 21;

const FAR: usize = 9;
const BETWEEN: usize = 13;
const CORNERS: usize = 17;

/// How far out the far points and the corners lie on [-1, 1]; on a common edge a form factor has no value.
const REACH: f64 = 0.948_683_298_050_513_8;
const CORNER: f64 = 0.998;

/// The part of the square beyond the far points.
const BORDER: f64 = 1.0 - REACH * REACH;

/// An integral of one function over one piece.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Estimate {
    pub value: f64,
    /// What it differs by from the rule of the lower degree.
    pub shift: f64,
    /// What may go on along the border, where only corners look.
    pub beyond: f64,
}

impl Estimate {
    pub fn error(&self) -> f64 {
        self.shift.abs() + self.beyond
    }
}

pub(super) struct Rule {
    /// On [-1, 1]².
    pub points: [[f64; 2]; POINTS],
    weights: [f64; POINTS],
    /// Those of degree 7 less those of degree 5.
    differences: [f64; POINTS],
    /// What the middle and two points of a diagonal foretell for its end.
    foretell: [f64; 3],
}

pub(super) static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);

impl Rule {
    fn new() -> Self {
        let (near, between) = ((9.0f64 / 70.0).sqrt(), (9.0f64 / 19.0).sqrt());
        let axes = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
        let diagonals = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let rings = [
            (near, axes, 980.0 / 6561.0, 245.0 / 486.0),
            (REACH, axes, 1020.0 / 19683.0, 65.0 / 1458.0),
            (REACH, diagonals, 200.0 / 19683.0, 25.0 / 729.0),
            (between, diagonals, 6859.0 / 78732.0, 0.0),
            (CORNER, diagonals, 0.0, 0.0),
        ];
        let middle = -3816.0 / 19683.0;
        let mut rule = Self {
            points: [[0.0; 2]; POINTS],
            weights: [middle; POINTS],
            differences: [middle + 971.0 / 729.0; POINTS],
            foretell: parabola([0.0, between, REACH], CORNER),
        };
        let directed = rings
            .into_iter()
            .flat_map(|(radius, directions, seven, five)| {
                directions.map(|[u, v]| ([radius * u, radius * v], seven, five))
            });
        for (slot, (point, seven, five)) in (1..).zip(directed) {
            rule.points[slot] = point;
            rule.weights[slot] = seven;
            rule.differences[slot] = seven - five;
        }
        rule
    }

    /// The integral of a function with the given values at the points, over a square of area 1.
    pub fn estimate(&self, values: &[f64; POINTS]) -> Estimate {
        let beyond: f64 = (0..4)
            .map(|k| {
                let inside = [values[0], values[BETWEEN + k], values[FAR + k]];
                (values[CORNERS + k] - sum_of(&self.foretell, &inside)).abs()
            })
            .sum();
        Estimate {
            value: sum_of(&self.weights, values),
            shift: sum_of(&self.differences, values),
            beyond: 0.25 * BORDER * beyond,
        }
    }
}

/// How rough a function is along each axis: its fourth differences.
pub(super) fn roughness(values: &[f64; POINTS]) -> [f64; 2] {
    let second = |first: usize| values[first] + values[first + 1] - 2.0 * values[0];
    // The far points are seven times as far in squares as the near ones.
    [0, 2].map(|axis| (second(1 + axis) - second(5 + axis) / 7.0).abs())
}

/// The weights with which the values at three places give that of their parabola at another.
fn parabola(places: [f64; 3], at: f64) -> [f64; 3] {
    std::array::from_fn(|i| {
        let others = (0..3).filter(|j| *j != i);
        others
            .map(|j| (at - places[j]) / (places[i] - places[j]))
            .product()
    })
}

fn sum_of(weights: &[f64], values: &[f64]) -> f64 {
    weights.iter().zip(values).map(|(w, v)| w * v).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(f: impl Fn(f64, f64) -> f64) -> [f64; POINTS] {
        RULE.points.map(|[u, v]| f(u, v))
    }

    #[test]
    fn polynomials_of_degree_7_are_exact_and_of_5_without_doubt() {
        let mean = |power: i32| [1.0 / f64::from(power + 1), 0.0][power as usize % 2];
        for p in 0..8 {
            for q in 0..8 - p {
                let found = RULE.estimate(&values(|u, v| u.powi(p) * v.powi(q)));
                let off = found.value - mean(p) * mean(q);
                assert!(off.abs() < 1e-13, "u^{p} v^{q}: {off:e}");
                assert!(p + q > 5 || found.shift.abs() < 1e-13, "u^{p} v^{q}");
                assert!(p + q > 2 || found.beyond < 1e-13, "u^{p} v^{q}");
            }
        }
    }

    #[test]
    fn what_rises_in_a_border_that_no_point_inside_sees_is_not_overlooked() {
        for width in [0.04, 0.01] {
            let slit = values(|u, _| f64::from(1.0 - u < width));
            let found = RULE.estimate(&slit);
            let exact = 0.5 * width;
            assert!(
                (found.value - exact).abs() <= found.error(),
                "{width}: {found:?}"
            );
        }
    }

    #[test]
    fn roughness_tells_the_direction() {
        let [u, v] = roughness(&values(|u, v| 1.0 / (1.1 + u) + v));
        assert!(u > 0.5 && v < 1e-12, "{u} {v}");
    }
}
