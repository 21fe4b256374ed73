//! Polygons to look at, seen from the origin unless said otherwise, and closed forms for any arguments.

use crate::common::shapes::rectangle;
use glam::{DVec3, dvec3};
use radiosity::form_factor::point_to_visible_polygon;
use radiosity::geometry::jitter;
use std::f64::consts::PI;

/// Eq. (2) is evaluated with a polynomial that is good to 3e-11.
pub const KERNEL: f64 = 1e-10;

/// F from the origin, clipped.
pub fn seen(normal: DVec3, corners: &[DVec3]) -> f64 {
    point_to_visible_polygon(normal, corners).0
}

#[track_caller]
pub fn close(computed: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (computed - expected).abs();
    assert!(
        error <= tolerance,
        "{what}: {computed} for {expected}, off by {error:e}"
    );
}

/// A wall of the plane y = `distance` that stands on z = 0 and radiates towards -y.
pub fn wall(distance: f64, left: f64, right: f64, height: f64) -> [DVec3; 4] {
    rectangle(
        dvec3(left, distance, 0.0),
        DVec3::X * (right - left),
        DVec3::Z * height,
    )
}

/// A regular polygon with the area of the disk that radiates along `u` x `v`, seen from the origin.
pub fn many_sided(centre: DVec3, radius: f64, u: DVec3, v: DVec3) -> Vec<DVec3> {
    const SIDES: u32 = 1024;
    let step = 2.0 * PI / f64::from(SIDES);
    let corner_radius = radius * (step / step.sin()).sqrt();
    let corner = |i| {
        let (sin, cos) = (step * f64::from(i)).sin_cos();
        centre + (u * cos + v * sin) * corner_radius
    };
    (0..SIDES).map(corner).collect()
}

/// The six walls of a box with a corner at the origin, radiating inwards.
pub fn room(size: DVec3) -> [[DVec3; 4]; 6] {
    let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
    let o = DVec3::ZERO;
    [
        rectangle(o, y, z),
        rectangle(x, z, y),
        rectangle(o, z, x),
        rectangle(y, x, z),
        rectangle(o, x, y),
        rectangle(z, y, x),
    ]
}

pub fn moved(corners: &[DVec3], by: DVec3) -> Vec<DVec3> {
    corners.iter().map(|c| *c + by).collect()
}

/// A point of the unit cube.
pub fn random(key: u32, number: u32) -> DVec3 {
    let ([x, y], [z, _]) = (jitter(key, 2 * number), jitter(key, 2 * number + 1));
    dvec3(x, y, z)
}

/// B4 for any arguments.
pub fn b4(a: f64, b: f64, c: f64) -> f64 {
    let (a, c) = (a / b, c / b);
    let y = a.hypot(c);
    ((1.0 / c).atan() - c / y * (1.0 / y).atan()) / (2.0 * PI)
}

/// The closed form for a disk in a parallel plane.
pub fn parallel_disk(height: f64, radius: f64, offset: f64) -> f64 {
    let (h2, r2) = ((height / offset).powi(2), (radius / offset).powi(2));
    let z = 1.0 + h2 + r2;
    0.5 * (1.0 - (1.0 + h2 - r2) / (z * z - 4.0 * r2).sqrt())
}
