//! Grouping tiles: first by the way they face and the side they are of, then in halves of space.

use super::{Cluster, Clusters, Node, Sends, Tile};
use crate::geometry::{SURFACE_OFFSET, facing};
use crate::radiometry::Spectrum;
use glam::Vec3;
use rayon::iter::repeat_n;
use rayon::prelude::*;

/// Nodes deeper than this are split into equal numbers, so that no arrangement of tiles makes a deep tree.
const DEEPEST_IN_SPACE: u32 = 40;

impl Clusters {
    /// The tree over `tiles`, in a scene of the given extent; nothing radiates yet.
    pub fn new(mut tiles: Vec<Tile>, extent: f64) -> Self {
        let mut order: Vec<u32> = (0..tiles.len() as u32).collect();
        let side = |tile: &u32| {
            let of = &tiles[*tile as usize];
            (facing(of.normal.as_dvec3()), of.back)
        };
        order.par_sort_by_key(side);
        let builder = Builder {
            tiles: &tiles,
            centres: tiles.par_iter().map(Tile::centre).collect(),
        };
        let (mut nodes, mut roots, mut first) = (Vec::new(), Vec::new(), 0);
        for group in order.chunk_by_mut(|a, b| side(a) == side(b)) {
            let end = first + group.len() as u32;
            roots.push(Cluster::over(first, end, nodes.len() as u32));
            builder.build(group, Place { first, depth: 0 }, &mut nodes);
            first = end;
        }
        nodes.shrink_to_fit();
        let mut places = vec![0; tiles.len()];
        for (place, tile) in (0..).zip(&order) {
            places[*tile as usize] = place;
        }
        drop(order);
        rearrange(&mut tiles, &mut places.clone());
        Self {
            radiosity: vec![Spectrum::ZERO; tiles.len()],
            sends: repeat_n(Sends::default(), nodes.len()).collect(),
            sums: vec![0.0; tiles.len() + 1],
            steps: Vec::new(),
            tiles,
            places,
            nodes,
            roots,
            seed: 0,
            offset: (SURFACE_OFFSET * extent) as f32,
        }
    }
}

/// Brings each tile to its place, within the memory that they have.
fn rearrange(tiles: &mut [Tile], places: &mut [u32]) {
    for at in 0..tiles.len() {
        while places[at] as usize != at {
            let place = places[at] as usize;
            tiles.swap(at, place);
            places.swap(at, place);
        }
    }
}

struct Builder<'a> {
    tiles: &'a [Tile],
    centres: Vec<Vec3>,
}

/// Where a node is.
#[derive(Clone, Copy)]
struct Place {
    /// The place of its first tile.
    first: u32,
    depth: u32,
}

impl Builder<'_> {
    /// Adds the node over `group`, and then all below it; there is none over one tile.
    fn build(&self, group: &mut [u32], at: Place, nodes: &mut Vec<Node>) {
        if group.len() == 1 {
            return;
        }
        let number = nodes.len();
        let mut node = self.node(group, at.first);
        nodes.push(node);
        if node.is_over_few() {
            return;
        }
        let middle = self.halve(group, at.depth);
        node.middle = at.first + middle as u32;
        let (left, right) = group.split_at_mut(middle);
        let depth = at.depth + 1;
        let at_left = Place { depth, ..at };
        let at_right = Place {
            first: node.middle,
            depth,
        };
        if node.is_worth_two_threads() {
            let (mut nodes_left, mut nodes_right) = (Vec::new(), Vec::new());
            rayon::join(
                || self.build(left, at_left, &mut nodes_left),
                || self.build(right, at_right, &mut nodes_right),
            );
            nodes.append(&mut nodes_left);
            node.second = (nodes.len() - number) as u32;
            nodes.append(&mut nodes_right);
        } else {
            self.build(left, at_left, nodes);
            node.second = (nodes.len() - number) as u32;
            self.build(right, at_right, nodes);
        }
        nodes[number] = node;
    }

    fn node(&self, group: &[u32], first: u32) -> Node {
        let of = |tile: &u32| &self.tiles[*tile as usize];
        let areas: f32 = group.iter().map(|t| of(t).area()).sum();
        let weighted = |t: &u32| self.centres[*t as usize] * of(t).area();
        let centre = group.iter().map(weighted).sum::<Vec3>() / areas.max(f32::MIN_POSITIVE);
        let far = |t: &u32| {
            let corners = of(t).corners.iter();
            corners
                .map(|c| c.distance_squared(centre))
                .fold(0.0, f32::max)
        };
        let vector_area: Vec3 = group.iter().map(|t| of(t).normal * of(t).area()).sum();
        let axis = vector_area.normalize_or(of(&group[0]).normal);
        let aside = |t: &u32| {
            let corners = of(t).corners.iter();
            corners
                .map(|c| (*c - centre).dot(axis).abs())
                .fold(0.0, f32::max)
        };
        // The sine from the normals themselves: from the cosine it would be lost in rounding where they are all but parallel.
        let sine_of = |t: &u32| of(t).normal.cross(axis).length();
        let cosine = group
            .iter()
            .map(|t| of(t).normal.dot(axis))
            .fold(1.0, f32::min);
        let sine = group.iter().map(sine_of).fold(0.0, f32::max);
        Node {
            centre,
            radius: group.iter().map(far).fold(0.0, f32::max).sqrt(),
            cone: (cosine, if cosine > 0.0 { sine } else { 1.0 }),
            axis,
            thickness: group.iter().map(aside).fold(0.0, f32::max),
            first,
            end: first + group.len() as u32,
            ..Node::default()
        }
    }

    /// Sorts a group into two halves of the box around its centres; gives where the second begins.
    fn halve(&self, group: &mut [u32], depth: u32) -> usize {
        let centre = |tile: &u32| self.centres[*tile as usize];
        let (low, high) = group
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), tile| {
                (low.min(centre(tile)), high.max(centre(tile)))
            });
        let axis = (high - low).max_position();
        let middle = 0.5 * (low[axis] + high[axis]);
        if depth < DEEPEST_IN_SPACE && low[axis] < middle {
            // Stable, so that the tree is the same on every machine.
            group.sort_by_key(|tile| centre(tile)[axis] >= middle);
            let lower = group.partition_point(|tile| centre(tile)[axis] < middle);
            if lower > 0 && lower < group.len() {
                return lower;
            }
        }
        group.sort_by(|a, b| centre(a)[axis].total_cmp(&centre(b)[axis]));
        group.len() / 2
    }
}
