//! What is seen only through slits along edges: closed forms of a cube in a cube, and boxes that stand close.

use crate::common::shapes::add_cuboid;
use crate::setup::{assert_closed, close, matrix, matrix_with, portable, quads, room_with_block};
use glam::{DVec3, dvec3};
use radiosity::matrix::Options;
use radiosity::scene::Scene;

/// A cube of edge `inner` in the middle of one of edge 1, each facing the other.
fn nested(inner: f64) -> Scene {
    let half = DVec3::splat(0.5 * inner);
    room_with_block(DVec3::splat(0.5) - half, DVec3::splat(0.5) + half)
}

#[test]
fn walls_see_one_another_through_the_slits_around_a_cube() {
    for (inner, within) in [(0.9, 2e-4), (0.95, 1e-4), (0.99, 5e-4)] {
        let room = matrix(&nested(inner));
        // All that leaves the inner cube arrives at the outer one.
        let seen: f64 = (0..6).map(|j| room.factor(0, j)).sum();
        close(
            seen,
            1.0 - inner * inner,
            within,
            &format!("a cube of {inner}"),
        );
        assert_closed(&room, within);
    }
    // Opposite walls, from four times 2^20 points of a sequence of low discrepancy.
    let room = matrix(&nested(0.9));
    let opposite = (1..6).map(|j| room.factor(0, j)).fold(1.0, f64::min);
    close(opposite, 0.00264, 3e-5, "opposite walls");
}

#[test]
fn in_sum_too_slits_count() {
    // To a tolerance at which a wall as a whole could be left out.
    let options = Options {
        tolerance: 1e-3,
        ..portable()
    };
    let room = matrix_with(&nested(0.99), &options);
    let seen: f64 = (0..6).map(|j| room.factor(0, j)).sum();
    close(seen, 0.0199, 1e-3, "outer walls");
}

#[test]
fn boxes_that_stand_close_leave_rows_closed() {
    let mut scene = quads(&[]);
    add_cuboid(&mut scene, 0, [DVec3::ZERO, DVec3::ONE], true);
    for [low, high] in [
        [dvec3(0.38, 0.24, 0.48), dvec3(0.65, 0.87, 0.9)],
        [dvec3(0.66, 0.12, 0.54), dvec3(0.93, 0.25, 0.77)],
        [dvec3(0.06, 0.15, 0.13), dvec3(0.31, 0.88, 0.26)],
        [dvec3(0.33, 0.01, 0.01), dvec3(0.95, 0.57, 0.45)],
        [dvec3(0.07, 0.47, 0.41), dvec3(0.3, 0.99, 0.66)],
        [dvec3(0.77, 0.28, 0.6), dvec3(0.9, 0.41, 0.94)],
    ] {
        add_cuboid(&mut scene, 0, [low, high], false);
    }
    assert_closed(&matrix(&scene), 5e-4);
}
