//! Boxes, beams, partitions, legs and spheres.

use super::setup::{Pieces, Polygons, UNIT, corners, cuboid, floor, footprint, pieces, sphere};
use glam::{DQuat, DVec3};
use radiosity::scene::{Scene, Sides};

fn assert_footprint(pieces: &Pieces, scene: &Scene) {
    for side in footprint(UNIT) {
        pieces.assert_split_along(scene, 0, side, 1e-4);
    }
}

#[test]
fn a_box_resting_on_a_floor_dipping_into_it_or_without_a_bottom() {
    let unit = cuboid(DVec3::ONE);
    let mut open = unit.clone();
    open.0.remove(2);
    for (solid, height) in [(&unit, 0.5), (&unit, 0.3), (&open, 0.5), (&open, 0.3)] {
        let scene = floor(4.0)
            .and(solid, DQuat::IDENTITY, DVec3::Y * height)
            .scene(false);
        let found = pieces(&scene);
        assert_footprint(&found, &scene);
        // Four trapezoids around the footprint, and the footprint.
        assert_eq!(found.of[0].len(), 5);
        let dipping = height < 0.5;
        assert!(
            found.of[1..]
                .iter()
                .all(|of| of.len() == 1 || dipping && of.len() == 2)
        );
        assert_eq!(found.of[1].len(), if dipping { 2 } else { 1 });
    }
}

#[test]
fn size_and_place_of_the_scene_do_not_matter() {
    let scene = floor(4.0).and(
        &cuboid(DVec3::ONE),
        DQuat::from_rotation_y(0.4),
        DVec3::new(0.2, 0.4, 0.1),
    );
    let count = |scale: f64, by: DVec3| {
        let scene = scene.mapped(scale, by * scale).scene(false);
        let found = pieces(&scene);
        found.assert_split_along_crossings(&scene, 1e-4 * scale);
        found.of.iter().map(Vec::len).collect::<Vec<_>>()
    };
    let here = count(1.0, DVec3::ZERO);
    for (scale, by) in [
        (1e-6, DVec3::ZERO),
        (1e6, DVec3::ZERO),
        (1.0, DVec3::splat(1e4)),
        (1e6, DVec3::splat(-300.0)),
    ] {
        assert_eq!(count(scale, by), here, "{scale} {by}");
    }
}

#[test]
fn a_beam_that_dips_at_an_angle() {
    let beam = cuboid(DVec3::new(3.0, 0.1, 0.1));
    for angle in [0.05, 0.26, 1.0] {
        let scene = floor(4.0)
            .and(
                &beam,
                DQuat::from_rotation_z(angle),
                DVec3::new(0.1, 0.05, 0.0),
            )
            .scene(false);
        let found = pieces(&scene);
        found.assert_split_along_crossings(&scene, 1e-4);
        assert!(found.of[0].len() > 1);
        assert!(found.of.iter().map(Vec::len).sum::<usize>() < 50);
    }
}

#[test]
fn a_partition_that_stands_on_a_floor() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.3);
    let wall = [at(-1.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(-1.0, 1.0)];
    let mut scene = floor(4.0).with(&wall).scene(false);
    scene.surfaces[1].sides = Sides::Both;
    let found = pieces(&scene);
    found.assert_split_along(&scene, 0, [wall[0], wall[1]], 1e-4);
    assert_eq!(found.of[1].len(), 1);
    assert_eq!(found.mesh.patches.iter().filter(|p| p.back).count(), 1);
    assert!(found.of[0].len() <= 6, "{}", found.of[0].len());
}

#[test]
fn both_sides_of_a_partition_are_split_alike() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.3);
    let wall = [at(-1.0, -1.0), at(1.0, -0.5), at(1.0, 1.0), at(-1.0, 1.0)];
    let mut scene = floor(4.0).with(&wall).scene(false);
    scene.surfaces[1].sides = Sides::Both;
    let found = pieces(&scene);
    let sheets: Vec<_> = found
        .mesh
        .patches
        .iter()
        .filter(|p| p.surface == 1)
        .collect();
    let (backs, fronts): (Vec<_>, Vec<_>) = sheets.into_iter().partition(|p| p.back);
    assert!(fronts.len() > 1);
    for (front, back) in fronts.iter().zip(&backs) {
        let mut turned = back.corners().to_vec();
        turned.reverse();
        assert_eq!(turned, front.corners());
        let n = turned.len();
        // Side i of the front runs from corner i to the next; on the back that is side n - 2 - i.
        let same = (0..n).all(|i| front.outline[i] == back.outline[(2 * n - 2 - i) % n]);
        assert!(same && front.normal.dot(back.normal) < -0.999_999);
    }
}

#[test]
fn a_wall_of_many_triangles_cuts_like_one_of_few() {
    let steps = 200;
    let mut scene = floor(4.0);
    for i in 0..steps {
        let x = |i: i32| 3.0 * f64::from(i) / f64::from(steps) - 1.5;
        let at = |i: i32, y: f64| DVec3::new(x(i), y, 0.2 * x(i));
        scene = scene
            .with(&[at(i, 0.0), at(i + 1, 0.0), at(i + 1, 1.0)])
            .with(&[at(i, 0.0), at(i + 1, 1.0), at(i, 1.0)]);
    }
    let scene = scene.scene(true);
    let found = pieces(&scene);
    found.assert_split_along(
        &scene,
        0,
        [DVec3::new(-1.5, 0.0, -0.3), DVec3::new(1.5, 0.0, 0.3)],
        1e-4,
    );
    assert!(found.of[0].len() <= 8, "{}", found.of[0].len());
}

#[test]
fn sheets_in_one_plane_are_split_along_the_rim_of_their_overlap_only() {
    // A carpet of sixteen squares, turned against the floor it lies on.
    let mut carpet = Polygons::default();
    for i in 0..16 {
        let tile = floor(0.25);
        let by = DVec3::new(
            0.25 * f64::from(i % 4) - 0.375,
            0.0,
            0.25 * f64::from(i / 4) - 0.375,
        );
        carpet = carpet.and(&tile, DQuat::IDENTITY, by);
    }
    let turn = DQuat::from_rotation_y(0.3);
    let scene = floor(4.0).and(&carpet, turn, DVec3::ZERO).scene(false);
    let found = pieces(&scene);
    for side in footprint(UNIT) {
        found.assert_split_along(&scene, 0, side.map(|p| turn * p), 1e-4);
    }
    let welded = floor(4.0).and(&carpet, turn, DVec3::ZERO).scene(true);
    let few = pieces(&welded).of[0].len();
    assert!(few <= 12, "{few}");
    assert!(found.of[1..].iter().all(|of| of.len() == 1));
}

#[test]
fn spheres_that_interpenetrate() {
    let spheres = sphere(1.0, 10).and(
        &sphere(1.0, 9),
        DQuat::from_rotation_x(0.3),
        DVec3::new(0.9, 0.13, 0.07),
    );
    let scene = spheres.scene(true);
    let found = pieces(&scene);
    let cut =
        |range: std::ops::Range<usize>| found.of[range].iter().filter(|of| of.len() > 1).count();
    let first = sphere(1.0, 10).0.len();
    assert!(cut(0..first) > 10 && cut(first..found.of.len()) > 10);
    assert_eq!(found.mesh.unsplit_contacts, 0);
    found.assert_split_along_crossings(&scene, 1e-4);
}

#[test]
fn surfaces_that_meet_without_touching_borders_share_corners() {
    // The ends of the line of contact are corners of pieces of both.
    let scene = floor(4.0)
        .and(
            &cuboid(DVec3::ONE),
            DQuat::from_rotation_y(0.5),
            DVec3::Y * 0.2,
        )
        .scene(false);
    let found = pieces(&scene);
    let all = |surface: usize| found.of[surface].iter().flatten();
    for side in [1, 2, 5, 6] {
        let on_floor: Vec<_> = all(side).filter(|p| p.y.abs() < 1e-9).collect();
        assert!(on_floor.len() >= 2);
        assert!(
            on_floor
                .iter()
                .all(|p| all(0).any(|q| q.distance(**p) < 1e-9)),
            "{:?}",
            corners(&scene, side)
        );
    }
}

#[test]
fn too_many_lines_leave_a_surface_whole_and_are_counted() {
    let mut spikes = floor(4.0);
    for i in 0..100_200 {
        let at = DVec3::new(
            f64::from(i % 320) * 0.0122 - 1.95,
            0.0,
            f64::from(i / 320) * 0.0122 - 1.95,
        );
        let corners = [
            DVec3::new(0.0, 0.004, 0.0),
            DVec3::new(-0.004, -0.004, 0.0),
            DVec3::new(0.004, -0.004, 0.0),
        ];
        spikes.0.push(corners.map(|p| p + at).to_vec());
    }
    let found = pieces(&spikes.scene(false));
    assert_eq!((found.mesh.unsplit_contacts, found.of[0].len()), (1, 1));
    assert!(
        found.of[1..]
            .iter()
            .all(|of| of.len() == 2 || of.len() == 3)
    );
}

/// Triangles of the floor with an angle below 10 degrees that are longer than a fiftieth of the scene.
fn long_needles(found: &Pieces) -> usize {
    let frame = found.mesh.frame;
    let longest = 0.02 * frame.extent() / frame.scale();
    let is_needle = |piece: &&Vec<DVec3>| {
        let [a, b, c] = piece[..] else { return false };
        let angle = |at: DVec3, to: DVec3, or: DVec3| (to - at).angle_between(or - at);
        let least = angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b));
        least < 10_f64.to_radians() && a.distance(b).max(b.distance(c)).max(c.distance(a)) > longest
    };
    found.of[0].iter().filter(is_needle).count()
}

#[test]
fn posts_leave_hardly_a_needle_where_surfaces_are_many() {
    let post = cuboid(DVec3::new(0.01, 0.6, 0.01));
    let posts = (0..12).map(f64::from).fold(floor(4.0), |scene, i| {
        let turn = DQuat::from_rotation_y(0.2 * i);
        let place = turn * DVec3::new(0.1 + 0.05 * i, 0.3, 0.0);
        scene.and(&post, turn, place)
    });
    let ball = sphere(0.2, 24);
    assert!(ball.0.len() > 2000);
    let many = posts
        .clone()
        .and(&ball, DQuat::IDENTITY, DVec3::new(0.0, 1.0, 0.0));
    let [few, many] = [posts, many].map(|scene| long_needles(&pieces(&scene.scene(false))));
    assert!(few > 5 && many < 3, "{few} and {many}");
}
