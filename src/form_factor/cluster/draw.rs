//! Aims drawn anew in clusters.
//!
//! In which tile an aim is, is found in sums over all tiles, and where it is there, in the tile: two far places in memory, for which one draw
//! after the other would wait. So draws go side by side, and each step of theirs asks for the memory that the next one needs: of a million
//! triangles that takes 3 % off the time of a solve, of five millions 15 % off that of the shots.

use super::found::Drawn;
use super::{Aim, Cluster, Clusters};
use crate::geometry::jitter;
use crate::simd::prefetch;
use std::ops::Range;

/// Draws that go side by side.
const ABREAST: usize = 16;

/// Of the sums, one in so many is looked at first: these stay in the cache.
const STEP: usize = 32;

/// A draw on its way.
#[derive(Default)]
struct Draw {
    /// Of all that the cluster sends, this part is sent by the tiles before the place that is drawn; then the sum up to it.
    passed: f64,
    /// Along the first side of the tile that it is in.
    s: f64,
    /// The tiles that it may be in.
    tiles: Range<usize>,
}

impl Clusters {
    /// What to look at first to find a place in the sums.
    pub(super) fn steps(sums: &[f64]) -> Vec<f64> {
        sums.iter().step_by(STEP).copied().collect()
    }

    /// Draws an aim in each of `drawn`; `key` tells draws for one point from those for others.
    #[inline(always)]
    pub(super) fn draw(&self, drawn: &[Drawn], key: u32, mut take: impl FnMut(&Drawn, Aim)) {
        let mut draws: [Draw; ABREAST] = Default::default();
        for drawn in drawn.chunks(ABREAST) {
            let draws = &mut draws[..drawn.len()];
            for (draw, of) in draws.iter_mut().zip(drawn) {
                *draw = self.begun(of.cluster, key);
                prefetch(&self.sums[draw.tiles.start]);
                prefetch(&self.sums[draw.tiles.end]);
                if let Cluster::Node(number) = of.cluster {
                    prefetch(&self.sends[number as usize]);
                }
            }
            for draw in &mut *draws {
                self.narrow(draw);
                prefetch(&self.sums[draw.tiles.clone()]);
            }
            for draw in &mut *draws {
                self.find(draw);
                prefetch(&self.tiles[draw.tiles.start]);
            }
            for (draw, of) in draws.iter().zip(drawn) {
                let tile = draw.tiles.start as u32;
                let t = jitter(key ^ tile, self.seed)[0];
                take(of, self.aim(tile, [draw.s, t]));
            }
        }
    }

    #[inline(always)]
    fn begun(&self, cluster: Cluster, key: u32) -> Draw {
        let [passed, s] = jitter(key, cluster.key() ^ self.seed);
        let tiles = match cluster {
            Cluster::Tile(place) => place..place + 1,
            Cluster::Node(number) => {
                let node = &self.nodes[number as usize];
                node.first..node.end
            }
        };
        Draw {
            passed,
            s,
            tiles: tiles.start as usize..tiles.end as usize,
        }
    }

    /// Leaves the tiles between two steps.
    #[inline(always)]
    fn narrow(&self, draw: &mut Draw) {
        let Range { start, end } = draw.tiles;
        let [before, all] = [start, end].map(|tile| self.sums[tile]);
        draw.passed = before + draw.passed * (all - before);
        let steps = start.div_ceil(STEP)..end / STEP + 1;
        let passed = self.steps[steps.clone()].partition_point(|sum| *sum <= draw.passed);
        let step = STEP * (steps.start + passed);
        let begin = start.max(step.saturating_sub(STEP));
        draw.tiles = begin.min(end - 1)..end.min(step);
    }

    /// Leaves the tile in which what all tiles send together reaches what is `passed`.
    #[inline(always)]
    fn find(&self, draw: &mut Draw) {
        let Range { start, end } = draw.tiles;
        let reached = self.sums[start + 1..end].partition_point(|sum| *sum <= draw.passed);
        draw.tiles = start + reached..end;
    }
}

#[cfg(test)]
mod tests {
    use super::super::found::Found;
    use super::*;
    use crate::form_factor::Tile;
    use crate::radiometry::Spectrum;
    use glam::{DVec3, Vec3};

    /// Tiles in a row that send what is given.
    fn row(sent: impl Fn(u32) -> f32, seed: u32) -> Clusters {
        let tile = |i: u32| {
            let at = |x: f64, y: f64| DVec3::new(f64::from(i) + x, y, 0.0);
            Tile::new(&[at(0.0, 0.0), at(0.9, 0.0), at(0.0, 0.9)], DVec3::Z, false)
        };
        let sent = |i: u32| Spectrum::splat(sent(i));
        let mut clusters = Clusters::new((0..1000).map(tile).collect(), 1000.0);
        clusters.radiate((0..1000).map(sent).collect(), seed);
        clusters
    }

    #[test]
    fn a_draw_falls_where_what_tiles_send_reaches_what_is_drawn() {
        // Each fifth sends nothing.
        let clusters = row(|i| if i % 5 == 2 { 0.0 } else { 1.0 + i as f32 }, 7);
        let nodes = (0..clusters.nodes.len() as u32).map(Cluster::Node);
        let all: Vec<Cluster> = nodes.chain((0..1000).map(Cluster::Tile)).collect();
        let drawn = |cluster: &Cluster| Drawn {
            cluster: *cluster,
            bound: 1.0,
            stands_for: 1.0,
        };
        let drawn: Vec<Drawn> = all.iter().map(drawn).collect();
        for key in 0..100 {
            let mut expected = all.iter().map(|cluster| {
                let Draw { passed, tiles, .. } = clusters.begun(*cluster, key);
                let sums = &clusters.sums[tiles.start..=tiles.end];
                let passed = sums[0] + passed * (sums[sums.len() - 1] - sums[0]);
                let before = sums.iter().take_while(|sum| **sum <= passed).count();
                tiles.start + before.clamp(1, tiles.len()) - 1
            });
            clusters.draw(&drawn, key, |_, aim| {
                let tile = expected.next().expect("an aim for each");
                assert_eq!(aim.target.x.floor(), clusters.tiles[tile].corners[0].x);
            });
            assert!(expected.next().is_none());
        }
    }

    /// Of five clusters that count alike one is drawn, and then a place in it: also in the first shot of a solve, of which the seed is 0.
    #[test]
    fn which_cluster_is_drawn_says_nothing_of_where_in_it() {
        for seed in [0, 1] {
            let clusters = row(|_| 1.0, seed);
            let count = clusters.nodes.len() as u32;
            let large = (0..count).filter(|n| {
                let node = &clusters.nodes[*n as usize];
                (100..200).contains(&(node.end - node.first))
            });
            let large: Vec<Cluster> = large.map(Cluster::Node).take(5).collect();
            assert_eq!(large.len(), 5);
            let place_of = |target: Vec3| {
                let is_there = |tile: &Tile| tile.corners[0].x == target.x.floor();
                clusters.tiles.iter().position(is_there).expect("of a tile")
            };
            let (mut found, mut first_halves) = (Found::default(), 0_usize);
            for key in 0..2000 {
                found.clear();
                for cluster in &large {
                    found.loosen(*cluster, 1.0, f32::INFINITY, key);
                }
                found.draw(&clusters, key, |of, aim| {
                    let node = clusters.node(of.cluster);
                    let middle = (node.first + node.end) as usize / 2;
                    Spectrum::splat(if place_of(aim.target) < middle {
                        1.0
                    } else {
                        0.0
                    })
                });
                first_halves += found.len();
            }
            // 1000, standard deviation 22; five of them.
            assert!(first_halves.abs_diff(1000) < 112, "{first_halves}");
        }
    }
}
