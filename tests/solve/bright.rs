//! Bright walls: what one reflection makes too much or too little is there 1/(1 - ρ) times in the end.
//!
//! Where nothing escapes and all walls reflect ρ, the mean irradiance is M/(1 - ρ) times the part of the walls that emits, wherever
//! that is and however light spreads; so all that is emitted is absorbed.

use super::common::shapes::{add_cuboid, add_grey, empty};
use super::{draft, solved};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solver::{Options, StopReason};

/// A cube whose walls reflect so much, and of which one emits.
fn cube(reflectance: f32) -> Scene {
    let mut scene = empty();
    let wall = add_grey(&mut scene, reflectance, 0.0);
    let lamp = add_grey(&mut scene, reflectance, 1.0);
    add_cuboid(&mut scene, wall, [DVec3::ZERO, DVec3::ONE], true);
    scene.surfaces[3].material = lamp;
    scene
}

#[track_caller]
fn assert_absorbs_what_is_emitted(reflectance: f32, options: Options) {
    let report = solved(&cube(reflectance), options).report;
    assert_eq!(report.stop_reason, StopReason::Converged);
    let absorbed = report.power.absorbed / report.power.emitted;
    assert!((absorbed - 1.0).abs() < 0.003, "{absorbed}");
    // The estimate neither overlooks an error nor makes one up.
    let found = report.audit.expect("all were looked at").n_rms;
    assert!((0.001..0.012).contains(&found), "{found}");
}

#[test]
fn a_cube_that_reflects_0_97_absorbs_what_is_emitted() {
    assert_absorbs_what_is_emitted(0.97, draft());
}

#[test]
fn a_cube_that_reflects_0_9_absorbs_what_is_emitted_as_clusters() {
    let clusters = Options {
        cluster_from: 1,
        ..draft()
    };
    assert_absorbs_what_is_emitted(0.9, clusters);
}
