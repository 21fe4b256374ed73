//! Families of segments, made the way the solver makes them.

use crate::random::Random;
use crate::scenes::EXTENT;
use glam::{DVec3, Vec3};
use radiosity::visibility::{Fans, MAX_FAN, Triangles};

/// Both ends of a segment are moved off their surfaces by this much.
const OFFSET: f64 = 1e-5 * EXTENT;
/// A vertex on the border of its patch is moved inwards by this part of its smallest element.
const INWARDS: f64 = 1e-3;

/// What a fan looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// From a point in space to points in space.
    Random,
    /// From a point on a surface to samples of another surface.
    Surfaces,
    /// From a point on a triangle to points on the same triangle: just above the surface.
    Along,
    /// From a corner of a triangle to samples of a triangle that meets it there.
    Corner,
    /// Through points on edges, and corners, of triangles.
    Edges,
}

impl Family {
    pub const ALL: [Self; 5] = [
        Self::Random,
        Self::Surfaces,
        Self::Along,
        Self::Corner,
        Self::Edges,
    ];
}

/// Makes fans over one set of triangles.
pub struct Segments<'a> {
    triangles: &'a Triangles,
    /// Triangles at each vertex.
    around: Vec<Vec<usize>>,
    random: Random,
}

impl<'a> Segments<'a> {
    pub fn new(triangles: &'a Triangles, seed: u64) -> Self {
        let mut around = vec![Vec::new(); triangles.vertices.len()];
        for (i, corners) in triangles.indices.iter().enumerate() {
            corners.iter().for_each(|&k| around[k as usize].push(i));
        }
        Self {
            triangles,
            around,
            random: Random::new(seed),
        }
    }

    /// Fans with 1 to 64 targets, until there are `segments`.
    pub fn fans(&mut self, family: Family, segments: usize) -> Fans {
        let mut fans = Fans::default();
        while fans.segments() < segments {
            let targets = if self.random.unit() < 0.5 {
                MAX_FAN
            } else {
                1 + self.random.below(MAX_FAN)
            };
            match family {
                Family::Random => self.random_fan(&mut fans, targets),
                Family::Surfaces => self.surfaces_fan(&mut fans, targets),
                Family::Along => self.along_fan(&mut fans, targets),
                Family::Corner => self.corner_fan(&mut fans, targets),
                Family::Edges => self.edges_fan(&mut fans, targets),
            }
        }
        fans
    }

    fn random_fan(&mut self, fans: &mut Fans, targets: usize) {
        begin(fans, 0.55 * EXTENT * self.random.in_cube());
        let centre = 0.55 * EXTENT * self.random.in_cube();
        let radius = EXTENT * self.random.unit().powi(3);
        for _ in 0..targets {
            push(fans, centre + radius * self.random.in_cube());
        }
    }

    fn surfaces_fan(&mut self, fans: &mut Fans, targets: usize) {
        let (from, to) = (self.any_triangle(), self.any_triangle());
        let origin = self.point_on(from);
        self.fan_between(fans, (from, origin), to, targets);
    }

    fn corner_fan(&mut self, fans: &mut Fans, targets: usize) {
        let from = self.any_triangle();
        let corner = self.random.below(3);
        let neighbours = &self.around[self.triangles.indices[from][corner] as usize];
        let to = neighbours[self.random.below(neighbours.len())];
        let points = self.corners(from);
        let centre = (points[0] + points[1] + points[2]) / 3.0;
        let origin = points[corner] + INWARDS * (centre - points[corner]);
        self.fan_between(fans, (from, origin), to, targets);
    }

    /// Each end is lifted to the side from which the other triangle's middle is seen.
    fn fan_between(
        &mut self,
        fans: &mut Fans,
        (from, origin): (usize, DVec3),
        to: usize,
        n: usize,
    ) {
        let middle = self.corners(to).iter().sum::<DVec3>() / 3.0;
        let origin = origin + OFFSET * self.normal_towards(from, middle);
        begin(fans, origin);
        let lift = OFFSET * self.normal_towards(to, origin);
        for _ in 0..n {
            let target = self.point_on(to);
            push(fans, target + lift);
        }
    }

    fn along_fan(&mut self, fans: &mut Fans, targets: usize) {
        let triangle = self.any_triangle();
        let side = if self.random.unit() < 0.5 { 1.0 } else { -1.0 };
        let lift = side * OFFSET * self.normal(triangle);
        let origin = self.point_on(triangle);
        begin(fans, origin + lift);
        for _ in 0..targets {
            let target = self.point_on(triangle);
            push(fans, target + lift);
        }
    }

    fn edges_fan(&mut self, fans: &mut Fans, targets: usize) {
        let origin = 0.55 * EXTENT * self.random.in_cube();
        begin(fans, origin);
        let triangle = self.any_triangle();
        for _ in 0..targets {
            let corner = self.random.below(3);
            let next = (corner + 1) % 3;
            let along = if self.random.unit() < 0.3 {
                0.0
            } else {
                self.random.unit()
            };
            let points = self.corners(triangle);
            let on_edge = points[corner].lerp(points[next], along);
            push(
                fans,
                origin + self.random.between(1.1, 2.0) * (on_edge - origin),
            );
        }
    }

    fn any_triangle(&mut self) -> usize {
        loop {
            let i = self.random.below(self.triangles.indices.len());
            if self.normal(i).is_finite() {
                return i;
            }
        }
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles.indices[triangle].map(|k| self.triangles.vertices[k as usize].as_dvec3())
    }

    fn point_on(&mut self, triangle: usize) -> DVec3 {
        let (points, weights) = (self.corners(triangle), self.random.weights());
        weights.x * points[0] + weights.y * points[1] + weights.z * points[2]
    }

    fn normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).normalize()
    }

    fn normal_towards(&self, triangle: usize, point: DVec3) -> DVec3 {
        let normal = self.normal(triangle);
        let [a, ..] = self.corners(triangle);
        if normal.dot(point - a) < 0.0 {
            -normal
        } else {
            normal
        }
    }
}

fn begin(fans: &mut Fans, origin: DVec3) {
    fans.begin(origin.as_vec3());
}

fn push(fans: &mut Fans, target: DVec3) {
    let target: Vec3 = target.as_vec3();
    fans.push(target);
}
