//! The light of a solution at points in the open.

use super::SolveError;
use crate::radiometry::Spectrum;
use crate::solution::Solution;
use crate::solver::OpenLight;
use crate::threads::pool;
use crate::visibility::{EngineChoice, build};
use glam::DVec3;

/// Irradiance, W/m², of a solution at points (scene units) for a surface that would face along each normal: gathered from all that
/// the solution emits and reflects, with occlusion. The points need not lie on a surface; those inside a solid have `None`.
///
/// # Errors
/// When the engine or the threads cannot be started.
pub fn irradiance_at(
    solution: &Solution,
    places: &[(DVec3, DVec3)],
    engine: EngineChoice,
    threads: usize,
) -> Result<Vec<Option<Spectrum>>, SolveError> {
    let Solution {
        mesh,
        light,
        report,
        ..
    } = solution;
    let open = OpenLight::new(mesh, light, &report.options, report.reference_irradiance);
    let visibility = build(engine, &open.occluders(), threads)?;
    let frame = &mesh.frame;
    let places: Vec<(DVec3, DVec3)> = places
        .iter()
        .map(|(point, normal)| (frame.enter(*point), normal.normalize_or(DVec3::Y)))
        .collect();
    Ok(pool(threads)?.install(|| open.irradiance(visibility.as_ref(), &places)))
}
