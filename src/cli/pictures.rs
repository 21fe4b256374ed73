//! The four pictures of a camera.

use super::CliError;
use crate::SolveError;
use crate::output::{write_exr, write_png};
use crate::render::{Place, RenderOptions, View};
use crate::scene::Camera;
use crate::solution::LitMesh;
use crate::threads::pool;
use crate::visibility::{EngineChoice, VisibilityError, build};
use std::path::Path;

/// Writes `shaded.exr`, `shaded.png`, `wireframe.png` and `mesh.png` of one camera into `folder`; whether it came to the end, as it does
/// while they are `wanted`; on so many threads, 0 for all. None of them is written in part.
pub(super) fn draw(
    lit: &LitMesh,
    camera: &Camera,
    (engine, threads): (EngineChoice, usize),
    folder: &Path,
    wanted: &(dyn Fn() -> bool + Sync),
) -> Result<bool, CliError> {
    let look = || -> Result<Option<View>, VisibilityError> {
        let engine = |triangles| build(engine, &triangles, threads);
        let place = Place::new(lit, camera.eye, engine)?;
        Ok(place.view(camera, &RenderOptions::standard(), wanted))
    };
    let pool = pool(threads).map_err(SolveError::from)?;
    let Some(view) = pool.install(look)? else {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radiometry::Spectrum;
    use crate::solution::{LitTriangle, LitVertex};
    use glam::{DVec3, Vec3};
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn no_more_threads_draw_than_were_asked_for() {
        let vertex = |position| LitVertex {
            position,
            normal: Vec3::Z,
            irradiance: Spectrum::ONE,
            radiosity: Spectrum::ONE,
        };
        let lit = LitMesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            vertices: [0, 1, 2].map(vertex).to_vec(),
            triangles: vec![LitTriangle {
                vertices: [0, 1, 2],
                element: 0,
                polygon: 0,
                on_border: true,
            }],
        };
        let camera = Camera {
            name: "front".into(),
            eye: DVec3::Z,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            horizontal_fov: 45.0,
            width: 8,
            height: 8,
            exposure: None,
        };
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let threads = AtomicUsize::new(0);
        let wanted = || {
            threads.store(rayon::current_num_threads(), Ordering::Relaxed);
            true
        };
        let engine = (EngineChoice::Obvhs, 7);
        let drawn = draw(&lit, &camera, engine, folder.path(), &wanted);
        assert!(drawn.expect("can be written"));
        assert_eq!(threads.into_inner(), 7);
    }
}
