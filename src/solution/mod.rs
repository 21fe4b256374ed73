//! The result: a mesh with light on it, its conforming triangulation, probing, the report, and the file that keeps it all.
//!
//! Imports `geometry`, `radiometry`, `scene`, `mesh`, and of the solver what a solve leaves behind.

mod borders;
mod conform;
mod file;
mod format_1;
mod lit_mesh;
mod plane;
mod probe;
mod report;

pub use file::SolutionError;
pub use lit_mesh::{LitMesh, LitTriangle, LitVertex};
pub use plane::{Levels, Plane};
pub use probe::{MATCH, Probe, Prober};
pub use report::{EngineReport, PowerReport, Report, Seconds, TargetReport};

use crate::mesh::Mesh;
use crate::scene::{Camera, Scene};
use crate::solver::{Course, Light};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A solved scene: what `solve` leaves and the other commands read back.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The facts of the solve.
    pub report: Report,
    /// The scene's cameras.
    pub cameras: Vec<Camera>,
    /// Length of one scene unit in metres.
    pub metres_per_unit: f64,
    /// The adaptive mesh.
    pub mesh: Mesh,
    /// The light on it.
    pub light: Light,
    /// What it takes to go on; files of format 1 do not hold it.
    pub continuation: Option<Continuation>,
}

/// What it takes, besides mesh and light, to go on with a solve.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Continuation {
    /// The scene.
    pub scene: Scene,
    /// How far the solve has come.
    pub course: Course,
}

impl Solution {
    /// The solution as conforming triangles.
    pub fn lit_mesh(&self) -> LitMesh {
        conform::conform(&self.mesh, &self.light)
    }

    /// The estimated RMS error of the irradiance on a leaf of the mesh, in W/m², channels pooled; `None` if the solve was not
    /// audited.
    pub fn element_error(&self, leaf: u32) -> Option<f64> {
        let model = self.report.audit?.model;
        Some(model.at(&self.mesh, &self.light, leaf))
    }

    /// [`Self::element_error`] for each triangle of `lit`.
    pub fn triangle_errors(&self, lit: &LitMesh) -> Option<Vec<f32>> {
        let error = |triangle: &LitTriangle| Some(self.element_error(triangle.element)? as f32);
        lit.triangles.par_iter().map(error).collect()
    }
}
