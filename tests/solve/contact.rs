//! A box that stands on a floor: neither light nor darkness leaks along the line where they touch.

use super::common::closed_form::to_polygon;
use super::common::shapes::{add_cuboid, add_grey, add_level, add_quad, empty, rectangle};
use super::{draft, engines, solved, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::{Prober, Solution};
use radiosity::solver::Preset;

/// A floor of 4 m, and on it a box that lines up with no grid of elements.
const BOX: [DVec3; 2] = [DVec3::new(-0.37, 0.0, -0.29), DVec3::new(0.45, 0.8, 0.61)];

/// A light of 1 W/m² that faces down, to the left of the box and above it: all of the floor behind the box, on the right
/// and near it, lies in its umbra.
const LIGHT: [[f64; 2]; 2] = [[-1.9, 0.0], [-1.5, 0.3]];
const HEIGHT: f64 = 1.5;

fn scene(reflectance: f32) -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, reflectance, 0.0);
    let light = add_grey(&mut scene, 0.0, 1.0);
    add_level(&mut scene, grey, [[-2.0, -2.0], [2.0, 2.0]], 0.0, true);
    add_cuboid(&mut scene, grey, BOX, false);
    add_level(&mut scene, light, LIGHT, HEIGHT, false);
    scene
}

/// What the floor would receive without the box.
fn unoccluded(point: DVec3) -> f64 {
    let [[x0, z0], [x1, z1]] = LIGHT;
    let corners = [(x0, z0), (x1, z0), (x1, z1), (x0, z1)].map(|(x, z)| DVec3::new(x, HEIGHT, z));
    to_polygon(point, DVec3::Y, &corners)
}

/// Points 2, 10 and 30 mm from the box, at x and beyond it.
fn beside(x: f64, outwards: f64) -> impl Iterator<Item = DVec3> {
    let depths = (0..15).map(|i| -0.25 + 0.0587 * f64::from(i));
    depths.flat_map(move |z| [0.002, 0.01, 0.03].map(|gap| DVec3::new(x + outwards * gap, 0.0, z)))
}

fn irradiance(prober: &Prober, point: DVec3) -> f64 {
    f64::from(
        prober
            .probe(point, DVec3::Y)
            .expect("lies on the floor")
            .irradiance
            .x,
    )
}

#[test]
fn no_light_leaks_into_the_umbra() {
    let solution = solved(&scene(0.0), Preset::Standard.options());
    let prober = Prober::new(&solution);
    let leaks = beside(BOX[1].x, 1.0).map(|point| irradiance(&prober, point) / unoccluded(point));
    let worst = leaks.fold(0.0, f64::max);
    assert!(
        worst <= 0.001,
        "{worst} of the light that the box keeps away"
    );
}

#[test]
fn no_darkness_leaks_out_on_the_lit_side() {
    for (preset, bound) in [(Preset::Draft, 0.03), (Preset::Standard, 0.005)] {
        let solution = solved(&scene(0.0), preset.options());
        let prober = Prober::new(&solution);
        let mut worst: f64 = 0.0;
        for point in beside(BOX[0].x, -1.0) {
            let error = irradiance(&prober, point) / unoccluded(point) - 1.0;
            worst = worst.max(error.abs());
        }
        assert!(worst <= bound, "{preset:?}: {worst}");
    }
}

/// With reflection the umbra has a little light, which comes over from the floor beyond.
#[test]
fn what_reflection_brings_into_the_umbra_is_that_of_a_fine_solve() {
    let fine = solved(&scene(0.5), Preset::Accurate.options());
    let coarse = solved(&scene(0.5), Preset::Standard.options());
    let [fine, coarse] = [Prober::new(&fine), Prober::new(&coarse)];
    let mut worst: f64 = 0.0;
    for point in beside(BOX[1].x, 1.0) {
        let difference = irradiance(&coarse, point) - irradiance(&fine, point);
        worst = worst.max(difference.abs() / unoccluded(point));
    }
    assert!(worst <= 0.003, "{worst}");
}

#[test]
fn the_floor_under_the_box_is_dark() {
    let solution: Solution = solved(&scene(0.5), draft());
    assert!(solution.report.buried_vertices > 0);
    let prober = Prober::new(&solution);
    for (x, z) in [(0.04, 0.16), (-0.1, 0.3), (0.2, 0.0)] {
        assert_eq!(irradiance(&prober, DVec3::new(x, 0.0, z)), 0.0);
    }
}

/// Rays are not tested where they begin, and the vertices of short elements on the border of a ledge are as close to a wall there.
#[test]
fn no_light_passes_through_the_wall_behind_a_narrow_ledge() {
    const WIDTH: f64 = 0.004;
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.0, 0.0);
    let light = add_grey(&mut scene, 0.0, 1.0);
    add_level(&mut scene, grey, [[-WIDTH, 0.0], [0.0, 0.04]], 0.0, true);
    let foot = DVec3::new(0.0, -0.01, -3.0);
    add_quad(
        &mut scene,
        grey,
        rectangle(foot, DVec3::Y * 4.0, DVec3::Z * 6.0),
    );
    add_level(&mut scene, light, [[0.1, -1.0], [2.0, 1.0]], 2.0, false);
    for engine in engines() {
        let solution = solved_by(&scene, Preset::Standard.options(), engine, 0);
        let prober = Prober::new(&solution);
        let lit = (0..8).map(|i| {
            let x = -WIDTH * (0.001 + f64::from(i) / 8.0);
            irradiance(&prober, DVec3::new(x, 0.0, 0.013))
        });
        assert_eq!(lit.fold(0.0, f64::max), 0.0, "{engine:?}");
    }
}

/// Nothing arrives below the box, but a floor that emits does so there too: B = M + ρE at every vertex of an export, as it is probed.
#[test]
fn an_emitter_below_a_solid_has_its_exitance() {
    let mut scene = scene(0.5);
    scene.materials[0].emitted_radiance = glam::Vec3::splat(2.0 / std::f32::consts::PI);
    let solution = solved(&scene, draft());
    let lit = solution.lit_mesh();
    let of_floor = lit.triangles.iter().filter(|t| t.polygon == 0);
    let vertices = of_floor.flat_map(|t| t.vertices.map(|v| lit.vertices[v as usize]));
    let (mut covered, prober) = (0, Prober::new(&solution));
    for vertex in vertices {
        let expected = 2.0 + 0.5 * vertex.irradiance.x;
        assert!((vertex.radiosity.x - expected).abs() < 1e-5, "{vertex:?}");
        covered += usize::from(vertex.irradiance.x == 0.0);
    }
    assert!(covered > 0, "some vertices lie below the box");
    let below = DVec3::new(0.1, 0.0, 0.1);
    let probe = prober.probe(below, DVec3::Y).expect("lies on the floor");
    assert!((probe.radiosity.x - 2.0).abs() < 1e-5, "{probe:?}");
}
