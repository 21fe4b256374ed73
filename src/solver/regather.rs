//! After the last shot: every patch's whole radiosity once more at every vertex of the finished mesh.
//!
//! A vertex that was made late has only interpolated what came before it, and what was left unshot has arrived nowhere. One
//! iteration of E = K (M + ρ E) on the final mesh replaces both, and takes along every vertex in the same state. What is unshot
//! then goes through all its reflections as an ambient term, so that fewer shots are needed before.

use super::audit::Span;
use super::observer::{Control, Observer};
use super::run::Solver;
use super::source::source_of;
use crate::radiometry::{Power, Spectrum};

impl Solver<'_> {
    /// Gathers; what was there stays if the observer stops it.
    pub(super) fn regather(&mut self, observer: &mut dyn Observer) -> Control {
        let unshot = self.unshot();
        let ambient = self.ambient(unshot);
        let mut whole = self.whole();
        for irradiance in &mut whole.unshot {
            *irradiance *= ambient;
        }
        let emitted = self.emitted().element_sum();
        let sampler = self.sampler();
        let mut irradiance = vec![Spectrum::ZERO; self.mesh.vertices.len()];
        let mut escaped = Power::ZERO;
        let mut sums = Vec::new();
        for shooter in 0..self.mesh.patches.len() {
            let power = whole.unshot_power(&self.mesh, shooter).element_sum() / emitted;
            if power <= 0.0 {
                continue;
            }
            if observer.progress(&self.progress(unshot)) == Control::Stop {
                return Control::Stop;
            }
            let source = source_of(
                &self.mesh,
                &whole,
                shooter,
                &self.options,
                &sampler.thresholds,
            );
            let reached = self.reached(&source);
            let arrived = self.arrivals(&sampler, &source, &reached);
            let mut received = Power::ZERO;
            for (vertex, gather) in arrived.iter().enumerate() {
                irradiance[vertex] += gather.irradiance;
                received += gather.irradiance.as_dvec3() * self.mesh.weights[vertex];
            }
            let lost = self.escape(shooter, &source, power, self.shots as u32 + shooter as u32);
            escaped += lost;
            if power > 1e-3 {
                let sent = power * emitted;
                sums.push(((received + lost).element_sum() / sent, sent));
            }
        }
        self.light.irradiance = irradiance;
        for ((unshot, now), gathered) in
            (self.light.unshot.iter_mut().zip(&self.light.irradiance)).zip(whole.unshot)
        {
            *unshot = *now - gathered;
        }
        self.light.exitance_unshot.fill(false);
        self.escaped = escaped;
        self.sent_sum = Span::of(sums.into_iter());
        observer.progress(&self.progress(unshot));
        Control::Continue
    }

    /// By how much reflected light grows until what is `unshot` has gone through all its reflections, were these like those of the
    /// light that has been shot: of a power M emitted, R is reflected so far and p of it unshot; then R∞ = R + p R∞ / M.
    fn ambient(&self, unshot: Power) -> Spectrum {
        let emitted = self.emitted().max(Power::splat(f64::MIN_POSITIVE));
        (Power::ONE - (unshot / emitted).min(Power::splat(0.5)))
            .recip()
            .as_vec3()
    }
}
