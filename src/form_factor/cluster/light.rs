//! What clusters send, from what their tiles send.

use super::{Aim, Cluster, Clusters, Node, Sends};
use crate::geometry::jitter;
use crate::radiometry::Spectrum;
use glam::{Mat3, Vec3, Vec3Swizzles};
use rayon::prelude::*;
use std::mem::take;

impl Clusters {
    /// Takes over the radiosity of each tile, in their order; `seed` draws the points that rays are aimed at.
    pub fn radiate(&mut self, radiosity: Vec<Spectrum>, seed: u32) {
        assert_eq!(radiosity.len(), self.tiles.len());
        for (place, radiosity) in self.places.iter().zip(radiosity) {
            self.radiosity[*place as usize] = radiosity;
        }
        self.seed = seed;
        let mut sums = take(&mut self.sums);
        let weights = (0..self.tiles.len() as u32)
            .into_par_iter()
            .with_min_len(4096)
            .map(|tile| f64::from(self.weight(tile)));
        weights.collect_into_vec(&mut sums);
        let mut sum = 0.0;
        for before in &mut sums {
            sum += std::mem::replace(before, sum);
        }
        sums.push(sum);
        self.sums = sums;
        self.steps = Self::steps(&self.sums);
        let (mut nodes, mut sends) = (take(&mut self.nodes), take(&mut self.sends));
        for root in &self.roots {
            if let Cluster::Node(number) = *root {
                let tree = number as usize..;
                self.send(*root, &mut nodes[tree.clone()], &mut sends[tree]);
            }
        }
        (self.nodes, self.sends) = (nodes, sends);
    }

    /// Finds what a cluster sends, and all below it: these are the first of `nodes`. Gives what it sends, and its largest radiosity.
    fn send(&self, cluster: Cluster, nodes: &mut [Node], sends: &mut [Sends]) -> (Sends, f32) {
        let number = match cluster {
            Cluster::Node(number) => number,
            Cluster::Tile(place) => return self.with_peak(place),
        };
        let ([node, below @ ..], [sent, sent_below @ ..]) = (nodes, sends) else {
            unreachable!("a node is the first of those that are of it and below it");
        };
        let drawn = |tile: u32| jitter(number, self.seed ^ tile)[0] as f32;
        (*sent, node.peak) = if node.is_over_few() {
            let begin = self.with_peak(node.first);
            (node.first + 1..node.end).fold(begin, |(sent, peak), tile| {
                let (other, other_peak) = self.with_peak(tile);
                (joined(sent, other, drawn(tile)), peak.max(other_peak))
            })
        } else {
            let [left, right] = node.children(number);
            let middle = node.second as usize - 1;
            let (nodes_left, nodes_right) = below.split_at_mut(middle);
            let (sends_left, sends_right) = sent_below.split_at_mut(middle);
            let mut left = || self.send(left, nodes_left, sends_left);
            let mut right = || self.send(right, nodes_right, sends_right);
            let ((sent, peak), (other, other_peak)) = if node.is_worth_two_threads() {
                rayon::join(left, right)
            } else {
                (left(), right())
            };
            let draw = drawn(node.middle);
            (joined(sent, other, draw), peak.max(other_peak))
        };
        node.strength = sent.weight * sent.colour.max_element();
        (*sent, node.peak)
    }

    /// What a tile sends, and its largest radiosity.
    fn with_peak(&self, place: u32) -> (Sends, f32) {
        (self.sent_by(place), self.tile(place).1.max_element())
    }

    /// Mean radiosity of the channels.
    fn mean(&self, tile: u32) -> f32 {
        self.radiosity[tile as usize].element_sum() / 3.0
    }

    /// Area × mean radiosity of a tile.
    fn weight(&self, tile: u32) -> f32 {
        self.tiles[tile as usize].area() * self.mean(tile)
    }

    /// An aim at the place (s, t) of a tile.
    pub(super) fn aim(&self, tile: u32, at: [f64; 2]) -> Aim {
        let of = &self.tiles[tile as usize];
        let [s, t] = at.map(|x| (0.05 + 0.9 * x) as f32);
        Aim {
            target: of.at(s, t) + of.normal * self.offset,
            normal: of.normal,
        }
    }

    /// What a tile sends.
    #[inline(always)]
    pub(super) fn sent_by(&self, place: u32) -> Sends {
        let (tile, radiosity) = self.tile(place);
        let mean = self.mean(place);
        let weight = tile.area() * mean;
        let centre = tile.centre();
        let corners = &tile.corners[..tile.corner_count()];
        // About its own centre a triangle or parallelogram has a twelfth of what its corners have.
        let inside = corners
            .iter()
            .map(|corner| products(*corner - centre, 1.0 / 12.0));
        Sends {
            flux: tile.normal * weight,
            weight,
            centre,
            spread: inside.fold([Vec3::ZERO; 2], plus),
            turn: Mat3::ZERO,
            colour: if mean > 0.0 {
                radiosity / mean
            } else {
                Spectrum::ZERO
            },
            aim: self.aim(place, jitter(place, !self.seed)),
        }
    }
}

/// Both together; rays go where one of them has its target, in proportion to what they send.
fn joined(a: Sends, b: Sends, draw: f32) -> Sends {
    let weight = a.weight + b.weight;
    if a.weight <= 0.0 {
        return b;
    }
    if b.weight <= 0.0 {
        return a;
    }
    let drawn = if draw * weight < a.weight { a } else { b };
    let (of_a, of_b) = (a.weight / weight, b.weight / weight);
    let between = b.centre - a.centre;
    let apart = products(between, of_a * of_b);
    let turned = outer(b.flux * of_a - a.flux * of_b, between);
    let spread = [0, 1].map(|i| a.spread[i] * of_a + b.spread[i] * of_b + apart[i]);
    Sends {
        flux: a.flux + b.flux,
        weight,
        centre: a.centre * of_a + b.centre * of_b,
        spread,
        turn: a.turn + b.turn + turned,
        colour: (a.colour * a.weight + b.colour * b.weight) / weight,
        ..drawn
    }
}

/// `factor` times the products of a vector's components: xx, yy, zz and yz, zx, xy.
fn products(of: Vec3, factor: f32) -> [Vec3; 2] {
    let scaled = of * factor;
    [of * scaled, of.yzx() * scaled.zxy()]
}

/// The products of the components of two vectors: those of `a` in each column.
fn outer(a: Vec3, b: Vec3) -> Mat3 {
    Mat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn plus(a: [Vec3; 2], b: [Vec3; 2]) -> [Vec3; 2] {
    [a[0] + b[0], a[1] + b[1]]
}
