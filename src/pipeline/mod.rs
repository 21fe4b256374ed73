//! From a scene to its solution in one call: mesh, visibility, solve, report.
//! [`solve_to_error`] repeats it until the estimated error is small enough.

mod target;

pub use target::solve_to_error;

use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::solution::{EngineReport, PowerReport, Report, Seconds, Solution};
use crate::solver::{Observer, Options, Solver, occluders};
use crate::threads::{ThreadsError, pool};
use crate::visibility::{EngineChoice, VisibilityError, build};
use std::time::Instant;
use thiserror::Error;

/// How a scene is solved.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Settings {
    /// Thresholds and limits.
    pub options: Options,
    /// Who traces the rays.
    pub engine: EngineChoice,
    /// Threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// Why a scene could not be solved.
#[derive(Debug, Error)]
pub enum SolveError {
    /// The visibility engine could not be built.
    #[error(transparent)]
    Visibility(#[from] VisibilityError),
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}

/// Solves `scene`; `observer` hears of the progress and may stop it. The same settings on the same instruction set give the same
/// solution, bit for bit, for any number of threads.
pub fn solve(
    scene: &Scene,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Solution, SolveError> {
    let started = Instant::now();
    let pool = pool(settings.threads)?;
    let threads = pool.current_num_threads();
    let mesh = pool.install(|| Mesh::new(scene, settings.options.limits));
    let visibility = build(settings.engine, &occluders(scene, &mesh), threads)?;
    let solver =
        pool.install(|| Solver::new(scene, mesh, visibility.as_ref(), settings.options.clone()));
    let built = Instant::now();
    let outcome = pool.install(|| solver.run(observer));
    let engine = visibility.info();
    let mesh = outcome.mesh;
    let report = Report {
        scene: scene.name.clone(),
        engine: EngineReport {
            name: engine.name.to_owned(),
            version: engine.version,
            isa: engine.isa,
            packet_width: engine.packet_width,
        },
        threads,
        input_patches: scene.input_polygons,
        patches: mesh.patches.len(),
        shots: outcome.shots,
        meshing_shots: outcome.meshing_shots,
        max_depth: mesh.depth(),
        elements: mesh.leaves().count(),
        vertices: mesh.vertices.len(),
        buried_vertices: mesh.buried.iter().filter(|b| **b).count(),
        rays: outcome.rays,
        seconds: Seconds {
            load: 0.0,
            build: (built - started).as_secs_f64(),
            solve: built.elapsed().as_secs_f64(),
            write: 0.0,
        },
        stop_reason: outcome.stop_reason,
        reference_irradiance: outcome.reference_irradiance,
        power: PowerReport::new(&outcome.ledger, |p| p.element_sum()),
        power_rgb: PowerReport::new(&outcome.ledger, |p| p.to_array()),
        audit: outcome.audit,
        target: None,
        options: settings.options.clone(),
        warnings: warnings(scene, &mesh),
    };
    Ok(Solution {
        report,
        cameras: scene.cameras.clone(),
        metres_per_unit: scene.metres_per_unit,
        mesh,
        light: outcome.light,
    })
}

/// What the reader found suspicious, and what could not be meshed as it should.
fn warnings(scene: &Scene, mesh: &Mesh) -> Vec<String> {
    let mut warnings = scene.warnings.clone();
    let count = mesh.unsplit_contacts;
    if count > 0 {
        let plural = if count == 1 { "" } else { "s" };
        warnings.push(format!(
            "{count} surface{plural} not split where others meet: light may leak along the contacts"
        ));
    }
    warnings
}
