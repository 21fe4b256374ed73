//! Shapes, and scenes made by hand.

use glam::{DVec3, Vec3};
use radiosity::scene::{Corners, Material, Scene, Sides, Surface};
use std::f32::consts::PI;

/// A parallelogram that radiates along `u` x `v`.
pub fn rectangle(corner: DVec3, u: DVec3, v: DVec3) -> [DVec3; 4] {
    [corner, corner + u, corner + u + v, corner + v]
}

/// An empty scene in metres.
pub fn empty() -> Scene {
    Scene {
        name: "made by hand".into(),
        metres_per_unit: 1.0,
        vertices: Vec::new(),
        surfaces: Vec::new(),
        materials: Vec::new(),
        cameras: Vec::new(),
        input_polygons: 0,
        warnings: Vec::new(),
    }
}

/// A grey material that reflects ρ and emits an exitance M; its index.
pub fn add_grey(scene: &mut Scene, reflectance: f32, exitance: f32) -> u32 {
    scene.materials.push(Material {
        name: format!("grey{}", scene.materials.len()),
        reflectance: Vec3::splat(reflectance),
        emitted_radiance: Vec3::splat(exitance / PI),
    });
    scene.materials.len() as u32 - 1
}

/// Adds a quad that radiates from its front, the side from which its corners run counter-clockwise.
pub fn add_quad(scene: &mut Scene, material: u32, corners: [DVec3; 4]) {
    let corners = Corners::Quad(corners.map(|corner| vertex(scene, corner)));
    add_surface(scene, material, corners);
}

/// Adds a triangle in the same way.
#[allow(dead_code, reason = "not every test binary has triangles")]
pub fn add_triangle(scene: &mut Scene, material: u32, corners: [DVec3; 3]) {
    let corners = Corners::Triangle(corners.map(|corner| vertex(scene, corner)));
    add_surface(scene, material, corners);
}

/// The number of a vertex, added if it is not there yet.
fn vertex(scene: &mut Scene, place: DVec3) -> u32 {
    let known = scene.vertices.iter().position(|v| *v == place);
    known.unwrap_or_else(|| {
        scene.vertices.push(place);
        scene.vertices.len() - 1
    }) as u32
}

fn add_surface(scene: &mut Scene, material: u32, corners: Corners) {
    let polygon = scene.input_polygons as u32;
    scene.surfaces.push(Surface {
        corners,
        material,
        polygon,
        sides: Sides::Front,
    });
    scene.input_polygons += 1;
}

/// The sides of a cuboid, outwards: left, right, bottom, top, back, front. The bits of a corner's number say along which axes it is high,
/// from the lowest on x, y and z.
pub const CUBOID: [[usize; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

/// A corner of a cuboid by its number in [`CUBOID`].
pub fn cuboid_corner(number: usize, [low, high]: [DVec3; 2]) -> DVec3 {
    let along = |axis: usize| [low, high][number >> axis & 1][axis];
    DVec3::new(along(0), along(1), along(2))
}

/// Adds the sides of a cuboid, which radiate outwards; or inwards, as a room.
pub fn add_cuboid(scene: &mut Scene, material: u32, ends: [DVec3; 2], inwards: bool) {
    for [a, b, c, d] in CUBOID.map(|side| side.map(|number| cuboid_corner(number, ends))) {
        add_quad(
            scene,
            material,
            if inwards { [d, c, b, a] } else { [a, b, c, d] },
        );
    }
}

/// Adds a horizontal rectangle from `low` to `high` at a height; it faces up, or down.
pub fn add_level(
    scene: &mut Scene,
    material: u32,
    [low, high]: [[f64; 2]; 2],
    height: f64,
    upwards: bool,
) {
    let at = |x: f64, z: f64| DVec3::new(x, height, z);
    let [a, b, c, d] = [
        at(low[0], low[1]),
        at(low[0], high[1]),
        at(high[0], high[1]),
        at(high[0], low[1]),
    ];
    add_quad(
        scene,
        material,
        if upwards { [a, b, c, d] } else { [d, c, b, a] },
    );
}
