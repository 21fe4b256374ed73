//! `radiosity info`.

use super::CliError;
use super::error::Code;
use crate::scene::{Scene, Summary};
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A folder with a scene.toml, a .toml, or an .obj
    scene: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let scene = Scene::load(&arguments.scene)?;
    for warning in &scene.warnings {
        eprintln!("warning: {warning}");
    }
    print!("{}", describe(&scene, &scene.summary()));
    Ok(Code::Success)
}

fn describe(scene: &Scene, summary: &Summary) -> String {
    let mut text = format!("{}\n", scene.name);
    let (low, high) = summary.bounds;
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<14}{value}");
    };
    line("unit", format!("{} m", scene.metres_per_unit));
    line("bounds", format!("{low} to {high}"));
    line("polygons", summary.polygons.to_string());
    line(
        "surfaces",
        format!(
            "{} ({} triangles, {} quads), {} two-sided",
            summary.surfaces, summary.triangles, summary.quads, summary.two_sided
        ),
    );
    line("area", format!("{:.6} m²", summary.area));
    line("emitters", summary.emitters.to_string());
    line(
        "emitted power",
        format!("{:.6} W per channel", summary.emitted_power),
    );
    for camera in &scene.cameras {
        line(
            "camera",
            format!(
                "{} {}x{} from {} to {}",
                camera.name, camera.width, camera.height, camera.eye, camera.look_at
            ),
        );
    }
    for of in &summary.materials {
        let material = &of.material;
        line(
            "material",
            format!(
                "{} reflectance {:.3} radiance {:.3}: {} surfaces, {:.6} m²",
                material.name,
                material.reflectance,
                material.emitted_radiance,
                of.surfaces,
                of.area
            ),
        );
    }
    text
}
