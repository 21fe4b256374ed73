//! The four pictures of a camera.

use super::CliError;
use crate::output::{write_exr, write_png};
use crate::render::{Place, RenderOptions};
use crate::scene::Camera;
use crate::solution::LitMesh;
use crate::visibility::{EngineChoice, build};
use std::path::Path;

/// Writes `shaded.exr`, `shaded.png`, `wireframe.png` and `mesh.png` of one camera into `folder`; whether it came to the end, as it does
/// while they are `wanted`. None of them is written in part.
pub(super) fn draw(
    lit: &LitMesh,
    camera: &Camera,
    (engine, threads): (EngineChoice, usize),
    folder: &Path,
    wanted: &(dyn Fn() -> bool + Sync),
) -> Result<bool, CliError> {
    let place = Place::new(lit, camera.eye, |triangles| {
        build(engine, &triangles, threads)
    })?;
    let Some(view) = place.view(camera, &RenderOptions::standard(), wanted) else {
        return Ok(false);
    };
    std::fs::create_dir_all(folder)
        .map_err(|e| CliError::System(format!("cannot make {}: {e}", folder.display())))?;
    let radiance = view.radiance();
    write_exr(
        &folder.join("shaded.exr"),
        radiance.width,
        radiance.height,
        &radiance.pixels,
    )?;
    drop(radiance);
    for (name, picture) in [
        ("shaded.png", view.shaded()),
        ("wireframe.png", view.wireframe()),
        ("mesh.png", view.mesh()),
    ] {
        write_png(
            &folder.join(name),
            picture.width,
            picture.height,
            &picture.pixels,
        )?;
    }
    Ok(true)
}
