//! Where few points agree by accident: it is found out, or the row sums tell, or the stated error covers it.

use crate::common::shapes::{add_cuboid, add_quad};
use crate::setup::{
    assert_closed, close, matrix_with, portable, quads, room_with_block, standing_block,
};
use glam::{DVec3, dvec3};
use radiosity::matrix::{By, Enclosure, Matrix, Options};
use radiosity::scene::{NamedScene, Scene};
use std::f64::consts::FRAC_PI_4;
use std::path::Path;

/// Two prisms and a box in a room of 4, askew.
fn three_prisms() -> NamedScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/three_prisms.obj");
    NamedScene::load(&path).expect("is a scene")
}

#[test]
fn a_third_number_of_points_finds_out_two_that_agree_by_accident() {
    let named = three_prisms();
    // To 1e-3 an error of 0.002 is no reason to look at a row again.
    for (tolerance, within) in [(1e-4, 1e-4), (1e-3, 5e-4)] {
        let options = Options {
            by: By::Group,
            tolerance,
            ..portable()
        };
        let enclosure = Enclosure::new(&named, &options).expect("radiates");
        let room = enclosure.matrix();
        let [y0, y1] = ["y0", "y1"].map(|label| room.index(label).expect("has a row"));
        close(room.factor(y0, y1), 0.158181, within, "walls past bodies");
        close(room.certificate.row_sums[y0], 1.0, within, "row sum");
    }
}

#[test]
fn a_body_that_hides_all_does_so_from_points_that_see_different_outlines_of_it() {
    let named = three_prisms();
    let options = Options {
        max_area: Some(0.5),
        tolerance: 1e-3,
        ..portable()
    };
    let enclosure = Enclosure::new(&named, &options).expect("radiates");
    let room = enclosure.matrix();
    let [ceiling, wall] = ["ceilz/7", "y0/23"].map(|label| room.index(label).expect("has a row"));
    // The box lies on all lines between them.
    assert_eq!(room.factor(ceiling, wall), 0.0);
    for row in [ceiling, wall] {
        close(room.certificate.row_sums[row], 1.0, 5e-4, "row sum");
    }
}

/// A room of 4 with a box in its air and an octagonal column beside it, both in the middle between two walls: from either of these
/// 4, 9 and 16 points see the same share of the other, and all of them too much.
fn symmetric() -> Scene {
    let mut scene = quads(&[]);
    add_cuboid(&mut scene, 0, [DVec3::ZERO, DVec3::splat(4.0)], true);
    let [low, high] = [0.741265496, 1.491265496];
    let corners = [dvec3(1.625, 1.5, low), dvec3(2.375, 2.5, high)];
    add_cuboid(&mut scene, 0, corners, false);
    let at = |k: usize, height: f64| {
        let (sin, cos) = (FRAC_PI_4 * (k % 8) as f64).sin_cos();
        dvec3(1.0 + 0.375 * cos, 2.0 + 0.375 * sin, height)
    };
    for k in 0..8 {
        let corners = [at(k, 0.0), at(k + 1, 0.0), at(k + 1, 0.75), at(k, 0.75)];
        add_quad(&mut scene, 0, corners);
    }
    for [a, b, c, d] in [[0, 1, 2, 3], [0, 3, 4, 7], [4, 5, 6, 7]] {
        add_quad(&mut scene, 0, [a, b, c, d].map(|k| at(k, 0.75)));
    }
    scene
}

/// The walls of [`symmetric`] whose exchange is in question.
const WALLS: [usize; 2] = [2, 3];

/// A room of 1 with a box close to one of its walls, of which few points see alike, and all of them too much.
fn close_to_a_wall() -> Scene {
    room_with_block(dvec3(0.66, 0.05, 0.8), dvec3(0.8, 0.6, 0.98))
}

fn coarse() -> Options {
    Options {
        tolerance: 1e-3,
        ..portable()
    }
}

#[test]
fn sides_that_mirror_one_another_are_no_evidence() {
    let named = NamedScene::from(symmetric());
    let enclosure = Enclosure::new(&named, &portable()).expect("radiates");
    // What is not kept is not worked out again.
    let streamed = enclosure.without_keeping().matrix();
    for wall in WALLS {
        close(streamed.certificate.row_sums[wall], 1.0, 5e-5, "a wall");
    }
}

#[test]
fn rows_that_sum_up_to_too_much_are_worked_out_again() {
    let room = matrix_with(&close_to_a_wall(), &coarse());
    assert_closed(&room, 3e-4);
    assert!(room.certificate.exceeding.is_empty());
}

#[track_caller]
fn assert_covers_its_excess(matrix: &Matrix, row: usize) {
    let certificate = &matrix.certificate;
    let excess = certificate.row_sums[row] - 1.0;
    assert!(certificate.exceeding.contains(&(row as u32)), "row {row}");
    close(certificate.row_errors[row], excess, 1e-12, "stated error");
}

#[test]
fn what_a_row_has_above_1_is_stated_as_its_error_where_it_is_not_worked_out_again() {
    let named = NamedScene::from(close_to_a_wall());
    let enclosure = Enclosure::new(&named, &coarse()).expect("radiates");
    let streamed = enclosure.without_keeping().matrix();
    let exceeding = streamed.certificate.exceeding.clone();
    assert!(!exceeding.is_empty());
    for row in exceeding {
        assert_covers_its_excess(&streamed, row as usize);
    }
    // Part of the floor is there twice.
    let mut scene = standing_block();
    let [low, high] = [0.75, 0.95];
    let at = |x: f64, z: f64| dvec3(x, 0.0, z);
    let rug = [at(low, low), at(low, high), at(high, high), at(high, low)];
    add_quad(&mut scene, 0, rug);
    let room = matrix_with(&scene, &portable());
    assert_covers_its_excess(&room, 0);
    assert!(!room.certificate.is_closed());
    assert!(room.certificate.escaped < 0.0);
}
