//! Ears of a polygon, cut off one after the other, going around.
//!
//! A corner that is none stays so while its two neighbours are the same and what is in its way is still there. So what was found first is kept
//! for each corner, and the rest of the polygon is looked at again when that is gone only: a spiral of four thousand corners takes a fraction
//! of a second, and took forty. The ears, and their order, are those that looking at everything each time finds.

use super::triangulate::{cross_properly, orient};
use glam::DVec2;

/// Triangles that cover a polygon, by the numbers of its corners; `None` if there is a time at which nothing can be cut off.
pub(super) fn cut(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    Rest::new(points).cut()
}

/// What is left of the polygon.
struct Rest<'a> {
    points: &'a [DVec2],
    /// The corners on both sides of each; that of one that was cut off is itself.
    next: Vec<usize>,
    before: Vec<usize>,
    /// Why each corner was no ear when it was looked at last, and what its neighbours were.
    kept: Vec<Option<(usize, usize, Obstacle)>>,
    /// How often the whole was looked at.
    looks: usize,
}

/// Why a corner cannot be cut off.
#[derive(Clone, Copy)]
enum Obstacle {
    /// It points inwards.
    Dent,
    /// This corner lies in the triangle.
    Corner(usize),
    /// The side that begins at the first and ends at the second of these corners crosses the cut.
    Side(usize, usize),
}

impl<'a> Rest<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let n = points.len();
        Self {
            points,
            next: (0..n).map(|corner| (corner + 1) % n).collect(),
            before: (0..n).map(|corner| (corner + n - 1) % n).collect(),
            kept: vec![None; n],
            looks: 0,
        }
    }

    fn cut(&mut self) -> Option<Vec<[usize; 3]>> {
        let corners = self.points.len();
        let mut triangles = Vec::with_capacity(corners);
        let mut at = 0;
        for left in (4..=corners).rev() {
            let mut tip = at;
            let mut tried = 0;
            while !self.is_ear(tip) {
                tried += 1;
                if tried == left {
                    return None;
                }
                tip = self.next[tip];
            }
            let (before, after) = (self.before[tip], self.next[tip]);
            triangles.push([before, tip, after]);
            self.remove(tip);
            // Go on past the neighbour, so that ears are cut all around and not as one fan.
            at = self.next[after];
        }
        let mut last = [self.before[at], at, self.next[at]];
        last.sort_unstable();
        let [a, b, c] = last.map(|corner| self.points[corner]);
        triangles.push(last);
        (orient(a, b, c) > 0.0).then_some(triangles)
    }

    fn remove(&mut self, corner: usize) {
        let (before, after) = (self.before[corner], self.next[corner]);
        self.next[before] = after;
        self.before[after] = before;
        self.next[corner] = corner;
    }

    /// Whether the corner can be cut off: it points outwards, nothing of the boundary lies in the triangle, and none of it crosses the cut.
    fn is_ear(&mut self, tip: usize) -> bool {
        let (before, after) = (self.before[tip], self.next[tip]);
        let stands = |obstacle: Obstacle| match obstacle {
            Obstacle::Dent => true,
            Obstacle::Corner(corner) => self.next[corner] != corner,
            Obstacle::Side(from, to) => self.next[from] == to,
        };
        match self.kept[tip] {
            Some((a, b, obstacle)) if (a, b) == (before, after) && stands(obstacle) => false,
            _ => {
                self.looks += 1;
                let obstacle = self.obstacle([before, tip, after]);
                self.kept[tip] = obstacle.map(|obstacle| (before, after, obstacle));
                obstacle.is_none()
            }
        }
    }

    fn obstacle(&self, corners: [usize; 3]) -> Option<Obstacle> {
        let [before, tip, after] = corners.map(|corner| self.points[corner]);
        if orient(before, tip, after) <= 0.0 {
            return Some(Obstacle::Dent);
        }
        let (low, high) = (before.min(tip).min(after), before.max(tip).max(after));
        let rounding = 1e-9 * (high - low).max_element();
        let (low, high) = (low - rounding, high + rounding);
        let mut from = corners[2];
        loop {
            let to = self.next[from];
            let [point, end] = [from, to].map(|corner| self.points[corner]);
            if point.min(end).cmple(high).all() && point.max(end).cmpge(low).all() {
                let is_corner = point == before || point == tip || point == after;
                let inside = orient(before, tip, point) >= 0.0
                    && orient(tip, after, point) >= 0.0
                    && orient(after, before, point) >= 0.0;
                if inside && !is_corner {
                    return Some(Obstacle::Corner(from));
                }
                if cross_properly([after, before], [point, end]) {
                    return Some(Obstacle::Side(from, to));
                }
            }
            from = to;
            if from == corners[2] {
                return None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// The same by looking at everything each time.
    fn plainly_cut(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
        let is_ear = |rest: &[usize], place: usize| {
            let n = rest.len();
            let at = |place: usize| points[rest[place % n]];
            let (before, tip, after) = (at(place + n - 1), at(place), at(place + 1));
            orient(before, tip, after) > 0.0
                && (0..n).all(|other| {
                    let point = at(other);
                    let is_corner = point == before || point == tip || point == after;
                    let inside = orient(before, tip, point) >= 0.0
                        && orient(tip, after, point) >= 0.0
                        && orient(after, before, point) >= 0.0;
                    (is_corner || !inside)
                        && !cross_properly([after, before], [point, at(other + 1)])
                })
        };
        let mut rest: Vec<usize> = (0..points.len()).collect();
        let (mut triangles, mut at) = (Vec::new(), 0);
        while rest.len() > 3 {
            let n = rest.len();
            let mut places = (0..n).map(|step| (at + step) % n);
            let ear = places.find(|place| is_ear(&rest, *place))?;
            triangles.push([rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]]);
            rest.remove(ear);
            at = ear + 1;
        }
        let last = [rest[0], rest[1], rest[2]];
        let [a, b, c] = last.map(|corner| points[corner]);
        triangles.push(last);
        (orient(a, b, c) > 0.0).then_some(triangles)
    }

    /// A star with rays as long as chance has it, its corners on a lattice of a tenth, so that many lie on one line.
    fn star(corners: usize, seed: u32) -> Vec<DVec2> {
        let corner = |i: usize| {
            let [long, wide] = crate::geometry::jitter(i as u32, seed);
            let angle = TAU * (i as f64 + 0.9 * wide) / corners as f64;
            (DVec2::from_angle(angle) * (1.0 + 9.0 * long * long) * 10.0).round() / 10.0
        };
        (0..corners).map(corner).collect()
    }

    /// A band that is wound up: inwards along its one side and back along the other.
    fn spiral(corners: usize) -> Vec<DVec2> {
        let half = corners / 2;
        let at = |i: usize, width: f64| {
            let turn = 8.0 * i as f64 / half as f64;
            DVec2::from_angle(TAU * turn) * (1.0 + turn + width)
        };
        let back = (0..half).rev().map(|i| at(i, 0.0));
        (0..half).map(|i| at(i, 0.5)).chain(back).collect()
    }

    #[test]
    fn ears_are_those_of_the_plain_search_in_its_order() {
        for seed in 0..60 {
            let points = star(5 + seed as usize, seed);
            assert_eq!(cut(&points), plainly_cut(&points), "{points:?}");
        }
        let mut points = spiral(300);
        assert!(cut(&points).is_some());
        assert_eq!(cut(&points), plainly_cut(&points));
        points.reverse();
        assert_eq!(cut(&points), plainly_cut(&points));
    }

    #[test]
    fn each_corner_of_a_spiral_is_looked_at_a_few_times() {
        let points = spiral(4000);
        let mut rest = Rest::new(&points);
        assert_eq!(rest.cut().map(|triangles| triangles.len()), Some(3998));
        assert!(rest.looks < 8 * points.len(), "{}", rest.looks);
    }
}
