//! The gathering of a scene of many patches: after the bounces, what is reflected arrives once more, at the vertices themselves, and the
//! mesh is refined for it.
//!
//! The direct light is not gathered again. It has arrived at every vertex by itself already, with thresholds at least as strict, and needs
//! elements where what is reflected is smooth.

use super::audit::Span;
use super::bounce::MOST_RATIO;
use super::course::{Bounce, Shot, Stage};
use super::light::{Light, Sign};
use super::run::Solver;
use super::sums::in_order;
use super::tiling::Tiling;
use super::wave::{Kind, Wave};
use crate::radiometry::Spectrum;
use rayon::prelude::*;

/// How much the ratio of a bounce to the one before it still grows, in units of how much it has grown last.
const STILL_TO_GROW: f32 = 1.5;

/// A ratio that differs from the one before it by more than this part of it is of no series that has settled.
const MOST_CHANGE: f32 = 0.25;

impl Solver<'_> {
    /// What is reflected sets out once more, with what is emitted if the direct light is not known.
    pub(super) fn begin_gathering(&mut self, bounce: Option<Bounce>) {
        self.neighbourhoods = None;
        let prospect = self.prospect(bounce);
        self.tiling = None;
        let foreseen = self.foreseen(prospect);
        let scale = self.sampler().thresholds.scale;
        let tiling = Tiling::even(&self.mesh, &foreseen, (&self.options, scale));
        let cells = tiling.unshot(&self.mesh, &foreseen, Sign::Positive);
        drop(foreseen);
        self.tiling = Some(tiling);
        self.set_out(Kind::Whole(prospect), cells, 1.0);
    }

    /// How many times what is unshot is still to come: λ + λ² + … = λ / (1 - λ), were all that follow like a bounce that leaves λ times
    /// what it shot. The first ones leave less than those after them, as what is bright for its neighbourhood goes first; the
    /// ratios approach that of what lasts longest like a geometric series. Where they jump, light goes to and fro, as between a floor in the open
    /// of which little falls on a canopy and the canopy of which much falls on the floor: what lasts is the mean of both ways.
    fn prospect(&self, bounce: Option<Bounce>) -> Spectrum {
        let Some(bounce) = bounce else {
            return Spectrum::ZERO;
        };
        let ratio = bounce.ratio_to(self.unshot());
        let before = bounce.ratio.unwrap_or(ratio);
        let growth = ratio - before;
        let is_settled = growth.abs().cmple(MOST_CHANGE * ratio);
        let still_growing = ratio + STILL_TO_GROW * growth.max(Spectrum::ZERO);
        let mean = (ratio * before).powf(0.5);
        let ratio = Spectrum::select(is_settled, still_growing, mean)
            .min(Spectrum::splat(MOST_RATIO as f32));
        ratio / (Spectrum::ONE - ratio)
    }

    /// The light of a gathering with nothing shot yet.
    fn foreseen(&self, prospect: Spectrum) -> Light {
        let light = self.light.irradiance.par_iter().zip(&self.light.unshot);
        let unshot = light.map(|(arrived, unshot)| reflected(*arrived, *unshot, prospect));
        let mut foreseen = Light::to_send(&self.mesh, unshot.collect());
        if self.course.direct.is_some() {
            foreseen.exitance_unshot.fill(Spectrum::ZERO);
        }
        foreseen
    }

    /// What is reflected has arrived everywhere: with the direct light it replaces what there was.
    pub(super) fn arrive_whole(&mut self, wave: Wave, prospect: Spectrum) {
        let Some(all) = &self.radiated else {
            return;
        };
        self.course.lost = self.escape_of_all(all, wave.power);
        let direct = self.course.direct.take().unwrap_or_default();
        self.course.lost += direct.lost;
        let light = self.light.irradiance.par_iter_mut();
        let light = light
            .zip(&mut self.light.unshot)
            .zip(&wave.arrived.irradiance);
        let light = light.enumerate().with_min_len(4096);
        light.for_each(|(vertex, ((irradiance, unshot), arrived))| {
            let sent = reflected(*irradiance, *unshot, prospect);
            let direct = direct.irradiance.get(vertex).copied().unwrap_or_default();
            *irradiance = *arrived + direct;
            *unshot = *irradiance - sent;
        });
        self.light.exitance_unshot.fill(Spectrum::ZERO);
        let shot = self.arrived(wave, Sign::Positive, self.course.meshing_ended.is_none());
        self.course.stage = Stage::Settling(shot);
    }

    /// One pass of refinement for what was gathered. The solve ends when there is nothing to split.
    pub(super) fn settle(&mut self, mut shot: Shot) {
        let all = self.made(&mut shot, true);
        let sampler = self.sampler();
        self.pass(&mut shot, &sampler, &all);
        if shot.candidates.is_empty() {
            self.conserve_clusters(&shot.arrived.irradiance, &all);
            self.course.sent_sum = self.sent_sum();
            self.radiated = Some(all);
            self.course.stage = Stage::Finished;
        } else {
            shot.made = Some(all);
            self.course.stage = Stage::Settling(shot);
        }
    }

    /// What arrived and what escaped over what was sent: all that is emitted, and of what is reflected what is not unshot.
    fn sent_sum(&self) -> Option<Span> {
        let (mesh, light) = (&self.mesh, &self.light);
        let (mut arrived, mut sent) = (self.course.lost.all, self.emitted());
        let at = |vertex: usize| {
            let patch = mesh.vertices.patch_of(vertex as u32) as usize;
            let (irradiance, unshot) = (light.irradiance[vertex], light.unshot[vertex]);
            let reflected = mesh.patches.reflectance(patch) * (irradiance - unshot);
            [irradiance, reflected].map(|of| of.as_dvec3() * mesh.weights[vertex])
        };
        in_order(mesh.weights.len(), at, |[here, reflected]| {
            arrived += here;
            sent += reflected;
        });
        let (arrived, sent) = (arrived.element_sum(), sent.element_sum());
        Span::of(std::iter::once((arrived / sent, sent)))
    }
}

/// What a gathering reflects of what has `arrived` at a vertex: `prospect` times what is unshot as if it had arrived too.
fn reflected(arrived: Spectrum, unshot: Spectrum, prospect: Spectrum) -> Spectrum {
    (arrived + unshot * prospect).max(Spectrum::ZERO)
}

#[cfg(test)]
mod tests {
    use crate::solver::trial::{Trial, as_clusters};
    use crate::solver::{Options, Outcome, Preset, Silent};
    use glam::DVec3;

    /// The Cornell box shot as clusters, from where `shots` waves have left it.
    fn solved(shots: u64) -> (Trial, Outcome) {
        let options = Options {
            audit_points: 0,
            ..as_clusters(Preset::Standard)
        };
        let trial = Trial::after(shots, options);
        let outcome = trial.solver().run(&mut Silent);
        (trial, outcome)
    }

    #[test]
    fn direct_light_and_what_is_reflected_are_all_light_gathered_at_once() {
        // After one wave all light is direct, and kept; after two it is not known which of it is.
        let (trial, kept) = solved(1);
        let (_, anew) = solved(2);
        let solver = trial.solver();
        let over = |value: &dyn Fn(DVec3, DVec3) -> f64| -> f64 {
            let weights = solver.mesh.weights.iter().enumerate();
            let at = |of: &Outcome, v: usize| of.light.irradiance[v].as_dvec3();
            weights
                .map(|(v, weight)| weight * value(at(&kept, v), at(&anew, v)))
                .sum()
        };
        let squares = over(&|a, b| a.distance_squared(b)) / over(&|_, b| b.length_squared());
        let bias = over(&|a, b| (a - b).element_sum()) / over(&|_, b| b.element_sum());
        let rms = squares.sqrt();
        assert!(
            rms > 0.0 && rms < 0.02 && bias.abs() < 0.01,
            "{rms}, {bias}"
        );
        assert!(kept.course.rays < anew.course.rays);
    }
}
