//! Illuminance against closed forms: CIE 171:2006, test case 5.8, and a rectangular luminaire over a plane of work. Prints the tables
//! of `docs/lighting.md`.
//!
//! ```text
//! cargo run --release --example lighting
//! ```

use glam::{DVec3, Vec3};
use radiosity::scene::{Corners, Material, Scene, Sides, Surface};
use radiosity::solution::Solution;
use radiosity::solver::{Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, irradiance_at, solve};
use std::error::Error;
use std::f64::consts::{PI, TAU};

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    integrating_cube()?;
    println!();
    luminaire()
}

/// CIE 171:2006, 5.8: a cube of 4 m with a point source of 10000 lm in the middle, here a sphere of 10 mm.
fn integrating_cube() -> Outcome<()> {
    const FLUX: f64 = 10_000.0;
    println!(
        "| reflectance | indirect, exact (lx) | computed (lx) | error | total, exact (lx) | computed (lx) | error |"
    );
    println!("|--:|--:|--:|--:|--:|--:|--:|");
    let direct = FLUX / 96.0;
    let mut computed_direct = 0.0;
    for rho in [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95] {
        let solution = solved(&cube(rho, FLUX))?;
        let total = mean_on_walls(&solution);
        if rho == 0.0 {
            computed_direct = total;
        }
        let exact = direct * rho / (1.0 - rho);
        let indirect = total - computed_direct;
        let error = |computed: f64, exact: f64| match exact > 0.0 {
            true => format!("{:+.2} %", 100.0 * (computed / exact - 1.0)),
            false => String::new(),
        };
        println!(
            "| {rho} | {exact:.2} | {indirect:.2} | {} | {:.2} | {total:.2} | {} |",
            error(indirect, exact),
            direct + exact,
            error(total, direct + exact),
        );
    }
    Ok(())
}

/// Six walls that face inwards, and an octahedron that gives `flux` in lumens: all quantities of this scene are photometric.
fn cube(rho: f64, flux: f64) -> Scene {
    const RADIUS: f64 = 0.01;
    let mut scene = empty();
    scene.materials[0].reflectance = Vec3::splat(rho as f32);
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let inwards = -sign * DVec3::AXES[axis];
            let (u, v) = inwards.any_orthonormal_pair();
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let corners = corners.map(|(a, b)| 2.0 * (a * u + b * v - inwards));
            add(&mut scene, &corners, 0);
        }
    }
    let mut area = 0.0;
    for [x, y, z] in [0, 1, 2, 3, 4, 5, 6, 7].map(|n| [n & 1, n >> 1 & 1, n >> 2]) {
        let sign = |bit: i32| f64::from(2 * bit - 1);
        let tips = [sign(x) * DVec3::X, sign(y) * DVec3::Y, sign(z) * DVec3::Z];
        let mut face = tips.map(|tip| RADIUS * tip);
        let normal = (face[1] - face[0]).cross(face[2] - face[0]);
        if normal.dot(face[0]) < 0.0 {
            face.swap(1, 2);
        }
        area += normal.length() / 2.0;
        add(&mut scene, &face, 1);
    }
    scene.materials[1].emitted_radiance = Vec3::splat((flux / (PI * area)) as f32);
    scene
}

fn mean_on_walls(solution: &Solution) -> f64 {
    let mesh = solution.lit_mesh();
    let (mut sum, mut area) = (0.0, 0.0);
    for triangle in mesh
        .triangles
        .iter()
        .filter(|triangle| triangle.polygon < 6)
    {
        let corners = triangle.vertices.map(|v| mesh.vertices[v as usize]);
        let [a, b, c] = corners.map(|corner| mesh.positions[corner.position as usize]);
        let weight = (b - a).cross(c - a).length() / 2.0;
        let mean: f32 = corners
            .iter()
            .map(|corner| corner.irradiance.x)
            .sum::<f32>()
            / 3.0;
        sum += weight * f64::from(mean);
        area += weight;
    }
    sum / area
}

/// A luminaire of 1.2 m by 0.6 m and 1000 cd/m², 2 m above the plane of work of a black room.
fn luminaire() -> Outcome<()> {
    let (a, b, height, luminance) = (1.2, 0.6, 2.0, 1000.0);
    let mut scene = empty();
    let corners = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)];
    add(
        &mut scene,
        &corners.map(|(x, z)| DVec3::new(x, height, z)),
        1,
    );
    scene.materials[1].emitted_radiance = Vec3::splat(luminance as f32);
    let solution = solved(&scene)?;
    let points = [(0.0, 0.0), (0.6, 0.3), (1.2, 0.6), (2.0, 1.0), (4.0, 2.0)];
    let points = points.map(|(x, z)| (DVec3::new(x, 0.0, z), DVec3::Y));
    let found = irradiance_at(&solution, &points, EngineChoice::Auto, 0)?;
    println!("| x (m) | z (m) | exact (lx) | computed (lx) | error |");
    println!("|--:|--:|--:|--:|--:|");
    for ((point, _), irradiance) in points.iter().zip(found) {
        let part =
            |x: f64, z: f64| x.signum() * z.signum() * below_corner(x.abs(), z.abs(), height);
        let (x0, x1, z0, z1) = (-point.x, a - point.x, -point.z, b - point.z);
        let factor = part(x1, z1) - part(x0, z1) - part(x1, z0) + part(x0, z0);
        let exact = luminance * PI * factor;
        let computed = f64::from(irradiance.ok_or("inside a solid")?.x);
        println!(
            "| {} | {} | {exact:.3} | {computed:.3} | {:+.3} % |",
            point.x,
            point.z,
            100.0 * (computed / exact - 1.0)
        );
    }
    Ok(())
}

/// Form factor from a point below the corner of a parallel rectangle of `a` by `b` at distance `c` (B-3 of Howell's catalogue).
fn below_corner(a: f64, b: f64, c: f64) -> f64 {
    let part = |a: f64, b: f64| {
        let root = a.hypot(c);
        a / root * (b / root).atan()
    };
    (part(a, b) + part(b, a)) / TAU
}

fn empty() -> Scene {
    let material = |name: &str| Material {
        name: name.into(),
        reflectance: Vec3::ZERO,
        emitted_radiance: Vec3::ZERO,
    };
    Scene {
        name: "lighting".into(),
        metres_per_unit: 1.0,
        vertices: Vec::new(),
        surfaces: Vec::new(),
        materials: vec![material("wall"), material("lamp")],
        cameras: Vec::new(),
        input_polygons: 0,
        warnings: Vec::new(),
    }
}

fn add(scene: &mut Scene, corners: &[DVec3], material: u32) {
    let first = scene.vertices.len() as u32;
    scene.vertices.extend(corners);
    scene.surfaces.push(Surface {
        corners: match corners.len() {
            3 => Corners::Triangle([first, first + 1, first + 2]),
            _ => Corners::Quad([first, first + 1, first + 2, first + 3]),
        },
        material,
        polygon: scene.surfaces.len() as u32,
        sides: Sides::Front,
    });
    scene.input_polygons += 1;
}

fn solved(scene: &Scene) -> Outcome<Solution> {
    let settings = Settings {
        options: Preset::Standard.options(),
        ..Settings::default()
    };
    Ok(solve(scene, &settings, &mut Silent)?)
}
