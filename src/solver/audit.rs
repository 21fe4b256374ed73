//! A second look at a finished solve, at random points of its surfaces: how large is its error, and does its light add up?
//!
//! At each point the light of all patches is gathered with much finer source sampling than the solve's own and compared with
//! what the mesh interpolates there. The difference is the error of interpolation, of source sampling, of the five-times rule
//! and of what is unshot, in one: everything but the error of the light that is gathered, which is taken in by
//! letting the mean error go through all reflections, as far as it is of what surfaces receive: they reflect more than the interpolant has, which
//! cuts off the tops (`mesh/integral.rs`). Of an error that differs from place to place and is reflected back to where it came from,
//! as in a gap between bright walls, what is seen is what one reflection loses of it: the estimate is too low there.

use super::course::Stage;
use super::error::{ErrorModel, Squares};
use super::light::{Light, Sign};
use super::run::Solver;
use super::shoot::{Shooter, evaluate};
use super::sums::{in_blocks, in_order};
use super::tiling::Tiling;
use crate::form_factor::{Formula, Receiver, Sampler, Source};
use crate::geometry::jitter;
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How much finer the thresholds ε_fe and ε_fd of the second look are.
pub(super) const FINER: f64 = 1.0 / 8.0;

/// Patches that are looked at side by side.
const SIDE_BY_SIDE: usize = 64;

/// The estimated error of a solution, from points spread over all that receives light.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Audit {
    /// Points that were looked at.
    pub points: usize,
    /// Their mean irradiance, W/m², channels pooled.
    pub mean_irradiance: f64,
    /// Estimated RMS error of the irradiance over its mean, channels pooled.
    pub n_rms: f64,
    /// The part of it that is the same everywhere: estimated mean error over the mean irradiance.
    pub bias: f64,
    /// How the error is spread over the elements.
    pub model: ErrorModel,
    /// Sum of the form factors from a point to all that it sees: 1 in a closed scene.
    pub received_sum: Span,
    /// What arrives of the power of a patch, and what is found to escape, over that power: 1 for each patch of any scene.
    /// Known if all light was gathered once more at the end; over patches that send a thousandth of what is emitted.
    pub sent_sum: Option<Span>,
}

/// Least, mean and largest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Span {
    /// The least.
    pub least: f64,
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub most: f64,
}

impl Span {
    /// The span of weighted values; `None` without weight.
    pub(super) fn of(values: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (value, weight) in values.filter(|(_, weight)| *weight > 0.0) {
            (least, most) = (least.min(value), most.max(value));
            sum += value * weight;
            weights += weight;
        }
        (weights > 0.0).then(|| Self {
            least,
            mean: sum / weights,
            most,
        })
    }
}

impl Solver<'_> {
    /// Looks again at `options.audit_points` points; `None` if that is 0 or there is no light.
    pub(super) fn audit(&mut self) -> Option<Audit> {
        if self.options.audit_points == 0 {
            return None;
        }
        let fans = open_fans(&self.mesh);
        let places = places(&self.mesh, &fans, self.options.audit_points);
        if places.is_empty() {
            return None;
        }
        let whole = self.whole(Spectrum::ONE);
        let mut fine = self.sampler();
        fine.thresholds = fine.thresholds.scaled(FINER);
        // Where a cell is just beyond the five-times rule Eq. (1) is low, and of finer cells more are: looked at with it, all would
        // seem a thousandth darker than it is.
        fine.formula = Formula::Polygon;
        let plain = self.sampler();
        let known: Vec<Spectrum> = places
            .iter()
            .map(|p| {
                let irradiance = |v: u32| self.light.irradiance[v as usize];
                self.mesh.interpolated(p.leaf, p.point, irradiance)
            })
            .collect();
        let receivers: Vec<(Receiver, u32)> = (0u32..)
            .zip(places.iter().zip(&known))
            .map(|(number, (place, known))| (place.receiver(&self.mesh, *known), number))
            .collect();
        let (gathered, factors) = if self.is_clustered() {
            self.second_look_at_clusters(&whole, (&fine, &plain), &receivers)
        } else {
            self.second_look(&whole, (&fine, &plain), &receivers)
        };
        let mut leaving = Power::ZERO;
        let of_patch = |patch| whole.unshot_power(&self.mesh, patch, Sign::Positive);
        in_order(self.mesh.patches.len(), of_patch, |power| leaving += power);
        let count = 3.0 * places.len() as f64;
        let mean = gathered.iter().sum::<Power>().element_sum() / count;
        let errors = || known.iter().zip(&gathered).map(|(k, g)| k.as_dvec3() - *g);
        let square = errors().map(|e| e.length_squared()).sum::<f64>() / count;
        let off = errors().sum::<Power>().element_sum() / count;
        // What all reflections make of a unit of light.
        let amplification = leaving.element_sum() / self.emitted().element_sum();
        let of_points = errors().map(|e| (e.element_sum() / 3.0 - off).powi(2));
        let variance = of_points.sum::<f64>() / (places.len() as f64).powi(2);
        let received = (off + self.beyond_interpolant(&fans), variance);
        let received = self.known_of_power(&whole, received);
        let bias = off + received * (amplification - 1.0).max(0.0);
        let spread = (square - off * off).max(0.0);
        let found = places.iter().zip(errors()).map(|(place, error)| {
            let squares = Squares::of(&self.mesh, &self.light, place.leaf);
            (error.length_squared() / 3.0, squares)
        });
        let model = ErrorModel::fit(found.collect());
        (mean > 0.0).then(|| Audit {
            points: places.len(),
            mean_irradiance: mean,
            n_rms: (spread + bias * bias).sqrt() / mean,
            bias: bias / mean,
            model,
            received_sum: Span::of(factors.iter().map(|f| (*f, 1.0))).unwrap_or_default(),
            sent_sum: self.course.sent_sum,
        })
    }

    /// A mean error of what surfaces receive, found with a variance, with what is known of it from the balance of power: in a closed scene that is
    /// known better than from points. Each counts by its variance.
    fn known_of_power(&self, whole: &Light, (found, variance): (f64, f64)) -> f64 {
        let was_gathered = self.course.sent_sum.is_some();
        if !was_gathered {
            return found;
        }
        let passage = self.passage_of_all(&self.light.irradiance, &self.course.lost, whole);
        let area = self.mesh.weights.iter().sum::<f64>();
        let (excess, deviation) = passage.excess();
        let mean = |of: Power| of.element_sum() / (3.0 * area);
        let balanced = mean(deviation).powi(2);
        (found * balanced + mean(excess) * variance) / (balanced + variance)
    }

    /// By how much what surfaces receive exceeds what the interpolant on their fans has, in the mean of all points and channels, W/m².
    fn beyond_interpolant(&self, fans: &[Triangle]) -> f64 {
        let at = |v: &u32| f64::from(self.light.irradiance[*v as usize].element_sum()) / 3.0;
        let (mut sum, mut area) = (0.0, 0.0);
        for fan in fans {
            let element = self.mesh.element(fan.leaf);
            let corners = element.corners();
            let mean = corners.iter().map(at).sum::<f64>() / corners.len() as f64;
            sum += fan.area * self.mesh.sag(fan.leaf) * (at(&element.centre) - mean);
            area += fan.area;
        }
        sum / area
    }

    /// At each receiver all light of `whole`, sampled finely, and the sum of all form factors, sampled as in the solve.
    fn second_look(
        &self,
        whole: &Light,
        (fine, plain): (&Sampler, &Sampler),
        receivers: &[(Receiver, u32)],
    ) -> (Vec<Power>, Vec<f64>) {
        let levels = self.options.source_levels();
        // As bright as thresholds expect: what sampling costs does not depend on the unit of light.
        let even = vec![Spectrum::splat(self.reference as f32); 1 << (2 * levels)];
        let look_at = |patch: usize| {
            let of = self.mesh.patches.at(patch);
            let bright = Shooter::Patch(Source::new(of.corners(), of.normal, levels, &even));
            let seen = evaluate(plain, &bright, receivers, |of| *of).0;
            let is_lit = whole.unshot_power(&self.mesh, patch, Sign::Positive) != Power::ZERO;
            let arrived = is_lit.then(|| {
                let shooter = (patch, Sign::Positive);
                let source = self.source_of(whole, shooter, &fine.thresholds);
                evaluate(fine, &Shooter::Patch(source), receivers, |of| *of).0
            });
            (seen, arrived.unwrap_or_default())
        };
        let mut gathered = vec![Power::ZERO; receivers.len()];
        let mut factors = vec![0.0; receivers.len()];
        let patches = self.mesh.patches.len();
        in_blocks(SIDE_BY_SIDE, patches, look_at, |(seen, arrived)| {
            for (factor, gather) in factors.iter_mut().zip(seen) {
                *factor += f64::from(gather.irradiance.x) / self.reference;
            }
            for (sum, gather) in gathered.iter_mut().zip(arrived) {
                *sum += gather.irradiance.as_dvec3();
            }
        });
        (gathered, factors)
    }

    /// The same of all patches at once.
    fn second_look_at_clusters(
        &mut self,
        whole: &Light,
        (fine, plain): (&Sampler, &Sampler),
        receivers: &[(Receiver, u32)],
    ) -> (Vec<Power>, Vec<f64>) {
        let tiling = match (&self.course.stage, self.radiated.take()) {
            // Where light differs it does so much as when it was gathered, for which these tiles were cut.
            (Stage::Finished, Some(Shooter::All { tiling, .. })) => tiling,
            _ => Tiling::even(&self.mesh, whole, (&self.options, fine.thresholds.scale)),
        };
        let mut shooter = tiling.radiating(&self.mesh, whole);
        let gathered = evaluate(fine, &shooter, receivers, |of| *of).0;
        if let Shooter::All { tiling, .. } = &mut shooter {
            let even = Spectrum::splat(self.reference as f32);
            let count = tiling.clusters.tiles().len();
            tiling.clusters.radiate(vec![even; count], 0);
        }
        let factors = evaluate(plain, &shooter, receivers, |of| *of).0;
        let gathered = gathered.iter().map(|g| g.irradiance.as_dvec3());
        let factors = factors
            .iter()
            .map(|g| f64::from(g.irradiance.x) / self.reference);
        (gathered.collect(), factors.collect())
    }
}

/// A random point of a leaf.
struct Place {
    leaf: u32,
    patch: u32,
    point: DVec3,
}

impl Place {
    fn receiver(&self, mesh: &Mesh, known: Spectrum) -> Receiver {
        Receiver {
            point: self.point,
            normal: mesh.patch(self.patch).normal,
            irradiance: known.max_element(),
        }
    }
}

/// A triangle of the fan of a leaf.
struct Triangle {
    leaf: u32,
    corners: [u32; 3],
    area: f64,
}

/// All of which no corner is buried.
fn open_fans(mesh: &Mesh) -> Vec<Triangle> {
    let leaves: Vec<u32> = mesh.leaves().collect();
    leaves
        .into_par_iter()
        .with_min_len(1024)
        .flat_map_iter(|leaf| mesh.fan(leaf).map(move |corners| (leaf, corners)))
        .filter(|(_, corners)| corners.iter().all(|v| !mesh.buried[*v as usize]))
        .map(|(leaf, corners)| {
            let [a, b, c] = corners.map(|v| mesh.position(v));
            let area = 0.5 * (b - a).cross(c - a).length();
            Triangle {
                leaf,
                corners,
                area,
            }
        })
        .collect()
}

/// Points spread evenly over fans, in proportion to their area.
fn places(mesh: &Mesh, fans: &[Triangle], count: usize) -> Vec<Place> {
    let total: f64 = fans.iter().map(|fan| fan.area).sum();
    let step = total / count.max(1) as f64;
    let mut places = Vec::with_capacity(count);
    let mut passed = 0.0;
    for fan in fans {
        passed += fan.area;
        while places.len() < count && (places.len() as f64 + 0.5) * step < passed {
            let [s, t] = jitter(places.len() as u32, 0x5eed);
            let root = s.sqrt();
            let weights = [1.0 - root, root * (1.0 - t), root * t];
            let corners = fan.corners.iter().zip(weights);
            let point = corners.map(|(v, w)| mesh.position(*v) * w).sum();
            let patch = mesh.elements.patch_of(fan.leaf);
            places.push(Place {
                leaf: fan.leaf,
                patch,
                point,
            });
        }
    }
    places
}
