//! The reference: every triangle, in double precision, for every segment.
//!
//! Slow and simple on purpose. The coordinates are single-precision numbers, so their differences,
//! and mostly the products of two of them, are exact in double precision.

use super::{
    EngineInfo, Fans, Hit, Ray, T_FAR, T_NEAR, Triangles, Visibility, VisibilityError, traceable,
};
use glam::{DVec3, Vec3};

/// Tests every triangle.
#[derive(Debug)]
pub struct BruteForce {
    triangles: Vec<[DVec3; 3]>,
}

impl BruteForce {
    /// Takes the triangles over, after [`Triangles::validate`].
    pub fn new(triangles: &Triangles) -> Result<Self, VisibilityError> {
        triangles.validate()?;
        let corners = |i| triangles.corners(i).map(Vec3::as_dvec3);
        Ok(Self {
            triangles: (0..triangles.indices.len()).map(corners).collect(),
        })
    }

    fn is_occluded(&self, origin: Vec3, target: Vec3) -> bool {
        if !traceable(origin, target - origin) {
            return false;
        }
        let (origin, target) = (origin.as_dvec3(), target.as_dvec3());
        self.triangles.iter().any(|corners| {
            intersect(corners, origin, target - origin)
                .is_some_and(|hit| hit.t > f64::from(T_NEAR) && hit.t < f64::from(T_FAR))
        })
    }

    fn nearest_of(&self, ray: &Ray) -> Option<Hit> {
        if !traceable(ray.origin, ray.direction) {
            return None;
        }
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let hits = self
            .triangles
            .iter()
            .enumerate()
            .filter_map(|(i, corners)| {
                intersect(corners, origin, direction)
                    .filter(|hit| hit.t > 0.0)
                    .map(|hit| (i, hit))
            });
        let (triangle, hit) = hits.min_by(|(_, a), (_, b)| a.t.total_cmp(&b.t))?;
        let (t, u, v) = (hit.t as f32, hit.u as f32, hit.v as f32);
        Some(Hit {
            t,
            triangle: triangle as u32,
            u,
            v,
        })
    }
}

impl Visibility for BruteForce {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            name: "brute_force",
            version: env!("CARGO_PKG_VERSION").to_owned(),
            isa: "portable".to_owned(),
            packet_width: 1,
            bytes: size_of_val(self.triangles.as_slice()) as u64,
        }
    }

    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>) {
        masks.clear();
        masks.extend((0..fans.len()).map(|fan| {
            fans.range(fan).enumerate().fold(0, |mask, (k, i)| {
                let target = Vec3::new(fans.x[i], fans.y[i], fans.z[i]);
                mask | u64::from(self.is_occluded(fans.origins[fan], target)) << k
            })
        }));
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        hits.clear();
        hits.extend(rays.iter().map(|ray| self.nearest_of(ray)));
    }
}

/// Where a line meets a triangle, in double precision.
struct Crossing {
    t: f64,
    u: f64,
    v: f64,
}

/// Intersects a line with a triangle: the line passes the three edges on the same side.
///
/// The volume spanned with an edge only changes its sign when the neighbour sees the edge the other
/// way round, so a line cannot slip between two triangles that share it; a volume of 0 counts as inside
/// for both. A line in the plane of the triangle misses.
fn intersect([a, b, c]: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<Crossing> {
    let (a, b, c) = (a - origin, b - origin, c - origin);
    let volume = |p: DVec3, q: DVec3| direction.dot((p + q).cross(q - p));
    let weights = DVec3::new(volume(b, c), volume(c, a), volume(a, b));
    if !(weights.min_element() >= 0.0 || weights.max_element() <= 0.0) {
        return None;
    }
    let normal = (b - a).cross(c - a);
    let (height, speed) = (normal.dot(a), normal.dot(direction));
    let sum = weights.element_sum();
    if speed == 0.0 || sum == 0.0 {
        return None;
    }
    Some(Crossing {
        t: height / speed,
        u: weights.y / sum,
        v: weights.z / sum,
    })
}
