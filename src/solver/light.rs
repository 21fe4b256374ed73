//! The light on a mesh.

use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Vertices that one thread adds light at: of fewer, to wake another would take longer.
const SLICE: usize = 1 << 15;

/// Irradiance at the vertices, and what of it has not been shot.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Irradiance E received so far, W/m², by vertex.
    pub irradiance: Vec<Spectrum>,
    /// The part of it whose reflection is unshot, by vertex.
    pub unshot: Vec<Spectrum>,
    /// What of a patch's own exitance is unshot, W/m², by patch.
    pub exitance_unshot: Vec<Spectrum>,
}

/// Unshot light is positive in a solve from darkness. What is left after gathering, or after an emitter was dimmed, is of either
/// sign; each is shot by itself, as light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// Light to be added.
    Positive,
    /// Light to be taken away.
    Negative,
}

impl Sign {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Positive, Self::Negative];

    /// 1 or -1.
    pub fn factor(self) -> f32 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The part of a quantity that has this sign, without it.
    fn part(self, of: Spectrum) -> Spectrum {
        (of * self.factor()).max(Spectrum::ZERO)
    }

    /// Takes that part away.
    fn take(self, from: &mut Spectrum) {
        *from -= self.part(*from) * self.factor();
    }
}

impl Light {
    /// Darkness, with everything to be emitted unshot.
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            irradiance: mesh.by_vertex(Spectrum::ZERO),
            ..Self::to_send(mesh, mesh.by_vertex(Spectrum::ZERO))
        }
    }

    /// What is unshot alone: what is given by vertex, and everything to be emitted.
    pub(super) fn to_send(mesh: &Mesh, unshot: Vec<Spectrum>) -> Self {
        Self {
            irradiance: Vec::new(),
            unshot,
            exitance_unshot: mesh.patches.iter().map(|p| p.exitance).collect(),
        }
    }

    /// Unshot radiosity ΔB of one sign of a patch at one of its vertices, ≥ 0.
    pub fn unshot_radiosity(&self, mesh: &Mesh, vertex: u32, sign: Sign) -> Spectrum {
        let patch = mesh.vertices.patch_of(vertex) as usize;
        sign.part(self.exitance_unshot[patch])
            + mesh.patches.reflectance(patch) * sign.part(self.unshot[vertex as usize])
    }

    /// Unshot power of one sign of a patch, in W times the square of the frame's scale, ≥ 0.
    pub fn unshot_power(&self, mesh: &Mesh, patch: usize, sign: Sign) -> Power {
        let [positive, negative] = self.unshot_by_sign(mesh, patch);
        match sign {
            Sign::Positive => positive,
            Sign::Negative => negative,
        }
    }

    /// That of a patch by sign, in the order of [`Sign::ALL`].
    pub(super) fn unshot_by_sign(&self, mesh: &Mesh, patch: usize) -> [Power; 2] {
        let mut received = [Power::ZERO; 2];
        for v in mesh.vertices_of(patch as u32) {
            let (unshot, weight) = (self.unshot[v as usize], mesh.weights[v as usize]);
            for (sum, sign) in received.iter_mut().zip(Sign::ALL) {
                *sum += sign.part(unshot).as_dvec3() * weight;
            }
        }
        let reflectance = mesh.patches.reflectance(patch).as_dvec3();
        let own = self.exitance_unshot[patch];
        // Hardly any patch emits: the others are not asked for their area, which takes longer than all the rest.
        let area = match own {
            Spectrum::ZERO => 0.0,
            _ => mesh.patches.at(patch).area,
        };
        [0, 1].map(|sign| {
            let own = Sign::ALL[sign].part(own).as_dvec3() * area;
            own + reflectance * received[sign]
        })
    }

    /// What is unshot of a patch's own emission of one sign, with the sign; power as above.
    pub(super) fn own_unshot(&self, mesh: &Mesh, patch: usize, sign: Sign) -> f64 {
        let own = sign.part(self.exitance_unshot[patch]) * sign.factor();
        f64::from(own.element_sum()) * mesh.patches.at(patch).area
    }

    /// Whether all that a patch has unshot of one sign is its own.
    pub(super) fn is_own(&self, mesh: &Mesh, patch: usize, sign: Sign) -> bool {
        let unshot = |v: u32| sign.part(self.unshot[v as usize]);
        let mut vertices = mesh.vertices_of(patch as u32);
        vertices.all(|v| unshot(v) == Spectrum::ZERO)
    }

    /// Whether emitters have anything of one sign to shoot.
    pub(super) fn is_direct(&self, sign: Sign) -> bool {
        let unshot = |exitance: &Spectrum| sign.part(*exitance) != Spectrum::ZERO;
        self.exitance_unshot.iter().any(unshot)
    }

    /// Whether all that is emitted, and that alone, has arrived.
    pub(super) fn is_all_direct(&self) -> bool {
        let emitted = Sign::ALL.iter().all(|sign| !self.is_direct(*sign));
        emitted && self.irradiance == self.unshot
    }

    /// Adds what arrives at each vertex, all of it unshot.
    pub(super) fn receive(&mut self, arrived: impl IndexedParallelIterator<Item = Spectrum>) {
        let light = self.irradiance.par_iter_mut().zip(&mut self.unshot);
        let light = light.zip(arrived).with_min_len(SLICE);
        light.for_each(|((irradiance, unshot), arrived)| {
            *irradiance += arrived;
            *unshot += arrived;
        });
    }

    /// Marks everything of one sign as shot.
    pub(super) fn take_all(&mut self, sign: Sign) {
        let unshot = self.unshot.par_iter_mut().chain(&mut self.exitance_unshot);
        unshot
            .with_min_len(4096)
            .for_each(|unshot| sign.take(unshot));
    }

    /// Marks everything of one sign of a patch as shot.
    pub fn take(&mut self, mesh: &Mesh, patch: usize, sign: Sign) {
        sign.take(&mut self.exitance_unshot[patch]);
        for vertex in mesh.vertices_of(patch as u32) {
            sign.take(&mut self.unshot[vertex as usize]);
        }
    }
}
