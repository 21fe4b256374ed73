//! Closed forms and published values.
//!
//! Formulas with a letter are numbered as in J. R. Howell's catalogue of radiation configuration factors. Every
//! expected value was obtained twice: from the closed form and by an independent quadrature of cosθ cosθ' / (π r²).

use crate::common::closed_form::{C11, C14};
use crate::common::shapes::rectangle;
use crate::quadrature::{Parallelogram, gauss};
use crate::shapes::{KERNEL, close, many_sided, moved, seen, wall};
use glam::{DVec3, dvec3};
use radiosity::form_factor::{point_to_disk, point_to_polygon};
use std::f64::consts::PI;

/// What the product rule below leaves of a form factor between areas that touch.
const QUADRATURE: f64 = 1e-8;

/// Parallel rectangle a x b at distance c, the normal of the point through a corner: a, b, c, F.
pub const B3: [[f64; 4]; 3] = [
    [1.0, 1.0, 1.0, 0.13853160599489298],
    [2.0, 1.0, 0.5, 0.22077762233476156],
    [0.2, 0.3, 1.0, 0.01758606211229528],
];

/// Perpendicular rectangle, a along the normal of the point and b across, at distance c: a, b, c, F.
pub const B4: [[f64; 4]; 3] = [
    [1.0, 1.0, 1.0, 0.05573419700255351],
    [2.0, 1.0, 0.5, 0.1587748045142993],
    [0.2, 0.3, 1.0, 0.0017362590381574824],
];

/// Disk in a parallel plane: height, radius, offset of its axis, F.
const PARALLEL_DISK: [[f64; 4]; 4] = [
    [1.0, 1.0, 0.0, 0.5],
    [1.0, 1.0, 0.5, 0.4379826327053958],
    [1.0, 0.5, 2.0, 0.01072510750662553],
    [2.0, 1.0, 1.0, 0.14644660940672627],
];

/// Disk in a perpendicular plane, the normal of the point towards its axis: height, radius, offset, F.
const PERPENDICULAR_DISK: [[f64; 4]; 2] = [
    [1.0, 0.5, 2.0, 0.020388756377917483],
    [1.0, 1.0, 1.5, 0.13725771917119314],
];

/// Coaxial parallel disks (C41): radius that receives, radius that is seen, gap, F.
const C41: [[f64; 4]; 2] = [
    [1.0, 1.0, 1.0, 0.3819660112501051],
    [1.0, 2.0, 1.5, 0.6016533443880441],
];

/// Triangles seen from the origin with normal +y: nine coordinates, then ρF for ρ = 0.5 in six digits as published with
/// the renderer Nori (direct light of triangles of radiance 1 on a diffuse point).
const NORI: [[f64; 10]; 5] = [
    [
        -0.443432, 0.596366, 0.495985, -0.320397, 0.0677699, -0.229359, 0.0341197, 0.11415,
        -0.343049, 0.0898394,
    ],
    [
        0.461963, 0.397843, 0.412747, -0.0381582, 0.851323, -0.156872, 0.195443, 0.891957,
        -0.260672, 0.02292,
    ],
    [
        0.100871, 0.289075, -0.422609, -0.308386, 0.629587, 0.423966, -0.373132, 0.237287,
        0.351592, 0.0534198,
    ],
    [
        -0.17575, 0.639397, 0.151268, 0.318604, 0.732996, 0.459771, 0.139095, 0.294498, 0.478556,
        0.0205314,
    ],
    [
        -0.17487, 0.447916, 0.367201, -0.405259, 0.249607, -0.354079, 0.356029, 0.0918984,
        -0.132271, 0.26174,
    ],
];

#[test]
fn a_rectangle_before_the_point_is_b3_and_beside_it_b4() {
    for [a, b, c, expected] in B3 {
        let facing = rectangle(dvec3(0.0, 0.0, c), DVec3::Y * b, DVec3::X * a);
        close(seen(DVec3::Z, &facing), expected, KERNEL, "B3");
    }
    for [a, b, c, expected] in B4 {
        close(seen(DVec3::Z, &wall(c, 0.0, b, a)), expected, KERNEL, "B4");
    }
}

#[test]
fn a_polygon_of_many_sides_is_a_disk() {
    // 1024 sides with the area of the disk: what is left of the difference is of fourth order in 2π/1024.
    for [height, radius, offset, expected] in PARALLEL_DISK {
        let disk = many_sided(dvec3(offset, 0.0, height), radius, DVec3::Y, DVec3::X);
        close(
            point_to_polygon(DVec3::Z, &disk),
            expected,
            1e-9,
            "parallel",
        );
    }
    for [height, radius, offset, expected] in PERPENDICULAR_DISK {
        let disk = many_sided(dvec3(offset, 0.0, height), radius, DVec3::Y, DVec3::X);
        close(
            point_to_polygon(DVec3::X, &disk),
            expected,
            1e-9,
            "perpendicular",
        );
    }
}

#[test]
fn a_disk_on_the_axis_is_eq_1() {
    for [height, radius, offset, expected] in PARALLEL_DISK {
        if offset == 0.0 {
            let computed =
                point_to_disk(DVec3::Z, DVec3::Z * height, -DVec3::Z, PI * radius * radius);
            close(computed, expected, 1e-15, "on the axis");
        }
    }
}

#[test]
fn published_triangles() {
    for row in NORI {
        let corners: Vec<DVec3> = row[..9].chunks(3).map(DVec3::from_slice).collect();
        // Published as two-sided: seen from whichever side the origin lies on.
        let expected = 2.0 * row[9];
        close(
            point_to_polygon(DVec3::Y, &corners).abs(),
            expected,
            1e-6,
            "nori",
        );
        let mirrored: Vec<DVec3> = corners.iter().rev().copied().collect();
        let sides = seen(DVec3::Y, &corners) + seen(DVec3::Y, &mirrored);
        close(sides, expected, 1e-6, "one of the two sides");
    }
}

#[test]
fn opposed_rectangles_are_c11() {
    for [a, b, c, expected] in C11 {
        let seen_one = rectangle(dvec3(0.0, 0.0, c), DVec3::Y * b, DVec3::X * a);
        let receiver = Parallelogram(DVec3::ZERO, DVec3::X * a, DVec3::Y * b);
        close(receiver.mean(&seen_one), expected, QUADRATURE, "C11");
    }
}

#[test]
fn rectangles_that_share_an_edge_are_c14() {
    for [l, h, w, expected] in C14 {
        let receiver = Parallelogram(DVec3::ZERO, DVec3::X * l, DVec3::Y * w);
        let seen_one = rectangle(dvec3(0.0, w, 0.0), DVec3::X * l, DVec3::Z * h);
        close(receiver.mean(&seen_one), expected, QUADRATURE, "C14");
    }
}

#[test]
fn what_goes_and_what_comes_are_the_same() {
    let pairs = [
        (
            "apart",
            dvec3(0.3, -0.2, 2.0),
            DVec3::Y,
            dvec3(1.0, 0.0, 0.4),
        ),
        ("near", dvec3(0.1, 0.2, 0.2), DVec3::Y * 0.5, DVec3::X * 0.5),
        (
            "cut by the horizon",
            dvec3(1.5, 0.2, -0.5),
            DVec3::Z * 2.0,
            DVec3::Y,
        ),
    ];
    for (what, corner, u, v) in pairs {
        let i = Parallelogram(DVec3::ZERO, DVec3::X, DVec3::Y);
        let j = Parallelogram(corner, u, v);
        // From below the horizon of i, nothing comes back.
        let hidden = if corner.z < 0.0 { -corner.z / u.z } else { 0.0 };
        let above = Parallelogram(corner + u * hidden, u * (1.0 - hidden), v);
        let (there, back) = (i.mean(&j.corners()), above.mean(&i.corners()));
        assert!(there > 1e-3, "{what}: {there}");
        close(
            i.area() * there,
            above.area() * back,
            1e-6 * i.area() * there,
            what,
        );
    }
}

#[test]
fn coaxial_disks_are_c41() {
    for [receiving, radius, gap, expected] in C41 {
        let disk = many_sided(DVec3::Z * gap, radius, DVec3::Y, DVec3::X);
        let at = |r: f64| point_to_polygon(DVec3::Z, &moved(&disk, -DVec3::X * (r * receiving)));
        let mean: f64 = gauss()
            .iter()
            .map(|(r, weight)| 2.0 * r * weight * at(*r))
            .sum();
        close(mean, expected, QUADRATURE, "C41");
    }
}
