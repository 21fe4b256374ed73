//! Segments in a plane, snapped and split until they have nothing in common but ends.

use super::face::Face;
use super::index::Index;
use super::lines::Line;
use glam::DVec2;
use rustc_hash::FxHashMap;

/// Splitting moves ends by up to the reach, which may make new crossings; it settles in two or three rounds.
const ROUNDS: usize = 8;

/// A point where segments end or a corner of the face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub at: DVec2,
    /// The sides of the face on which it lies, a bit each.
    pub sides: u8,
}

/// Segments between nodes; the first nodes are the corners of the face.
#[derive(Debug, Clone, Default)]
pub(super) struct Arrangement {
    pub nodes: Vec<Node>,
    /// Each once, the lower node first, in order.
    pub edges: Vec<[u32; 2]>,
}

/// Arranges the segments on a face; `None` if there are more than `most`, or no end to the splitting.
pub(super) fn arrange(face: &Face, lines: &[Line], most: usize) -> Option<Arrangement> {
    if lines.len() > most {
        return None;
    }
    let mut nodes = Nodes::new(face);
    let edges = lines
        .iter()
        .map(|line| line.map(|end| nodes.insert(end)))
        .collect();
    settle(nodes, edges, most)
}

/// Arranges edges anew, among the nodes that they end in.
pub(super) fn rearrange(
    face: &Face,
    nodes: &[Node],
    edges: &[[u32; 2]],
    most: usize,
) -> Option<Arrangement> {
    let mut fresh = Nodes::new(face);
    let edges = edges
        .iter()
        .map(|edge| edge.map(|node| fresh.insert(nodes[node as usize].at)))
        .collect();
    settle(fresh, edges, most)
}

fn settle(mut nodes: Nodes, edges: Vec<[u32; 2]>, most: usize) -> Option<Arrangement> {
    let mut edges = tidy(&nodes, edges);
    for _ in 0..ROUNDS {
        let mut stops = nodes.stops_on(&edges);
        stops.extend(nodes.crossings_of(&edges));
        if stops.is_empty() {
            return Some(Arrangement {
                nodes: nodes.list,
                edges,
            });
        }
        edges = tidy(&nodes, split(&edges, stops));
        if edges.len() > most {
            return None;
        }
    }
    None
}

/// A node on an edge: number of the edge, place on it, number of the node.
type Stop = (usize, f64, u32);

/// Splits edges at their stops.
fn split(edges: &[[u32; 2]], mut stops: Vec<Stop>) -> Vec<[u32; 2]> {
    stops.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)).then(x.2.cmp(&y.2)));
    let mut stops = stops.into_iter().peekable();
    let mut parts = Vec::with_capacity(edges.len());
    for (number, [first, last]) in edges.iter().enumerate() {
        let mut from = *first;
        while let Some((_, _, node)) = stops.next_if(|stop| stop.0 == number) {
            parts.push([from, node]);
            from = node;
        }
        parts.push([from, *last]);
    }
    parts
}

/// Each edge once, without those of no length and those along the border.
fn tidy(nodes: &Nodes, mut edges: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    edges.iter_mut().for_each(|edge| edge.sort_unstable());
    edges.sort_unstable();
    edges.dedup();
    let sides = |node: u32| nodes.list[node as usize].sides;
    edges.retain(|[a, b]| a != b && sides(*a) & sides(*b) == 0);
    edges
}

/// Nodes no closer to one another than the reach.
struct Nodes<'a> {
    face: &'a Face,
    list: Vec<Node>,
    /// By cells of twice the reach.
    cells: FxHashMap<[i64; 2], Vec<u32>>,
}

impl<'a> Nodes<'a> {
    fn new(face: &'a Face) -> Self {
        let mut nodes = Self {
            face,
            list: Vec::new(),
            cells: FxHashMap::default(),
        };
        let count = face.flat().len();
        for (corner, at) in face.flat().iter().enumerate() {
            nodes.push(Node {
                at: *at,
                sides: 1 << corner | 1 << ((corner + count - 1) % count),
            });
        }
        nodes
    }

    /// The node at a point: one that is there already, or on the border, or new.
    fn insert(&mut self, at: DVec2) -> u32 {
        if let Some(known) = self.nearest(at) {
            return known;
        }
        let depths = (0..self.face.flat().len()).map(|side| (self.face.depth(side, at), side));
        let Some((depth, side)) = depths.min_by(|x, y| x.0.total_cmp(&y.0)) else {
            return 0;
        };
        if depth > self.face.reach {
            return self.push(Node { at, sides: 0 });
        }
        let (at, _) = self.face.on_side(side, at);
        self.nearest(at).unwrap_or_else(|| {
            self.push(Node {
                at,
                sides: 1 << side,
            })
        })
    }

    fn push(&mut self, node: Node) -> u32 {
        let number = self.list.len() as u32;
        self.list.push(node);
        self.cells
            .entry(self.cell(node.at))
            .or_default()
            .push(number);
        number
    }

    fn cell(&self, at: DVec2) -> [i64; 2] {
        (at / (2.0 * self.face.reach))
            .to_array()
            .map(|x| x.floor() as i64)
    }

    /// The nearest node within the reach.
    fn nearest(&self, at: DVec2) -> Option<u32> {
        let [x, y] = self.cell(at);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        let near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let ranked = near.map(|node| (self.list[*node as usize].at.distance(at), *node));
        let best = ranked.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)))?;
        (best.0 <= self.face.reach).then_some(best.1)
    }

    fn ends(&self, edge: [u32; 2]) -> Line {
        edge.map(|node| self.list[node as usize].at)
    }

    /// Nodes that lie on an edge's inside, or within half the reach of it: in a triangle of three nodes, no closer than the
    /// reach, at most one can be so close to the side between the others, or edges would be sent back and forth among them.
    fn stops_on(&self, edges: &[[u32; 2]]) -> Vec<Stop> {
        let nodes = Index::of(self.list.iter().map(|node| [node.at; 2]));
        let reach = 0.5 * self.face.reach;
        let mut stops = Vec::new();
        for (number, edge) in edges.iter().enumerate() {
            let [a, b] = self.ends(*edge);
            for node in nodes.near([a, b], reach) {
                let (at, node) = (self.list[node].at, node as u32);
                let place = (at - a).dot(b - a) / (b - a).length_squared();
                let is_inside = (0.0..=1.0).contains(&place) && !edge.contains(&node);
                if is_inside && a.lerp(b, place).distance(at) <= reach {
                    stops.push((number, place, node));
                }
            }
        }
        stops
    }

    /// Where edges cross each other's inside; makes the nodes there.
    fn crossings_of(&mut self, edges: &[[u32; 2]]) -> Vec<Stop> {
        let index = Index::of(edges.iter().map(|edge| self.ends(*edge)));
        let lines = &index.list;
        let low = |edge: &usize| lines[*edge][0].x.min(lines[*edge][1].x);
        let mut from_left: Vec<usize> = (0..edges.len()).collect();
        from_left.sort_by(|x, y| low(x).total_cmp(&low(y)));
        let mut places = vec![0; edges.len()];
        for (place, edge) in from_left.iter().enumerate() {
            places[*edge] = place;
        }
        let mut stops = Vec::new();
        for first in from_left {
            let near = index.near(lines[first], 0.0);
            let mut others: Vec<usize> = near.filter(|of| places[*of] > places[first]).collect();
            others.sort_unstable_by_key(|of| places[*of]);
            for second in others {
                let Some((s, t)) = crossing(lines[first], lines[second]) else {
                    continue;
                };
                let [a, b] = lines[first];
                let node = self.insert(a.lerp(b, s));
                for (edge, place) in [(first, s), (second, t)] {
                    if !edges[edge].contains(&node) {
                        stops.push((edge, place, node));
                    }
                }
            }
        }
        stops
    }
}

/// The places at which two segments cross, if each has its ends on either side of the other.
fn crossing([a, b]: Line, [c, d]: Line) -> Option<(f64, f64)> {
    let (first, second) = (b - a, d - c);
    let (from_c, from_d) = (first.perp_dot(c - a), first.perp_dot(d - a));
    let (from_a, from_b) = (second.perp_dot(a - c), second.perp_dot(b - c));
    let apart = |p: f64, q: f64| (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
    (apart(from_c, from_d) && apart(from_a, from_b))
        .then(|| (from_a / (from_a - from_b), from_c / (from_c - from_d)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn square() -> Face {
        let corners = [
            DVec3::ZERO,
            DVec3::X * 4.0,
            DVec3::new(4.0, 4.0, 0.0),
            DVec3::Y * 4.0,
        ];
        Face::new(&corners, 1e-5).expect("a square has an area")
    }

    fn arranged(lines: &[[[f64; 2]; 2]]) -> Arrangement {
        let face = square();
        let flat = |[x, y]: [f64; 2]| face.flatten(DVec3::new(x, y, 0.0));
        let lines: Vec<Line> = lines.iter().map(|line| line.map(flat)).collect();
        arrange(&face, &lines, 1000).expect("they settle")
    }

    #[test]
    fn crossing_segments_get_a_common_node() {
        let cross = arranged(&[[[0.0, 2.0], [4.0, 2.0]], [[2.0, 0.0], [2.0, 4.0]]]);
        assert_eq!((cross.nodes.len(), cross.edges.len()), (9, 4));
        assert!(cross.edges.iter().all(|[_, b]| *b == 8));
        assert_eq!(
            cross
                .nodes
                .iter()
                .filter(|n| n.sides.count_ones() == 1)
                .count(),
            4
        );
    }

    #[test]
    fn ends_snap_and_overlaps_are_one() {
        let lines = [
            [[1.0, 1.0], [2.0, 1.0]],
            [[2.0 + 3e-6, 1.0], [3.0, 1.0]],
            [[1.5, 1.0 + 2e-6], [3.0, 1.0]],
        ];
        let chain = arranged(&lines);
        assert_eq!((chain.nodes.len(), chain.edges.len()), (4 + 4, 3));
        assert!(
            arranged(&[[[0.0, 3e-6], [4.0, 2e-6]]]).edges.is_empty(),
            "the border is no contact"
        );
    }

    #[test]
    fn a_fan_through_nearly_one_point_settles() {
        let through = |i: u32| {
            let (sine, cosine) = (f64::from(i) * 0.1).sin_cos();
            let miss = 4e-6 * f64::from(i % 3);
            [
                [2.0 + cosine, 2.0 + miss + sine],
                [2.0 - cosine, 2.0 + miss - sine],
            ]
        };
        let lines: Vec<_> = (0..31).map(through).collect();
        let star = arranged(&lines);
        assert!(star.edges.len() >= 62, "{}", star.edges.len());
    }
}
