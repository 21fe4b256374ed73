//! Surfaces that come closer to others than elements can resolve are split along the rims of these.

use super::setup::{Polygons, UNIT, cuboid, floor, footprint, pieces_down_to, sphere};
use glam::{DQuat, DVec3, Vec3};
use radiosity::geometry::polygon::{diameter, vector_area};
use radiosity::scene::{Material, Scene};
use radiosity::solution::{Prober, Solution};
use radiosity::solver::{Options, Preset, Silent};
use radiosity::{Settings, solve};

/// The least size of elements, of a floor of four metres: gaps up to two millimetres are thin against these eight.
const SMALLEST: f64 = 0.002;

/// A floor of two triangles.
fn halves(size: f64) -> Polygons {
    let [a, b, c, d] = floor(size).0[0][..] else {
        panic!("a quad")
    };
    Polygons::default().with(&[a, b, c]).with(&[a, c, d])
}

#[test]
fn no_element_of_a_floor_crosses_the_outline_of_a_box_that_hovers_close_above_it() {
    for (floor, open, angle) in [
        (floor(4.0), false, 0.0),
        (floor(4.0), true, 0.4),
        (halves(4.0), false, 0.4),
    ] {
        for gap in [2e-5, 4e-4, 1.9e-3] {
            let mut solid = cuboid(DVec3::ONE);
            if open {
                solid.0.remove(2);
            }
            let turn = DQuat::from_rotation_y(angle);
            let scene = floor
                .clone()
                .and(&solid, turn, DVec3::Y * (0.5 + gap))
                .scene(true);
            let found = pieces_down_to(&scene, SMALLEST);
            for side in footprint(UNIT) {
                found.assert_split_along(&scene, 0, side.map(|p| turn * p), 1e-4);
            }
            let count = found.of[0].len();
            assert!((5..=12).contains(&count), "{count} pieces");
            assert!(found.of[1..].iter().all(|of| of.len() <= 1));
        }
    }
}

#[test]
fn a_gap_that_is_high_against_elements_is_not_split() {
    let hovering =
        |gap| floor(4.0).and(&cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::Y * (0.5 + gap));
    pieces_down_to(&hovering(2.1e-3).scene(true), SMALLEST).assert_whole();
    pieces_down_to(&hovering(4e-4).scene(true), SMALLEST / 8.0).assert_whole();
}

#[test]
fn what_is_behind_a_floor_does_not_split_it() {
    let below = DVec3::Y * (-0.5 - 4e-4);
    let scene = floor(4.0).and(&cuboid(DVec3::ONE), DQuat::IDENTITY, below);
    pieces_down_to(&scene.scene(true), SMALLEST).assert_whole();
}

#[test]
fn a_parallel_sheet_splits_along_its_outline_alone() {
    // A carpet of thirty-two triangles.
    let mut carpet = Polygons::default();
    for i in 0..16 {
        let at = |i: i32| 0.25 * f64::from(i) - 0.375;
        let by = DVec3::new(at(i % 4), 0.0, at(i / 4));
        carpet = carpet.and(&halves(0.25), DQuat::IDENTITY, by);
    }
    // Its vertices are on one another, whether or not they are one.
    for welded in [false, true] {
        let turn = DQuat::from_rotation_y(0.3);
        let scene = floor(4.0).and(&carpet, turn, DVec3::Y * 5e-4).scene(welded);
        let found = pieces_down_to(&scene, SMALLEST);
        for side in footprint(UNIT) {
            found.assert_split_along(&scene, 0, side.map(|p| turn * p), 1e-4);
        }
        let few = found.of[0].len();
        assert!(few <= 12, "{few}");
    }
}

#[test]
fn a_floor_is_cut_along_the_rims_of_any_number_of_tiles() {
    let across = 30;
    let mut tiles = Polygons::default();
    for i in 0..across * across {
        let at = |i: i32| 0.1 * f64::from(i) - 1.5;
        let by = DVec3::new(at(i % across), 5e-4, at(i / across));
        tiles = tiles.and(&floor(0.06), DQuat::IDENTITY, by);
    }
    let scene = floor(4.0)
        .and(&tiles, DQuat::from_rotation_y(0.3), DVec3::ZERO)
        .scene(true);
    let found = pieces_down_to(&scene, SMALLEST);
    assert_eq!(found.mesh.uncut_gaps, 0);
    let is_below_one = |piece: &&Vec<DVec3>| vector_area(piece).length() < 1.01 * 0.06 * 0.06;
    let below = found.of[0].iter().filter(is_below_one).count();
    assert!(below >= 900, "{below} of 900 tiles");
}

#[test]
fn a_ball_close_above_a_floor_has_no_rim() {
    let ball = sphere(0.5, 24);
    for gap in [2e-5, 4e-4] {
        let above = floor(4.0).and(&ball, DQuat::IDENTITY, DVec3::Y * (0.5 + gap));
        let found = pieces_down_to(&above.scene(true), SMALLEST);
        assert_eq!(found.of[0].len(), 1);
    }
}

#[test]
fn a_board_on_edge_splits_along_the_edge() {
    for angle in [0.05, 0.5, 1.2] {
        let turn = DQuat::from_rotation_z(angle);
        // The left edge of its bottom is the lowest.
        let lowest = turn * DVec3::new(-0.5, -0.05, 0.0);
        let by = DVec3::new(0.0, 5e-4 - lowest.y, 0.0);
        let scene = floor(4.0)
            .and(&cuboid(DVec3::new(1.0, 0.1, 1.0)), turn, by)
            .scene(true);
        let found = pieces_down_to(&scene, SMALLEST);
        let [a, b] = [-0.5, 0.5].map(|z| DVec3::new(lowest.x, 0.0, z));
        found.assert_split_along(&scene, 0, [a, b], 1e-4);
        let few = found.of[0].len();
        assert!(few <= 10, "{few}");
    }
}

/// The width of the thinnest piece of the floor.
fn thinnest(scene: &Scene) -> f64 {
    let found = pieces_down_to(scene, SMALLEST);
    assert_eq!(found.mesh.unsplit_contacts, 0);
    let width = |piece: &Vec<DVec3>| vector_area(piece).length() / diameter(piece);
    found.of[0].iter().map(width).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_rim_beside_a_line_of_contact_is_bent_onto_it() {
    // One box stands on the floor, another hovers beside it.
    let [standing, hovering] =
        [DVec3::ONE, DVec3::new(0.7, 1.0, 0.6)].map(|size| (cuboid(size), size));
    for apart in [0.0, 1e-4, 2e-4] {
        for angle in [0.0, 5e-4] {
            let by = DVec3::new(0.85 + apart, 0.5 + 4e-4, 0.0);
            let scene = floor(4.0)
                .and(&standing.0, DQuat::IDENTITY, DVec3::Y * 0.5)
                .and(&hovering.0, DQuat::from_rotation_y(angle), by)
                .scene(true);
            let width = thinnest(&scene);
            assert!(width > 0.02, "a piece {width} wide");
            let found = pieces_down_to(&scene, SMALLEST);
            for side in footprint(UNIT) {
                found.assert_split_along(&scene, 0, side, 1e-4);
            }
        }
    }
}

#[test]
fn boxes_at_random_close_above_a_floor_leave_hardly_a_needle() {
    let has_needle = |seed: &u64| {
        let mut random = fastrand::Rng::with_seed(*seed);
        let mut scene = floor(4.0);
        for _ in 0..4 {
            let size = DVec3::new(random.f64() + 0.1, 0.5, random.f64() + 0.1);
            let gap = 2.2e-3 * random.f64();
            let turn = DQuat::from_rotation_y(random.f64() * std::f64::consts::TAU);
            let at = DVec3::new(2.0 * random.f64() - 1.0, 0.25 + gap, random.f64() - 0.5);
            scene = scene.and(&cuboid(size), turn, at);
        }
        // Half as wide as the highest gap.
        thinnest(&scene.scene(true)) < 1e-3
    };
    // Where rims cross beside the end of one.
    let needles = (0..100).filter(has_needle).count();
    assert!(needles <= 5, "{needles}");
}

/// Polygons with a light over them that shines down, solved as a draft.
fn lit(below: Polygons, [x, z]: [f64; 2], side: f64) -> Solution {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let light = corners.map(|(a, b)| DVec3::new(x + side * a, 3.0, z + side * b));
    let mut scene = below.with(&light).scene(true);
    scene.materials.push(Material {
        name: "light".into(),
        reflectance: Vec3::ZERO,
        emitted_radiance: Vec3::ONE,
    });
    let last = scene.surfaces.len() - 1;
    scene.surfaces[last].material = 1;
    let options = Options {
        audit_points: 0,
        ..Preset::Draft.options()
    };
    let settings = Settings {
        options,
        ..Settings::default()
    };
    solve(&scene, &settings, &mut Silent).expect("it can be solved")
}

#[test]
fn a_floor_with_tiles_close_above_it_absorbs_what_a_plane_does() {
    let tile = floor(0.8);
    let at = |i: i32| DVec3::new(f64::from(i % 8) - 3.5, 1e-3, f64::from(i / 8) - 3.5);
    let tiled = (0..64).fold(floor(8.0), |all, i| all.and(&tile, DQuat::IDENTITY, at(i)));
    let power = lit(tiled, [0.0, 0.0], 0.2).report.power;
    // Of a small light at the middle of a square, facing it, four times the form factor of a corner (Howell, C-14).
    let leg = 4.0 / 3.0;
    let slant = (1.0f64 + leg * leg).sqrt();
    let factor = 4.0 / std::f64::consts::PI * (leg / slant) * (leg / slant).atan();
    let share = power.absorbed / (0.5 * factor * power.emitted);
    assert!((share - 1.0).abs() < 0.02, "{share}");
}

#[test]
fn beside_a_hovering_box_it_is_as_bright_as_beside_one_that_stands() {
    for turn in [0.0, 0.4].map(DQuat::from_rotation_y) {
        let above = |gap| floor(4.0).and(&cuboid(DVec3::ONE), turn, DVec3::Y * (0.5 + gap));
        let [standing, hovering] = [0.0, 4e-4].map(|gap| lit(above(gap), [0.3, 0.9], 1.0));
        let [standing, hovering] = [&standing, &hovering].map(Prober::new);
        let off = |at: DVec3, normal: DVec3| {
            let [there, here] = [&standing, &hovering].map(|prober| {
                let probe = prober.probe(turn * at, turn * normal);
                f64::from(probe.expect("on a surface").irradiance.x)
            });
            (here / there - 1.0).abs()
        };
        // Along the side that the light reaches: on the floor, a millimetre from the box, and on the box, three from its edge.
        let places = (0..41).map(|step| f64::from(step) / 42.0 - 0.476);
        let floor = places
            .clone()
            .map(|x| off(DVec3::new(x, 0.0, 0.501), DVec3::Y));
        let side = places.map(|x| off(DVec3::new(x, 0.003, 0.5), DVec3::Z));
        let worst = floor.chain(side).fold(0.0, f64::max);
        // What light there is enters the gap instead of meeting the box, less than a hundredth; the rest is that of two draft meshes.
        assert!(worst < 0.1, "{worst}");
    }
}

/// How far from the lines where `depth` is 0 light is evaluated for the vertices on them, at least, of patches that face a way at a height; and
/// how many vertices these are.
fn least_clearance(
    scene: &Scene,
    (height, facing): (f64, DVec3),
    depth: impl Fn(DVec3) -> f64,
) -> (f64, usize) {
    let mesh = pieces_down_to(scene, SMALLEST).mesh;
    let clearance = |vertex: u32| {
        let places = [mesh.position(vertex), mesh.point(vertex)];
        let [at, from] = places.map(|p| mesh.frame.leave(p));
        let patch = mesh.patch(mesh.vertices.patch_of(vertex));
        let is_on_it = (at.y - height).abs() < 1e-5 && patch.normal.dot(facing) > 0.9;
        (is_on_it && depth(at).abs() < 1e-5).then(|| depth(from).abs())
    };
    let vertices = 0..mesh.vertices.len() as u32;
    let clearances: Vec<f64> = vertices.filter_map(clearance).collect();
    let count = clearances.len();
    (clearances.into_iter().fold(f64::INFINITY, f64::min), count)
}

#[test]
fn beside_a_rim_light_is_evaluated_where_the_gap_is_hardly_seen() {
    let gap = 4e-4;
    let hovering = floor(4.0).and(&cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::Y * (0.5 + gap));
    let dark = hovering.scene(true);
    let from_rim = |p: DVec3| p.x.abs().max(p.z.abs()) - 0.5;
    // On the floor, and on the side of the box above it.
    for (place, least) in [((0.0, DVec3::Y), 8), ((gap, DVec3::NEG_Y), 4)] {
        let (clearance, beside) = least_clearance(&dark, place, from_rim);
        assert!(clearance >= 1.9 * gap, "{clearance}");
        assert!(beside >= least, "{beside}");
    }
    // What shines lights all up to its rim.
    let mut bright = dark;
    for surface in &mut bright.surfaces[1..] {
        surface.material = 1;
    }
    let shining = Material {
        emitted_radiance: Vec3::ONE,
        ..bright.materials[0].clone()
    };
    bright.materials.push(shining);
    let (clearance, beside) = least_clearance(&bright, (0.0, DVec3::Y), from_rim);
    assert!(clearance < 1.5 * gap, "{clearance}");
    assert!(beside >= 8, "{beside}");
}

#[test]
fn beside_a_low_step_light_is_evaluated_where_it_hardly_hides_anything() {
    let step = 4e-4;
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let higher = [(2.0, 2.0), (4.0, 2.0), (4.0, -2.0), (2.0, -2.0)];
    let rise = [(0.0, 2.0), (step, 2.0), (step, -2.0), (0.0, -2.0)];
    let scene = floor(4.0)
        .with(&higher.map(|(x, z)| at(x, step, z)))
        .with(&rise.map(|(y, z)| at(2.0, y, z)));
    let (clearance, beside) = least_clearance(&scene.scene(true), (0.0, DVec3::Y), |p| p.x - 2.0);
    assert!(clearance >= 1.9 * step, "{clearance}");
    assert!(beside >= 2, "{beside}");
}

#[test]
fn a_gap_is_dark_many_times_as_far_in_as_it_is_high() {
    let gap = 4e-4;
    let hovering = floor(4.0).and(&cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::Y * (0.5 + gap));
    let solution = lit(hovering, [0.3, 0.9], 1.0);
    let prober = Prober::new(&solution);
    let irradiance = |at: DVec3, normal: DVec3| {
        let probe = prober.probe(at, normal).expect("on a surface");
        f64::from(probe.irradiance.x)
    };
    for step in 0..41 {
        let x = f64::from(step) / 42.0 - 0.476;
        let open = irradiance(DVec3::new(x, 0.0, 0.52), DVec3::Y);
        let floor = irradiance(DVec3::new(x, 0.0, 0.48), DVec3::Y);
        let above = irradiance(DVec3::new(x, gap, 0.48), DVec3::NEG_Y);
        let most = floor.max(above) / open;
        assert!(most < 0.06, "{most} of what is open at {x}");
    }
}
