//! Obstructed pairs against independent quadrature: millions of segments, with nothing of the product in between.

use crate::common::ENGINE;
use crate::common::shapes::rectangle;
use crate::setup::{
    assert_closed, close, hanging_block, matrix, matrix_with, portable, quads, standing_block,
};
use glam::{DVec3, dvec3};
use radiosity::matrix::Options;
use radiosity::scene::Scene;
use radiosity::visibility::EngineChoice;

/// A rectangle as (corner, side, side).
type Rect = [DVec3; 3];

fn corners([at, u, v]: Rect) -> [DVec3; 4] {
    rectangle(at, u, v)
}

/// F from `a` to `b` past rectangles, by the midpoint rule with `cells`⁴ segments: twice, with the points shifted to either side, so
/// that no symmetry of the scene meets one of the grid and what the shift adds cancels.
fn by_segments(a: Rect, b: Rect, blockers: &[Rect], cells: u32) -> f64 {
    let normal = |[_, u, v]: Rect| u.cross(v);
    let points = |[at, u, v]: Rect, shift: f64| -> Vec<DVec3> {
        let place = |k: u32| (f64::from(k) + 0.5 + shift) / f64::from(cells);
        (0..cells * cells)
            .map(|k| at + u * place(k % cells) + v * place(k / cells))
            .collect()
    };
    let mut sum = 0.0;
    for side in [-1.0, 1.0] {
        let ends = points(b, 0.03 * side);
        for x in points(a, 0.07 * side) {
            for y in &ends {
                let r = *y - x;
                let cosines = (normal(a).dot(r)).max(0.0) * (-normal(b).dot(r)).max(0.0);
                if cosines > 0.0 && !blockers.iter().any(|blocker| blocks(*blocker, x, r)) {
                    sum += cosines / (r.length_squared() * r.length_squared());
                }
            }
        }
    }
    let weight = 0.5 / f64::from(cells).powi(4);
    weight * sum / std::f64::consts::PI / normal(a).length()
}

/// Whether a rectangle crosses the segment from x along r.
fn blocks([at, u, v]: Rect, x: DVec3, r: DVec3) -> bool {
    let n = u.cross(v);
    let t = n.dot(at - x) / n.dot(r);
    let p = x + r * t - at;
    let (s, q) = (p.dot(u) / u.length_squared(), p.dot(v) / v.length_squared());
    t > 1e-9 && t < 1.0 - 1e-9 && (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&q)
}

const BELOW: Rect = [DVec3::ZERO, DVec3::X, DVec3::Y];
const ABOVE: Rect = [DVec3::Z, DVec3::Y, DVec3::X];

fn plate(at: DVec3, size: f64) -> Rect {
    [at, DVec3::X * size, DVec3::Y * size]
}

#[test]
fn a_square_between_two_squares() {
    for (at, size) in [
        (dvec3(0.25, 0.25, 0.5), 0.5),
        (dvec3(0.1, 0.3, 0.8), 0.4),
        (dvec3(0.6, 0.55, 0.1), 0.9),
    ] {
        let blocker = plate(at, size);
        let scene = quads(&[corners(BELOW), corners(ABOVE), corners(blocker)]);
        let found = matrix(&scene).factor(0, 1);
        // The midpoint rule is off by about the perimeter of the shadow over the number of segments across.
        close(
            found,
            by_segments(BELOW, ABOVE, &[blocker], 36),
            2e-4,
            "past a square",
        );
    }
}

#[test]
fn tilted_surfaces_past_two_that_cross() {
    let below = [DVec3::ZERO, DVec3::X, dvec3(0.0, 1.0, 0.3)];
    let above = [dvec3(0.2, 0.0, 1.2), dvec3(0.0, 1.0, -0.1), DVec3::X];
    let blockers = [
        [
            dvec3(0.2, 0.2, 0.6),
            dvec3(0.6, 0.0, 0.1),
            dvec3(0.0, 0.3, 0.0),
        ],
        [
            dvec3(0.5, 0.1, 0.4),
            dvec3(0.0, 0.5, 0.0),
            dvec3(0.0, 0.0, 0.5),
        ],
    ];
    let list = [below, above, blockers[0], blockers[1]];
    let found = matrix(&quads(&list.map(corners))).factor(0, 1);
    close(
        found,
        by_segments(below, above, &blockers, 36),
        2e-4,
        "past two",
    );
}

#[test]
fn a_square_that_covers_the_whole_view_leaves_exactly_nothing() {
    let cover = plate(dvec3(-0.1, -0.1, 0.5), 1.2);
    let covered = matrix(&quads(&[BELOW, ABOVE, cover].map(corners)));
    assert_eq!(covered.factor(0, 1), 0.0);
    // Two that share an edge cover as well as one.
    let halves = [0.0, 0.6].map(|x| [dvec3(-0.1 + x, -0.1, 0.5), DVec3::X * 0.6, DVec3::Y * 1.2]);
    let covered = matrix(&quads(&[BELOW, ABOVE, halves[0], halves[1]].map(corners)));
    assert_eq!(covered.factor(0, 1), 0.0);
}

#[test]
fn a_window_and_its_pane_add_up() {
    // What passes a hole in a wall is what a plate of its size would stop.
    let pane = plate(dvec3(0.3, 0.35, 0.5), 0.3);
    let frame = [
        [dvec3(-0.5, -0.5, 0.5), DVec3::X * 2.0, DVec3::Y * 0.85],
        [dvec3(-0.5, 0.65, 0.5), DVec3::X * 2.0, DVec3::Y * 0.85],
        [dvec3(-0.5, 0.35, 0.5), DVec3::X * 0.8, DVec3::Y * 0.3],
        [dvec3(0.6, 0.35, 0.5), DVec3::X * 0.9, DVec3::Y * 0.3],
    ];
    let free = matrix(&quads(&[BELOW, ABOVE].map(corners))).factor(0, 1);
    let stopped = free - matrix(&quads(&[BELOW, ABOVE, pane].map(corners))).factor(0, 1);
    let list = [BELOW, ABOVE, frame[0], frame[1], frame[2], frame[3]];
    let passed = matrix(&quads(&list.map(corners))).factor(0, 1);
    close(passed, stopped, 1e-4, "window and pane");
}

#[test]
fn a_room_with_a_block_on_its_floor_is_closed_whatever_the_engine() {
    let scene = standing_block();
    let engines = [ENGINE, EngineChoice::Obvhs, EngineChoice::BruteForce];
    let matrices = engines.map(|engine| {
        matrix_with(
            &scene,
            &Options {
                engine,
                max_area: Some(0.1),
                ..portable()
            },
        )
    });
    for other in &matrices[1..] {
        for i in 0..other.len() {
            assert_eq!(matrices[0].row(i), other.row(i), "row {i}");
        }
    }
    // The bottom of the block (9) and the floor below it (3) are covered.
    let room = &matrices[0];
    for (row, sum) in room.rows.iter().zip(&room.certificate.row_sums) {
        match row.area > 0.0 {
            true => close(*sum, 1.0, 1e-3, &row.label),
            false => assert_eq!(*sum, 0.0, "{}", row.label),
        }
    }
    let bottom = room.rows.iter().filter(|row| row.label.starts_with('9'));
    assert!(bottom.clone().count() > 0 && bottom.clone().all(|row| row.area == 0.0));
    assert!(room.certificate.is_closed());
}

#[test]
fn a_room_with_a_block_in_its_air_is_closed() {
    assert_closed(&matrix(&hanging_block()), 5e-4);
}

#[test]
fn a_round_body_is_cut_out_too() {
    // A prism of 20 sides in the air of a room, whose outline has more corners than a shadow may have.
    let mut scene = quads(&[]);
    crate::common::shapes::add_cuboid(&mut scene, 0, [DVec3::ZERO, DVec3::ONE], true);
    let corner = |k: u32, height: f64| {
        let turn = f64::from(k % 20) / 20.0 * std::f64::consts::TAU;
        dvec3(0.5 + 0.2 * turn.cos(), 0.45 + 0.2 * turn.sin(), height)
    };
    for k in 0..20 {
        let side = [
            corner(k, 0.4),
            corner(k + 1, 0.4),
            corner(k + 1, 0.7),
            corner(k, 0.7),
        ];
        crate::common::shapes::add_quad(&mut scene, 0, side);
    }
    for k in 0..9 {
        let strip = [k, k + 1, 18 - k, 19 - k];
        crate::common::shapes::add_quad(&mut scene, 0, strip.map(|k| corner(k, 0.7)));
        let [p, q, r, s] = strip.map(|k| corner(k, 0.4));
        crate::common::shapes::add_quad(&mut scene, 0, [s, r, q, p]);
    }
    let room = matrix(&scene);
    assert_eq!(room.certificate.pairs.rays, 0);
    for sum in &room.certificate.row_sums[..6] {
        close(*sum, 1.0, 5e-4, "a wall");
    }
}

/// F between the floor and the ceiling (2 by 2) of a room 1 high past a horizontal plate of 0.9 by 0.9 in its middle, 0.75 over the
/// floor: all that leaves the floor goes to the walls, four times C-14, to the plate, C-11 by superposition, or to the ceiling.
/// MOOSE's test `analytical_with_obstruction` of the same room prints 0.282833.
const PAST_A_PLATE: f64 = 0.2828875141866425;

#[test]
fn a_plate_in_a_room_leaves_what_the_closed_forms_leave() {
    let mut scene = quads(&[]);
    crate::common::shapes::add_cuboid(&mut scene, 0, [DVec3::ZERO, dvec3(2.0, 2.0, 1.0)], true);
    let below = [dvec3(0.55, 0.55, 0.75), DVec3::Y * 0.9, DVec3::X * 0.9];
    let above = [below[0], below[2], below[1]];
    for [a, b, c, d] in [below, above].map(corners) {
        crate::common::shapes::add_quad(&mut scene, 0, [a, b, c, d]);
    }
    let room = matrix(&scene);
    let lies_at = |height: f64| {
        (0..6)
            .find(|k| {
                let mut corners = scene.positions(&scene.surfaces[*k]);
                corners.all(|corner| corner.z == height)
            })
            .expect("is a side of the room")
    };
    close(
        room.factor(lies_at(0.0), lies_at(1.0)),
        PAST_A_PLATE,
        2e-5,
        "past a plate",
    );
    assert_closed(&room, 5e-4);
}

#[test]
fn two_rooms_with_a_wall_between_them_exchange_nothing() {
    let mut scene = quads(&[]);
    let rooms = [
        [DVec3::ZERO, dvec3(1.0, 1.0, 1.0)],
        [dvec3(1.0, 0.0, 0.0), dvec3(2.5, 1.0, 1.0)],
    ];
    for room in rooms {
        crate::common::shapes::add_cuboid(&mut scene, 0, room, true);
    }
    let apart = matrix(&scene);
    for i in 0..6 {
        for j in 6..12 {
            // Surfaces touch up to 1e-7 of the scene: a gap of that width is left along the edges of the wall.
            assert!(apart.factor(i, j) < 1e-7, "{i} {j}: {}", apart.factor(i, j));
            assert!(apart.factor(j, i) < 1e-7, "{j} {i}: {}", apart.factor(j, i));
        }
    }
    assert_closed(&apart, 1e-6);
}

/// A venetian blind of 90 slats half-way between two squares: more than is cut out.
fn slats() -> Vec<Rect> {
    let slat = |k: u32| {
        [
            dvec3(f64::from(k) / 90.0, 0.0, 0.45),
            dvec3(0.006, 0.0, 0.006),
            DVec3::Y,
        ]
    };
    (0..90).map(slat).collect()
}

/// The blind between squares of so many strips, each along all of it.
fn past_a_blind(strips: u32) -> Scene {
    let strip = |[at, u, v]: Rect, along: DVec3, k: u32| {
        let at = at + along * (f64::from(k) / f64::from(strips));
        let thin = |side: DVec3| {
            if side == along {
                side / f64::from(strips)
            } else {
                side
            }
        };
        corners([at, thin(u), thin(v)])
    };
    let squares = [BELOW, ABOVE].into_iter();
    let mut list: Vec<_> = squares
        .flat_map(|square| (0..strips).map(move |k| strip(square, DVec3::Y, k)))
        .collect();
    list.extend(slats().iter().map(|slat| corners(*slat)));
    quads(&list)
}

#[test]
fn rays_take_over_where_there_is_too_much_to_cut() {
    let blinds = matrix(&past_a_blind(1));
    assert!(blinds.certificate.pairs.rays > 0);
    let found = blinds.factor(0, 1);
    let error = blinds.certificate.row_errors[0];
    close(
        found,
        by_segments(BELOW, ABOVE, &slats(), 30),
        3e-3 + 3.0 * error,
        "past a blind",
    );
}

/// Engines see the same segments, of which single precision answers a few in a million otherwise; a pair has 4,096 to 32,768 of them.
const ENGINES_DIFFER: f64 = 1e-3;

#[test]
fn where_rays_are_traced_the_engines_agree_pair_by_pair() {
    let scene = past_a_blind(4);
    // Embree where it was built in, then the others.
    let engines = [ENGINE, EngineChoice::Obvhs, EngineChoice::BruteForce];
    let matrices = engines.map(|engine| {
        let options = Options {
            engine,
            tolerance: 3e-3,
            ..portable()
        };
        matrix_with(&scene, &options)
    });
    let first = &matrices[0];
    assert!(
        first.certificate.pairs.rays > 50_000,
        "{:?}",
        first.certificate.pairs
    );
    assert!(first.certificate.pairs.sampled + first.certificate.pairs.limited >= 16);
    for other in &matrices[1..] {
        for i in 0..first.len() {
            for (a, b) in first.row(i).iter().zip(other.row(i)) {
                let bound = ENGINES_DIFFER * a.max(*b);
                assert!((a - b).abs() <= bound, "row {i}: {a} {b}");
            }
        }
    }
}
