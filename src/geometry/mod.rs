//! Points, polygons and the frame in which a scene is solved. Imports nothing of ours.

mod frame;
mod jitter;
pub mod polygon;

pub use frame::Frame;
pub use jitter::jitter;

use glam::DVec3;
use std::f64::consts::TAU;

/// Both ends of a visibility segment leave their surfaces by this fraction of the scene's extent.
///
/// Together with the open interval of the segment and the inward move of border vertices it decides that
/// two engines agree: measured at ≤ 8 ppm of differing answers, against 13-42 % without any policy.
pub const SURFACE_OFFSET: f64 = 1e-5;

/// `point` lifted off its surface along the unit `normal`, in a scene of the given extent.
pub fn lift(point: DVec3, normal: DVec3, extent: f64) -> DVec3 {
    point + normal * (SURFACE_OFFSET * extent)
}

/// A direction about `normal`, cosine-distributed for evenly distributed (a, b) in the unit square.
pub fn cosine_direction(normal: DVec3, [a, b]: [f64; 2]) -> DVec3 {
    let tangent = normal.any_orthonormal_vector();
    let bitangent = normal.cross(tangent);
    let (sine, cosine) = (a.sqrt(), (1.0 - a).sqrt());
    let (y, x) = (TAU * b).sin_cos();
    tangent * (sine * x) + bitangent * (sine * y) + normal * cosine
}
