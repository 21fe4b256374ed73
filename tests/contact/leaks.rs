//! Light stays on its side of a line of contact.

use super::setup::{cuboid, floor};
use glam::{DQuat, DVec3, Vec3};
use radiosity::scene::{Material, Scene, Sides};
use radiosity::solver::{Options, Silent};
use radiosity::{Settings, solve};

/// A box without a bottom that stands on a floor, or is sunk into it, with a light under its lid.
fn lamp(sunk: f64, turn: f64) -> Scene {
    let mut walls = cuboid(DVec3::ONE);
    walls.0.remove(2);
    let light =
        [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)].map(|(x, z)| DVec3::new(x, 0.4, z));
    let turn = DQuat::from_rotation_y(turn);
    let mut scene = floor(4.0)
        .and(&walls.with(&light), turn, DVec3::Y * (0.5 - sunk))
        .scene(false);
    let glow = Material {
        name: "glow".into(),
        reflectance: Vec3::ZERO,
        emitted_radiance: Vec3::ONE,
    };
    scene.materials.push(glow);
    scene
        .surfaces
        .iter_mut()
        .for_each(|surface| surface.sides = Sides::Both);
    let light = scene.surfaces.len() - 1;
    scene.surfaces[light].material = 1;
    scene.surfaces[light].sides = Sides::Front;
    scene
}

#[test]
fn a_floor_beside_a_box_of_light_stays_black() {
    for (sunk, turn) in [(0.0, 0.0), (0.0, 0.4), (0.2, 0.4)] {
        let scene = lamp(sunk, turn);
        let mut options = Options {
            tolerance: 0.01,
            ..Options::default()
        };
        options.limits.max_depth = 3;
        let settings = Settings {
            options,
            ..Settings::default()
        };
        let solution = solve(&scene, &settings, &mut Silent).expect("it can be solved");
        let prober = radiosity::solution::Prober::new(&solution);
        for step in 0..40 {
            // Around the box, a millimetre inside and outside of its walls.
            let (sine, cosine) = (f64::from(step) * std::f64::consts::TAU / 40.0).sin_cos();
            let direction = DVec3::new(cosine, 0.0, sine);
            let on_wall = direction * (0.5 / direction.abs().max_element());
            let probe = |by: f64| {
                let at = DQuat::from_rotation_y(turn) * (on_wall * (1.0 + by));
                prober
                    .probe(at, DVec3::Y)
                    .expect("the floor is there")
                    .irradiance
                    .max_element()
            };
            assert_eq!(probe(2e-3), 0.0, "outside");
            assert!(probe(-2e-3) > 0.05, "inside: {}", probe(-2e-3));
        }
    }
}
