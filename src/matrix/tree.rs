//! A tree over the facets: for one facet, all others, each with the surfaces that may come between.

use super::facet::Facet;
use super::occluder::{Near, Occluder};
use glam::DVec3;
use std::ops::Range;

/// Facets in a leaf.
const LEAF: usize = 8;

/// Facets by place.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

#[derive(Debug, Clone)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Places in `order`.
    facets: Range<u32>,
    /// The second child; the first follows its parent. 0 for a leaf.
    second: u32,
    /// The largest number of a facet below.
    last: u32,
}

impl Tree {
    pub fn new(facets: &[Facet]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..facets.len() as u32).collect(),
        };
        if !facets.is_empty() {
            tree.build(facets, 0..facets.len());
        }
        tree
    }

    fn build(&mut self, facets: &[Facet], range: Range<usize>) {
        let members = &mut self.order[range.clone()];
        let of = |k: &u32| &facets[*k as usize];
        let low = members
            .iter()
            .map(|k| of(k).low)
            .fold(DVec3::INFINITY, DVec3::min);
        let high = members
            .iter()
            .map(|k| of(k).high)
            .fold(DVec3::NEG_INFINITY, DVec3::max);
        let middles = members.iter().map(|k| of(k).centroid);
        let spread = middles.clone().fold(DVec3::NEG_INFINITY, DVec3::max)
            - middles.fold(DVec3::INFINITY, DVec3::min);
        let axis = if spread.x >= spread.y && spread.x >= spread.z {
            0
        } else {
            1 + usize::from(spread.z > spread.y)
        };
        let node = self.nodes.len();
        let last = members.iter().copied().max().unwrap_or(0);
        let is_leaf = members.len() <= LEAF;
        if !is_leaf {
            let half = members.len() / 2;
            members.select_nth_unstable_by(half, |a, b| {
                let [x, y] = [a, b].map(|k| of(k).centroid[axis]);
                x.total_cmp(&y).then(a.cmp(b))
            });
        }
        self.nodes.push(Node {
            low,
            high,
            facets: range.start as u32..range.end as u32,
            second: 0,
            last,
        });
        if !is_leaf {
            let middle = range.start + range.len() / 2;
            self.build(facets, range.start..middle);
            self.nodes[node].second = self.nodes.len() as u32;
            self.build(facets, middle..range.end);
        }
    }

    /// Calls `visit` with every facet from number `from` on that may see `facet`, and the surfaces that may come between.
    pub fn each_partner(
        &self,
        facet: &Facet,
        occluders: &[Occluder],
        from: u32,
        visit: &mut impl FnMut(u32, &[Near]),
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let mut walk = Walk {
            tree: self,
            facet,
            occluders,
            from,
            near: Vec::new(),
        };
        for (k, occluder) in (0..).zip(occluders) {
            let sides = occluder.sides(facet);
            let is_in_plane = !occluder.is_body() && sides.is_on();
            if !occluder.is_face && !is_in_plane && occluder.rises_over(facet) {
                walk.near.push(Near { occluder: k, sides });
            }
        }
        let count = walk.near.len();
        walk.node(0, 0..count, visit);
    }
}

/// One facet's way through the tree; what may come between grows less with each level.
struct Walk<'a> {
    tree: &'a Tree,
    facet: &'a Facet,
    occluders: &'a [Occluder],
    from: u32,
    /// Occluders for the levels on the way, one after the other.
    near: Vec<Near>,
}

impl Walk<'_> {
    fn node(&mut self, number: usize, near: Range<usize>, visit: &mut impl FnMut(u32, &[Near])) {
        let tree = self.tree;
        let node = &tree.nodes[number];
        let (middle, half) = ((node.low + node.high) * 0.5, (node.high - node.low) * 0.5);
        let top = self.facet.height(middle) + self.facet.normal.abs().dot(half);
        if node.last < self.from || top <= 0.0 {
            return;
        }
        let begin = self.near.len();
        let (low, high) = (node.low.min(self.facet.low), node.high.max(self.facet.high));
        let (ends, width) = ([self.facet.centroid, middle], half.length());
        let width = width.max(self.facet.radius);
        for place in near {
            let near = self.near[place];
            let occluder = &self.occluders[near.occluder as usize];
            let is_apart = occluder.low.cmpge(high).any() || occluder.high.cmple(low).any();
            let is_between = !is_apart
                && !occluder.is_beside(ends, width)
                && !(near.sides).share_a_front(occluder.sides_of_box(node.low, node.high));
            if is_between {
                self.near.push(near);
            }
        }
        let end = self.near.len();
        if node.second == 0 {
            let members = node.facets.start as usize..node.facets.end as usize;
            for &other in &tree.order[members] {
                if other >= self.from {
                    visit(other, &self.near[begin..end]);
                }
            }
        } else {
            self.node(number + 1, begin..end, visit);
            self.node(node.second as usize, begin..end, visit);
        }
        self.near.truncate(begin);
    }
}
