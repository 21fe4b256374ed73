//! Patches that give their light to all others side by side: shots too weak to test the mesh, and the last gathering.
//!
//! One such shot has little work on each level of the quadtree, too little to share out evenly. What one of them sends
//! to another stays unshot until that one's next turn.

use super::arrived::Arrived;
use super::escape::Lost;
use super::light::{Light, Sign};
use super::run::Solver;
use super::shoot::{Beam, Shooter};
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

/// Patches that shoot side by side …
const SIDE_BY_SIDE: usize = 8;

/// … and from which light is gathered so. …
const GATHERED: usize = 32;

/// … unless together they would hold more values at vertices.
const VALUES: usize = 1 << 22;

/// Vertices at which the light of some patches is added up by one thread.
const SLICE: usize = 1024;

/// Patches that have this part of the strongest one's power shoot with it.
const ALONGSIDE: f64 = 0.5;

/// A patch that gives all it has of one sign, with its power.
#[derive(Debug, Clone, Copy)]
pub(super) struct Giver {
    pub patch: usize,
    pub sign: Sign,
    pub power: f64,
}

/// What it gives.
pub(super) struct Given {
    /// By vertex.
    pub irradiance: Vec<Spectrum>,
    /// The power that arrived before it was closed, without the sign.
    pub arrived: Power,
    pub lost: Lost,
    pub rays: u64,
}

impl Solver<'_> {
    /// The patches from number `first` on that have any light in `light` to give.
    pub(super) fn givers(&self, light: &Light, first: usize) -> impl Iterator<Item = Giver> {
        let sign = Sign::Positive;
        let giver = move |patch: usize| Giver {
            patch,
            sign,
            power: light.unshot_power(&self.mesh, patch, sign).element_sum(),
        };
        let givers = (first..self.mesh.patches.len()).map(giver);
        givers.filter(|giver| giver.power > 0.0)
    }

    /// What each of `givers` has of `light` and gives to all patches.
    pub(super) fn given(&self, givers: &[Giver], light: &Light) -> Vec<Given> {
        let giver = givers.par_iter().with_max_len(1);
        giver.map(|giver| self.given_by(*giver, light)).collect()
    }

    fn given_by(&self, Giver { patch, sign, power }: Giver, light: &Light) -> Given {
        let sampler = self.sampler();
        let source = self.source_of(light, (patch, sign), &sampler.thresholds);
        let reached = self.reached(&source);
        let shooter = Shooter::Patch(source);
        let beam = Beam {
            sampler: &sampler,
            shooter: &shooter,
            sign,
        };
        let (Arrived { mut irradiance, .. }, rays) = self.arrivals(beam, patch, &reached);
        let power = power / self.emitted().element_sum();
        let seed = self.course.shots as u32 + patch as u32;
        let lost = self.escape(patch, &shooter, power, seed) * f64::from(sign.factor());
        let sent = light.unshot_power(&self.mesh, patch, sign);
        let passage = self.passage((sent, power, sign), &lost, &irradiance);
        if let Some(closing) = self.closing_of_shot(patch, &passage) {
            irradiance
                .par_iter_mut()
                .with_min_len(4096)
                .for_each(|e| *e *= closing);
        }
        Given {
            irradiance,
            arrived: passage.arrived,
            lost,
            rays,
        }
    }

    /// How many of the first of `givers` go without a test of the mesh. Of emitters too weak for one, each with which another
    /// [`meshing_power`](super::Options::meshing_power) of direct light is shot has it all the same: many small lights refine like a
    /// large one.
    pub(super) fn untested(&self, givers: &[Giver]) -> usize {
        if self.course.meshing_ended.is_some() {
            return givers.len();
        }
        let emitted = self.emitted().element_sum();
        let mut direct = self.direct_shot() / emitted;
        let is_tested = |giver: &Giver| {
            let parts = |power: f64| (power / self.options.meshing_power).floor();
            let before = parts(direct);
            direct += self.light.own_unshot(&self.mesh, giver.patch, giver.sign) / emitted;
            self.meshes(giver.power / emitted) || parts(direct) != before
        };
        givers.iter().position(is_tested).unwrap_or(givers.len())
    }

    /// What emitters have shot of what they emit; nothing more to come counts as nothing.
    fn direct_shot(&self) -> f64 {
        if Sign::ALL.iter().all(|sign| !self.light.is_direct(*sign)) {
            return 0.0;
        }
        let patches = self.mesh.patches.iter().zip(&self.light.exitance_unshot);
        patches
            .map(|(patch, unshot)| f64::from((patch.exitance - *unshot).element_sum()) * patch.area)
            .sum()
    }

    /// A shot from each of `givers`; none of them tests the mesh.
    pub(super) fn volley(&mut self, givers: &[Giver]) {
        let given = self.given(givers, &self.light);
        for giver in givers {
            self.light.take(&self.mesh, giver.patch, giver.sign);
        }
        for of in &given {
            self.light.receive(of.irradiance.par_iter().copied());
            self.course.rays += of.rays;
            self.course.lost += of.lost;
        }
        self.course.shots += givers.len() as u64;
    }
}

/// Adds what is `given` to what has arrived at each vertex.
pub(super) fn add(given: &[Given], irradiance: &mut [Spectrum]) {
    let light = irradiance.par_chunks_mut(SLICE).enumerate();
    light.for_each(|(slice, light)| {
        for of in given {
            for (sum, irradiance) in light.iter_mut().zip(&of.irradiance[slice * SLICE..]) {
                *sum += *irradiance;
            }
        }
    });
}

/// The strongest of `powers`, by patch and sign (the first of equals), and then those nearly as strong, `most` at the most.
pub(super) fn strongest(powers: &[Power], most: usize) -> Vec<Giver> {
    let giver = |(of, power): (usize, &Power)| Giver {
        patch: of / 2,
        sign: Sign::ALL[of % 2],
        power: power.element_sum(),
    };
    let givers = powers.iter().enumerate().map(giver);
    let least = ALONGSIDE * givers.clone().map(|of| of.power).fold(0.0, f64::max);
    let mut givers: Vec<Giver> = givers.filter(|of| of.power >= least).collect();
    givers.sort_by(|a, b| b.power.total_cmp(&a.power));
    givers.truncate(most);
    givers
}

/// How many patches may shoot at once.
pub(super) fn side_by_side(mesh: &Mesh) -> usize {
    held(mesh).min(SIDE_BY_SIDE)
}

/// How many patches' light may be gathered at once.
pub(super) fn gathered(mesh: &Mesh) -> usize {
    held(mesh).min(GATHERED)
}

/// How many values there may be at each vertex.
fn held(mesh: &Mesh) -> usize {
    (VALUES / mesh.vertices.len().max(1)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::options::Preset;
    use crate::solver::trial::Trial;

    #[test]
    fn what_shots_of_a_volley_give_one_another_stays_unshot() {
        let trial = Trial::after(20, Preset::Draft.options());
        let mut solver = trial.solver();

        let givers = strongest(&solver.unshot_powers(), SIDE_BY_SIDE);
        assert!(givers.len() > 1, "{givers:?}");
        let mut expected = solver.light.clone();
        for giver in &givers {
            expected.take(&solver.mesh, giver.patch, giver.sign);
        }
        for giver in &givers {
            let given = solver.given(&[*giver], &solver.light).remove(0);
            expected.receive(given.irradiance.into_par_iter());
        }
        solver.volley(&givers);
        assert_eq!(solver.light, expected);
        assert_eq!(solver.course.shots, givers.len() as u64);
        let left = |of: &Giver| solver.light.unshot_power(&solver.mesh, of.patch, of.sign);
        assert!(givers.iter().any(|of| left(of).element_sum() > 0.0));
    }

    #[test]
    fn only_what_is_nearly_as_strong_shoots_along() {
        let powers = [0.1, 0.0, 1.0, 0.0, 0.6, 0.0, 0.49, 0.0, 0.9].map(Power::splat);
        let patches = |most| {
            let givers = strongest(&powers, most);
            givers.iter().map(|g| g.patch).collect::<Vec<_>>()
        };
        assert_eq!(patches(8), [1, 4, 2]);
        assert_eq!(patches(2), [1, 4]);
        assert_eq!(patches(1), [1]);
    }
}
