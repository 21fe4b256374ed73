//! What clusters send, from what their tiles send.

use super::{Children, Clusters, Sends, Tile};
use crate::geometry::jitter;
use crate::radiometry::Spectrum;

impl Clusters {
    /// Takes over the radiosity of each tile, in their order; `seed` draws the points that rays are aimed at.
    pub fn radiate(&mut self, radiosity: Vec<Spectrum>, seed: u32) {
        assert_eq!(radiosity.len(), self.tiles.len());
        self.radiosity = radiosity;
        for number in (0..self.nodes.len()).rev() {
            let sends = match self.nodes[number].children {
                Children::Two(second) => {
                    let [a, b] = [number + 1, second as usize].map(|n| self.nodes[n].sends);
                    joined(a, b, jitter(number as u32, seed)[0] as f32)
                }
                Children::Tiles { first, count } => self.bucket(first, count, number as u32, seed),
            };
            self.nodes[number].sends = sends;
        }
    }

    fn bucket(&self, first: u32, count: u32, node: u32, seed: u32) -> Sends {
        let tiles = &self.order[first as usize..(first + count) as usize];
        let of = |tile: &u32| {
            let tile = *tile as usize;
            sent_by(
                &self.tiles[tile],
                self.radiosity[tile],
                jitter(tile as u32, !seed),
                self.offset,
            )
        };
        let draw = |place: usize| jitter(node.wrapping_add(place as u32), seed)[1] as f32;
        let sends = tiles.iter().map(of).enumerate();
        sends.fold(Sends::default(), |sum, (place, tile)| {
            joined(sum, tile, draw(place))
        })
    }
}

fn sent_by(tile: &Tile, radiosity: Spectrum, [s, t]: [f64; 2], offset: f32) -> Sends {
    let mean = radiosity.element_sum() / 3.0;
    let weight = tile.area() * mean;
    let place = |x: f64| (0.05 + 0.9 * x) as f32;
    Sends {
        flux: tile.normal * weight,
        weight,
        colour: if mean > 0.0 {
            radiosity / mean
        } else {
            Spectrum::ZERO
        },
        target: tile.at(place(s), place(t)) + tile.normal * offset,
        facing: tile.normal,
    }
}

/// Both together; rays go where one of them has its target, in proportion to what they send.
fn joined(a: Sends, b: Sends, draw: f32) -> Sends {
    let weight = a.weight + b.weight;
    if weight <= 0.0 {
        return a;
    }
    let drawn = if draw * weight < a.weight { a } else { b };
    Sends {
        flux: a.flux + b.flux,
        weight,
        colour: (a.colour * a.weight + b.colour * b.weight) / weight,
        ..drawn
    }
}
