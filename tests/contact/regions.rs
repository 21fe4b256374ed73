//! Triangles that continue one another in a plane are one surface.

use super::setup::{Pieces, Polygons, cuboid, pieces};
use glam::{DQuat, DVec3, Vec3};
use radiosity::geometry::polygon::vector_area;
use radiosity::scene::{Scene, Sides};

/// A floor of `count`² unit squares in the first quadrant, but those that `is_hole`, each cut into two triangles; facing up.
fn cut_floor(count: u32, is_hole: impl Fn(u32, u32) -> bool) -> Polygons {
    let at = |x: u32, y: u32| DVec3::new(f64::from(x), 0.0, -f64::from(y));
    let mut floor = Polygons::default();
    for (x, y) in (0..count).flat_map(|y| (0..count).map(move |x| (x, y))) {
        if !is_hole(x, y) {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            floor = floor.with(&[a, b, c]).with(&[a, c, d]);
        }
    }
    floor
}

fn whole_floor(count: u32) -> Polygons {
    cut_floor(count, |_, _| false)
}

/// How many of the surfaces are meshed by themselves.
fn meshed(found: &Pieces) -> usize {
    found.of.iter().filter(|of| !of.is_empty()).count()
}

fn patches(scene: &Scene) -> usize {
    pieces(scene).mesh.patches.len()
}

#[test]
fn a_floor_cut_into_triangles_is_one_square() {
    for turn in [
        DQuat::IDENTITY,
        DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.0, 2.0),
    ] {
        let floor = Polygons::default().and(&whole_floor(8), turn, DVec3::new(3.0, 1.0, 0.5));
        let found = pieces(&floor.scene(true));
        assert_eq!(found.mesh.patches.len(), 1);
        assert_eq!(found.mesh.patches.at(0).corners().len(), 4);
        assert_eq!(found.mesh.patches.at(0).outline, [true; 4]);
    }
}

#[test]
fn holes_stay_open() {
    let frame = cut_floor(6, |x, y| (2..4).contains(&x) && (1..3).contains(&y));
    let found = pieces(&frame.scene(true));
    assert_eq!(meshed(&found), 1);
    let middle = DVec3::new(3.0, 0.0, -2.0);
    for piece in &found.of[0] {
        let normal = vector_area(piece).normalize();
        assert!(
            super::setup::depth(piece, middle, normal) <= 0.0,
            "{piece:?}"
        );
    }
}

#[test]
fn a_box_on_the_cuts_splits_the_floor_along_its_footprint_alone() {
    let on = DVec3::new(4.0, 0.5, -4.0);
    let floor = whole_floor(8).and(&cuboid(DVec3::ONE * 2.0), DQuat::from_rotation_y(0.4), on);
    let found = pieces(&floor.scene(true));
    let count = found.of[0].len();
    // The footprint and a ring of pieces around it, not 128 triangles.
    assert!((5..20).contains(&count), "{count}");
    assert_eq!(meshed(&found), 1 + 6);
    let corner = |x: f64, z: f64| {
        let at = on + DQuat::from_rotation_y(0.4) * DVec3::new(x, 0.0, z);
        DVec3::new(at.x, 0.0, at.z)
    };
    let footprint = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ];
    for side in 0..4 {
        let (a, b) = (footprint[side], footprint[(side + 1) % 4]);
        let aside = DVec3::Y.cross(b - a).normalize() * 1e-4;
        let both = [0.5 * (a + b) + aside, 0.5 * (a + b) - aside];
        let inside = |piece: &Vec<DVec3>, p: DVec3| super::setup::depth(piece, p, DVec3::Y) > 0.0;
        let across = found.of[0]
            .iter()
            .filter(|piece| both.iter().all(|p| inside(piece, *p)));
        assert_eq!(across.count(), 0, "not split along {a} to {b}");
    }
}

#[test]
fn what_differs_or_bends_stays_apart() {
    let two = whole_floor(1).scene(true);
    assert_eq!(patches(&two), 1);

    let mut coloured = two.clone();
    let mut red = coloured.materials[0].clone();
    red.reflectance = Vec3::new(0.5, 0.1, 0.1);
    coloured.materials.push(red);
    coloured.surfaces[1].material = 1;
    assert_eq!(patches(&coloured), 2);

    let mut sided = two.clone();
    sided.surfaces[1].sides = Sides::Both;
    assert_eq!(patches(&sided), 3);

    let mut bent = two.clone();
    let tip = bent.surfaces[1].corners.indices()[2] as usize;
    bent.vertices[tip].y += 0.01;
    assert_eq!(patches(&bent), 2);

    let unwelded = whole_floor(1).scene(false);
    assert_eq!(patches(&unwelded), 2);
}

#[test]
fn a_wall_on_the_cut_keeps_the_sides_of_the_floor_apart() {
    let wall = [
        DVec3::ZERO,
        DVec3::new(1.0, 0.0, -1.0),
        DVec3::new(1.0, 1.0, -1.0),
        DVec3::Y,
    ];
    let wall = [&wall[..3], &[wall[0], wall[2], wall[3]]];
    let scene = wall
        .iter()
        .fold(whole_floor(1), |floor, part| floor.with(part))
        .scene(true);
    let found = pieces(&scene);
    assert_eq!(meshed(&found), 3, "two halves of the floor, one wall");
}
