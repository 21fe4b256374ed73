//! What goes wrong where a form factor is written without care, and what must hold for any polygons.

use crate::catalogue::{B3, B4};
use crate::common::shapes::rectangle;
use crate::quadrature::Parallelogram;
use crate::shapes::{KERNEL, b4, close, moved, random, room, seen, wall};
use glam::{DVec3, dvec3};
use radiosity::form_factor::{point_to_disk, point_to_polygon, point_to_visible_polygon};
use radiosity::geometry::polygon;

#[test]
fn only_what_is_above_the_horizon_counts() {
    for [a, b, c, expected] in B4 {
        let below = rectangle(dvec3(0.0, c, -0.7 * a), DVec3::X * b, DVec3::Z * (1.7 * a));
        close(seen(DVec3::Z, &below), expected, KERNEL, "half below");
        let (_, left) = point_to_visible_polygon(DVec3::Z, &below);
        close(
            polygon::vector_area(left.corners()).length(),
            a * b,
            1e-14 * a * b,
            "area left",
        );
        assert_eq!(seen(-DVec3::Z, &wall(c, 0.0, b, a)), 0.0, "all below");
        // The sum over the unclipped polygon takes away what lies below.
        let unclipped = point_to_polygon(DVec3::Z, &below);
        assert!(unclipped < 0.9 * expected, "{unclipped} {expected}");
    }
}

#[test]
fn nothing_arrives_from_behind_the_polygon() {
    for [a, b, c, expected] in B3 {
        let mut facing = rectangle(dvec3(0.0, 0.0, c), DVec3::Y * b, DVec3::X * a);
        facing.reverse();
        close(
            point_to_polygon(DVec3::Z, &facing),
            -expected,
            KERNEL,
            "the sum alone",
        );
        assert_eq!(seen(DVec3::Z, &facing), 0.0);
    }
}

#[test]
fn a_closed_room_is_all_that_a_point_sees() {
    let faces = room(dvec3(3.0, 2.0, 5.0));
    for key in 0..500 {
        let point = random(key, 0) * dvec3(3.0, 2.0, 5.0);
        let normal = (random(key, 1) - 0.5).normalize();
        let sum: f64 = faces
            .iter()
            .map(|face| seen(normal, &moved(face, -point)))
            .sum();
        close(sum, 1.0, KERNEL, "any point, any normal");
    }
}

#[test]
fn a_point_a_hair_from_a_wall_has_the_closed_form() {
    // Down to the rounding of coordinates: a vertex of a floor may come as near to a box that stands on it.
    for exponent in 1..=15 {
        let hair = 10f64.powi(-exponent);
        let beside = b4(1.0, 0.4, hair) + b4(1.0, 0.6, hair);
        close(
            seen(DVec3::Z, &wall(hair, -0.4, 0.6, 1.0)),
            beside,
            1e-7,
            "an edge",
        );
        let corner = b4(1.0, hair, hair) + b4(1.0, 0.6, hair);
        close(
            seen(DVec3::Z, &wall(hair, -hair, 0.6, 1.0)),
            corner,
            1e-7,
            "a corner",
        );
    }
}

#[test]
fn on_an_edge_or_corner_the_sum_is_finite_and_below_one() {
    for wall in [
        wall(0.0, -0.4, 0.6, 1.0),
        wall(0.0, 0.0, 0.6, 1.0),
        wall(0.0, -0.4, 0.6, 1e-9),
    ] {
        for normal in [DVec3::Z, -DVec3::Y, dvec3(0.0, -0.6, 0.8)] {
            let form_factor = seen(normal, &wall);
            assert!((0.0..=1.0).contains(&form_factor), "{form_factor} {normal}");
        }
    }
}

#[test]
fn flux_is_the_same_in_both_directions() {
    for key in 0..40 {
        let r = |n| random(key, n) - 0.5;
        let i = Parallelogram(r(0), DVec3::X + 0.5 * r(1), DVec3::Y + 0.5 * r(2));
        let j = Parallelogram(
            3.0 * DVec3::Z + r(3),
            DVec3::Y + 0.5 * r(4),
            DVec3::X + 0.5 * r(5),
        );
        let there = i.area() * i.mean(&j.corners());
        let back = j.area() * j.mean(&i.corners());
        close(there, back, 1e-9, "A_i F_ij = A_j F_ji");
        assert!(there > 1e-3, "a pair that sees each other: {there}");
    }
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-30, 1e-6, 1e6, 1e30] {
        let scaled = |corners: &[DVec3]| corners.iter().map(|c| *c * scale).collect::<Vec<_>>();
        for [a, b, c, expected] in B4 {
            close(
                seen(DVec3::Z, &scaled(&wall(c, 0.0, b, a))),
                expected,
                KERNEL,
                "Eq. (2)",
            );
        }
        let to = dvec3(0.3, 0.1, 2.0);
        let one = point_to_disk(DVec3::Z, to, -DVec3::Z, 0.5);
        let same = point_to_disk(DVec3::Z, to * scale, -DVec3::Z, 0.5 * scale * scale);
        close(same / one, 1.0, 1e-14, "Eq. (1)");
    }
}
