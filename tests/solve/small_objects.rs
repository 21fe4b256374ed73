//! Small things in the air: a shadow that lies between the vertices of the first mesh is found.

use super::common::ENGINE;
use super::common::shapes::{add_grey, add_level, empty};
use super::{engines, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::Prober;
use radiosity::solver::Preset;
use radiosity::visibility::EngineChoice;
use std::f64::consts::PI;

/// A light that faces down.
const LIGHT: f64 = 0.2;
const LIGHT_HEIGHT: f64 = 2.0;
/// The heights of squares in the air.
const HEIGHT: f64 = 0.3;

/// Where a point of the floor lies that is behind the middle of a square, seen from the middle of the light.
fn behind([x, z]: [f64; 2]) -> DVec3 {
    DVec3::new(x, 0.0, z) * (LIGHT_HEIGHT / (LIGHT_HEIGHT - HEIGHT))
}

/// Irradiance on the floor from a light of radiance 1/π behind a square, by the midpoint rule.
fn exact(point: DVec3, [x, z]: [f64; 2], side: f64) -> f64 {
    const STEPS: u32 = 200;
    let step = LIGHT / f64::from(STEPS);
    let at = |i: u32| (f64::from(i) + 0.5) * step - 0.5 * LIGHT;
    let mut sum = 0.0;
    for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
        let to = DVec3::new(at(i), LIGHT_HEIGHT, at(j)) - point;
        let crossing = point + to * (HEIGHT / LIGHT_HEIGHT);
        let hidden = (crossing.x - x).abs().max((crossing.z - z).abs()) < 0.5 * side;
        if !hidden {
            sum += to.y * to.y / (PI * to.length_squared().powi(2)) * step * step;
        }
    }
    sum
}

/// Squares at uneven places over a floor of 4 m, from 20 cm down to 3 cm: the first elements are 25 cm long.
fn squares() -> Vec<([f64; 2], f64)> {
    let sides = [0.2, 0.1, 0.05, 0.03];
    let place = |i: u32| f64::from(i) * 0.557 - 1.43 + 0.013 * f64::from(i * i);
    let places = (0..6).flat_map(|i| (0..6).map(move |j| [place(i), place(j)]));
    places.zip(sides.into_iter().cycle()).collect()
}

/// A dark floor below the squares, and a light of so many tiles along each side.
fn scene(tiles: u32) -> Scene {
    let mut scene = empty();
    let dark = add_grey(&mut scene, 0.0, 0.0);
    // As they differ by a hair they are not meshed as one.
    let lights = [0.9995, 1.0005].map(|exitance| add_grey(&mut scene, 0.0, exitance));
    add_level(&mut scene, dark, [[-2.0, -2.0], [2.0, 2.0]], 0.0, true);
    let at = |i: u32| LIGHT * (f64::from(i) / f64::from(tiles) - 0.5);
    for (i, j) in (0..tiles).flat_map(|i| (0..tiles).map(move |j| (i, j))) {
        let light = lights[(i + j) as usize % 2];
        let tile = [[at(i), at(j)], [at(i + 1), at(j + 1)]];
        add_level(&mut scene, light, tile, LIGHT_HEIGHT, false);
    }
    for ([x, z], side) in squares() {
        let half = 0.5 * side;
        let span = [[x - half, z - half], [x + half, z + half]];
        add_level(&mut scene, dark, span, HEIGHT, true);
    }
    scene
}

/// Behind the squares of `least` and more.
fn assert_shadows(scene: &Scene, engine: EngineChoice, least: f64) {
    let solution = solved_by(scene, Preset::Standard.options(), engine, 0);
    let prober = Prober::new(&solution);
    for (place, side) in squares().into_iter().filter(|(_, side)| *side >= least) {
        let point = behind(place);
        let found = prober.probe(point, DVec3::Y).expect("lies on the floor");
        // The smallest has no umbra, and the dark middle of its shadow is as wide as the finest elements.
        let bound = if side > 0.03 { 0.01 } else { 0.25 };
        let lit = exact(point, place, 0.0);
        let error = (f64::from(found.irradiance.x) - exact(point, place, side)) / lit;
        assert!(
            error.abs() <= bound,
            "{engine}: behind the square of {side} m at {place:?} {error:+.3} of the light"
        );
    }
}

#[test]
fn the_shadows_of_small_things_are_found() {
    for engine in engines() {
        assert_shadows(&scene(1), engine, 0.0);
    }
}

/// None of the lights has the power for which a shot tests the mesh. What falls between all vertices is not found: of each light that is
/// next to nothing.
#[test]
fn many_small_lights_refine_like_a_large_one() {
    assert_shadows(&scene(20), ENGINE, 0.05);
}
