//! After the last shot: every patch's whole radiosity once more at every vertex of the finished mesh.
//!
//! A vertex that was made late has only interpolated what came before it, and what was left unshot has arrived nowhere. One
//! iteration of E = K (M + ρ E) on the final mesh replaces both, and takes along every vertex in the same state. What is unshot
//! then goes through all its reflections as an ambient term, so that fewer shots are needed before.

use super::audit::Span;
use super::course::{Gathering, Stage};
use super::escape::Lost;
use super::light::Light;
use super::run::Solver;
use super::volley::{Giver, add, gathered};
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

/// Of patches that send more than this part of what is emitted, it is known how much of that arrives or escapes.
const MUCH: f64 = 1e-3;

impl Solver<'_> {
    /// Nothing gathered yet.
    pub(super) fn gathering(&self) -> Gathering {
        Gathering {
            next: 0,
            ambient: self.ambient(),
            irradiance: vec![Spectrum::ZERO; self.mesh.vertices.len()],
            lost: Lost::default(),
            sums: Vec::new(),
            whole: None,
        }
    }

    /// Gathers the light of some more patches; when there are none, it replaces what was there.
    pub(super) fn gather(&mut self, mut so_far: Gathering) {
        let whole = match so_far.whole.take() {
            Some(whole) => whole,
            None => self.whole(so_far.ambient),
        };
        let givers = self.givers(&whole, so_far.next as usize);
        let next: Vec<Giver> = givers.take(gathered(&self.mesh)).collect();
        let Some(last) = next.last() else {
            let Gathering {
                irradiance,
                lost,
                sums,
                ..
            } = so_far;
            return self.take_over(irradiance, &whole, lost, sums);
        };
        let much = MUCH * self.emitted().element_sum();
        let given = self.given(&next, &whole);
        add(&given, &mut so_far.irradiance);
        let found = next.par_iter().zip(&given).with_max_len(1);
        let found = found
            .filter(|(giver, _)| giver.power > much)
            .map(|(giver, of)| {
                let arrived = (of.arrived + of.lost.all).element_sum();
                (arrived / giver.power, giver.power)
            });
        so_far.sums.par_extend(found);
        for of in given {
            self.course.rays += of.rays;
            so_far.lost += of.lost;
        }
        so_far.next = last.patch as u32 + 1;
        so_far.whole = Some(whole);
        self.course.stage = Stage::Gathering(so_far);
    }

    /// What was gathered from `whole` replaces what there was.
    pub(super) fn take_over(
        &mut self,
        mut irradiance: Vec<Spectrum>,
        whole: &Light,
        mut lost: Lost,
        sums: Vec<(f64, f64)>,
    ) {
        let level = self.conserve(&mut irradiance, &mut lost, whole);
        self.light.irradiance = irradiance;
        for ((unshot, now), sent) in
            (self.light.unshot.iter_mut().zip(&self.light.irradiance)).zip(&whole.unshot)
        {
            *unshot = *now - *sent * level;
        }
        self.light.exitance_unshot.fill(Spectrum::ZERO);
        self.course.lost = lost;
        self.course.sent_sum = Span::of(sums.into_iter());
        self.course.stage = Stage::Finished;
    }

    /// The light with nothing shot yet, what is reflected multiplied by `ambient`.
    pub(super) fn whole(&self, ambient: Spectrum) -> Light {
        let reflected = |irradiance: &Spectrum| irradiance.max(Spectrum::ZERO) * ambient;
        let unshot = self.light.irradiance.iter().map(reflected);
        Light::to_send(&self.mesh, unshot.collect())
    }

    /// By how much reflected light grows until what is unshot has gone through all its reflections, were these like those of the
    /// light that has been shot: of a power M emitted, R is reflected so far and p of it unshot; then R∞ = R + p R∞ / M.
    pub(super) fn ambient(&self) -> Spectrum {
        let emitted = self.emitted().max(Power::splat(f64::MIN_POSITIVE));
        (Power::ONE - (self.unshot() / emitted).min(Power::splat(0.5)))
            .recip()
            .as_vec3()
    }
}
