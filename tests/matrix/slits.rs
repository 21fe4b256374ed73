//! What is seen only through slits along edges: closed forms of a cube in a cube, and boxes that stand close.

use crate::common::shapes::{add_cuboid, add_grey};
use crate::setup::{assert_closed, close, matrix, matrix_with, portable, quads, room_with_block};
use glam::{DVec3, dvec3};
use radiosity::matrix::{By, Options};
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
fn pairs_that_are_alike_in_one_row_are_all_as_accurate_as_the_row_asks() {
    for (inner, within) in [(0.9, 2e-4), (0.99, 5e-4)] {
        let mut scene = nested(inner);
        let other = add_grey(&mut scene, 0.5, 0.0);
        let cube = scene.surfaces.iter_mut().skip(6);
        cube.for_each(|surface| surface.material = other);
        let options = Options {
            by: By::Material,
            ..portable()
        };
        let room = matrix_with(&scene, &options);
        let seen = 1.0 - inner * inner;
        close(room.factor(0, 0), seen, within, "the outer cube");
        assert_closed(&room, within);
    }
}

#[test]
fn boxes_that_stand_close_leave_rows_closed() {
    let mut scene = quads(&[]);
    add_cuboid(&mut scene, 0, [DVec3::ZERO, DVec3::ONE], true);
    for [low, high] in [
        [dvec3(0.04, 0.11, 0.64), dvec3(0.21, 0.21, 0.81)],
        [dvec3(0.16, 0.11, 0.35), dvec3(0.8, 0.57, 0.58)],
        [dvec3(0.02, 0.68, 0.19), dvec3(0.41, 0.83, 0.34)],
        [dvec3(0.42, 0.61, 0.05), dvec3(0.83, 0.81, 0.68)],
    ] {
        add_cuboid(&mut scene, 0, [low, high], false);
    }
    assert_closed(&matrix(&scene), 5e-4);
}
