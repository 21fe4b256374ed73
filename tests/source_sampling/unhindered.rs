//! Nothing in between: form factors and the source's own radiosity alone.

use crate::setup::{
    HYBRID, QUAD, TRIANGLE, close, constant, engines, eq_2, gather_one, integral, linear,
};
use glam::{DVec3, dvec3};
use radiosity::form_factor::{Formula, Gather, Receiver};

/// Irradiances are stored in single precision.
const SINGLE: f64 = 1e-6;

#[test]
fn unhindered_constant_sources_give_eq_2() {
    // Eq. (1) at its limit is low by up to 2.8 %, but the cells that use it are compared with finer ones: what is left
    // is a fraction of the threshold for each cell.
    for corners in [&QUAD[..], &TRIANGLE[..]] {
        let source = constant(corners);
        for (receiver, name) in near_and_far() {
            let expected = eq_2(receiver, corners);
            for engine in engines(&[]) {
                let exact = gather_one(&*engine, Formula::Polygon, 1e-4, &source, receiver);
                close(exact.irradiance, expected, SINGLE, name);
                let hybrid = gather_one(&*engine, HYBRID, 1e-4, &source, receiver);
                close(hybrid.irradiance, expected, 1e-3 * expected, name);
                assert_eq!(hybrid.irradiance, hybrid.unoccluded);
                assert_eq!(hybrid.visibility, Some(1.0));
            }
        }
    }
}

#[test]
fn a_source_that_is_not_constant_gives_its_integral() {
    for corners in [&QUAD[..], &TRIANGLE[..]] {
        let source = linear(corners);
        for (receiver, name) in near_and_far() {
            let expected = integral(receiver, corners);
            for engine in engines(&[]) {
                let gather = gather_one(&*engine, HYBRID, 1e-4, &source, receiver);
                close(gather.irradiance, expected, 2e-3 * expected, name);
            }
        }
    }
}

#[test]
fn the_horizon_cuts_a_source_and_the_rest_counts_whole() {
    // With the height h the horizon lies at x = h on the source, which reaches from -0.5 to 0.5.
    for height in [0.4, 0.0, -0.4] {
        let normal = dvec3(-1.0, 0.0, height).normalize();
        let receiver = Receiver {
            irradiance: 0.0,
            point: DVec3::ZERO,
            normal,
        };
        let expected = eq_2(receiver, &QUAD);
        for engine in engines(&[]) {
            let gather = gather_one(&*engine, HYBRID, 1e-4, &constant(&QUAD), receiver);
            close(
                gather.irradiance,
                expected,
                1e-3 * expected,
                "above the horizon",
            );
            assert_eq!(gather.visibility, Some(1.0));
        }
    }
}

#[test]
fn nothing_arrives_from_a_source_that_looks_away_or_lies_below() {
    let above = Receiver {
        irradiance: 0.0,
        point: dvec3(0.2, 0.1, 2.0),
        normal: -DVec3::Z,
    };
    let turned = Receiver {
        irradiance: 0.0,
        point: DVec3::ZERO,
        normal: -DVec3::Z,
    };
    for receiver in [above, turned] {
        for engine in engines(&[]) {
            let gather = gather_one(&*engine, HYBRID, 1e-4, &constant(&QUAD), receiver);
            assert_eq!(
                gather,
                Gather::default(),
                "no light and no visibility index"
            );
        }
    }
}

fn near_and_far() -> [(Receiver, &'static str); 5] {
    let at = |x, y, z, normal: DVec3| Receiver {
        irradiance: 0.0,
        point: dvec3(x, y, z),
        normal: normal.normalize(),
    };
    [
        (at(0.1, 0.05, 0.95, DVec3::Z), "almost touching"),
        (at(0.2, 0.1, 0.0, DVec3::Z), "near"),
        (at(0.3, -0.4, 0.5, dvec3(-0.3, 0.5, 1.0)), "near and tilted"),
        (at(1.0, 1.0, -4.0, DVec3::Z), "at the five-times limit"),
        (at(-3.0, 2.0, -30.0, dvec3(0.3, 0.0, 1.0)), "far"),
    ]
}
