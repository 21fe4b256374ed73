//! The four pictures of a camera.

use super::CliError;
use crate::output::{write_exr, write_png};
use crate::render::{RenderOptions, View};
use crate::scene::Camera;
use crate::solution::LitMesh;
use crate::visibility::{EngineChoice, build};
use std::path::Path;

/// Writes `shaded.exr`, `shaded.png`, `wireframe.png` and `mesh.png` of one camera into `folder`.
pub(super) fn draw(
    lit: &LitMesh,
    camera: &Camera,
    options: &RenderOptions,
    engine: EngineChoice,
    threads: usize,
    folder: &Path,
) -> Result<(), CliError> {
    std::fs::create_dir_all(folder)
        .map_err(|e| CliError::System(format!("cannot make {}: {e}", folder.display())))?;
    let view = View::new(lit, camera, options, |triangles| {
        build(engine, &triangles, threads)
    })?;
    let radiance = view.radiance();
    write_exr(
        &folder.join("shaded.exr"),
        radiance.width,
        radiance.height,
        &radiance.pixels,
    )?;
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
    Ok(())
}
