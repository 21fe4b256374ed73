//! Form factors with a closed form, in double precision, independent of the library.

use crate::common::reference::Sample;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Identical opposed rectangles (C-11 of Howell's catalogue) a x b, gap c: a, b, c, F.
pub const C11: [[f64; 4]; 6] = [
    [1.0, 1.0, 1.0, 0.19982489569838746],
    [1.0, 1.0, 10.0, 0.0031620568387544677],
    [1.0, 1.0, 0.1, 0.8269945223972565],
    [1.0, 1.5, 0.5, 0.4755764365329532],
    [2.0, 0.5, 1.0, 0.16526921900955807],
    [4.0, 1.0, 3.0, 0.09536382321261395],
];

/// From w x l to the perpendicular h x l that shares the edge l (C-14): l, h, w, F.
pub const C14: [[f64; 4]; 6] = [
    [1.0, 1.0, 1.0, 0.20004377607540316],
    [1.0, 0.5, 1.0, 0.1461866791057133],
    [1.0, 2.0, 1.0, 0.2328526027953619],
    [1.0, 1.0, 0.1, 0.4325136940068586],
    [2.0, 1.0, 3.0, 0.10271343099399849],
    [3.0, 1.0, 4.0, 0.08706944267430279],
];

/// Lambert's formula: the form factor from a surface element to a polygon that lies above the element's horizon,
/// counter-clockwise seen from the element.
pub fn to_polygon(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let edge = |i: usize| {
        let (a, b) = (corners[i] - point, corners[(i + 1) % corners.len()] - point);
        let across = a.cross(b);
        across.length().atan2(a.dot(b)) * across.normalize_or_zero().dot(normal)
    };
    -(0..corners.len()).map(edge).sum::<f64>() / TAU
}

/// Between opposite squares of side 1 at distance 1: 2/π (ln √(4/3) + 2√2 atan(1/√2) - π/2).
pub fn between_opposite_squares() -> f64 {
    let logarithm = (4.0f64 / 3.0).sqrt().ln();
    2.0 / PI * (logarithm + 2.0 * 2f64.sqrt() * 0.5f64.sqrt().atan() - 0.5 * PI)
}

/// The exact irradiance E = π (F_left + F_right) on the floor of the scene Emission, on a grid of points at least 10 cm
/// from its lights: squares of 1 m with radiance 1 that stand on the edges x = ±2 of the floor. Nothing is in
/// the way, and the only bounce is this one.
pub fn emission_floor() -> Vec<Sample> {
    let light = |x: f64| {
        let corners =
            [(0.0, -0.5), (1.0, -0.5), (1.0, 0.5), (0.0, 0.5)].map(|(y, z)| DVec3::new(x, y, z));
        // The left one faces +x, the right one -x.
        if x < 0.0 {
            corners
        } else {
            [3, 2, 1, 0].map(|i| corners[i])
        }
    };
    let lights = [light(-2.0), light(2.0)];
    // Steps that are no multiple of any element's size.
    let places = (0..39).flat_map(|i| {
        (0..39).map(move |j| (-1.95 + 0.1026 * f64::from(i), -1.95 + 0.1026 * f64::from(j)))
    });
    let far = |&(x, z): &(f64, f64)| (2.0 - x.abs()).hypot((z.abs() - 0.5).max(0.0)) >= 0.1;
    let sample = |(x, z)| {
        let point = DVec3::new(x, 0.0, z);
        let factor: f64 = lights
            .iter()
            .map(|light| to_polygon(point, DVec3::Y, light))
            .sum();
        Sample {
            point,
            normal: DVec3::Y,
            irradiance: DVec3::splat(PI * factor),
            standard_error: DVec3::ZERO,
        }
    };
    places.filter(far).map(sample).collect()
}
