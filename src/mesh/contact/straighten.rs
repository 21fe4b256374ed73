//! Chains of short edges that lie on one line become one edge.
//!
//! The foot of a wall of many triangles is one straight contact, not as many as it has triangles.

use super::arrange::Node;
use glam::DVec2;

/// Replaces chains that pass no other edge by fewer edges, none farther than `reach` from what it replaces
/// (Douglas and Peucker's method).
pub(super) fn straighten(nodes: &[Node], edges: &[[u32; 2]], reach: f64) -> Vec<[u32; 2]> {
    let beside = neighbours(nodes.len(), edges);
    let passes = |node: u32| nodes[node as usize].sides == 0 && beside[node as usize].len() == 2;
    let mut used = vec![false; nodes.len()];
    let mut straight = Vec::new();
    // Chains between nodes that must stay, then closed ones.
    let all = 0..nodes.len() as u32;
    let (within, fixed): (Vec<u32>, Vec<u32>) = all.partition(|node| passes(*node));
    for start in fixed {
        for &next in &beside[start as usize] {
            // A chain is met from both of its ends; take it once.
            if if passes(next) {
                !used[next as usize]
            } else {
                start < next
            } {
                let chain = follow(&beside, [start, next], passes, &mut used);
                reduce(nodes, &chain, reach, &mut straight);
            }
        }
    }
    for start in within {
        if !used[start as usize] {
            // Begin at a corner: the point farthest from any is one.
            let mut ring = follow(
                &beside,
                [start, beside[start as usize][0]],
                |node| node != start,
                &mut used,
            );
            ring.pop();
            let from_start =
                |node: &u32| nodes[*node as usize].at.distance(nodes[start as usize].at);
            let farthest = (0..ring.len())
                .max_by(|x, y| from_start(&ring[*x]).total_cmp(&from_start(&ring[*y])));
            ring.rotate_left(farthest.unwrap_or(0));
            ring.push(ring[0]);
            reduce(nodes, &ring, reach, &mut straight);
        }
    }
    straight
}

/// The chain that begins with two nodes, to the first that does not pass it on.
fn follow(
    beside: &[Vec<u32>],
    [start, next]: [u32; 2],
    passes: impl Fn(u32) -> bool,
    used: &mut [bool],
) -> Vec<u32> {
    let mut chain = vec![start, next];
    let (mut before, mut last) = (start, next);
    while passes(last) {
        used[last as usize] = true;
        let onwards = beside[last as usize].iter().find(|node| **node != before);
        let Some(&onwards) = onwards else { break };
        (before, last) = (last, onwards);
        chain.push(last);
    }
    chain
}

fn neighbours(count: usize, edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut beside = vec![Vec::new(); count];
    for &[a, b] in edges {
        beside[a as usize].push(b);
        beside[b as usize].push(a);
    }
    beside
}

fn reduce(nodes: &[Node], chain: &[u32], reach: f64, straight: &mut Vec<[u32; 2]>) {
    let at = |place: usize| nodes[chain[place] as usize].at;
    let mut pending = vec![(0, chain.len() - 1)];
    while let Some((first, last)) = pending.pop() {
        let aside = |place: &usize| distance(at(*place), at(first), at(last));
        let farthest = (first + 1..last).max_by(|x, y| aside(x).total_cmp(&aside(y)));
        match farthest.filter(|place| aside(place) > reach) {
            Some(place) => pending.extend([(place, last), (first, place)]),
            None => straight.push([chain[first], chain[last]]),
        }
    }
}

/// Distance of a point from a segment.
fn distance(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let place = (point - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point.distance(a.lerp(b, place.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(points: impl Iterator<Item = (f64, f64)>) -> Vec<Node> {
        points
            .map(|(x, y)| Node {
                at: DVec2::new(x, y),
                sides: 0,
            })
            .collect()
    }

    #[test]
    fn a_straight_chain_becomes_one_edge() {
        let line = nodes((0..10).map(|i| (f64::from(i), 1e-8 * f64::from(i % 2))));
        let edges: Vec<_> = (0..9).map(|i| [i, i + 1]).collect();
        assert_eq!(straighten(&line, &edges, 1e-6), [[0, 9]]);
    }

    #[test]
    fn corners_of_a_closed_chain_stay() {
        let around = [
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (2.0, 2.0),
            (1.0, 2.0),
            (0.0, 2.0),
            (0.0, 1.0),
        ];
        let ring = nodes(around.into_iter());
        let edges: Vec<_> = (0..7).map(|i| [i, (i + 1) % 7]).collect();
        let mut kept: Vec<_> = straighten(&ring, &edges, 1e-6)
            .into_iter()
            .flatten()
            .collect();
        kept.sort_unstable();
        assert_eq!(kept, [0, 0, 2, 2, 3, 3, 5, 5]);
    }

    #[test]
    fn junctions_stay() {
        let tee = nodes([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1.0)].into_iter());
        let mut kept = straighten(&tee, &[[0, 1], [1, 2], [1, 3]], 1e-6);
        kept.iter_mut().for_each(|edge| edge.sort_unstable());
        kept.sort_unstable();
        assert_eq!(kept, [[0, 1], [1, 2], [1, 3]]);
    }
}
