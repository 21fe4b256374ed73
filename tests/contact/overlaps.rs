//! Sides in the plane of another surface that faces as they do.

use super::setup::{cuboid, floor};
use glam::{DQuat, DVec3, Vec3};
use radiosity::mesh::{Mesh, MeshLimits};
use radiosity::scene::{Material, Scene, Sides};

fn meshed(scene: &Scene) -> Mesh {
    let limits = MeshLimits {
        initial_size: 10.0,
        max_depth: 4,
        min_size: 0.1,
    };
    Mesh::new(scene, limits)
}

/// What of the plane of the floor radiates upwards, and what downwards, in square metres.
fn radiating(mesh: &Mesh) -> [f64; 2] {
    let is_low = |corner: &DVec3| mesh.frame.leave(*corner).y.abs() < 1e-6;
    let on_floor = mesh
        .patches
        .iter()
        .filter(|p| p.corners().iter().all(is_low));
    let mut areas = [0.0; 2];
    for patch in on_floor {
        areas[usize::from(patch.normal.y < 0.0)] += patch.area / mesh.frame.scale().powi(2);
    }
    areas
}

/// A floor of sixteen square metres, and a box of one that stands on it, or hangs below it.
fn floor_and_box(above: bool, angle: f64) -> Scene {
    let height = if above { 0.5 } else { -0.5 };
    let turn = DQuat::from_rotation_y(angle);
    let unit = cuboid(DVec3::ONE);
    floor(4.0).and(&unit, turn, DVec3::Y * height).scene(true)
}

#[test]
fn a_two_sided_floor_has_two_sides_below_a_box_of_two_sides() {
    for (above, angle) in [(true, 0.0), (true, 0.3), (false, 0.3)] {
        let mut scene = floor_and_box(above, angle);
        for surface in &mut scene.surfaces {
            surface.sides = Sides::Both;
        }
        let mesh = meshed(&scene);
        assert_eq!(mesh.covered_sides, 2);
        for area in radiating(&mesh) {
            assert!((area - 16.0).abs() < 1e-6, "{area}");
        }
    }
}

#[test]
fn what_faces_the_other_way_is_not_covered() {
    let mesh = meshed(&floor_and_box(true, 0.3));
    assert_eq!(mesh.covered_sides, 0);
    let [up, down] = radiating(&mesh);
    assert!(
        (up - 16.0).abs() < 1e-6 && (down - 1.0).abs() < 1e-6,
        "{up}, {down}"
    );
}

/// It shines, though it comes last and something else is there.
#[test]
fn a_lamp_in_a_floor_is_no_floor() {
    let lamp = floor(1.0);
    let mut scene = floor(4.0)
        .and(&lamp, DQuat::from_rotation_y(0.3), DVec3::ZERO)
        .scene(true);
    scene.materials.push(Material {
        name: "lamp".into(),
        reflectance: Vec3::splat(0.5),
        emitted_radiance: Vec3::ONE,
    });
    scene.surfaces[1].material = 1;
    let mesh = meshed(&scene);
    assert_eq!(mesh.covered_sides, 1);
    let [up, _] = radiating(&mesh);
    assert!((up - 16.0).abs() < 1e-6, "{up}");
    let shining = mesh.patches.iter().filter(|p| p.exitance != Vec3::ZERO);
    let shining: f64 = shining.map(|p| p.area).sum::<f64>() / mesh.frame.scale().powi(2);
    assert!((shining - 1.0).abs() < 1e-6, "{shining}");
}
