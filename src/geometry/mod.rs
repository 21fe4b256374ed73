//! Points, polygons and the frame in which a scene is solved. Imports nothing of ours.

mod curve;
mod frame;
mod jitter;
pub mod polygon;
mod sets;

pub use curve::along_curve;
pub use frame::Frame;
pub use jitter::jitter;
pub use sets::Sets;

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

/// The box around all points: its lowest and its highest corner; around none, infinity and minus infinity.
pub fn bounds(points: impl IntoIterator<Item = DVec3>) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let points = points.into_iter();
    points.fold(none, |(low, high), p| (low.min(p), high.max(p)))
}

/// The face of a cube about the origin, of six, that a normal meets. No two normals that meet the same are more than a right angle
/// apart by much, so that vector areas of surfaces that face alike never cancel.
pub fn facing(normal: DVec3) -> usize {
    let size = normal.abs();
    let axis = if size.x >= size.y.max(size.z) {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    2 * axis + usize::from(normal[axis] < 0.0)
}

/// A direction about `normal`, cosine-distributed for evenly distributed (a, b) in the unit square.
pub fn cosine_direction(normal: DVec3, [a, b]: [f64; 2]) -> DVec3 {
    let tangent = normal.any_orthonormal_vector();
    let bitangent = normal.cross(tangent);
    let (sine, cosine) = (a.sqrt(), (1.0 - a).sqrt());
    let (y, x) = (TAU * b).sin_cos();
    tangent * (sine * x) + bitangent * (sine * y) + normal * cosine
}
