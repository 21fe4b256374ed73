//! A canopy over a floor in the open: the floor is lit by a lamp, and the canopy by the floor alone. Little of what the floor sends falls on the
//! canopy, but much of what that sends falls on the floor.

use super::clusters::clustered;
use super::common::ENGINE;
use super::common::shapes::{add_grey, add_level, empty};
use super::resume::{in_sessions, settings};
use super::{bits, draft, solved, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::Prober;
use radiosity::solver::{Options, Preset};

/// From x, z below the canopy: the irradiance there, by an independent path tracer; its standard error is below 0.2 %.
const KNOWN: [[f64; 3]; 4] = [
    [-3.5, 0.0, 0.508],
    [-3.5, 1.5, 0.534],
    [-1.0, 0.0, 1.044],
    [-1.0, 1.5, 1.122],
];

/// A floor of so many metres that reflects a half, as the canopy does; the lamp has 400 W.
fn scene(width: f64) -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 0.0);
    let light = add_grey(&mut scene, 0.0, 1e4);
    let half = 0.5 * width;
    add_level(&mut scene, grey, [[-half; 2], [half; 2]], 0.0, true);
    add_level(&mut scene, light, [[2.1, 1.3], [2.3, 1.5]], 4.0, false);
    add_level(&mut scene, grey, [[-4.0, -2.0], [0.0, 2.0]], 3.0, false);
    scene
}

fn assert_lit(width: f64, options: Options, most: f64) {
    let solution = solved(&scene(width), options);
    let power = &solution.report.power;
    let unshot = power.unshot / power.emitted;
    assert!(unshot.abs() < 0.01, "{unshot} is unshot");
    let prober = Prober::new(&solution);
    for [x, z, expected] in KNOWN {
        let point = DVec3::new(x, 3.0, z);
        let found = prober.probe(point, DVec3::NEG_Y).expect("on the canopy");
        let error = f64::from(found.irradiance.x) / expected - 1.0;
        assert!(error.abs() < most, "{width} m, at {x}, {z}: {error:+.3}");
    }
}

#[test]
fn what_is_still_to_come_is_not_foreseen_from_bounces_that_differ() {
    assert_lit(40.0, clustered(Preset::Standard.options()), 0.05);
}

/// Of a floor of 400 m a cell of the source is 25 m wide, in a draft, and most of the light of the floor is in one of them.
#[test]
fn light_in_a_small_part_of_a_floor_stays_there() {
    for width in [40.0, 200.0, 400.0] {
        assert_lit(width, draft(), 0.04);
    }
}

#[test]
fn a_shot_from_a_small_part_of_a_floor_can_be_interrupted() {
    let scene = scene(400.0);
    let whole = bits(solved_by(&scene, draft(), ENGINE, 1));
    let (solution, sessions) = in_sessions(&scene, &settings(draft(), ENGINE, 1), 2);
    assert!(sessions > 4, "{sessions}");
    assert!(bits(solution) == whole);
}
