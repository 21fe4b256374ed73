//! The furnace: where all surfaces emit M and reflect ρ, and nothing escapes, everything shines with B = M / (1 - ρ).
//!
//! Whatever the shape, that holds at every point; so errors of form factors, of visibility where walls meet, of
//! interpolation and of selection all show, and are not excused by a bad reference.

use super::common::ENGINE;
use super::common::shapes::{add_cuboid, add_grey, add_level, add_quad, empty};
use super::{engines, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::Solution;
use radiosity::solver::{Options, Preset};
use radiosity::visibility::EngineChoice;

const EXITANCE: f32 = 1.0;
const REFLECTANCE: f32 = 0.5;

/// A room of 2 m by 1 m by 1.5 m, seen from inside.
pub(super) fn cuboid() -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, REFLECTANCE, EXITANCE);
    add_cuboid(
        &mut scene,
        grey,
        [DVec3::ZERO, DVec3::new(2.0, 1.0, 1.5)],
        true,
    );
    scene
}

/// A room that is an L of three squares seen from above, so that its legs are out of each other's sight in part.
fn l_shaped() -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, REFLECTANCE, EXITANCE);
    for square in [
        [[0.0, 0.0], [1.0, 1.0]],
        [[1.0, 0.0], [2.0, 1.0]],
        [[0.0, 1.0], [1.0, 2.0]],
    ] {
        add_level(&mut scene, grey, square, 0.0, true);
        add_level(&mut scene, grey, square, 1.0, false);
    }
    // Once around, seen from above: the room is on the left.
    let outline = [
        [0.0, 0.0],
        [0.0, 2.0],
        [1.0, 2.0],
        [1.0, 1.0],
        [2.0, 1.0],
        [2.0, 0.0],
    ];
    for (i, [x, z]) in outline.into_iter().enumerate() {
        let [to_x, to_z] = outline[(i + 1) % outline.len()];
        let at = |x, y, z| DVec3::new(x, y, z);
        add_quad(
            &mut scene,
            grey,
            [
                at(x, 0.0, z),
                at(x, 1.0, z),
                at(to_x, 1.0, to_z),
                at(to_x, 0.0, to_z),
            ],
        );
    }
    scene
}

/// The largest relative error of the radiosity at any vertex.
pub(super) fn error(solution: &Solution) -> f64 {
    let exact = f64::from(EXITANCE / (1.0 - REFLECTANCE));
    let radiosity = |e: &glam::Vec3| f64::from(EXITANCE) + f64::from(REFLECTANCE) * e.as_dvec3();
    let errors = solution
        .light
        .irradiance
        .iter()
        .map(|e| (radiosity(e) / exact - 1.0).abs().max_element());
    errors.fold(0.0, f64::max)
}

/// What a preset may be off at its worst vertex, in the cuboid and in the L.
///
/// In the L a
/// wall is seen around a corner: a cell of the source of which an eighth is hidden may count as seen. Finer source cells
/// (a tenth of ε_fe and ε_fd) bring it down.
fn assert_uniform(engine: EngineChoice, preset: Preset, bounds: [f64; 2]) {
    // What has not been shot yet is no error of the geometry.
    let options = Options {
        tolerance: 1e-5,
        ..preset.options()
    };
    for (scene, bound) in [cuboid(), l_shaped()].iter().zip(bounds) {
        let error = error(&solved_by(scene, options.clone(), engine, 0));
        assert!(error <= bound, "{engine}: off by {error:.5}");
    }
}

#[test]
fn draft() {
    for engine in engines() {
        assert_uniform(engine, Preset::Draft, [0.005, 0.014]);
    }
}

#[test]
fn standard() {
    for engine in engines() {
        assert_uniform(engine, Preset::Standard, [0.0005, 0.013]);
    }
}

#[test]
fn accurate() {
    assert_uniform(ENGINE, Preset::Accurate, [0.0003, 0.004]);
}
