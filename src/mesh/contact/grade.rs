//! Points added to an arrangement so that pieces grow from small to large instead of being needles.
//!
//! A table's leg on a floor has no other points near, so its sides would be the bases of triangles that reach as far as the
//! walls. Points at the centres of their circumcircles, or in the middle of segments that such a circle reaches beyond
//! (Ruppert's method, with a bound on what it may add), make two or three rings of fair triangles of them.
//!
//! Measured in pieces and first elements no longer than a tenth of the scene, against the same scene uncut:
//!
//! | scene | uncut | cut | graded |
//! |---|---|---|---|
//! | Cornell box | 19, 1536 | 32, 2794 | 33, 1742 |
//! | Geometry | 30, 800 | 60, 1532 | 66, 1235 |
//! | Shadow | 55, 1684 | 103, 3984 | 122, 1736 |

use super::MANY;
use super::arrange::{Arrangement, Node};
use super::face::Face;
use super::lines::Line;
use super::quads::{Tile, flatness};
use super::tile::{sides, tile};
use crate::geometry::Frame;
use glam::DVec2;
use rustc_hash::FxHashSet;

/// Triangles with a smaller angle, in degrees, are needles.
const LEAST_ANGLE: f64 = 20.0;

/// How far needles are relieved.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grading {
    /// Shorter ones stay, in the unit of the frame.
    smallest: f64,
    /// Rounds of adding points and triangulating again.
    rounds: usize,
}

impl Grading {
    /// Down to a tenth of the scene: elements are not longer either. Where surfaces are many, so that a patch more is not a shot more, down
    /// to a hundredth: light across the tips of needles is a star of streaks.
    pub fn of(surfaces: usize, frame: &Frame) -> Self {
        let (fraction, rounds) = if surfaces > MANY {
            (0.01, 12)
        } else {
            (0.1, 6)
        };
        let smallest = fraction * frame.extent();
        Self { smallest, rounds }
    }
}

/// Adds points; needles between segments at a small angle stay.
pub(super) fn grade(face: &Face, mut arrangement: Arrangement, how: Grading) -> Arrangement {
    let Grading { smallest, rounds } = how;
    let most = 3 * arrangement.nodes.len();
    for _ in 0..rounds {
        let Some(tiles) = tile(face, &arrangement) else {
            break;
        };
        let before = arrangement.nodes.len();
        let mut round = Round::new(face, arrangement);
        for needle in round.needles(&tiles, smallest) {
            if round.nodes.len() < most {
                round.relieve(needle, smallest);
            }
        }
        arrangement = round.finish();
        if arrangement.nodes.len() == before {
            break;
        }
    }
    arrangement
}

/// The arrangement while points are added.
struct Round<'a> {
    face: &'a Face,
    nodes: Vec<Node>,
    /// Nodes of the rounds before.
    known: usize,
    /// Segments of the arrangement, then those of the border from `inner` on.
    segments: Vec<[u32; 2]>,
    inner: usize,
    /// The node in the middle of each segment that was split.
    middles: Vec<Option<u32>>,
}

impl<'a> Round<'a> {
    fn new(face: &'a Face, arrangement: Arrangement) -> Self {
        let inner = arrangement.edges.len();
        let mut segments = arrangement.edges;
        segments.extend(sides(face, &arrangement.nodes));
        let middles = vec![None; segments.len()];
        Self {
            face,
            known: arrangement.nodes.len(),
            nodes: arrangement.nodes,
            segments,
            inner,
            middles,
        }
    }

    fn finish(self) -> Arrangement {
        let mut edges = Vec::with_capacity(self.inner);
        for (edge, middle) in self.segments[..self.inner].iter().zip(self.middles) {
            match (*edge, middle) {
                ([a, b], Some(middle)) => edges.extend([[a, middle], [b, middle]]),
                (whole, None) => edges.push(whole),
            }
        }
        edges.sort_unstable();
        Arrangement {
            nodes: self.nodes,
            edges,
        }
    }

    fn at(&self, node: u32) -> DVec2 {
        self.nodes[node as usize].at
    }

    /// Triangles with a small angle that is not one between segments, the sharpest first.
    fn needles(&self, tiles: &[Tile], smallest: f64) -> Vec<[DVec2; 3]> {
        let segments: FxHashSet<[u32; 2]> = self
            .segments
            .iter()
            .map(|[a, b]| [*a.min(b), *a.max(b)])
            .collect();
        let is_segment = |a: u32, b: u32| segments.contains(&[a.min(b), a.max(b)]);
        let mut needles = Vec::new();
        for tile in tiles {
            let Tile::Triangle(triangle) = *tile else {
                continue;
            };
            let points = triangle.map(|node| self.at(node));
            let sides = [0, 1, 2].map(|i| points[i].distance(points[(i + 1) % 3]));
            let shortest = if sides[0] <= sides[1].min(sides[2]) {
                0
            } else {
                1 + usize::from(sides[2] < sides[1])
            };
            let tip = (shortest + 2) % 3;
            let given =
                (0..3).all(|i| i == shortest || is_segment(triangle[i], triangle[(i + 1) % 3]));
            let angle = flatness(points);
            if angle < LEAST_ANGLE && sides[tip] > smallest && !given {
                needles.push((angle, points));
            }
        }
        needles.sort_by(|x, y| x.0.total_cmp(&y.0));
        needles.into_iter().map(|(_, points)| points).collect()
    }

    /// Adds the point that breaks a needle, unless one of this round is near.
    fn relieve(&mut self, [a, b, c]: [DVec2; 3], smallest: f64) {
        let Some(centre) = circumcentre([a, b, c]) else {
            return;
        };
        let radius = centre.distance(a);
        if self.nodes[self.known..]
            .iter()
            .any(|node| node.at.distance(centre) < radius)
        {
            return;
        }
        let middle = (a + b + c) / 3.0;
        match self
            .between(middle, centre)
            .or_else(|| self.reached(centre))
        {
            None => self.nodes.push(Node {
                at: centre,
                sides: 0,
            }),
            Some(segment) => self.halve(segment, smallest),
        }
    }

    /// The first segment on the way from a triangle to the centre of its circumcircle.
    fn between(&self, from: DVec2, to: DVec2) -> Option<usize> {
        let crossed = (0..self.segments.len()).filter_map(|segment| {
            let [a, b] = self.segments[segment].map(|node| self.at(node));
            let place = first_crossing([from, to], [a, b])?;
            Some((place, segment))
        });
        crossed
            .min_by(|x, y| x.0.total_cmp(&y.0))
            .map(|(_, segment)| segment)
    }

    /// The segment whose diametral circle holds a point, and most deeply.
    fn reached(&self, point: DVec2) -> Option<usize> {
        let depths = (0..self.segments.len()).map(|segment| {
            let [a, b] = self.segments[segment].map(|node| self.at(node));
            ((a - point).dot(b - point) / a.distance_squared(b), segment)
        });
        depths
            .min_by(|x, y| x.0.total_cmp(&y.0))
            .filter(|(depth, _)| *depth < 0.0)
            .map(|(_, segment)| segment)
    }

    fn halve(&mut self, segment: usize, smallest: f64) {
        let [a, b] = self.segments[segment];
        let (from, to) = (self.at(a), self.at(b));
        if self.middles[segment].is_some() || from.distance(to) <= smallest {
            return;
        }
        let sides = self.nodes[a as usize].sides & self.nodes[b as usize].sides;
        let middle = from.midpoint(to);
        let at = if segment < self.inner {
            middle
        } else {
            self.face.on_side(sides.trailing_zeros() as usize, middle).0
        };
        self.middles[segment] = Some(self.nodes.len() as u32);
        self.nodes.push(Node {
            at,
            sides: if segment < self.inner { 0 } else { sides },
        });
    }
}

fn circumcentre([a, b, c]: [DVec2; 3]) -> Option<DVec2> {
    let (b, c) = (b - a, c - a);
    let twice = 2.0 * b.perp_dot(c);
    let to = DVec2::new(
        c.y * b.length_squared() - b.y * c.length_squared(),
        b.x * c.length_squared() - c.x * b.length_squared(),
    );
    (twice > 0.0).then(|| a + to / twice)
}

/// The place on the first segment at which it crosses the second.
fn first_crossing([from, to]: Line, [a, b]: Line) -> Option<f64> {
    let (way, along) = (to - from, b - a);
    let (over_a, over_b) = (way.perp_dot(a - from), way.perp_dot(b - from));
    let (begin, end) = (along.perp_dot(from - a), along.perp_dot(to - a));
    let crosses = (over_a > 0.0) != (over_b > 0.0) && (begin > 0.0) != (end > 0.0);
    crosses.then(|| begin / (begin - end))
}
