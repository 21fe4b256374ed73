//! What must stay whole.

use super::setup::{Polygons, cuboid, floor, pieces, pieces_down_to, sphere};
use glam::{DQuat, DVec3};

#[test]
fn a_box_stays_whole_welded_or_not() {
    for welded in [false, true] {
        pieces(&cuboid(DVec3::new(3.0, 2.0, 1.0)).scene(welded)).assert_whole();
    }
}

#[test]
fn rooms_that_share_a_wall_s_plane_stay_whole() {
    let rooms = cuboid(DVec3::ONE)
        .and(&cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::X * 1.0)
        .and(&cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::Y * 1.0);
    pieces(&rooms.scene(false)).assert_whole();
}

#[test]
fn a_sphere_of_triangles_stays_whole() {
    for welded in [false, true] {
        pieces(&sphere(2.0, 12).scene(welded)).assert_whole();
    }
}

#[test]
fn what_hovers_does_not_touch() {
    // A millimetre above a floor of four metres, and five millionths of it, where elements can be as small.
    for gap in [1e-3, 2e-5] {
        let above = floor(4.0).and(&cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::Y * (0.5 + gap));
        pieces_down_to(&above.scene(false), 1e-6).assert_whole();
    }
}

#[test]
fn corners_that_touch_a_surface_do_not_split_it() {
    let tip = [
        DVec3::ZERO,
        DVec3::new(0.5, 1.0, 0.0),
        DVec3::new(0.0, 1.0, 0.5),
    ];
    pieces(&floor(4.0).with(&tip).scene(false)).assert_whole();
}

#[test]
fn two_sheets_back_to_back_stay_whole() {
    let up = floor(2.0);
    let down: Vec<DVec3> = up.0[0].iter().rev().copied().collect();
    pieces(&up.with(&down).scene(true)).assert_whole();
}

#[test]
fn slivers_and_specks_are_harmless() {
    let mut dust = floor(4.0);
    for i in 0..200 {
        let (x, size) = (f64::from(i) * 0.015 - 1.5, 10f64.powi(-(i % 16)));
        let at = DVec3::new(
            x,
            -0.5 * size * f64::from(i % 3),
            0.3 * f64::from(i % 7) - 1.0,
        );
        dust = dust.with(&[
            at,
            at + DVec3::new(0.0, size, 1e-3 * size),
            at + DVec3::new(1e-5, size, 0.0),
        ]);
    }
    let scene = dust.scene(false);
    assert!(pieces(&scene).of[0].len() > 1);
    let thin = Polygons::default()
        .with(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1e-9, 0.0)])
        .with(&[
            DVec3::new(0.5, -1.0, -1.0),
            DVec3::new(0.5, 1.0, 0.0),
            DVec3::new(0.5, -1.0, 1.0),
        ]);
    assert_eq!(pieces(&thin.scene(false)).of[0].len(), 1);
}
