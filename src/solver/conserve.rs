//! How strong all reflected light is: so strong that power is conserved.
//!
//! A gathering is one iteration. How reflected light is spread is then as good as the mesh is, but how much of it there is in all has been left by
//! the shots, and of each bounce a mesh makes a thousandth too much or too little: between walls that reflect ρ that adds up
//! to 1/(1 - ρ) times as much. A box of reflectance 0.97 came out 6 % too bright, one of 0.99 18 %. So what is reflected is multiplied,
//! channel by channel, by the factor with which it is what the direct light and itself become when they are reflected, and by that with
//! which what is sent arrives or is lost.

use super::escape::{Lost, rays_for};
use super::light::{Light, Sign};
use super::run::Solver;
use super::shoot::Shooter;
use super::sums::in_order;
use super::volley::{Giver, add, gathered};
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

/// An imbalance below this part of the tolerance stays.
const NEGLIGIBLE: f64 = 0.25;

/// Light is not multiplied by more than this, nor by less than one over it.
const MOST: f64 = 2.0;

/// A shot is brought to what it sent by no more than this part of it. What is further off has gone wrong in one place, beside a contact maybe, and is
/// right in all others.
const MOST_OF_A_SHOT: f64 = 0.003;

/// What is lost is known to so many standard deviations.
const SURE: f64 = 3.0;

/// What a gathering sent, and what became of it; powers over the whole scene.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    pub sent: Power,
    /// What of it was found to be lost, with so many rays.
    pub lost: Power,
    pub rays: f64,
    /// What of it arrived,
    pub arrived: Power,
    /// and what of that is reflected.
    pub returned: Power,
}

/// What reflected light is multiplied by: what is sent (and with it what is lost), and what has arrived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Level {
    pub sent: Spectrum,
    pub arrived: Spectrum,
}

impl Level {
    pub const AS_IT_IS: Self = Self {
        sent: Spectrum::ONE,
        arrived: Spectrum::ONE,
    };
}

impl Passage {
    /// The level at which reflected light, sent as this, conserves power; of direct light `first` is reflected.
    pub fn level(&self, first: Power) -> Level {
        let closing = self.closing();
        let spent = self.sent - self.returned * closing;
        let is_known = self.sent.cmpgt(Power::ZERO) & spent.cmpgt(Power::ZERO);
        let factor = Power::select(is_known, first / spent, Power::ONE);
        let bounds = [1.0 / MOST, MOST].map(Power::splat);
        let sent = factor.clamp(bounds[0], bounds[1]);
        Level {
            sent: sent.as_vec3(),
            arrived: (sent * closing).as_vec3(),
        }
    }

    /// What was sent and not lost over what arrived, as far as the difference is more than the rays' that found what is lost.
    fn closing(&self) -> Power {
        let (excess, deviation) = self.excess();
        let noise = SURE * deviation / excess;
        let part = Power::ONE - noise * noise;
        let is_known = self.arrived.cmpgt(Power::ZERO) & part.cmpgt(Power::ZERO);
        let arrived = self.arrived.max(Power::splat(f64::MIN_POSITIVE));
        Power::ONE - Power::select(is_known, excess / arrived * part, Power::ZERO)
    }

    /// What has arrived or was lost beyond what was sent, and one standard deviation of that.
    pub fn excess(&self) -> (Power, Power) {
        let excess = self.arrived + self.lost - self.sent;
        let lost = (self.lost / self.sent).clamp(Power::splat(1.0 / self.rays), Power::splat(0.5));
        let deviation = (lost * (Power::ONE - lost) / self.rays).powf(0.5);
        (excess, deviation * self.sent)
    }

    /// Whether, with all that is `emitted` in what was sent, power is out of balance by more than a part of the tolerance of it.
    pub fn is_out_of_balance(&self, emitted: Power, tolerance: f64) -> bool {
        let over = self.arrived * (self.closing() - Power::ONE);
        let unshot = self.returned - (self.sent - emitted);
        (over.abs() + unshot.abs()).element_sum() > NEGLIGIBLE * tolerance * emitted.element_sum()
    }
}

impl Solver<'_> {
    /// Brings what was gathered from `whole`, patch by patch, to the level at which power is conserved, if it is far from it. Returns
    /// what all that was sent but emitted is to be multiplied by.
    pub(super) fn conserve(
        &mut self,
        irradiance: &mut [Spectrum],
        lost: &mut Lost,
        whole: &Light,
    ) -> Spectrum {
        let emitted = self.emitted();
        let all = self.passage_of_all(irradiance, lost, whole);
        if !all.is_out_of_balance(emitted, self.options.tolerance) {
            return Spectrum::ONE;
        }
        let (direct, lost_directly) = self.direct();
        let [arrived, returned] = self.totals(|vertex| direct[vertex]);
        let reflected = Passage {
            sent: all.sent - emitted,
            lost: all.lost - lost_directly.all,
            arrived: all.arrived - arrived,
            returned: all.returned - returned,
            ..all
        };
        let level = reflected.level(returned);
        let light = irradiance.par_iter_mut().zip(&direct).with_min_len(4096);
        light.for_each(|(all, direct)| *all = *direct + (*all - *direct) * level.arrived);
        *lost = lost_directly + (*lost + lost_directly * -Power::ONE) * level.sent.as_dvec3();
        level.sent
    }

    /// What a shot of one sign sent (in all, and as a fraction of what is emitted) and lost, with what has come of it to each vertex.
    pub(super) fn passage(
        &self,
        (sent, power, sign): (Power, f64, Sign),
        lost: &Lost,
        arrived: &[Spectrum],
    ) -> Passage {
        let positive = f64::from(sign.factor());
        let [arrived, returned] = self.totals(|vertex| arrived[vertex]);
        Passage {
            sent,
            lost: lost.all * positive,
            rays: rays_for(power),
            arrived: arrived * positive,
            returned: returned * positive,
        }
    }

    /// What a shot from `patch` is to be multiplied by so that what is sent arrives or is lost, if that is known. Direct light stays as it is: at
    /// each vertex it is right, and it comes once.
    pub(super) fn closing_of_shot(&self, patch: usize, of: &Passage) -> Option<Spectrum> {
        let bounds = [1.0 - MOST_OF_A_SHOT, 1.0 + MOST_OF_A_SHOT].map(Power::splat);
        let closing = of.closing().clamp(bounds[0], bounds[1]);
        let is_reflected = self.mesh.patches.at(patch).exitance == Spectrum::ZERO;
        (is_reflected && closing != Power::ONE).then(|| closing.as_vec3())
    }

    /// That of a gathering from `whole`.
    pub(super) fn passage_of_all(
        &self,
        irradiance: &[Spectrum],
        lost: &Lost,
        whole: &Light,
    ) -> Passage {
        let emitted = self.emitted().element_sum();
        let (mut sent, mut spread) = (Power::ZERO, 0.0);
        let power = |patch| whole.unshot_power(&self.mesh, patch, Sign::Positive);
        in_order(self.mesh.patches.len(), power, |power| {
            let part = power.element_sum() / emitted;
            sent += power;
            spread += part * part / rays_for(part);
        });
        let part = sent.element_sum() / emitted;
        let rays = match self.is_clustered() {
            true => rays_for(1.0),
            false => part * part / spread,
        };
        let [arrived, returned] = self.totals(|vertex| irradiance[vertex]);
        Passage {
            sent,
            lost: lost.all,
            rays,
            arrived,
            returned,
        }
    }

    /// The light of the emitters alone, gathered.
    fn direct(&mut self) -> (Vec<Spectrum>, Lost) {
        let dark = || self.mesh.by_vertex(Spectrum::ZERO);
        let emitters = Light::to_send(&self.mesh, dark());
        let givers: Vec<Giver> = self.givers(&emitters, 0).collect();
        let (mut direct, mut lost) = (dark(), Lost::default());
        for givers in givers.chunks(gathered(&self.mesh)) {
            let given = self.given(givers, &emitters);
            add(&given, &mut direct);
            for of in given {
                self.course.rays += of.rays;
                lost += of.lost;
            }
        }
        (direct, lost)
    }

    /// The same of what clusters sent: `arrived`, with the direct light that was kept, is the light there is. What is unshot becomes what
    /// that is beyond the power that was sent, which an interpolant of what was sent has no more once the mesh is refined.
    pub(super) fn conserve_clusters(&mut self, arrived: &[Spectrum], all: &Shooter) {
        let Shooter::All { tiling, .. } = all else {
            return;
        };
        let emitted = self.emitted();
        let light = &self.light;
        let direct = |vertex: usize| light.irradiance[vertex] - arrived[vertex];
        let [arrived_directly, returned_directly] = self.totals(direct);
        if returned_directly == Power::ZERO {
            // All light was sent, that of the emitters too.
            return;
        }
        let lost = self.escape_of_all(all, 1.0);
        let powers = tiling.parts().map(|part| part.power.as_dvec3());
        let [reached, returned] = self.totals(|vertex| arrived[vertex]);
        let reflected = Passage {
            sent: powers.sum(),
            lost: lost.all,
            rays: rays_for(1.0),
            arrived: reached,
            returned,
        };
        let whole = Passage {
            sent: reflected.sent + emitted,
            lost: self.course.lost.all,
            arrived: reached + arrived_directly,
            returned: returned + returned_directly,
            ..reflected
        };
        let level = match whole.is_out_of_balance(emitted, self.options.tolerance) {
            true => reflected.level(returned_directly),
            false => Level::AS_IT_IS,
        };
        let [_, kept] = self.totals(|vertex| light.irradiance[vertex] - light.unshot[vertex]);
        let kept = reflected.sent / kept.max(Power::splat(f64::MIN_POSITIVE));
        let sent = kept.as_vec3() * level.sent;
        let Light {
            irradiance, unshot, ..
        } = &mut self.light;
        let light = irradiance.par_iter_mut().zip(unshot).zip(arrived);
        light
            .with_min_len(4096)
            .for_each(|((all, unshot), arrived)| {
                let was_sent = (*all - *unshot) * sent;
                *all += *arrived * (level.arrived - Spectrum::ONE);
                *unshot = *all - was_sent;
            });
        self.course.lost += lost * (level.sent - Spectrum::ONE).as_dvec3();
    }

    /// What an irradiance by vertex comes to in all, and what of that is reflected.
    fn totals(&self, irradiance: impl Fn(usize) -> Spectrum + Sync) -> [Power; 2] {
        let mesh = &self.mesh;
        let of_patch = |patch: usize| {
            let vertices = mesh.vertices_of(patch as u32).map(|v| v as usize);
            let arrived = vertices.map(|v| irradiance(v).as_dvec3() * mesh.weights[v]);
            let arrived: Power = arrived.sum();
            [
                arrived,
                mesh.patches.reflectance(patch).as_dvec3() * arrived,
            ]
        };
        let mut totals = [Power::ZERO; 2];
        in_order(mesh.patches.len(), of_patch, |[arrived, returned]| {
            totals[0] += arrived;
            totals[1] += returned;
        });
        totals
    }
}
