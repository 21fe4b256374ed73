//! Edges of polygons and elements.

use crate::setup::{COLOUR, add_quad, brightness, head_on, look, square};
use glam::{DVec3, Vec3};
use radiosity::render::{Picture, RenderOptions};
use radiosity::solution::LitMesh;
use std::f32::consts::PI;

/// Whether a pixel is darker than the surface by much.
fn inked(picture: &Picture<[u8; 3]>, x: u32, y: u32, surface: i32) -> bool {
    brightness(picture.at(x, y)) < surface - 20
}

#[test]
fn the_wireframe_has_lines_at_the_border_of_the_polygon_and_nowhere_else() {
    // 20 pixels to the unit: the square of 32 pixels lies between the pixels 3 and 4, and 35 and 36.
    let view = look(
        &square(1.6, 4, |_| COLOUR),
        &head_on(40, 2.0),
        &RenderOptions::standard(),
    );
    let picture = view.wireframe();
    let surface = brightness(picture.at(20, 20));
    assert!((200..240).contains(&surface), "a light surface: {surface}");
    for (x, y) in (0..40).flat_map(|x| (0..40).map(move |y| (x, y))) {
        let outside = x.min(y) < 3 || x.max(y) > 36;
        let at_corner = [x, y].iter().all(|i| [3, 36].contains(i));
        let inside = x.min(y) > 4 && x.max(y) < 35;
        if outside {
            assert_eq!(picture.at(x, y), &[255; 3], "paper at ({x}, {y})");
        } else if inside {
            assert!(
                (brightness(picture.at(x, y)) - surface).abs() <= 1,
                "surface at ({x}, {y})"
            );
        } else if !at_corner {
            // Half of the line is inside, half beside the outline.
            assert!(brightness(picture.at(x, y)) < 130, "line at ({x}, {y})");
        }
    }
}

#[test]
fn the_mesh_has_lines_between_elements_and_none_inside() {
    let view = look(
        &square(2.0, 4, |_| PI * COLOUR),
        &head_on(64, 2.0),
        &RenderOptions::standard(),
    );
    let (shaded, picture) = (view.shaded(), view.mesh());
    for (x, y) in (0..64).flat_map(|x| (0..64).map(move |y| (x, y))) {
        let beside_line = |i: u32| matches!(i % 16, 0 | 15);
        if beside_line(x) || beside_line(y) {
            assert!(
                inked(&picture, x, y, brightness(shaded.at(x, y))),
                "line at ({x}, {y})"
            );
        } else {
            assert_eq!(
                picture.at(x, y),
                shaded.at(x, y),
                "no line at ({x}, {y}), spokes least of all"
            );
        }
    }
}

#[test]
fn lines_on_dark_surfaces_are_brighter() {
    let view = look(
        &square(2.0, 1, |_| Vec3::splat(1e-4)),
        &head_on(16, 2.0),
        &RenderOptions::standard(),
    );
    assert!(brightness(view.mesh().at(0, 8)) > brightness(view.shaded().at(0, 8)) + 20);
}

#[test]
fn lines_fade_where_elements_are_tiny() {
    // 32 elements on 32 pixels.
    let view = look(
        &square(2.0, 32, |_| PI * COLOUR),
        &head_on(32, 2.0),
        &RenderOptions::draft(),
    );
    assert_eq!(view.mesh(), view.shaded());
    let edges = view.wireframe();
    assert!(
        brightness(edges.at(0, 16)) < 150 && brightness(edges.at(16, 16)) > 200,
        "the polygon is large"
    );
}

#[test]
fn hidden_lines_are_not_drawn() {
    let mut mesh = square(1.0, 1, |_| COLOUR);
    let before = [DVec3::new(-1.0, -1.0, 0.25), DVec3::X * 2.0, DVec3::Y * 2.0];
    add_quad(&mut mesh, before, 1, |_| COLOUR);
    let picture = look(&mesh, &head_on(32, 2.0), &RenderOptions::standard()).wireframe();
    assert!(
        (1..31)
            .all(|x| (brightness(picture.at(x, 16)) - brightness(picture.at(16, 16))).abs() <= 1)
    );
}

#[test]
fn a_line_that_passes_behind_the_eye_stays_in_its_place() {
    // A floor from far in front of the eye to far behind it; its long edges vanish in the horizon.
    let mut mesh = LitMesh::default();
    add_quad(
        &mut mesh,
        [
            DVec3::new(-1.0, -1.0, 50.0),
            DVec3::X * 2.0,
            DVec3::Z * -100.0,
        ],
        1,
        |_| COLOUR,
    );
    let picture = look(&mesh, &head_on(64, 2.0), &RenderOptions::standard()).wireframe();
    // One unit below the eye, the edges at x = +-1 run down the diagonals of the lower half.
    for y in 40..64 {
        for x in [y, 63 - y] {
            assert!(brightness(picture.at(x, y)) < 150, "line at ({x}, {y})");
        }
        assert!(brightness(picture.at(32, y)) > 200);
    }
}
