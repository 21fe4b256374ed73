//! A scene built in code, solved, and written for Blender: a lamp over a table.
//!
//! ```text
//! cargo run --release --example solve_in_code -- table.glb
//! ```

use glam::{DVec3, Vec3};
use radiosity::output::{GlbFacts, write_glb};
use radiosity::radiometry::radiance_from_radiosity;
use radiosity::render::Tone;
use radiosity::scene::{Camera, Corners, Material, Names, Scene, Sides, Surface};
use radiosity::solver::{Preset, Silent};
use radiosity::{Settings, solve};
use std::error::Error;
use std::path::Path;

/// A level rectangle around a point; `up` is the side of its front.
fn level(scene: &mut Scene, centre: DVec3, half: f64, up: bool, material: u32) {
    let first = scene.vertices.len() as u32;
    let ring = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let corner = |(x, z): (f64, f64)| centre + half * DVec3::new(x, 0.0, z);
    scene.vertices.extend(ring.map(corner));
    let corners = if up { [0, 1, 2, 3] } else { [3, 2, 1, 0] };
    scene.surfaces.push(Surface {
        corners: Corners::Quad(corners.map(|corner| first + corner)),
        material,
        polygon: scene.surfaces.len() as u32,
        sides: Sides::Both,
    });
    scene.input_polygons += 1;
}

fn material(name: &str, reflectance: Vec3, radiance: f32) -> Material {
    Material {
        name: name.into(),
        reflectance,
        emitted_radiance: Vec3::splat(radiance),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut scene = Scene {
        name: "A lamp over a table".into(),
        metres_per_unit: 1.0,
        vertices: Vec::new(),
        surfaces: Vec::new(),
        materials: vec![
            material("floor", Vec3::new(0.6, 0.5, 0.4), 0.0),
            material("table", Vec3::new(0.3, 0.5, 0.3), 0.0),
            material("lamp", Vec3::ZERO, 20.0),
        ],
        cameras: vec![Camera {
            name: "front".into(),
            eye: DVec3::new(0.0, 2.0, 6.0),
            look_at: DVec3::new(0.0, 0.6, 0.0),
            up: DVec3::Y,
            horizontal_fov: 40.0,
            width: 640,
            height: 480,
            exposure: None,
        }],
        input_polygons: 0,
        warnings: Vec::new(),
    };
    level(&mut scene, DVec3::ZERO, 2.0, true, 0);
    level(&mut scene, DVec3::new(0.0, 0.7, 0.0), 0.6, true, 1);
    level(&mut scene, DVec3::new(0.0, 2.0, 0.0), 0.3, false, 2);

    let settings = Settings {
        options: Preset::Draft.options(),
        ..Settings::default()
    };
    let solution = solve(&scene, &settings, &mut Silent)?;
    let power = &solution.report.power;
    println!(
        "{:.3} W emitted, {:.3} W absorbed",
        power.emitted, power.absorbed
    );

    let path = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "table.glb".into());
    let mesh = solution.lit_mesh();
    let tone = Tone::for_mesh(&mesh);
    let names = Names::default();
    let facts = GlbFacts {
        names: &names,
        name: &scene.name,
        metres_per_unit: scene.metres_per_unit,
        cameras: &scene.cameras,
        exposure: tone.exposure(),
        two_sided: &[],
    };
    write_glb(Path::new(&path), &mesh, &facts, |vertex| {
        tone.display(radiance_from_radiosity(vertex.radiosity))
    })?;
    println!("{} triangles in {path}", mesh.triangles.len());
    Ok(())
}
