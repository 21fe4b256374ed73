//! The light on a mesh.

use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};

/// Irradiance at the vertices, and what of it has not been shot.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Light {
    /// Irradiance E received so far, W/m², by vertex.
    pub irradiance: Vec<Spectrum>,
    /// The part of it whose reflection is unshot, by vertex.
    pub unshot: Vec<Spectrum>,
    /// Whether a patch's own exitance is still unshot, by patch.
    pub exitance_unshot: Vec<bool>,
}

impl Light {
    /// Darkness, with everything to be emitted unshot.
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            irradiance: vec![Spectrum::ZERO; mesh.vertices.len()],
            unshot: vec![Spectrum::ZERO; mesh.vertices.len()],
            exitance_unshot: mesh
                .patches
                .iter()
                .map(|p| p.exitance != Spectrum::ZERO)
                .collect(),
        }
    }

    /// Unshot radiosity ΔB of a patch at one of its vertices.
    pub fn unshot_radiosity(&self, mesh: &Mesh, vertex: u32) -> Spectrum {
        let patch = mesh.vertices[vertex as usize].patch as usize;
        let own = if self.exitance_unshot[patch] {
            mesh.patches[patch].exitance
        } else {
            Spectrum::ZERO
        };
        own + mesh.patches[patch].reflectance * self.unshot[vertex as usize]
    }

    /// Unshot power of a patch, in W times the square of the frame's scale.
    pub fn unshot_power(&self, mesh: &Mesh, patch: usize) -> Power {
        let of = &mesh.patches[patch];
        let received: Power = of
            .vertices
            .iter()
            .map(|v| self.unshot[*v as usize].as_dvec3() * mesh.weights[*v as usize])
            .sum();
        let own = if self.exitance_unshot[patch] {
            of.exitance.as_dvec3() * of.area
        } else {
            Power::ZERO
        };
        own + of.reflectance.as_dvec3() * received
    }

    /// Marks everything of a patch as shot.
    pub fn take(&mut self, mesh: &Mesh, patch: usize) {
        self.exitance_unshot[patch] = false;
        for vertex in &mesh.patches[patch].vertices {
            self.unshot[*vertex as usize] = Spectrum::ZERO;
        }
    }
}
