//! The visible share of a pair with too much between to cut out: rays, in rounds, until they agree.

use super::facet::Facet;
use super::hidden::Share;
use super::pair::Kind;
use super::space::Space;
use crate::geometry::{jitter, lift};
use crate::visibility::Fans;
use glam::{DVec3, Vec3};

/// Rays of a round leave from this many by this many cells of one facet …
const ORIGINS: u32 = 4;
/// … for this many by this many of the other.
const TARGETS: u32 = 8;

/// Rounds that are always traced.
const FEWEST_ROUNDS: u32 = 4;

/// Rounds after which the tolerance is given up.
const MOST_ROUNDS: u32 = 32;

/// Traces rays between facets.
pub(super) struct Sampler<'a> {
    space: &'a Space,
    fans: Fans,
    masks: Vec<u64>,
    origins: Vec<(DVec3, f64)>,
    targets: Vec<(DVec3, f64)>,
}

impl<'a> Sampler<'a> {
    pub fn new(space: &'a Space) -> Self {
        Self {
            space,
            fans: Fans::default(),
            masks: Vec::new(),
            origins: Vec::new(),
            targets: Vec::new(),
        }
    }

    /// The visible share of a pair, with the standard error of the rounds.
    pub fn share(&mut self, [a, b]: [&Facet; 2], tolerance: f64, [i, j]: [u32; 2]) -> Share {
        let mut rounds = Rounds::default();
        let mut rays = 0;
        while rounds.count < MOST_ROUNDS
            && (rounds.count < FEWEST_ROUNDS || rounds.error() > tolerance)
        {
            let seed = jitter_seed(i, j, rounds.count);
            scatter(a, ORIGINS, seed, &mut self.origins);
            scatter(b, TARGETS, seed.wrapping_add(1), &mut self.targets);
            rounds.add(self.round(a, b));
            rays += self.fans.segments() as u64;
        }
        let error = rounds.error();
        let kind = if error <= tolerance {
            Kind::Sampled
        } else {
            Kind::Limited
        };
        Share {
            visible: rounds.mean(),
            error,
            kind,
            rays,
        }
    }

    /// The share of one round's rays that pass, each with what it would carry.
    fn round(&mut self, a: &Facet, b: &Facet) -> f64 {
        let extent = self.space.extent;
        let place = |x: DVec3, facet: &Facet| -> Vec3 { lift(x, facet.normal, extent).as_vec3() };
        self.fans.clear();
        // Polygons of five corners and more have several tiles, and their targets several fans.
        for (x, _) in &self.origins {
            for targets in self.targets.chunks(crate::visibility::MAX_FAN) {
                self.fans.begin(place(*x, a));
                targets
                    .iter()
                    .for_each(|(y, _)| self.fans.push(place(*y, b)));
            }
        }
        self.space.visibility.occluded(&self.fans, &mut self.masks);
        let (mut visible, mut all) = (0.0, 0.0);
        let mut masks = self.masks.iter();
        for (x, wx) in &self.origins {
            for targets in self.targets.chunks(crate::visibility::MAX_FAN) {
                let mask = masks.next().copied().unwrap_or(0);
                for (k, (y, wy)) in targets.iter().enumerate() {
                    let r = *y - *x;
                    let square = r.length_squared();
                    let carried =
                        wx * wy * (a.normal.dot(r) * -b.normal.dot(r)).max(0.0) / (square * square);
                    all += carried;
                    if mask & (1 << k) == 0 {
                        visible += carried;
                    }
                }
            }
        }
        if all > 0.0 { visible / all } else { 0.0 }
    }
}

fn jitter_seed(i: u32, j: u32, round: u32) -> u32 {
    let [mixed, _] = jitter(i, j);
    ((mixed * 4_294_967_296.0) as u32).wrapping_add(round.wrapping_mul(0x9e37_79b9))
}

/// Points at random, one in each cell of a grid on every tile, with the areas that they stand for.
fn scatter(facet: &Facet, cells: u32, seed: u32, points: &mut Vec<(DVec3, f64)>) {
    points.clear();
    for tile in facet.shape.tiles() {
        let [a, b, c, d] = tile.quad();
        for cell in 0..cells * cells {
            let [s, t] = jitter(seed, points.len() as u32);
            let u = (f64::from(cell % cells) + s) / f64::from(cells);
            let v = (f64::from(cell / cells) + t) / f64::from(cells);
            let (left, right) = (a.lerp(d, v), b.lerp(c, v));
            let along_u = right - left;
            let area = along_u.cross((d - a).lerp(c - b, u)).length();
            points.push((left + along_u * u, area / f64::from(cells * cells)));
        }
    }
}

/// Mean and spread of the rounds.
#[derive(Default)]
struct Rounds {
    count: u32,
    sum: f64,
    squares: f64,
}

impl Rounds {
    fn add(&mut self, share: f64) {
        self.count += 1;
        self.sum += share;
        self.squares += share * share;
    }

    fn mean(&self) -> f64 {
        self.sum / f64::from(self.count.max(1))
    }

    fn error(&self) -> f64 {
        let n = f64::from(self.count);
        let variance = (self.squares / n - self.mean() * self.mean()).max(0.0);
        (variance / (n - 1.0).max(1.0)).sqrt()
    }
}
