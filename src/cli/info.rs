//! `radiosity info`.

use super::CliError;
use super::error::Code;
use super::say;
use crate::scene::{MaterialSummary, Scene, Summary};
use crate::words::counted;
use clap::Args;
use rustc_hash::FxHashMap;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A folder with a scene.toml, a .toml, or an .obj, .glb, .gltf or .ply
    scene: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let scene = Scene::load(&arguments.scene)?;
    say::warnings(&scene.warnings);
    say::result(describe(&scene, &scene.summary()))?;
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
            "{} ({}, {}), {} two-sided",
            summary.surfaces,
            counted(summary.triangles, "triangle", "triangles"),
            counted(summary.quads, "quad", "quads"),
            summary.two_sided
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
    for (of, colours) in by_name(&summary.materials) {
        let material = &of.material;
        let mean = match colours {
            1 => String::new(),
            n => format!(" (means of {n} colours of its textures)"),
        };
        line(
            "material",
            format!(
                "{} reflectance {:.3} radiance {:.3}{mean}: {}, {:.6} m²",
                material.name,
                material.reflectance,
                material.emitted_radiance,
                counted(of.surfaces, "surface", "surfaces"),
                of.area
            ),
        );
    }
    text
}

/// Materials that share a name as one, with how many they are: textures give a material several colours.
fn by_name(materials: &[MaterialSummary]) -> Vec<(MaterialSummary, usize)> {
    let mut places: FxHashMap<&str, usize> = FxHashMap::default();
    let mut merged: Vec<(MaterialSummary, usize)> = Vec::new();
    for of in materials {
        let place = *places.entry(&of.material.name).or_insert(merged.len());
        let Some((all, colours)) = merged.get_mut(place) else {
            merged.push((of.clone(), 1));
            continue;
        };
        let area = (all.area + of.area).max(f64::MIN_POSITIVE);
        let share = (of.area / area) as f32;
        let (mean, more) = (&mut all.material, &of.material);
        mean.reflectance = mean.reflectance.lerp(more.reflectance, share);
        mean.emitted_radiance = mean.emitted_radiance.lerp(more.emitted_radiance, share);
        all.surfaces += of.surfaces;
        all.area += of.area;
        all.emitted_power += of.emitted_power;
        *colours += 1;
    }
    merged
}
