//! What is seen only through slits along edges: closed forms of a cube in a cube, and boxes that stand close.

use crate::common::shapes::{add_cuboid, add_grey};
use crate::setup::{assert_closed, close, matrix, portable, quads, room_with_block};
use glam::{DVec3, dvec3};
use radiosity::matrix::{By, Enclosure, Options};
use radiosity::scene::{NamedScene, Scene};

/// A cube of edge `inner` in the middle of one of edge 1, each facing the other.
fn nested(inner: f64) -> Scene {
    let half = DVec3::splat(0.5 * inner);
    room_with_block(DVec3::splat(0.5) - half, DVec3::splat(0.5) + half)
}

/// The same with rows for all of either cube: by the names of groups, or of materials.
fn as_two_rows(inner: f64, by: By) -> NamedScene {
    let mut scene = nested(inner);
    if by == By::Material {
        let other = add_grey(&mut scene, 0.5, 0.0);
        let cube = scene.surfaces.iter_mut().skip(6);
        cube.for_each(|surface| surface.material = other);
    }
    let mut named = NamedScene::from(scene);
    if by == By::Group {
        named.names.groups = vec!["outer".into(), "inner".into()];
        named.names.group_of = (0..12).map(|polygon| Some(polygon / 6)).collect();
    }
    named
}

/// What the outer cube, or its first wall, sees of the outer cube, and the error that is stated of its row.
fn seen_by_outer(inner: f64, by: By, tolerance: f64) -> (f64, f64) {
    let options = Options {
        by,
        tolerance,
        ..portable()
    };
    let enclosure = Enclosure::new(&as_two_rows(inner, by), &options);
    let room = enclosure.expect("a scene that radiates").matrix();
    let own = room.len() / 2;
    let seen = (0..own).map(|j| room.factor(0, j)).sum();
    (seen, room.certificate.row_errors[0])
}

#[test]
fn walls_see_one_another_through_the_slits_around_a_cube() {
    for inner in [0.9, 0.95, 0.99, 0.999] {
        let room = matrix(&nested(inner));
        // All that leaves the inner cube arrives at the outer one.
        let seen: f64 = (0..6).map(|j| room.factor(0, j)).sum();
        let exact = 1.0 - inner * inner;
        close(seen, exact, 3e-5, &format!("a cube of {inner}"));
        assert_closed(&room, 3e-5);
    }
    // Opposite walls, from four times 2^20 points of a sequence of low discrepancy.
    let room = matrix(&nested(0.9));
    let opposite = (1..6).map(|j| room.factor(0, j)).fold(1.0, f64::min);
    close(opposite, 0.00264, 3e-5, "opposite walls");
}

#[test]
fn what_slits_let_through_is_off_by_no_more_than_is_stated() {
    for inner in [0.5, 0.9, 0.97, 0.99, 0.999] {
        for by in [By::Surface, By::Group, By::Material] {
            for tolerance in [1e-3, 1e-4, 1e-5] {
                let (seen, stated) = seen_by_outer(inner, by, tolerance);
                let what = format!("a cube of {inner} by {by:?} to {tolerance:e}");
                close(seen, 1.0 - inner * inner, stated, &what);
                assert!(stated <= tolerance, "{what}: {stated:e} is stated");
            }
        }
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
    assert_closed(&matrix(&scene), 1e-4);
}
