//! What an eye can see: the triangles that face it, and which of them lies where.

use super::frame::Frame;
use super::lens::Lens;
use crate::radiometry::Spectrum;
use crate::solution::{LitMesh, LitTriangle, LitVertex};
use crate::visibility::{Hit, Ray, Triangles, Visibility};
use glam::{DVec2, DVec3};

/// The triangles of a mesh that face an eye. The others are left out before a ray is traced: so the back of a wall is
/// see-through, and of a two-sided surface, which is two patches back to back, remains the one to be seen.
pub(super) struct Sight<'a> {
    mesh: &'a LitMesh,
    frame: Frame,
    /// The mesh's triangle, for each of the engine's.
    facing: Vec<u32>,
}

/// A visible point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<'a> {
    /// Index of the triangle in the mesh.
    pub(super) triangle: u32,
    /// Unit normal of the triangle, towards the eye.
    pub(super) normal: DVec3,
    /// A point of its plane.
    anchor: DVec3,
    corners: [&'a LitVertex; 3],
    /// The barycentric weights of the corners.
    weights: [f32; 3],
}

/// Memory that is used again from one call to the next.
#[derive(Default)]
pub(super) struct Scratch {
    rays: Vec<Ray>,
    /// The screen point of each ray.
    sources: Vec<usize>,
    hits: Vec<Option<Hit>>,
}

impl<'a> Sight<'a> {
    /// Chooses what faces `eye`, and gives it to be traced: in a frame that suits single precision.
    pub(super) fn new(mesh: &'a LitMesh, eye: DVec3) -> (Self, Triangles) {
        let facing: Vec<u32> = (0..mesh.triangles.len() as u32)
            .filter(|&index| {
                let positions = corner_positions(mesh, &mesh.triangles[index as usize]);
                area_vector(positions).dot(eye - positions[0]) > 0.0
            })
            .collect();
        let frame = Frame::around(mesh.positions.iter().copied());
        let triangles = Triangles {
            vertices: mesh
                .positions
                .iter()
                .map(|&position| frame.place(position))
                .collect(),
            indices: facing
                .iter()
                .map(|&index| {
                    mesh.triangles[index as usize]
                        .vertices
                        .map(|v| mesh.vertices[v as usize].position)
                })
                .collect(),
        };
        (
            Self {
                mesh,
                frame,
                facing,
            },
            triangles,
        )
    }

    /// The triangles that face the eye.
    pub(super) fn triangles(&self) -> impl Iterator<Item = &'a LitTriangle> {
        self.facing
            .iter()
            .map(|&index| &self.mesh.triangles[index as usize])
    }

    /// Where the corners of a triangle are.
    pub(super) fn positions(&self, triangle: &LitTriangle) -> [DVec3; 3] {
        corner_positions(self.mesh, triangle)
    }

    /// The normal of a triangle, as long as its area.
    pub(super) fn area_vector(&self, triangle: &LitTriangle) -> DVec3 {
        area_vector(self.positions(triangle))
    }

    /// Puts into `seen` what lies at each of the `points` of the screen.
    pub(super) fn look(
        &self,
        engine: &dyn Visibility,
        lens: &Lens,
        points: &[DVec2],
        scratch: &mut Scratch,
        seen: &mut Vec<Option<Seen<'a>>>,
    ) {
        scratch.rays.clear();
        scratch.sources.clear();
        for (source, &point) in points.iter().enumerate() {
            let direction = lens.direction(point).normalize();
            if let Some(origin) = self.frame.enter(lens.eye, direction) {
                scratch.rays.push(Ray {
                    origin,
                    direction: direction.as_vec3(),
                });
                scratch.sources.push(source);
            }
        }
        engine.nearest(&scratch.rays, &mut scratch.hits);
        seen.clear();
        seen.resize(points.len(), None);
        for (&source, hit) in scratch.sources.iter().zip(&scratch.hits) {
            seen[source] = hit.map(|hit| self.seen(hit));
        }
    }

    fn seen(&self, hit: Hit) -> Seen<'a> {
        let number = self.facing[hit.triangle as usize];
        let triangle = &self.mesh.triangles[number as usize];
        Seen {
            triangle: number,
            anchor: self.positions(triangle)[0],
            corners: triangle
                .vertices
                .map(|index| &self.mesh.vertices[index as usize]),
            normal: self.area_vector(triangle).normalize(),
            weights: [(1.0 - hit.u - hit.v).max(0.0), hit.u, hit.v],
        }
    }
}

fn corner_positions(mesh: &LitMesh, triangle: &LitTriangle) -> [DVec3; 3] {
    triangle
        .vertices
        .map(|index| mesh.positions[mesh.vertices[index as usize].position as usize])
}

fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    0.5 * (b - a).cross(c - a)
}

impl Seen<'_> {
    /// Interpolates what `quantity` says of the corners.
    pub(super) fn interpolate(&self, quantity: impl Fn(&LitVertex) -> Spectrum) -> Spectrum {
        let [a, b, c] = self.corners.map(quantity);
        self.weights[0] * a + self.weights[1] * b + self.weights[2] * c
    }

    /// Where it is.
    pub(super) fn point(&self, mesh: &LitMesh) -> DVec3 {
        let [a, b, c] = corner_positions(mesh, &mesh.triangles[self.triangle as usize]);
        let [u, v, w] = self.weights.map(f64::from);
        u * a + v * b + w * c
    }

    /// Distance of `point` from the plane of the triangle, positive on the eye's side.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.anchor)
    }
}
