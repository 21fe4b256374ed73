//! The scenes in `scenes/`, against figures worked out by hand from their sources.

use super::bundled;
use glam::DVec3;
use radiosity::scene::{Scene, Sides, Surface};
use std::f64::consts::PI;

const SCENES: [&str; 6] = [
    "emission",
    "shadow",
    "huge",
    "secondary",
    "geometry",
    "cornell-box",
];

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-9 * expected.abs().max(1e-3)
}

/// The surfaces that emit.
fn lights(scene: &Scene) -> Vec<&Surface> {
    let emits = |surface: &&Surface| scene.materials[surface.material as usize].emits();
    scene.surfaces.iter().filter(emits).collect()
}

#[test]
fn polygon_counts_are_those_of_table_1_and_none_is_split() {
    for (name, count) in SCENES.into_iter().zip([107, 55, 20, 20, 30, 19]) {
        let scene = bundled(name);
        assert_eq!(
            (scene.input_polygons, scene.surfaces.len()),
            (count, count),
            "{name}"
        );
        assert_eq!(scene.warnings, [""; 0], "{name}");
        assert!(
            scene.surfaces.iter().all(|s| s.sides == Sides::Front),
            "{name}"
        );
        assert!(
            scene
                .surfaces
                .iter()
                .enumerate()
                .all(|(i, s)| s.polygon as usize == i),
            "{name}"
        );
        let triangles = if name == "geometry" { 2 } else { 0 };
        assert_eq!(
            scene.summary().triangles,
            triangles,
            "{name}: the ends of the wedge"
        );
    }
}

#[test]
fn names_and_units_are_read() {
    for (name, title) in
        SCENES
            .into_iter()
            .zip(["Emission", "Shadow", "Huge", "Secondary", "Geometry"])
    {
        let scene = bundled(name);
        assert_eq!((scene.name.as_str(), scene.metres_per_unit), (title, 1.0));
    }
    let cornell = bundled("cornell-box");
    assert_eq!(
        (cornell.name.as_str(), cornell.metres_per_unit),
        ("Cornell box", 0.001)
    );
}

/// Lights of radiance 1 emit π times their area.
#[test]
fn emitted_power_is_pi_times_the_area_of_the_lights() {
    let areas = [
        1.0 + 1.0,     // Emission: two squares of 1 m
        0.5 * 0.5,     // Shadow: 0.5 m
        100.0 + 1.0,   // Huge: 10 m and 1 m
        0.8 * 1.0,     // Secondary: 0.8 m by 1 m
        1.0,           // Geometry: 1 m
        0.130 * 0.105, // Cornell box: 130 mm by 105 mm
    ];
    for (name, area) in SCENES.into_iter().zip(areas) {
        let power = bundled(name).summary().emitted_power;
        let expected = DVec3::splat(PI * area);
        assert!(
            (power - expected).length() < 1e-9 * expected.length(),
            "{name}: {power}"
        );
    }
}

/// Areas in m². A box of a by b by c has 2 (ab + bc + ca).
#[test]
fn areas_are_those_of_the_parts() {
    let cuboid = |a: f64, b: f64, c: f64| 2.0 * (a * b + b * c + c * a);
    let slab = cuboid(4.0, 0.1, 4.0);
    let emission = slab + 2.0;
    assert!(close(bundled("emission").summary().area, emission));
    let shadow = slab + 8.0 * cuboid(3.0, 0.1, 0.1) + 0.25;
    assert!((bundled("shadow").summary().area - shadow).abs() < 1e-9 * shadow);

    let cornell = bundled("cornell-box");
    let area_of = |name: &str| {
        let materials = cornell.summary().materials;
        materials
            .iter()
            .find(|m| m.material.name == name)
            .map(|m| m.area)
    };
    // The green wall is 559.2 mm deep and 548.8 mm high.
    assert!(area_of("green").is_some_and(|area| close(area, 0.5592 * 0.5488)));
    assert!(area_of("light").is_some_and(|area| close(area, 0.130 * 0.105)));
}

#[test]
fn lights_face_what_they_light() {
    let down = DVec3::NEG_Y;
    for (name, normal) in [
        ("huge", down),
        ("geometry", down),
        ("cornell-box", down),
        ("secondary", DVec3::NEG_X),
    ] {
        let scene = bundled(name);
        for light in lights(&scene) {
            assert!(
                scene.normal(light).dot(normal) > 1.0 - 1e-12,
                "{name}: {}",
                scene.normal(light)
            );
        }
    }
    let emission = bundled("emission");
    for light in lights(&emission) {
        let inwards = -emission.positions(light).map(|p| p.x).sum::<f64>().signum();
        let cosine = emission.normal(light).x * inwards;
        assert!(cosine > 1.0 - 1e-12, "the lights at x = ±2 face each other");
    }
}

/// Seen from the middle of the box, all of the room turns its front.
#[test]
fn the_cornell_room_faces_inwards_and_its_blocks_outwards() {
    let scene = bundled("cornell-box");
    for (index, surface) in scene.surfaces.iter().enumerate() {
        let corner = scene.positions(surface).next().expect("has corners");
        let centre = match index {
            8..13 => DVec3::new(185.5, 82.5, 169.0),   // the short block
            13..18 => DVec3::new(368.5, 165.0, 351.5), // the tall block
            _ => DVec3::new(278.0, 274.0, 279.6),
        };
        let outwards = scene.normal(surface).dot(corner - centre) > 0.0;
        assert_eq!(outwards, (8..18).contains(&index), "polygon {index}");
    }
}

#[test]
fn cameras_are_those_of_the_sources() {
    let cornell = bundled("cornell-box").cameras;
    assert_eq!(cornell.len(), 1);
    let camera = &cornell[0];
    assert_eq!(camera.eye, DVec3::new(278.0, 273.0, -800.0));
    assert_eq!((camera.look_at - camera.eye).normalize(), DVec3::Z);
    assert_eq!(camera.up, DVec3::Y);
    assert_eq!(
        (camera.width, camera.height, camera.exposure),
        (768, 768, None)
    );
    // 35 mm of focal length on a sensor of 25 mm.
    assert!(close(
        (camera.horizontal_fov.to_radians() / 2.0).tan(),
        12.5 / 35.0
    ));

    let emission = &bundled("emission").cameras[0];
    assert_eq!(emission.up, DVec3::NEG_Z, "it looks straight down");
    assert_eq!(emission.horizontal_fov, 45.0);
    for name in SCENES {
        assert_eq!(bundled(name).cameras.len(), 1, "{name}");
    }
}

#[test]
fn bounds_hold_every_surface() {
    let (low, high) = bundled("cornell-box").bounds();
    assert_eq!((low, high), (DVec3::ZERO, DVec3::new(556.0, 548.8, 559.2)));
}
