//! What a point has found on its way through the tree.

use super::{Aim, Cluster, Clusters};
use crate::form_factor::Gather;
use crate::geometry::jitter;
use crate::radiometry::Spectrum;
use crate::visibility::MAX_FAN;
use glam::Vec3;

/// What is pooled for one ray gives at least this part of ε_fe.
const POOLED: f32 = 0.25;

/// What a draw settles is bounded by this many times ε_fe: with 0.5, draws were noisier than the tests of clusters allow.
const LOOSE: f32 = 0.1;

/// What a point gets from a cluster or tile, if all of its rays arrive.
#[derive(Debug, Clone, Copy)]
struct Part {
    contribution: Spectrum,
    rays: u32,
}

/// Parts that are too small for a ray each: one ray, to one of them drawn in proportion to what they give, answers for all.
#[derive(Debug, Clone, Copy, Default)]
struct Pool {
    contribution: Spectrum,
    measure: f32,
    target: Vec3,
    draws: u32,
}

/// Clusters that a point may see a part of, to be settled by one draw: first which of them, in proportion to what can arrive of it, and
/// then which place of it.
#[derive(Debug, Clone, Copy, Default)]
struct Loose {
    /// Σ of the bounds of all.
    bounds: f32,
    /// One of them, and its bound.
    drawn: Option<(Cluster, f32)>,
}

/// A cluster that was drawn of several.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    pub cluster: Cluster,
    /// No more than this can arrive of it.
    pub bound: f32,
    /// So many times what it gives stands for all.
    pub stands_for: f32,
}

/// The parts of one point and the targets of their rays.
#[derive(Default)]
pub(super) struct Found {
    parts: Vec<Part>,
    /// Of the rays of all parts, in their order.
    targets: Vec<Vec3>,
    /// For each of these, what part of its part arrives with it.
    shares: Vec<f32>,
    pool: Pool,
    loose: Loose,
    /// What is still to be drawn from.
    drawn: Vec<Drawn>,
}

impl Found {
    pub fn clear(&mut self) {
        self.parts.clear();
        self.targets.clear();
        self.shares.clear();
        self.pool = Pool::default();
        self.loose = Loose::default();
        self.drawn.clear();
    }

    /// How many parts there are, with those to be drawn.
    pub fn len(&self) -> usize {
        self.parts.len() + self.drawn.len()
    }

    pub fn targets(&self) -> &[Vec3] {
        &self.targets
    }

    /// Adds a part with one ray.
    #[inline(always)]
    pub fn push(&mut self, contribution: Spectrum, target: Vec3) {
        self.targets.push(target);
        self.shares.push(1.0);
        self.parts.push(Part {
            contribution,
            rays: 1,
        });
    }

    /// Adds a part with a ray to each target; what arrives with each is in proportion to what `kernel` says of it.
    #[inline(always)]
    pub fn push_all(
        &mut self,
        contribution: Spectrum,
        targets: impl ExactSizeIterator<Item = Vec3>,
        kernel: impl Fn(Vec3) -> f32,
    ) {
        let rays = targets.len();
        let before = self.targets.len();
        self.targets.extend(targets);
        let kernels = self.targets[before..].iter().map(|target| kernel(*target));
        self.shares.extend(kernels);
        let shares = &mut self.shares[before..];
        let all: f32 = shares.iter().sum();
        if all > 0.0 && all.is_finite() {
            let scale = 1.0 / all;
            shares.iter_mut().for_each(|share| *share *= scale);
        } else {
            shares.fill(1.0 / rays as f32);
        }
        self.parts.push(Part {
            contribution,
            rays: rays as u32,
        });
    }

    /// Adds what one ray is enough for, by itself or with others; `key` draws the one that the ray goes to.
    #[inline(always)]
    pub fn pool(&mut self, contribution: Spectrum, target: Vec3, estimate: f32, key: u32) {
        let measure = contribution.max_element();
        if measure <= 0.0 {
            return;
        }
        let pool = &mut self.pool;
        pool.contribution += contribution;
        pool.measure += measure;
        pool.draws += 1;
        if pool.draws == 1 || jitter(key, !pool.draws)[0] as f32 * pool.measure < measure {
            pool.target = target;
        }
        if pool.measure >= POOLED * estimate {
            self.empty_pool();
        }
    }

    /// The ray for what is left in the pool.
    pub fn empty_pool(&mut self) {
        let pool = std::mem::take(&mut self.pool);
        if pool.draws > 0 {
            self.push(pool.contribution, pool.target);
        }
    }

    /// Adds a cluster of which no more than `bound` can arrive. When there are enough, one of them is to be drawn from.
    pub fn loosen(&mut self, cluster: Cluster, bound: f32, estimate: f32, key: u32) {
        if bound <= 0.0 {
            return;
        }
        let loose = &mut self.loose;
        loose.bounds += bound;
        // By another number than those that say where in a cluster its aim is.
        let drawn = jitter(!key, cluster.key())[0] as f32 * loose.bounds < bound;
        if drawn || loose.drawn.is_none() {
            loose.drawn = Some((cluster, bound));
        }
        if loose.bounds >= LOOSE * estimate {
            self.empty_loose();
        }
    }

    fn empty_loose(&mut self) {
        let Loose { bounds, drawn } = std::mem::take(&mut self.loose);
        self.drawn.extend(drawn.map(|(cluster, bound)| Drawn {
            cluster,
            bound,
            stands_for: bounds / bound,
        }));
    }

    /// Draws an aim in all that is to be drawn from, also in what is left; `given` says what arrives from there.
    #[inline(always)]
    pub fn draw(
        &mut self,
        clusters: &Clusters,
        key: u32,
        given: impl Fn(&Drawn, &Aim) -> Spectrum,
    ) {
        self.empty_loose();
        let mut drawn = std::mem::take(&mut self.drawn);
        clusters.draw(&drawn, key, |of, aim| {
            let contribution = given(of, &aim);
            if contribution.max_element() > 0.0 {
                self.push(contribution, aim.target);
            }
        });
        drawn.clear();
        self.drawn = drawn;
    }

    /// Adds up the parts; `masks` are those of the fans of its targets.
    pub fn sum(&self, masks: &mut impl Iterator<Item = u64>) -> Gather {
        let mut gather = Gather::default();
        let (mut mask, mut bit) = (0, MAX_FAN);
        let mut shares = self.shares.iter();
        for part in &self.parts {
            let (mut seen, mut hidden) = (0.0, false);
            for share in shares.by_ref().take(part.rays as usize) {
                if bit == MAX_FAN {
                    (mask, bit) = (masks.next().expect("a mask for each fan"), 0);
                }
                match mask >> bit & 1 {
                    0 => seen += share,
                    _ => hidden = true,
                }
                bit += 1;
            }
            gather.unoccluded += part.contribution;
            // All of it to the last bit, where all is seen.
            gather.irradiance += part.contribution * if hidden { seen } else { 1.0 };
        }
        let all = gather.unoccluded.element_sum();
        gather.visibility = (all > 0.0).then(|| gather.irradiance.element_sum() / all);
        gather
    }
}
