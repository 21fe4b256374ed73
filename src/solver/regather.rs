//! After the last shot: every patch's whole radiosity once more at every vertex of the finished mesh.
//!
//! A vertex that was made late has only interpolated what came before it, and what was left unshot has arrived nowhere. One
//! iteration of E = K (M + ρ E) on the final mesh replaces both, and takes along every vertex in the same state. What is unshot
//! then goes through all its reflections as an ambient term, so that fewer shots are needed before.

use super::audit::Span;
use super::course::{Gathering, Stage};
use super::escape::Lost;
use super::light::{Light, Sign};
use super::run::Solver;
use super::shoot::{Beam, Shooter};
use crate::radiometry::{Power, Spectrum};

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

    /// Gathers the light of one more patch; when there is none, it replaces what was there.
    pub(super) fn gather(&mut self, mut so_far: Gathering) {
        let whole = match so_far.whole.take() {
            Some(whole) => whole,
            None => self.whole(so_far.ambient),
        };
        let power = |patch: &u32| {
            let power = whole.unshot_power(&self.mesh, *patch as usize, Sign::Positive);
            power.element_sum()
        };
        let next = (so_far.next..self.mesh.patches.len() as u32).find(|p| power(p) > 0.0);
        let Some(patch) = next else {
            let Gathering {
                irradiance,
                lost,
                sums,
                ..
            } = so_far;
            return self.take_over(irradiance, &whole, lost, sums);
        };
        let sent = power(&patch);
        self.gather_from(patch as usize, sent, &whole, &mut so_far);
        so_far.next = patch + 1;
        so_far.whole = Some(whole);
        self.course.stage = Stage::Gathering(so_far);
    }

    fn gather_from(&mut self, patch: usize, sent: f64, whole: &Light, into: &mut Gathering) {
        let power = sent / self.emitted().element_sum();
        let sampler = self.sampler();
        let source = self.source_of(whole, (patch, Sign::Positive), &sampler.thresholds);
        let reached = self.reached(&source);
        let shooter = Shooter::Patch(source);
        let beam = Beam {
            sampler: &sampler,
            shooter: &shooter,
            sign: Sign::Positive,
        };
        let arrived = self.arrivals(beam, patch, &reached);
        let mut received = Power::ZERO;
        for (vertex, gather) in arrived.iter().enumerate() {
            into.irradiance[vertex] += gather.irradiance;
            received += gather.irradiance.as_dvec3() * self.mesh.weights[vertex];
        }
        let lost = self.escape(
            patch,
            &shooter,
            power,
            self.course.shots as u32 + patch as u32,
        );
        into.lost += lost;
        if power > 1e-3 {
            into.sums
                .push(((received + lost.all).element_sum() / sent, sent));
        }
    }

    /// What was gathered from `whole` replaces what there was.
    pub(super) fn take_over(
        &mut self,
        irradiance: Vec<Spectrum>,
        whole: &Light,
        lost: Lost,
        sums: Vec<(f64, f64)>,
    ) {
        self.light.irradiance = irradiance;
        for ((unshot, now), sent) in
            (self.light.unshot.iter_mut().zip(&self.light.irradiance)).zip(&whole.unshot)
        {
            *unshot = *now - *sent;
        }
        self.light.exitance_unshot.fill(Spectrum::ZERO);
        self.course.lost = lost;
        self.course.sent_sum = Span::of(sums.into_iter());
        self.course.stage = Stage::Finished;
    }

    /// The light with nothing shot yet, what is reflected multiplied by `ambient`.
    pub(super) fn whole(&self, ambient: Spectrum) -> Light {
        let reflected = |irradiance: &Spectrum| irradiance.max(Spectrum::ZERO) * ambient;
        Light {
            unshot: self.light.irradiance.iter().map(reflected).collect(),
            ..Light::new(&self.mesh)
        }
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
