//! All patches shooting at once, as clusters: what a scene of many small polygons is solved with, tried where the answer is known.

use super::common::reference::{Deviation, table};
use super::common::shapes::{add_cuboid, add_grey, add_level, add_quad, add_triangle, empty};
use super::resume::{in_sessions, settings};
use super::{bits, bundled, draft, engines, solved, solved_by};
use glam::DVec3;
use radiosity::geometry::polygon::diameter;
use radiosity::scene::{Scene, Sides};
use radiosity::solution::Solution;
use radiosity::solver::{Options, Preset};
use radiosity::visibility::EngineChoice;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Clusters however few patches there are.
pub(super) fn clustered(options: Options) -> Options {
    Options {
        cluster_from: 0,
        ..options
    }
}

#[test]
fn the_cornell_box_comes_out_as_path_traced() {
    let scene = bundled("cornell-box");
    let solution = solved(&scene, clustered(Preset::Standard.options()));
    let found = Deviation::of(&solution, &table("cornell_irradiance.csv"));
    // Shot patch by patch it is 0.5 % and 0.2 %; a cluster is seen or hidden as a whole.
    assert!(found.n_rms <= 0.02 && found.bias.abs() <= 0.01, "{found:?}");
    let sent = solution.report.audit.and_then(|audit| audit.sent_sum);
    let sent = sent.expect("light was gathered at the end");
    assert!((sent.mean - 1.0).abs() < 0.005, "{sent:?}");
}

#[test]
fn in_a_furnace_everything_shines_alike() {
    let options = Options {
        tolerance: 1e-5,
        ..clustered(Preset::Standard.options())
    };
    for engine in engines() {
        let solution = solved_by(&super::furnace::cuboid(), options.clone(), engine, 0);
        let error = super::furnace::error(&solution);
        assert!(error < 0.02, "{engine}: off by {error}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = bundled("cornell-box");
    for engine in engines() {
        let on = |threads| {
            let mut solution = solved_by(&scene, clustered(draft()), engine, threads);
            solution.report.threads = 0;
            bits(solution)
        };
        let alone = on(1);
        assert!(on(2) == alone && on(7) == alone, "{engine}");
    }
}

#[test]
fn a_solve_in_sessions_ends_with_the_same_bits() {
    let scene = ball_in_a_room();
    let how = settings(clustered(draft()), EngineChoice::Obvhs, 1);
    let whole = bits(solved_by(
        &scene,
        clustered(draft()),
        EngineChoice::Obvhs,
        1,
    ));
    let (solution, sessions) = in_sessions(&scene, &how, 1);
    assert!(sessions > 10, "{sessions}");
    assert!(bits(solution) == whole);
}

/// A ball of 48 by 24 facets above the middle of a floor, under a light; its vertices are shared as in a file.
fn ball_in_a_room() -> Scene {
    let mut scene = empty();
    let white = add_grey(&mut scene, 0.7, 0.0);
    let light = add_grey(&mut scene, 0.0, 10.0);
    let level = |y: f64, half: f64, up: bool| {
        let corners = [[-half, half], [half, half], [half, -half], [-half, -half]];
        let mut corners = corners.map(|[x, z]| DVec3::new(x, y, z));
        if !up {
            corners.reverse();
        }
        corners
    };
    add_quad(&mut scene, white, level(0.0, 2.0, true));
    add_quad(&mut scene, light, level(3.0, 0.5, false));
    let (around, down) = (48, 24);
    let at = |u: usize, v: usize| {
        let (a, b) = (
            TAU * (u % around) as f64 / around as f64,
            PI * v as f64 / down as f64,
        );
        DVec3::new(0.0, 1.2, 0.0) + 0.6 * DVec3::new(b.sin() * a.cos(), b.cos(), b.sin() * a.sin())
    };
    for (u, v) in (0..around).flat_map(|u| (0..down).map(move |v| (u, v))) {
        let [a, b, c, d] = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
        if v > 0 {
            add_triangle(&mut scene, white, [a, b, c]);
        }
        if v + 1 < down {
            add_triangle(&mut scene, white, [a, c, d]);
        }
    }
    scene
}

#[test]
fn the_inside_of_a_thin_box_stays_dark() {
    let mut scene = super::furnace::cuboid();
    let grey = add_grey(&mut scene, 0.8, 0.0);
    let (low, high) = (DVec3::new(0.6, 0.4, 0.5), DVec3::new(1.3, 0.9, 0.52));
    let first = scene.surfaces.len();
    add_cuboid(&mut scene, grey, [low, high], false);
    for surface in &mut scene.surfaces[first..] {
        surface.sides = Sides::Both;
    }
    let solution = solved(&scene, clustered(draft()));
    let mesh = &solution.mesh;
    let mut outside: f32 = 0.0;
    for (number, irradiance) in (0..).zip(&solution.light.irradiance) {
        let patch = mesh.patch(mesh.vertices.patch_of(number));
        if patch.surface as usize >= first && patch.back {
            assert_eq!(
                irradiance.x,
                0.0,
                "inside, at {:?}",
                mesh.frame.leave(mesh.point(number))
            );
        } else {
            outside = outside.max(irradiance.x);
        }
    }
    assert!(outside > 0.0);
}

/// A room with a ceiling let in: its walls go on above, in the dark.
#[test]
fn no_light_comes_past_a_ceiling_along_the_walls() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.8, 0.0);
    let (low, high, height) = (DVec3::ZERO, DVec3::new(2.0, 1.0, 1.5), 0.91);
    add_cuboid(&mut scene, grey, [low, high], true);
    let level = [[low.x, low.z], [high.x, high.z]];
    add_level(&mut scene, grey, level, height, false);
    scene.surfaces.last_mut().expect("the ceiling").sides = Sides::Both;
    let light = add_grey(&mut scene, 0.0, 1.0);
    let middle = 0.5 * (low + high);
    let [near, far] = [-0.1, 0.1].map(|d| [middle.x + d, middle.z + d]);
    add_level(&mut scene, light, [near, far], 0.6, false);
    let solution = solved(&scene, clustered(draft()));
    let mesh = &solution.mesh;
    let (mut above, mut below): (f32, f32) = (0.0, 0.0);
    for (number, irradiance) in (0..).zip(&solution.light.irradiance) {
        let (point, normal) = mesh.receiver(number);
        let is_above = mesh.frame.leave(point + 1e-6 * normal).y > height;
        let most = if is_above { &mut above } else { &mut below };
        *most = most.max(irradiance.x);
    }
    assert!(above == 0.0 && below > 0.03, "{above} above, {below} below");
}

/// Irradiance at the vertices of patches that are no floor and no light, by the bits of the place and the side.
fn by_place(solution: &Solution) -> BTreeMap<([u64; 3], bool), Vec<f32>> {
    let mesh = &solution.mesh;
    let mut found: BTreeMap<_, Vec<f32>> = BTreeMap::new();
    for (vertex, patch) in mesh.vertices.patches().enumerate() {
        let patch = mesh.patch(patch);
        let corner = patch
            .corners()
            .iter()
            .find(|c| **c == mesh.position(vertex as u32));
        let is_facet = diameter(patch.corners()) < 0.1 * mesh.frame.extent();
        if let Some(corner) = corner.filter(|_| is_facet) {
            let key = (corner.to_array().map(f64::to_bits), patch.back);
            found
                .entry(key)
                .or_default()
                .push(solution.light.irradiance[vertex].x);
        }
    }
    found
}

#[test]
fn a_ball_of_facets_is_smooth() {
    let solution = solved(&ball_in_a_room(), clustered(draft()));
    let places = by_place(&solution);
    assert!(places.len() > 1000, "{}", places.len());
    for (place, values) in &places {
        assert!(
            values.iter().all(|e| *e == values[0]),
            "{place:?}: {values:?}"
        );
    }
}
