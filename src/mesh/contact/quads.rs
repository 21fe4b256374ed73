//! Triangles joined to convex quads.

use glam::DVec2;
use rustc_hash::FxHashMap;

/// A quad whose angles lie between this and 180° less this is always worth having.
pub(super) const FAIR: f64 = 30.0;

/// A quad with angles beyond this one is never worth having; in between it must be twice as good as its worse half.
const FLAT: f64 = 5.0;

/// The corners of a triangle or a convex quad, counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tile {
    Triangle([u32; 3]),
    Quad([u32; 4]),
}

impl Tile {
    pub fn corners(&self) -> &[u32] {
        match self {
            Tile::Triangle(corners) => corners,
            Tile::Quad(corners) => corners,
        }
    }
}

/// Joins neighbours that nothing separates, the squarest first.
pub(super) fn join(
    points: &[DVec2],
    triangles: &[[u32; 3]],
    separated: impl Fn([u32; 2]) -> bool,
) -> Vec<Tile> {
    let mut owner = FxHashMap::default();
    let mut candidates = Vec::new();
    for (index, triangle) in triangles.iter().enumerate() {
        for side in 0..3 {
            let [a, b, c] = [side, side + 1, side + 2].map(|i| triangle[i % 3]);
            if let Some(&(other, d)) = owner.get(&(b, a)).filter(|_| !separated([a, b])) {
                let quad = [b, c, a, d];
                let squareness = flatness(quad.map(|i| points[i as usize]));
                let halves = [index, other]
                    .map(|half| flatness(triangles[half].map(|i| points[i as usize])));
                let worth = squareness >= FAIR
                    || (squareness >= FLAT && squareness > 2.0 * halves[0].min(halves[1]));
                if worth {
                    candidates.push((squareness, quad, [other, index]));
                }
            }
            owner.insert((a, b), (index, c));
        }
    }
    // The sort is stable: equals stay in the order of the triangles.
    candidates.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut joined = vec![false; triangles.len()];
    let mut tiles = Vec::new();
    for (_, quad, [first, second]) in candidates {
        if !joined[first] && !joined[second] {
            joined[first] = true;
            joined[second] = true;
            tiles.push(Tile::Quad(quad));
        }
    }
    let rest = triangles.iter().zip(joined).filter(|(_, joined)| !joined);
    tiles.extend(rest.map(|(triangle, _)| Tile::Triangle(*triangle)));
    tiles
}

/// How far the angle farthest from a right one is from being flat, in degrees; negative where a polygon is not convex.
pub(super) fn flatness<const N: usize>(polygon: [DVec2; N]) -> f64 {
    let angle = |i: usize| {
        (polygon[(i + 1) % N] - polygon[i]).angle_to(polygon[(i + N - 1) % N] - polygon[i])
    };
    let flatness = |i: usize| f64::min(angle(i), std::f64::consts::PI - angle(i));
    (0..N)
        .map(flatness)
        .fold(f64::INFINITY, f64::min)
        .to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    #[test]
    fn halves_of_a_square_are_joined_unless_something_separates_them() {
        assert_eq!(
            join(&SQUARE, &HALVES, |_| false),
            [Tile::Quad([2, 3, 0, 1])]
        );
        assert_eq!(
            join(&SQUARE, &HALVES, |edge| edge == [0, 2]),
            HALVES.map(Tile::Triangle)
        );
    }

    #[test]
    fn flat_and_concave_quads_stay_triangles() {
        let low = [
            DVec2::ZERO,
            DVec2::X,
            DVec2::new(0.9, 0.2),
            DVec2::new(0.1, 0.2),
        ];
        assert!((flatness(SQUARE) - 90.0).abs() < 1e-12);
        assert!(flatness([DVec2::ZERO, DVec2::X, DVec2::new(0.2, 0.2), DVec2::Y]) < 0.0);
        assert!(flatness(low) > 60.0);
        let flat = low.map(|p| p * DVec2::new(1.0, 0.01));
        assert!(flatness(flat) < 2.0);
        assert_eq!(join(&flat, &HALVES, |_| false), HALVES.map(Tile::Triangle));
    }

    #[test]
    fn two_needles_become_one_band() {
        let slanted = [
            DVec2::ZERO,
            DVec2::new(30.0, 0.0),
            DVec2::new(30.0, 1.0),
            DVec2::new(4.0, 1.0),
        ];
        assert!(flatness(slanted) < FAIR);
        assert!(matches!(
            join(&slanted, &HALVES, |_| false)[..],
            [Tile::Quad(_)]
        ));
    }
}
