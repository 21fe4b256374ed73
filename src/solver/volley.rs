//! Patches that give their light to all others side by side: shots too weak to test the mesh, and the last gathering.
//!
//! One such shot has little work on each level of the quadtree, too little to share out evenly. What one of them sends
//! to another stays unshot until that one's next turn.

use super::escape::Lost;
use super::light::{Light, Sign};
use super::run::Solver;
use super::shoot::{Beam, Shooter};
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

/// Patches that give their light side by side …
const SIDE_BY_SIDE: usize = 8;

/// … unless together they would hold more values at vertices.
const VALUES: usize = 1 << 22;

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
    /// The power that arrives.
    pub received: Power,
    pub lost: Lost,
    pub rays: u64,
}

impl Solver<'_> {
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
        let (arrived, rays) = self.arrivals(beam, patch, &reached);
        let irradiance: Vec<Spectrum> = arrived.into_iter().map(|g| g.irradiance).collect();
        let received = irradiance.iter().zip(&self.mesh.weights);
        let power = power / self.emitted().element_sum();
        let seed = self.course.shots as u32 + patch as u32;
        Given {
            received: received.map(|(e, w)| e.as_dvec3() * *w).sum(),
            irradiance,
            lost: self.escape(patch, &shooter, power, seed) * f64::from(sign.factor()),
            rays,
        }
    }

    /// Shots from the strongest of `powers` and from others nearly as strong, `most` at the most; none of them tests the mesh.
    pub(super) fn volley(&mut self, powers: &[Power], most: usize) {
        let giver = |(of, power): (usize, &Power)| Giver {
            patch: of / 2,
            sign: Sign::ALL[of % 2],
            power: power.element_sum(),
        };
        let mut givers: Vec<Giver> = powers.iter().enumerate().map(giver).collect();
        givers.sort_by(|a, b| b.power.total_cmp(&a.power));
        let least = ALONGSIDE * givers[0].power;
        givers.truncate(most.min(side_by_side(&self.mesh)));
        givers.retain(|giver| giver.power >= least);

        let given = self.given(&givers, &self.light);
        for giver in &givers {
            self.light.take(&self.mesh, giver.patch, giver.sign);
        }
        for of in given {
            self.light.receive(of.irradiance.into_par_iter());
            self.course.rays += of.rays;
            self.course.lost += of.lost;
        }
        self.course.shots += givers.len() as u64;
    }
}

/// How many patches may give their light at once.
pub(super) fn side_by_side(mesh: &Mesh) -> usize {
    (VALUES / mesh.vertices.len().max(1)).clamp(1, SIDE_BY_SIDE)
}
