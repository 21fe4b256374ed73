//! Small solutions, and an engine to look at them.

use glam::{DVec3, Vec3};
use radiosity::render::{RenderOptions, View};
use radiosity::scene::Camera;
use radiosity::solution::{LitMesh, LitTriangle, LitVertex};
use radiosity::visibility::{EngineInfo, Fans, Hit, Ray, Triangles, Visibility};
use std::convert::Infallible;

/// Every triangle, in double precision.
struct EveryTriangle(Triangles);

impl EveryTriangle {
    fn hit(&self, triangle: usize, ray: &Ray) -> Option<Hit> {
        let corners = self.0.indices[triangle].map(|i| self.0.vertices[i as usize].as_dvec3());
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (ab, ac) = (corners[1] - corners[0], corners[2] - corners[0]);
        let determinant = ab.dot(direction.cross(ac));
        let from_a = origin - corners[0];
        let u = from_a.dot(direction.cross(ac)) / determinant;
        let v = direction.dot(from_a.cross(ab)) / determinant;
        let t = ac.dot(from_a.cross(ab)) / determinant;
        let inside = u >= -1e-12 && v >= -1e-12 && u + v <= 1.0 + 1e-12 && t > 0.0;
        inside.then_some(Hit {
            t: t as f32,
            triangle: triangle as u32,
            u: u as f32,
            v: v as f32,
        })
    }
}

impl Visibility for EveryTriangle {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            name: "brute_force",
            version: String::new(),
            isa: String::new(),
            packet_width: 1,
            bytes: 0,
        }
    }

    fn occluded(&self, _: &Fans, masks: &mut Vec<u64>) {
        masks.clear();
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        let nearest = |ray| {
            let all = (0..self.0.indices.len()).filter_map(|triangle| self.hit(triangle, ray));
            all.min_by(|a, b| a.t.total_cmp(&b.t))
        };
        hits.clear();
        hits.extend(rays.iter().map(nearest));
    }
}

pub fn look(mesh: &LitMesh, camera: &Camera, options: &RenderOptions) -> View {
    let build =
        |triangles| Ok::<_, Infallible>(Box::new(EveryTriangle(triangles)) as Box<dyn Visibility>);
    View::new(mesh, camera, options, build).unwrap_or_else(|never| match never {})
}

/// Adds the parallelogram from `corner` along `u` and `v` as one polygon of `cells` x `cells` elements; it radiates
/// towards `u` x `v`. `radiosity` is a function of the position.
pub fn add_quad(
    mesh: &mut LitMesh,
    [corner, u, v]: [DVec3; 3],
    cells: u32,
    radiosity: impl Fn(DVec3) -> Vec3,
) {
    let polygon = mesh.triangles.last().map_or(0, |last| last.polygon + 1);
    let normal = u.cross(v).normalize().as_vec3();
    let at = |x: f64, y: f64| corner + u * (x / f64::from(cells)) + v * (y / f64::from(cells));
    for (column, row) in (0..cells).flat_map(|x| (0..cells).map(move |y| (x, y))) {
        let (x, y) = (f64::from(column), f64::from(row));
        let places = [(0.5, 0.5), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let first = mesh.vertices.len() as u32;
        for position in places.map(|(dx, dy)| at(x + dx, y + dy)) {
            let index = mesh.positions.len() as u32;
            mesh.positions.push(position);
            let (irradiance, radiosity) = (2.0 * radiosity(position), radiosity(position));
            mesh.vertices.push(LitVertex {
                position: index,
                normal,
                irradiance,
                radiosity,
            });
        }
        let on_border = [row == 0, column == cells - 1, row == cells - 1, column == 0];
        let element = mesh.triangles.last().map_or(0, |last| last.element + 1);
        for (side, on_border) in (0..4).zip(on_border) {
            let vertices = [first, first + 1 + side, first + 1 + (side + 1) % 4];
            mesh.triangles.push(LitTriangle {
                vertices,
                element,
                polygon,
                on_border,
            });
        }
    }
}

/// A square in the plane z = 0 around the origin, facing +z.
pub fn square(side: f64, cells: u32, radiosity: impl Fn(DVec3) -> Vec3) -> LitMesh {
    let mut mesh = LitMesh::default();
    let corner = DVec3::new(-0.5, -0.5, 0.0) * side;
    add_quad(
        &mut mesh,
        [corner, DVec3::X * side, DVec3::Y * side],
        cells,
        radiosity,
    );
    mesh
}

/// Looks along -z from a distance of 1; the square of this side fills the picture of `pixels` x `pixels` exactly.
pub fn head_on(pixels: u32, side: f64) -> Camera {
    Camera {
        name: "head on".into(),
        eye: DVec3::Z,
        look_at: DVec3::ZERO,
        up: DVec3::Y,
        horizontal_fov: 2.0 * (0.5 * side).atan().to_degrees(),
        width: pixels,
        height: pixels,
        exposure: Some(0.0),
    }
}

pub const COLOUR: Vec3 = Vec3::new(0.5, 0.25, 0.0625);

/// Brightness of a pixel as shown, 0 to 255.
pub fn brightness(pixel: &[u8; 3]) -> i32 {
    pixel.iter().map(|&value| i32::from(value)).sum::<i32>() / 3
}
