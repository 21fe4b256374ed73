//! Reflected light on its way: between the direct light and the last gathering it arrives at *neighbourhoods*.
//!
//! What is reflected varies slowly, and the gathering at the end asks for it anew at every vertex. So until then
//! [`Neighbourhoods`] receive as one: what one vertex does, another in each wave. (With two, `staircase2` took longer and came
//! no nearer to its reference.)
//!
//! All points look at the same place of a cluster, and as that is seen more or less often than the rest of it, all is too bright or too dark.
//! What is sent and does not escape arrives, so what arrived is scaled to that: a kitchen with white walls was 2 to 4 % too dark without.

use super::course::{Bounce, Direct, Stage};
use super::light::Sign;
use super::neighbourhoods::{Neighbourhoods, drawn};
use super::run::Solver;
use super::shoot::{Beam, evaluate, receiver_at};
use super::sums::in_order;
use crate::form_factor::Gather;
use crate::mesh::NONE;
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

/// Thresholds are so many times those of the gathering: what arrives is drawn anew in each wave, and only what it comes to where light is
/// gathered from counts.
const LOOSER: f64 = 1.5;

/// What arrives is taken to be too little or too much by no more than this factor.
const MOST_CLOSING: f64 = 1.25;

/// A bounce is taken to be no stronger than this part of the one before it.
pub(super) const MOST_RATIO: f64 = 0.95;

impl Bounce {
    /// What is `unshot` after it over what was before it.
    pub fn ratio_to(&self, unshot: Power) -> Spectrum {
        let before = self.unshot.abs().max(Power::splat(f64::MIN_POSITIVE));
        let ratio = (unshot.abs() / before).min(Power::splat(MOST_RATIO));
        ratio.as_vec3()
    }
}

impl Solver<'_> {
    /// What sets out as `cells` arrives at all neighbourhoods; `before` is how it was.
    pub(super) fn bounce(&mut self, sign: Sign, cells: &[Spectrum], sent: Power, before: Bounce) {
        let power = sent.element_sum() / self.emitted().element_sum();
        let shooter = self.radiating(cells, true);
        let mut sampler = self.sampler();
        sampler.thresholds = sampler.thresholds.scaled(LOOSER);
        let beam = Beam {
            sampler: &sampler,
            shooter: &shooter,
            sign,
        };
        if self.light.is_all_direct() {
            self.course.direct = Some(Direct {
                irradiance: self.light.irradiance.clone(),
                lost: self.course.lost,
            });
        }
        let neighbourhoods = self.neighbourhoods.take();
        let neighbourhoods = neighbourhoods.unwrap_or_else(|| {
            let direct = self.course.direct.as_ref();
            let direct = direct.map(|direct| &direct.irradiance[..]);
            Neighbourhoods::new(&self.mesh, self.visibility, direct)
        });
        // One has work where the other waits.
        let ((arrived, rays), lost) = rayon::join(
            || self.arrivals_near(beam, &neighbourhoods),
            || self.escape_of_all(&shooter, power),
        );
        self.course.rays += rays;
        let closing = self.closing(sent - lost.all, &arrived, &neighbourhoods);
        self.light.take_all(sign);
        let at = neighbourhoods.of.par_iter().map(|near| match *near {
            NONE => Spectrum::ZERO,
            near => arrived[near as usize].irradiance * closing * sign.factor(),
        });
        self.light.receive(at);
        self.mesh
            .continue_to_buried(&mut self.light.irradiance, |e| e, 0);
        self.mesh
            .continue_to_buried(&mut self.light.unshot, |e| e, 0);
        self.course.lost += lost * f64::from(sign.factor());
        self.course.shots += 1;
        self.neighbourhoods = Some(neighbourhoods);
        self.keep_tiling(shooter);
        self.course.stage = Stage::Bounced(before);
    }

    /// By how much what arrived falls short of what was sent and not lost.
    fn closing(&self, sent: Power, arrived: &[Gather], near: &Neighbourhoods) -> Spectrum {
        let power = |vertex: usize| match near.of[vertex] {
            NONE => Power::ZERO,
            near => arrived[near as usize].irradiance.as_dvec3() * self.mesh.weights[vertex],
        };
        let mut came = Power::ZERO;
        in_order(near.of.len(), power, |power| came += power);
        let ratio = sent / came.max(Power::splat(f64::MIN_POSITIVE));
        let bounds = [1.0 / MOST_CLOSING, MOST_CLOSING].map(Power::splat);
        ratio.clamp(bounds[0], bounds[1]).as_vec3()
    }

    /// What arrives at one vertex of each neighbourhood, and with how many rays.
    fn arrivals_near(&self, beam: Beam, near: &Neighbourhoods) -> (Vec<Gather>, u64) {
        let seed = self.course.shots as u32;
        let near: Vec<&[u32]> = near.iter().collect();
        let receiver = |vertices: &&[u32]| {
            let vertex = drawn(&self.mesh, vertices, seed);
            receiver_at(&self.mesh, &self.light, vertex)
        };
        evaluate(beam.sampler, beam.shooter, &near, receiver)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::options::Preset;
    use crate::solver::shoot::Shooter;
    use crate::solver::trial::{Trial, as_clusters};

    #[test]
    fn a_bounce_takes_fewer_rays_than_a_gathering_at_the_same_points() {
        let trial = Trial::after(1, as_clusters(Preset::Draft));
        let mut solver = trial.solver();
        let unshot = solver.unshot_by_sign();
        solver.begin_wave(unshot, None);
        let taken = solver.course.rays;

        let near = solver.neighbourhoods.take().expect("it was a bounce");
        let tiling = solver.tiling.take().expect("they were kept");
        let shooter = Shooter::All {
            tiling,
            settled: true,
        };
        let beam = Beam {
            sampler: &solver.sampler(),
            shooter: &shooter,
            sign: Sign::Positive,
        };
        let (_, gathered) = solver.arrivals_near(beam, &near);
        assert!(
            taken > 0 && 10 * taken < 9 * gathered,
            "{taken} of {gathered}"
        );
    }
}
