//! The tree: obvhs' nodes, with siblings side by side in one cache line.

use crate::visibility::Triangles;
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris, node::Bvh2Node};
use obvhs::triangle::Triangle;
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
        let input: Vec<_> = corners
            .iter()
            .map(|&[a, b, c]| Triangle {
                v0: a.into(),
                v1: b.into(),
                v2: c.into(),
            })
            .collect();
        let params = BvhBuildParams::medium_build();
        let bvh = build_bvh2_from_tris(&input, params, &mut Duration::default());
        tree.corners = bvh
            .primitive_indices
            .iter()
            .map(|&i| corners[i as usize])
            .collect();
        tree.indices = bvh.primitive_indices.clone();
        tree.copy_nodes(&bvh, padding(&corners));
        tree
    }

    /// Most pairs that wait on the stack of a traversal.
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Copies the nodes in depth-first order, so that no order of obvhs' is relied on, and measures
    /// the depth.
    fn copy_nodes(&mut self, bvh: &Bvh2, padding: f32) {
        let root = padded(&bvh.nodes[0], padding);
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
            let children = [source, source + 1].map(|i| padded(&bvh.nodes[i], padding));
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

/// What boxes are enlarged by: 4 units in the last place of the largest coordinate. A segment in the
/// face of a box must enter it, and a triangle test that rounds must not hit outside of its box.
fn padding(corners: &[[Vec3; 3]]) -> f32 {
    let largest = corners
        .iter()
        .flatten()
        .fold(Vec3::ZERO, |m, v| m.max(v.abs()));
    4.0 * f32::EPSILON * largest.max_element()
}

fn padded(node: &Bvh2Node, padding: f32) -> Node {
    let (bounds, padding) = (node.aabb(), Vec3A::splat(padding));
    Node {
        min: (bounds.min - padding).to_array(),
        first: node.first_index,
        max: (bounds.max + padding).to_array(),
        count: node.prim_count,
    }
}
