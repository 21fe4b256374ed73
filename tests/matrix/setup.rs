//! Scenes and matrices for these tests.

use crate::common::shapes::{add_cuboid, add_grey, add_quad, empty};
use glam::{DVec3, dvec3};
use radiosity::matrix::{Enclosure, Matrix, Options};
use radiosity::scene::{NamedScene, Scene};
use radiosity::visibility::EngineChoice;

/// Options with the portable engine, so that no test depends on what is installed.
pub fn portable() -> Options {
    Options {
        engine: EngineChoice::Obvhs,
        ..Options::standard()
    }
}

/// The matrix of a scene made by hand.
pub fn matrix_with(scene: &Scene, options: &Options) -> Matrix {
    let named = NamedScene::from(scene.clone());
    Enclosure::new(&named, options)
        .expect("a scene that radiates")
        .matrix()
}

/// The same with standard options.
pub fn matrix(scene: &Scene) -> Matrix {
    matrix_with(scene, &portable())
}

/// A scene of quads, each its own surface, radiating from the side from which its corners run counter-clockwise.
pub fn quads(list: &[[DVec3; 4]]) -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 0.0);
    for corners in list {
        add_quad(&mut scene, grey, *corners);
    }
    scene
}

/// A room of 1 with a cuboid between the given corners in it, all radiating into the space between.
pub fn room_with_block(low: DVec3, high: DVec3) -> Scene {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 0.0);
    add_cuboid(&mut scene, grey, [DVec3::ZERO, DVec3::ONE], true);
    add_cuboid(&mut scene, grey, [low, high], false);
    scene
}

/// A block that stands on the floor of [`room_with_block`]: part of the floor lies below it.
pub fn standing_block() -> Scene {
    room_with_block(dvec3(0.3, 0.0, 0.25), dvec3(0.7, 0.55, 0.6))
}

/// A block that hangs in the air, so that every point of every surface sees the room.
pub fn hanging_block() -> Scene {
    room_with_block(dvec3(0.3, 0.2, 0.25), dvec3(0.7, 0.55, 0.6))
}

/// Fails where two numbers differ by more than `within`.
#[track_caller]
pub fn close(found: f64, expected: f64, within: f64, what: &str) {
    assert!(
        (found - expected).abs() <= within,
        "{what}: {found} is not {expected} to within {within:e}"
    );
}

/// Fails unless all rows sum up to 1.
#[track_caller]
pub fn assert_closed(matrix: &Matrix, within: f64) {
    for (row, sum) in matrix.rows.iter().zip(&matrix.certificate.row_sums) {
        close(*sum, 1.0, within, &format!("the row sum of {}", row.label));
    }
    assert!(matrix.certificate.is_closed());
}
