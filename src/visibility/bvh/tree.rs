//! The tree: obvhs' nodes, with siblings side by side in one cache line.

use crate::visibility::Triangles;
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2, node::Bvh2Node};
use std::ops::Range;
use std::time::Duration;

/// A box with what it holds: a leaf's triangles, or the index of the pair of its children.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// Lower corner, padded.
    pub min: [f32; 3],
    /// First triangle of a leaf, else index of a pair.
    first: u32,
    /// Upper corner, padded.
    pub max: [f32; 3],
    /// Triangles in a leaf; 0 for an inner node.
    count: u32,
}

/// What is inside a node.
pub enum Content {
    /// Triangles, in the order of [`Tree::corners`].
    Leaf(Range<usize>),
    /// The pair of its children.
    Inner(u32),
}

/// Two siblings: one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Pair(pub [Node; 2]);

const _: () = assert!(size_of::<Pair>() == 64);

/// A bounding volume hierarchy over triangles.
#[derive(Debug)]
pub struct Tree {
    /// The whole scene; nothing if there are no triangles.
    pub root: Option<Node>,
    /// Inner nodes' children, parents first.
    pub pairs: Vec<Pair>,
    /// Corners of the triangles in the order of the leaves.
    pub corners: Vec<[Vec3; 3]>,
    /// The index that each of them has in the scene.
    pub indices: Vec<u32>,
    depth: usize,
}

impl Node {
    /// What is inside.
    pub fn content(&self) -> Content {
        match self.count {
            0 => Content::Inner(self.first),
            n => Content::Leaf(self.first as usize..(self.first + n) as usize),
        }
    }
}

impl Tree {
    /// Memory that it holds.
    pub fn bytes(&self) -> u64 {
        let (pairs, corners) = (size_of::<Pair>(), size_of::<[Vec3; 3]>() + size_of::<u32>());
        (self.pairs.len() * pairs + self.corners.len() * corners) as u64
    }

    /// Builds the tree over valid triangles.
    pub fn new(triangles: &Triangles) -> Self {
        let corners: Vec<_> = (0..triangles.indices.len())
            .map(|i| triangles.corners(i))
            .collect();
        let mut tree = Self {
            root: None,
            pairs: Vec::new(),
            corners: Vec::new(),
            indices: Vec::new(),
            depth: 0,
        };
        if corners.is_empty() {
            return tree;
        }
        let (bounds, params) = (padded_bounds(&corners), BvhBuildParams::medium_build());
        let bvh = build_bvh2(&bounds, params, &mut Duration::default());
        tree.corners = bvh
            .primitive_indices
            .iter()
            .map(|&i| corners[i as usize])
            .collect();
        tree.indices = bvh.primitive_indices.clone();
        tree.copy_nodes(&bvh);
        tree
    }

    /// Most pairs that wait on the stack of a traversal.
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Copies the nodes in depth-first order, so that no order of obvhs' is relied on, and measures
    /// the depth.
    fn copy_nodes(&mut self, bvh: &Bvh2) {
        let root = node(&bvh.nodes[0]);
        let mut waiting = Vec::new();
        if root.count == 0 {
            waiting.push(Waiting {
                source: root.first as usize,
                parent: None,
                depth: 1,
            });
        }
        while let Some(Waiting {
            source,
            parent,
            depth,
        }) = waiting.pop()
        {
            let pair = self.pairs.len();
            let children = [node(&bvh.nodes[source]), node(&bvh.nodes[source + 1])];
            self.pairs.push(Pair(children));
            self.depth = self.depth.max(depth);
            if let Some((parent, side)) = parent {
                self.pairs[parent].0[side].first = pair as u32;
            }
            for side in [1, 0] {
                let Node { first, count, .. } = children[side];
                if count == 0 {
                    let (source, parent) = (first as usize, Some((pair, side)));
                    waiting.push(Waiting {
                        source,
                        parent,
                        depth: depth + 1,
                    });
                }
            }
        }
        // An inner root's children are the pair that was copied first.
        let first = if root.count == 0 { 0 } else { root.first };
        self.root = Some(Node { first, ..root });
    }
}

/// A pair of siblings still to be copied.
struct Waiting {
    /// Index of the first of them in obvhs' nodes.
    source: usize,
    /// Pair and side of their parent.
    parent: Option<(usize, usize)>,
    depth: usize,
}

/// A box around each triangle, enlarged by 4 units in the last place of the largest coordinate: a
/// segment in the face of a box must enter it, and a triangle test that rounds must not hit outside of its box.
///
/// It also keeps the middle of a flat box off the upper face of the scene's box. There obvhs 0.4 wraps
/// the Morton code around to the lower face and pairs ceiling with floor: in a room with 156 thousand
/// triangles segments then took 20 times as long.
fn padded_bounds(corners: &[[Vec3; 3]]) -> Vec<Aabb> {
    let largest = corners
        .iter()
        .flatten()
        .fold(Vec3::ZERO, |m, v| m.max(v.abs()));
    let padding = Vec3A::splat(4.0 * f32::EPSILON * largest.max_element());
    let bounds = |corners: &[Vec3; 3]| {
        let Aabb { min, max } = Aabb::from_points(&corners.map(Vec3A::from));
        Aabb {
            min: min - padding,
            max: max + padding,
        }
    };
    corners.iter().map(bounds).collect()
}

fn node(node: &Bvh2Node) -> Node {
    let bounds = node.aabb();
    Node {
        min: bounds.min.to_array(),
        first: node.first_index,
        max: bounds.max.to_array(),
        count: node.prim_count,
    }
}
