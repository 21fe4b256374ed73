//! The exchange between two polygons as a double integral along their edges.
//!
//! Stokes' theorem, applied to both areas, gives A_i F_ij = (1/2π) ∮ ∮ ln r dx_i · dx_j (Sparrow, *A new and simpler formulation
//! for radiative angle factors*, 1963). The integral along one edge is known in closed form, that along the other is done
//! by Gauss's rule. It stays accurate where the polygons touch: the integrand then has logarithmic singularities at
//! known places, where the interval is divided and its points are crowded together.

use super::gauss::rule;
use glam::DVec3;
use std::f64::consts::PI;

/// Points between two places where the inner integral may be singular.
const POINTS: usize = 16;

/// A_i F_ij of two polygons each of which lies in front of the other and of which each sees all of the other, corners
/// counter-clockwise seen from the radiating side; within 1e-6 of the smaller area, shared edges and corners included.
pub(super) fn exchange(a: &[DVec3], b: &[DVec3]) -> f64 {
    // In units of the pair's own size logarithms stay small.
    let size = a
        .iter()
        .chain(b)
        .map(|p| p.distance(a[0]))
        .fold(0.0, f64::max);
    if size == 0.0 {
        return 0.0;
    }
    let mut sum = 0.0;
    for outer in edges(a) {
        for inner in edges(b) {
            sum += edge_pair(outer, inner, size);
        }
    }
    sum / (2.0 * PI)
}

fn edges(polygon: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> + '_ {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(p, q)| [*p, *q])
}

/// ∫ ∫ ln(r / size) dx · dy along two edges.
fn edge_pair([a0, a1]: [DVec3; 2], [b0, b1]: [DVec3; 2], size: f64) -> f64 {
    let (along_a, along_b) = (a1 - a0, b1 - b0);
    let (length_a, length_b) = (along_a.length(), along_b.length());
    let product = along_a.dot(along_b);
    if product.abs() <= 1e-15 * length_a * length_b {
        return 0.0;
    }
    let direction = along_b / length_b;
    let inner = |s: f64| {
        let from = a0 + along_a * s - b0;
        let foot = from.dot(direction);
        let aside = (from - direction * foot).length_squared();
        primitive(length_b - foot, aside) + primitive(foot, aside) - length_b * size.ln()
    };

    // Divide where the foot on the other edge's line passes its ends and where the lines come closest.
    let rate = along_a.dot(direction);
    let start = (a0 - b0).dot(direction);
    let across = along_a - direction * rate;
    let aside = (a0 - b0) - direction * start;
    let closest = -aside.dot(across) / across.length_squared().max(1e-30 * length_a * length_a);
    let mut places = [0.0, -start / rate, (length_b - start) / rate, closest, 1.0];
    for place in &mut places {
        // Parts too short to matter are not worth a rule.
        if !(1e-6..=1.0 - 1e-6).contains(place) {
            *place = if *place > 0.5 { 1.0 } else { 0.0 };
        }
    }
    places.sort_unstable_by(f64::total_cmp);
    let panels = places.windows(2).filter(|w| w[1] - w[0] > 1e-9);
    let integral: f64 = panels.map(|w| crowded(w[0], w[1], inner)).sum();
    integral * product / length_b
}

/// ∫₀ᵘ ln √(t² + aside) dt.
fn primitive(u: f64, aside: f64) -> f64 {
    let square = u * u + aside;
    if square <= 0.0 {
        return 0.0;
    }
    let distance = aside.sqrt();
    0.5 * u * square.ln() - u + distance * u.atan2(distance)
}

/// Integral over an interval, with the points crowded towards its ends: t = s³ (10 - 15 s + 6 s²), of which two derivatives are
/// 0 at both ends, takes singularities like s ln s away.
fn crowded(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let width = to - from;
    rule(POINTS)
        .iter()
        .map(|(s, w)| {
            let t = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
            let slope = 30.0 * s * s * (1.0 - s) * (1.0 - s);
            w * slope * f(from + width * t)
        })
        .sum::<f64>()
        * width
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(at: DVec3, u: DVec3, v: DVec3) -> [DVec3; 4] {
        [at, at + u, at + u + v, at + v]
    }

    #[test]
    fn squares_of_a_cube() {
        let floor = square(DVec3::ZERO, DVec3::Y, DVec3::X).map(|p| p - DVec3::ZERO);
        let floor = [floor[0], floor[3], floor[2], floor[1]];
        let ceiling = square(DVec3::Z, DVec3::Y, DVec3::X);
        let wall = square(DVec3::ZERO, DVec3::Y, DVec3::Z);
        let opposite = exchange(&floor, &ceiling);
        assert!((opposite - 0.19982489569838746).abs() < 1e-9, "{opposite}");
        let beside = exchange(&floor, &wall);
        assert!((beside - 0.20004377607540316).abs() < 1e-8, "{beside}");
    }

    #[test]
    fn far_squares_see_little_and_it_is_right() {
        let floor = square(DVec3::ZERO, DVec3::X, DVec3::Y);
        let ceiling = square(DVec3::Z * 1000.0, DVec3::Y, DVec3::X);
        let seen = exchange(&floor, &ceiling);
        let expected = 1e-6 / PI;
        assert!((seen / expected - 1.0).abs() < 1e-5, "{seen}");
    }
}
