//! What a matrix is for: radiosity, closure, heat.

use crate::common::shapes::{add_cuboid, add_grey, empty};
use crate::setup::{close, hanging_block, matrix, matrix_with, portable, quads};
use glam::{DVec3, dvec3};
use radiosity::matrix::{By, EnforceError, Options};
use radiosity::radiometry::Power;
use radiosity::scene::{NamedScene, Scene};
use radiosity::solver::{Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, solve};

/// Radiosities of a cube of which one face emits 1, one zone a face: ρ, emitter, opposite, side.
const CUBE: [[f64; 4]; 3] = [
    [
        0.2,
        1.0096153859782608,
        0.04804454459544677,
        0.04808501735657318,
    ],
    [
        0.5,
        1.090909098107695,
        0.18174582610778847,
        0.181836268946129,
    ],
    [
        0.8,
        1.5517241536449151,
        0.6895510707376379,
        0.689681193904362,
    ],
];

#[test]
fn a_cube_with_one_bright_face_has_the_radiosities_of_its_six_equations() {
    let mut scene = quads(&[]);
    add_cuboid(&mut scene, 0, [DVec3::ZERO, DVec3::ONE], true);
    let cube = matrix(&scene);
    for [rho, emitter, opposite, side] in CUBE {
        let mut exitance = vec![Power::ZERO; 6];
        exitance[0] = Power::ONE;
        let balances = cube.balance_of(&[Power::splat(rho); 6], &exitance);
        for (i, balance) in balances.iter().enumerate() {
            let expected = [emitter, opposite, side][i.min(2)];
            close(balance.radiosity.x, expected, 1e-6, "radiosity");
        }
        let net: f64 = balances.iter().map(|b| b.net_flux.x).sum();
        close(net, 0.0, 1e-6, "nothing leaves a closed cube");
    }
}

#[test]
fn in_a_furnace_everything_shines_alike_even_where_almost_all_is_reflected() {
    let scene = hanging_block();
    let room = matrix_with(
        &scene,
        &Options {
            max_area: Some(0.2),
            ..portable()
        },
    );
    for rho in [0.5, 0.999] {
        let n = room.len();
        let balances = room.balance_of(&vec![Power::splat(rho); n], &vec![Power::ONE; n]);
        for balance in &balances {
            // M / (1 - ρ), to the accuracy of the row sums times the number of reflections.
            let bright = 1.0 / (1.0 - rho);
            close(
                balance.radiosity.x / bright,
                1.0,
                5e-4 / (1.0 - rho),
                "furnace",
            );
        }
    }
}

#[test]
fn closure_is_enforced_by_a_small_change_that_keeps_reciprocity() {
    let mut scene = quads(&[]);
    add_cuboid(&mut scene, 0, [DVec3::ZERO, dvec3(1.0, 2.0, 3.0)], true);
    let mut room = matrix_with(
        &scene,
        &Options {
            max_area: Some(0.8),
            ..portable()
        },
    );
    let before = room.clone();
    let correction = room.enforce_closure().expect("a closed room");
    assert!(
        correction.residual < 1e-12 && correction.largest < 1e-5,
        "{correction:?}"
    );
    for i in 0..room.len() {
        for j in 0..room.len() {
            let [to, from] = [
                room.factor(i, j) * room.rows[i].area,
                room.factor(j, i) * room.rows[j].area,
            ];
            assert!((to - from).abs() <= 1e-14 * to.max(from));
            let change = (room.factor(i, j) - before.factor(i, j)).abs();
            assert!(change <= correction.largest + f64::EPSILON);
            assert_eq!(room.factor(i, j) == 0.0, before.factor(i, j) == 0.0);
        }
    }
    assert!(room.enforce_reciprocity().largest <= 1e-16);
}

#[test]
fn closure_is_refused_where_light_escapes() {
    let floor = [DVec3::ZERO, DVec3::X, dvec3(1.0, 1.0, 0.0), DVec3::Y];
    let mut open = matrix(&quads(&[floor]));
    let EnforceError::Open { label, sum } = open.enforce_closure().expect_err("an open scene");
    assert_eq!((label.as_str(), sum), ("1", 0.0));
}

/// A lit room with a block in its air: emitter in the ceiling, materials of different reflectance.
fn lit_room() -> Scene {
    let mut scene = empty();
    let walls = add_grey(&mut scene, 0.6, 0.0);
    let block = add_grey(&mut scene, 0.3, 0.0);
    let light = add_grey(&mut scene, 0.2, 1.0);
    add_cuboid(&mut scene, walls, [DVec3::ZERO, DVec3::ONE], true);
    add_cuboid(
        &mut scene,
        block,
        [dvec3(0.3, 0.2, 0.3), dvec3(0.6, 0.5, 0.7)],
        false,
    );
    // The ceiling, at y = 1, shines.
    for surface in &mut scene.surfaces {
        let mut corners = surface.corners.places(&scene.vertices);
        if corners.all(|corner| corner.y == 1.0) {
            surface.material = light;
        }
    }
    scene
}

#[test]
fn the_matrix_and_the_progressive_solver_agree() {
    let scene = lit_room();
    let zones = matrix_with(
        &scene,
        &Options {
            max_area: Some(0.01),
            tolerance: 1e-3,
            ..portable()
        },
    );
    let balances = zones.balance();
    let mut absorbed = 0.0;
    let mut emitted = 0.0;
    for (row, balance) in zones.rows.iter().zip(&balances) {
        absorbed += (1.0 - row.reflectance.x) * balance.irradiance.x * row.area;
        emitted += row.exitance.x * row.area;
    }
    close(
        absorbed / emitted,
        1.0,
        1e-3,
        "all that is emitted is absorbed",
    );

    let settings = Settings {
        options: Preset::Standard.options(),
        engine: EngineChoice::Obvhs,
        ..Settings::default()
    };
    let solution = solve(&scene, &settings, &mut Silent).expect("can be solved");
    // Power received by each surface: the mean irradiance of its zones, against the solver's integral over its mesh.
    let mesh = &solution.mesh;
    let scale = mesh.frame.scale();
    for polygon in 0..scene.input_polygons {
        let of = format!("{}/", polygon + 1);
        let of_zones = zones
            .rows
            .iter()
            .zip(&balances)
            .filter(|(row, _)| row.label.starts_with(&of));
        let by_matrix: f64 = of_zones.map(|(row, b)| b.irradiance.x * row.area).sum();
        let on_it =
            |v: usize| mesh.patch(mesh.vertices.patch_of(v as u32)).polygon as usize == polygon;
        let by_solver: f64 = (0..mesh.vertices.len())
            .filter(|v| on_it(*v))
            .map(|v| mesh.weights[v] * f64::from(solution.light.irradiance[v].x))
            .sum::<f64>()
            / (scale * scale);
        // Zones of 0.1 by 0.1 in a room of 1 and the preset's mesh: each is off by a per cent or so.
        let size = by_matrix.max(by_solver).max(0.01);
        assert!(
            (by_matrix - by_solver).abs() <= 0.02 * size,
            "surface {}: {by_matrix} {by_solver}",
            polygon + 1
        );
    }
}

#[test]
fn rows_can_be_materials() {
    let named = NamedScene::from(lit_room());
    let by = |by| matrix_with(&named.scene, &Options { by, ..portable() });
    let (materials, surfaces) = (by(By::Material), by(By::Surface));
    assert_eq!(
        materials
            .rows
            .iter()
            .map(|r| r.label.as_str())
            .collect::<Vec<_>>(),
        ["grey0", "grey2", "grey1"]
    );
    // Flux between groups is the sum over their members.
    let light = surfaces
        .rows
        .iter()
        .position(|row| row.exitance.x > 0.0)
        .expect("there is a light");
    let walls: f64 = (0..6)
        .filter(|j| *j != light)
        .map(|j| surfaces.factor(light, j))
        .sum();
    let at = |label: &str| materials.index(label).expect("is a row");
    close(
        materials.factor(at("grey2"), at("grey0")),
        walls,
        1e-3,
        "light to walls",
    );
    assert!(
        materials.factor(at("grey0"), at("grey0")) > 0.3,
        "walls see each other"
    );
}
