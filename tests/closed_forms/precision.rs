//! How good each formula is: Eq. (1) at the distance where it takes over, Eq. (2) for what is far or thin.

use crate::quadrature::Parallelogram;
use crate::shapes::{close, parallel_disk, random};
use glam::{DVec3, Vec3, dvec3};
use radiosity::form_factor::{point_to_disk, point_to_polygon};
use std::f64::consts::PI;

#[test]
fn eq_1_at_the_five_times_limit_is_low_by_known_percentages() {
    // The ratio to the exact disk, in percent, at 30°, 60° and 75° off the axis; twice the distance quarters it.
    let error = |times: f64, degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (height, offset) = (2.0 * times * cos, 2.0 * times * sin);
        let computed = point_to_disk(DVec3::Z, dvec3(offset, 0.0, height), -DVec3::Z, PI);
        100.0 * (computed / parallel_disk(height, 1.0, offset) - 1.0)
    };
    for (degrees, percent) in [(30.0, -0.74), (60.0, -2.22), (75.0, -2.76)] {
        close(error(5.0, degrees), percent, 0.005, "five times");
        close(
            error(10.0, degrees) / error(5.0, degrees),
            0.25,
            0.004,
            "ten times",
        );
    }
}

#[test]
fn eq_2_loses_two_digits_for_every_digit_of_distance() {
    // A sum of edges of size 1/distance gives 1/distance². Single precision has lost the third digit at a thousand
    // times the size, and everything soon after; double precision serves for whatever a scene can hold.
    for (distance, double, single) in [
        (10.0, 3e-11, 1e-6..1e-5),
        (100.0, 3e-11, 1e-4..1e-3),
        (1e3, 1e-10, 1e-2..1e-1),
        (1e5, 1e-6, 1.0..f64::INFINITY),
    ] {
        let worst = worst_errors(distance, 1.0);
        assert!(
            worst[0] < double && single.contains(&worst[1]),
            "{distance}: {worst:?}"
        );
    }
}

#[test]
fn eq_2_loses_a_digit_for_every_digit_of_slenderness() {
    for (width, double, single) in [(1e-2, 3e-11, 1e-6..1e-4), (1e-5, 1e-10, 1e-3..1e-1)] {
        let worst = worst_errors(2.0, width);
        assert!(
            worst[0] < double && single.contains(&worst[1]),
            "{width}: {worst:?}"
        );
    }
}

/// The largest relative errors of Eq. (2) for a rectangle of length 1 at about `distance`: ours and in f32.
fn worst_errors(distance: f64, width: f64) -> [f64; 2] {
    let errors = (0..200).map(|key| {
        let corner = distance * (random(key, 0) - dvec3(0.5, 0.5, -1.0));
        let seen = Parallelogram(corner, DVec3::Y * width, DVec3::X);
        let exact = seen.area() * seen.integrate(|y| y.z * y.z / (PI * y.length_squared().powi(2)));
        let ours = point_to_polygon(DVec3::Z, &seen.corners());
        let single = eq_2_in_f32(Vec3::Z, &seen.corners().map(|c| c.as_vec3()));
        [ours, f64::from(single)].map(|f| (f / exact - 1.0).abs())
    });
    errors.fold([0.0, 0.0], |[a, b], [c, d]| [a.max(c), b.max(d)])
}

/// Eq. (2) as a renderer would write it.
fn eq_2_in_f32(normal: Vec3, corners: &[Vec3]) -> f32 {
    let edge = |(i, r): (usize, &Vec3)| {
        let next = corners[(i + 1) % corners.len()];
        let cross = r.cross(next);
        normal.dot(cross) / cross.length() * cross.length().atan2(r.dot(next))
    };
    -corners.iter().enumerate().map(edge).sum::<f32>() / (2.0 * std::f32::consts::PI)
}
