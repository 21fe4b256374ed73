//! What stands on a surface covers it: that area does not count, and a closed scene stays closed.

use crate::common::shapes::{add_cuboid, add_grey, add_quad, empty};
use crate::setup::{assert_closed, close, matrix, matrix_with, portable, quads, standing_block};
use glam::{DVec3, dvec3};
use radiosity::matrix::{Matrix, Options};
use radiosity::radiometry::Power;
use radiosity::scene::{NamedScene, Scene, Sides};
use std::path::Path;

/// What the block of [`standing_block`] stands on.
const FOOTPRINT: f64 = 0.4 * 0.35;

/// Fails unless A_i F_ij = A_j F_ji, with the areas that are exposed.
#[track_caller]
fn assert_reciprocal(matrix: &Matrix) {
    for i in 0..matrix.len() {
        for j in 0..i {
            let [to, from] =
                [(i, j), (j, i)].map(|(i, j)| matrix.factor(i, j) * matrix.rows[i].area);
            assert!(
                (to - from).abs() <= 1e-14 * to.max(from),
                "{i} {j}: {to} {from}"
            );
        }
    }
}

fn covered(matrix: &Matrix) -> f64 {
    matrix.rows.iter().map(|row| row.covered).sum()
}

#[test]
fn a_floor_counts_as_far_as_it_is_not_covered() {
    let room = matrix(&standing_block());
    let floor = &room.rows[2];
    close(floor.area, 1.0 - FOOTPRINT, 1e-9, "exposed");
    close(floor.covered, FOOTPRINT, 1e-9, "covered");
    close(room.certificate.covered[2], FOOTPRINT, 1e-9, "share");
    assert_closed_but_for_covered(&room, 5e-4);
    // The bottom of the block is covered altogether: it keeps its row, which is empty.
    let bottom = &room.rows[8];
    assert_eq!((bottom.area, room.certificate.row_sums[8]), (0.0, 0.0));
    close(bottom.covered, FOOTPRINT, 1e-9, "bottom");
    close(covered(&room), 2.0 * FOOTPRINT, 1e-9, "nothing else");
    assert_reciprocal(&room);
}

#[track_caller]
fn assert_closed_but_for_covered(matrix: &Matrix, within: f64) {
    let sums = matrix.rows.iter().zip(&matrix.certificate.row_sums);
    for (row, sum) in sums.filter(|(row, _)| row.area > 0.0) {
        close(*sum, 1.0, within, &format!("the row sum of {}", row.label));
    }
    assert!(matrix.certificate.is_closed());
    close(matrix.certificate.escaped, 0.0, within, "escaped");
}

#[test]
fn a_block_needs_no_bottom_and_may_stand_on_another() {
    let mut scene = standing_block();
    scene.surfaces.remove(8);
    let room = matrix(&scene);
    assert_closed(&room, 5e-4);
    close(covered(&room), FOOTPRINT, 1e-9, "without a bottom");

    let mut scene = standing_block();
    add_cuboid(
        &mut scene,
        0,
        [dvec3(0.4, 0.55, 0.3), dvec3(0.8, 0.8, 0.5)],
        false,
    );
    let room = matrix(&scene);
    assert_closed_but_for_covered(&room, 1e-3);
    // It overhangs: 0.3 of 0.4 by 0.2 rest on the block.
    close(
        covered(&room),
        2.0 * FOOTPRINT + 2.0 * 0.3 * 0.2,
        1e-9,
        "one on the other",
    );
    assert_reciprocal(&room);
}

#[test]
fn what_only_touches_or_is_open_is_not_covered() {
    // Walls of two rooms back to back, a block in the air, an open box that radiates inside, a plate that faces the void.
    let mut rooms = quads(&[]);
    for [low, high] in [[0.0, 1.0], [1.0, 2.5]] {
        let corners = [dvec3(low, 0.0, 0.0), dvec3(high, 1.0, 1.0)];
        add_cuboid(&mut rooms, 0, corners, true);
    }
    assert_eq!(covered(&matrix(&rooms)), 0.0);
    assert_eq!(covered(&matrix(&crate::setup::hanging_block())), 0.0);
    let mut open = empty();
    let grey = add_grey(&mut open, 0.5, 0.0);
    add_cuboid(&mut open, grey, [DVec3::ZERO, DVec3::ONE], false);
    open.surfaces.remove(0);
    for surface in &mut open.surfaces {
        surface.sides = Sides::Both;
    }
    assert_eq!(covered(&matrix(&open)), 0.0);
    let mut alone = quads(&[]);
    add_quad(
        &mut alone,
        0,
        [DVec3::ZERO, DVec3::X, dvec3(1.0, 1.0, 0.0), DVec3::Y],
    );
    assert_eq!(covered(&matrix(&alone)), 0.0);
}

/// A room of 4 with an L on its floor, 1 wide and high.
fn room_with_an_l() -> Scene {
    let mut scene = quads(&[]);
    add_cuboid(&mut scene, 0, [DVec3::ZERO, DVec3::splat(4.0)], true);
    let outline = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 0.4],
        [0.4, 0.4],
        [0.4, 1.0],
        [0.0, 1.0],
    ];
    let at = |k: usize, height: f64| {
        let [x, z] = outline[k % outline.len()];
        dvec3(1.0 + x, height, 1.0 + z)
    };
    for k in 0..outline.len() {
        let corners = [at(k, 0.0), at(k, 1.0), at(k + 1, 1.0), at(k + 1, 0.0)];
        add_quad(&mut scene, 0, corners);
    }
    for [a, b, c, d] in [[0, 1, 2, 3], [0, 3, 4, 5]] {
        add_quad(&mut scene, 0, [a, b, c, d].map(|k| at(k, 0.0)));
        add_quad(&mut scene, 0, [d, c, b, a].map(|k| at(k, 1.0)));
    }
    scene
}

/// What the L of [`room_with_an_l`] stands on.
const L_FOOTPRINT: f64 = 0.4 + 0.6 * 0.4;

#[test]
fn what_reaches_into_a_solid_of_any_shape_uncovers_nothing_in_it() {
    let mut scene = room_with_an_l();
    let room = matrix(&scene);
    assert_closed_but_for_covered(&room, 5e-4);
    close(covered(&room), 2.0 * L_FOOTPRINT, 1e-9, "the L alone");

    // From above, half of it in the L; the floor and its lower half see one another there.
    let corners = [dvec3(1.1, 0.5, 1.1), dvec3(1.3, 1.5, 1.3)];
    add_cuboid(&mut scene, 0, corners, false);
    let room = matrix(&scene);
    assert_closed_but_for_covered(&room, 5e-4);
    close(room.rows[2].covered, L_FOOTPRINT, 1e-9, "the floor");
    // Its bottom, half of its four sides, and what it covers of the top of the L.
    let reached = 0.04 + 4.0 * 0.2 * 0.5 + 0.04;
    close(
        covered(&room),
        2.0 * L_FOOTPRINT + reached,
        1e-9,
        "with a box",
    );
    assert_reciprocal(&room);
}

#[test]
fn between_things_that_reach_into_a_solid_nothing_is_exposed() {
    // Seven plates, 2 cm apart: what lies between them in the L sees fronts before all.
    let mut scene = room_with_an_l();
    for k in 0..7 {
        let x = 1.04 + 0.05 * f64::from(k);
        let corners = [dvec3(x, 0.4, 1.04), dvec3(x + 0.03, 1.2, 1.36)];
        add_cuboid(&mut scene, 0, corners, false);
    }
    let room = matrix(&scene);
    assert_closed_but_for_covered(&room, 1e-3);
    let reached = 7.0 * (2.0 * 0.03 * 0.32 + 2.0 * 0.6 * (0.03 + 0.32));
    close(covered(&room), 2.0 * L_FOOTPRINT + reached, 1e-9, "plates");
}

#[test]
fn a_room_within_thick_walls_is_not_in_a_solid() {
    // With a block in it; then with a hole in a wall, through which the backs of what is outside are seen.
    let mut scene = crate::setup::hanging_block();
    let shell = [DVec3::splat(-0.3), DVec3::splat(1.3)];
    add_cuboid(&mut scene, 0, shell, false);
    assert_eq!(covered(&matrix(&scene)), 0.0);
    scene.surfaces.remove(5);
    let [left, right] = [0.0, 1.0].map(|x| [0.0, 0.9].map(|y| dvec3(x, y, 1.0)));
    add_quad(&mut scene, 0, [left[0], left[1], right[1], right[0]]);
    assert_eq!(covered(&matrix(&scene)), 0.0);
    // Nor where the solid is no box.
    let mut scene = room_with_an_l();
    let cavity = [dvec3(1.1, 0.2, 1.1), dvec3(1.3, 0.8, 1.3)];
    add_cuboid(&mut scene, 0, cavity, true);
    let ell = covered(&matrix(&scene));
    close(ell, 2.0 * L_FOOTPRINT, 1e-9, "an L with a cavity");
}

#[test]
fn in_a_furnace_what_is_exposed_shines_alike_and_closure_can_be_enforced() {
    let mut room = matrix(&standing_block());
    let correction = room.enforce_closure().expect("is closed");
    assert!(correction.residual < 1e-12, "{correction:?}");
    assert_reciprocal(&room);
    let n = room.len();
    let balances = room.balance_of(&vec![Power::splat(0.5); n], &vec![Power::ONE; n]);
    for (row, balance) in room.rows.iter().zip(&balances) {
        let [bright, net] = if row.area > 0.0 {
            [2.0, 0.0]
        } else {
            [1.0, 0.0]
        };
        close(balance.radiosity.x, bright, 1e-9, &row.label);
        close(balance.net_flux.x, net, 1e-9, &row.label);
    }
}

/// The Cornell box with its front closed, in metres; its blocks have no bottoms.
fn cornell_box() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box");
    let mut scene = Scene::load(&path).expect("the scenes of this repository load");
    let front = [[0.0, 0.0], [552.8, 0.0], [556.0, 548.8], [0.0, 548.8]];
    add_quad(&mut scene, 0, front.map(|[x, y]| dvec3(x, y, 0.0)));
    scene
}

/// What the two blocks stand on, mm².
const FOOTPRINTS: [[[f64; 2]; 4]; 2] = [
    [[130.0, 65.0], [82.0, 225.0], [240.0, 272.0], [290.0, 114.0]],
    [
        [423.0, 247.0],
        [265.0, 296.0],
        [314.0, 456.0],
        [472.0, 406.0],
    ],
];

#[test]
fn patches_of_the_cornell_box_that_straddle_its_footprints_balance() {
    let named = NamedScene::from(cornell_box());
    let options = Options {
        max_area: Some(0.0165),
        tolerance: 3e-4,
        ..portable()
    };
    let room = matrix_with(&named.scene, &options);
    let shoelace = |corners: [[f64; 2]; 4]| -> f64 {
        let next = corners.iter().cycle().skip(1);
        let twice: f64 = corners
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
            .sum();
        0.5 * twice.abs()
    };
    let footprints: f64 = FOOTPRINTS.map(shoelace).iter().sum();
    close(covered(&room), 1e-6 * footprints, 1e-6, "footprints");
    let straddle = |share: &&f64| **share > 0.0 && **share < 1.0;
    assert!(room.certificate.covered.iter().filter(straddle).count() > 5);
    assert_closed_but_for_covered(&room, 1.5e-3);
    assert_reciprocal(&room);
}
