//! Grouping tiles: first by the way they face and the side they are of, then in halves of space.

use super::{Cluster, Clusters, Node, Sends, Tile};
use crate::geometry::{SURFACE_OFFSET, facing};
use crate::radiometry::Spectrum;
use glam::{Vec3, Vec4};
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
        let centre = |tile: &Tile| tile.centre().extend(tile.area());
        let builder = Builder {
            tiles: &tiles,
            centres: tiles.par_iter().map(centre).collect(),
        };
        let mut first = 0;
        let mut groups = Vec::new();
        for group in order.chunk_by_mut(|a, b| side(a) == side(b)) {
            let at = Place { first, depth: 0 };
            first += group.len() as u32;
            groups.push((at, group));
        }
        let trees = groups.into_par_iter().with_max_len(1).map(|(at, group)| {
            let mut nodes = Vec::new();
            builder.build(group, at, &mut nodes);
            (at.first..at.first + group.len() as u32, nodes)
        });
        let trees: Vec<_> = trees.collect();
        let mut nodes = Vec::with_capacity(trees.iter().map(|(_, nodes)| nodes.len()).sum());
        let mut roots = Vec::new();
        for (of, mut tree) in trees {
            roots.push(Cluster::over(of.start, of.end, nodes.len() as u32));
            nodes.append(&mut tree);
        }
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
    /// The centre of each, and its area.
    centres: Vec<Vec4>,
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
        let (mut areas, mut centre, mut vector_area) = (0.0, Vec3::ZERO, Vec3::ZERO);
        for (tile, at) in self.of(group) {
            areas += at.w;
            centre += at.truncate() * at.w;
            vector_area += tile.normal * at.w;
        }
        centre /= areas.max(f32::MIN_POSITIVE);
        let axis = vector_area.normalize_or(self.tiles[group[0] as usize].normal);
        let (mut square, mut thickness) = (0.0_f32, 0.0_f32);
        let (mut cosine, mut square_sine) = (1.0_f32, 0.0_f32);
        for (tile, _) in self.of(group) {
            for corner in tile.corners {
                let to = corner - centre;
                square = square.max(to.length_squared());
                thickness = thickness.max(to.dot(axis).abs());
            }
            cosine = cosine.min(tile.normal.dot(axis));
            // From the normals themselves: from the cosine it would be lost in rounding where they are all but parallel.
            square_sine = square_sine.max(tile.normal.cross(axis).length_squared());
        }
        let sine = if cosine > 0.0 {
            square_sine.sqrt()
        } else {
            1.0
        };
        Node {
            centre,
            radius: square.sqrt(),
            cone: (cosine, sine),
            axis,
            thickness,
            first,
            end: first + group.len() as u32,
            ..Node::default()
        }
    }

    /// The tiles of a group, each with its centre and area.
    fn of(&self, group: &[u32]) -> impl Iterator<Item = (&Tile, Vec4)> {
        let places = group.iter().map(|tile| *tile as usize);
        places.map(|place| (&self.tiles[place], self.centres[place]))
    }

    /// Sorts a group into two halves of the box around its centres; gives where the second begins.
    fn halve(&self, group: &mut [u32], depth: u32) -> usize {
        let centre = |tile: &u32| self.centres[*tile as usize].truncate();
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
