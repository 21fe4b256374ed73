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
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

/// Patches whose light is gathered side by side …
const SIDE_BY_SIDE: usize = 8;

/// … unless together they would hold more values at vertices.
const VALUES: usize = 1 << 22;

/// What one patch gives to all others.
struct Given {
    irradiance: Vec<Spectrum>,
    rays: u64,
    lost: Lost,
    /// What arrived and what escaped over what was sent, and what was sent, if that was much.
    sum: Option<(f64, f64)>,
}

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
        let power = |patch: u32| {
            let power = whole.unshot_power(&self.mesh, patch as usize, Sign::Positive);
            (patch, power.element_sum())
        };
        let next: Vec<(u32, f64)> = (so_far.next..self.mesh.patches.len() as u32)
            .map(power)
            .filter(|(_, sent)| *sent > 0.0)
            .take(side_by_side(&self.mesh))
            .collect();
        let Some((last, _)) = next.last() else {
            let Gathering {
                irradiance,
                lost,
                sums,
                ..
            } = so_far;
            return self.take_over(irradiance, &whole, lost, sums);
        };
        let given: Vec<Given> = next
            .par_iter()
            .with_max_len(1)
            .map(|(patch, sent)| self.given(*patch as usize, *sent, &whole))
            .collect();
        for of in given {
            for (sum, irradiance) in so_far.irradiance.iter_mut().zip(&of.irradiance) {
                *sum += *irradiance;
            }
            self.course.rays += of.rays;
            so_far.lost += of.lost;
            so_far.sums.extend(of.sum);
        }
        so_far.next = last + 1;
        so_far.whole = Some(whole);
        self.course.stage = Stage::Gathering(so_far);
    }

    /// What a patch that sends the power `sent` gives to the others.
    fn given(&self, patch: usize, sent: f64, whole: &Light) -> Given {
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
        let (arrived, rays) = self.arrivals(beam, patch, &reached);
        let irradiance: Vec<Spectrum> = arrived.into_iter().map(|g| g.irradiance).collect();
        let received = irradiance.iter().zip(&self.mesh.weights);
        let received: Power = received.map(|(e, w)| e.as_dvec3() * *w).sum();
        let lost = self.escape(
            patch,
            &shooter,
            power,
            self.course.shots as u32 + patch as u32,
        );
        let sum = (received + lost.all).element_sum() / sent;
        Given {
            irradiance,
            rays,
            lost,
            sum: (power > 1e-3).then_some((sum, sent)),
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

fn side_by_side(mesh: &Mesh) -> usize {
    (VALUES / mesh.vertices.len().max(1)).clamp(1, SIDE_BY_SIDE)
}
