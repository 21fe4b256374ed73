//! What a block of points receives from all clusters: for each point a cut through the tree, one ray a cluster.

use super::Clusters;
use super::view::View;
use crate::form_factor::hybrid::{Receiver, above_horizon, point_in_cut};
use crate::form_factor::partition::Limits;
use crate::form_factor::source::{Cell, SourceShape};
use crate::form_factor::{Formula, Gather, Sampler};
use crate::geometry::{jitter, lift};
use crate::radiometry::Spectrum;
use crate::visibility::{Fans, MAX_FAN};
use glam::{DVec3, Vec3};

/// Clusters and tiles that one point may gather from before its thresholds are doubled.
const MOST: usize = 2048;

/// Light that is known to be there counts at least this part of the scene's reference: where it is dark, thresholds need not follow
/// the light to nothing.
const LEAST_KNOWN: f32 = 0.1;

/// A cluster that looks larger than this, radius over distance, is not taken whole for the first guess of the light at a point.
const GUESS: f32 = 1.0;

/// Rays along each side of a tile that gives a point much.
const MOST_RAYS: u32 = 4;

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
    measure: f64,
    target: Vec3,
    draws: u32,
}

/// What is pooled for one ray gives at least this part of ε_fe.
const POOLED: f64 = 0.25;

/// Memory of a thread, reused between blocks.
#[derive(Default)]
pub struct ClusterScratch {
    pending: Vec<u32>,
    parts: Vec<Part>,
    /// Where the parts of each point end.
    ends: Vec<usize>,
    targets: Vec<Vec3>,
    fans: Fans,
    masks: Vec<u64>,
}

impl Sampler<'_> {
    /// Evaluates `clusters` at each receiver into `gathers`; returns the number of rays. With `settled`, neighbours send their rays
    /// to the same places, so that what they find differs by little; else each draws its own, so that the mean of many is right.
    pub fn gather_clusters(
        &self,
        clusters: &Clusters,
        receivers: &[(Receiver, u32)],
        settled: bool,
        scratch: &mut ClusterScratch,
        gathers: &mut Vec<Gather>,
    ) -> u64 {
        scratch.parts.clear();
        scratch.ends.clear();
        scratch.fans.clear();
        for (receiver, key) in receivers {
            let limits = self.cluster_limits(clusters, receiver, &mut scratch.pending);
            scratch.targets.clear();
            Cut {
                pool: Pool::default(),
                sampler: self,
                clusters,
                receiver,
                key: *key,
                settled,
                limits,
            }
            .take(scratch);
            scratch.ends.push(scratch.parts.len());
            let origin = lift(receiver.point, receiver.normal, self.extent).as_vec3();
            for fan in scratch.targets.chunks(MAX_FAN) {
                scratch.fans.begin(origin);
                fan.iter().for_each(|target| scratch.fans.push(*target));
            }
        }
        self.visibility.occluded(&scratch.fans, &mut scratch.masks);
        sum(scratch, gathers);
        scratch.fans.segments() as u64
    }

    fn cluster_limits(
        &self,
        clusters: &Clusters,
        receiver: &Receiver,
        pending: &mut Vec<u32>,
    ) -> Limits {
        let known = if receiver.irradiance > 0.0 {
            receiver.irradiance
        } else {
            clusters.expected(receiver, pending)
        };
        let local = known.max(LEAST_KNOWN * self.thresholds.scale.reference as f32);
        let unit = self.thresholds.scale.at(f64::from(local));
        Limits {
            difference: self.thresholds.difference * unit,
            estimate: self.thresholds.estimate * unit,
        }
    }
}

/// Adds up the parts of each point.
fn sum(scratch: &ClusterScratch, gathers: &mut Vec<Gather>) {
    gathers.clear();
    let (mut fan, mut bit, mut first) = (0, 0, 0);
    for &end in &scratch.ends {
        let mut gather = Gather::default();
        for part in &scratch.parts[first..end] {
            let mut seen = 0;
            for _ in 0..part.rays {
                if bit == scratch.fans.range(fan).len() {
                    (fan, bit) = (fan + 1, 0);
                }
                seen += u32::from(scratch.masks[fan] >> bit & 1 == 0);
                bit += 1;
            }
            gather.unoccluded += part.contribution;
            gather.irradiance += part.contribution * (seen as f32 / part.rays as f32);
        }
        if first < end {
            (fan, bit) = (fan + 1, 0);
        }
        first = end;
        let all = gather.unoccluded.element_sum();
        gather.visibility = (all > 0.0).then(|| gather.irradiance.element_sum() / all);
        gathers.push(gather);
    }
}

impl Clusters {
    /// Points no higher than this above a cluster lie in its plane, up to rounding.
    fn hair(&self) -> f32 {
        0.1 * self.offset
    }

    /// About what a point would get were nothing in between, largest channel.
    fn expected(&self, receiver: &Receiver, pending: &mut Vec<u32>) -> f32 {
        let (point, normal) = (receiver.point.as_vec3(), receiver.normal.as_vec3());
        let mut sum = Spectrum::ZERO;
        pending.clear();
        pending.extend(&self.roots);
        while let Some(number) = pending.pop() {
            let node = &self.nodes[number as usize];
            let Some(view) = node.view(point, normal, self.hair()) else {
                continue;
            };
            if node.second != 0 && view.size > GUESS {
                pending.extend([node.second, number + 1]);
            } else {
                let sends = &self.sends[number as usize];
                sum += if view.whole {
                    sends.arriving(point, normal, node.radius)
                } else {
                    sends.drawn(&sends.aim, point, normal, view.bound)
                };
            }
        }
        sum.max_element()
    }
}

/// The cut of one point.
struct Cut<'a> {
    sampler: &'a Sampler<'a>,
    clusters: &'a Clusters,
    receiver: &'a Receiver,
    key: u32,
    settled: bool,
    limits: Limits,
    pool: Pool,
}

impl Cut<'_> {
    /// Adds the parts of the point and the targets of their rays.
    fn take(mut self, scratch: &mut ClusterScratch) {
        let (point, normal) = (
            self.receiver.point.as_vec3(),
            self.receiver.normal.as_vec3(),
        );
        let mut most = scratch.parts.len() + MOST;
        scratch.pending.clear();
        scratch.pending.extend(self.clusters.roots.iter().rev());
        while let Some(number) = scratch.pending.pop() {
            let node = &self.clusters.nodes[number as usize];
            let Some(view) = node.view(point, normal, self.clusters.hair()) else {
                continue;
            };
            if self.is_fine(number, &view) {
                self.take_cluster(number, &view, scratch);
            } else if node.second != 0 {
                scratch.pending.extend([node.second, number + 1]);
            } else {
                for place in node.first..node.end {
                    self.take_tile(self.clusters.order[place as usize], scratch);
                }
            }
            if scratch.parts.len() > most {
                most += MOST / 2;
                self.limits.difference *= 2.0;
                self.limits.estimate *= 2.0;
            }
        }
        self.empty_pool(scratch);
    }

    /// Adds a part of one ray, by itself or to the pool.
    fn take_one(&mut self, contribution: Spectrum, target: Vec3, scratch: &mut ClusterScratch) {
        let measure = f64::from(contribution.max_element());
        let pool = &mut self.pool;
        pool.contribution += contribution;
        pool.measure += measure;
        pool.draws += 1;
        if pool.draws == 1 || jitter(self.key, !pool.draws)[0] * pool.measure < measure {
            pool.target = target;
        }
        if pool.measure >= POOLED * self.limits.estimate {
            self.empty_pool(scratch);
        }
    }

    fn empty_pool(&mut self, scratch: &mut ClusterScratch) {
        let Pool {
            contribution,
            target,
            draws,
            ..
        } = std::mem::take(&mut self.pool);
        if draws > 0 {
            scratch.parts.push(Part {
                contribution,
                rays: 1,
            });
            scratch.targets.push(target);
        }
    }

    /// Whether a cluster needs not be opened.
    fn is_fine(&self, number: u32, view: &View) -> bool {
        let Limits {
            difference,
            estimate,
        } = self.limits;
        let bound = f64::from(view.bound);
        if !view.whole {
            return bound <= 0.5 * estimate;
        }
        bound <= difference
            || view.size < 0.5 && {
                let measure = f64::from(self.arriving(number).max_element());
                let left = 0.5 * f64::from(view.size * view.size) * measure;
                measure <= estimate && left <= difference
            }
    }

    fn arriving(&self, number: u32) -> Spectrum {
        let (point, normal) = (
            self.receiver.point.as_vec3(),
            self.receiver.normal.as_vec3(),
        );
        let radius = self.clusters.nodes[number as usize].radius;
        self.clusters.sends[number as usize].arriving(point, normal, radius)
    }

    fn take_cluster(&mut self, number: u32, view: &View, scratch: &mut ClusterScratch) {
        let sends = &self.clusters.sends[number as usize];
        let mut aim = sends.aim;
        let contribution = if view.whole {
            self.arriving(number)
        } else {
            if !self.settled {
                aim = self.clusters.draw(number, self.key);
            }
            let (point, normal) = (
                self.receiver.point.as_vec3(),
                self.receiver.normal.as_vec3(),
            );
            sends.drawn(&aim, point, normal, view.bound)
        };
        if contribution.max_element() > 0.0 {
            self.take_one(contribution, aim.target, scratch);
        }
    }

    /// Clusters take Eq. (1) where the five-times rule would; a single tile is near.
    fn formula(&self) -> Formula {
        match self.sampler.formula {
            Formula::Disk => Formula::Disk,
            Formula::Hybrid(_) | Formula::Polygon => Formula::Polygon,
        }
    }

    fn take_tile(&mut self, number: u32, scratch: &mut ClusterScratch) {
        let radiosity = self.clusters.radiosity[number as usize];
        if radiosity.max_element() <= 0.0 {
            return;
        }
        let tile = &self.clusters.tiles[number as usize];
        let shape = if tile.corner_count() == 3 {
            SourceShape::Triangle
        } else {
            SourceShape::Quad
        };
        let cell = Cell::new(tile.corners.map(Vec3::as_dvec3), shape);
        let normal = tile.normal.as_dvec3();
        let sight = self.formula().sight(*self.receiver, &cell, normal);
        let contribution = radiosity * sight.form_factor as f32;
        let measure = f64::from(contribution.max_element());
        if measure <= 0.0 {
            return;
        }
        let side = (measure / self.limits.estimate).sqrt().ceil();
        let side = (side as u32).clamp(1, MOST_RAYS);
        let cut = sight.cut.then(|| above_horizon(*self.receiver, &cell));
        let (receiver, key, extent) = (self.receiver, self.key, self.sampler.extent);
        let aim = |ray: u32| {
            let [s, t] = jitter(key, number ^ ray.wrapping_mul(0x9e37_79b9));
            let place = |i: u32, x: f64| (f64::from(i) + 0.05 + 0.9 * x) / f64::from(side);
            let (s, t) = (place(ray % side, s), place(ray / side, t));
            let point: DVec3 = match &cut {
                Some(cut) => receiver.point + point_in_cut(cut, s, t),
                None => cell.at(s, t),
            };
            lift(point, normal, extent).as_vec3()
        };
        if side == 1 {
            return self.take_one(contribution, aim(0), scratch);
        }
        scratch.targets.extend((0..side * side).map(aim));
        scratch.parts.push(Part {
            contribution,
            rays: side * side,
        });
    }
}
