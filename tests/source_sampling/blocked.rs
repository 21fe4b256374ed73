//! A blocker in between: rays, visibility indices, and what the thresholds are worth.

use crate::setup::*;
use glam::{DVec3, dvec3};
use radiosity::form_factor::{Gather, Receiver};
use radiosity::geometry::polygon;
use radiosity::radiometry::Spectrum;

#[test]
fn a_blocker_takes_away_what_lies_behind_it() {
    // A half-plane at half the height hides of the source what lies beyond twice its own edge.
    for (corners, edge) in [(&QUAD[..], 0.05), (&QUAD[..], 0.21), (&TRIANGLE[..], -0.1)] {
        let blocker = half_plane(edge);
        let visible = cut(corners, 2.0 * edge);
        let receiver = Receiver {
            irradiance: 0.0,
            point: DVec3::ZERO,
            normal: DVec3::Z,
        };
        let expected = eq_2(receiver, &visible);
        let index = area(&visible) / area(corners);
        for engine in engines(&blocker) {
            let gather = gather_one(&*engine, HYBRID, 1e-4, &constant(corners), receiver);
            close(gather.irradiance, expected, 0.02 * expected, "irradiance");
            close(
                gather.unoccluded,
                eq_2(receiver, corners),
                1e-3,
                "unoccluded",
            );
            let visibility = f64::from(gather.visibility.expect("above the horizon"));
            assert!((visibility - index).abs() < 0.01, "{visibility} {index}");
        }
    }
}

#[test]
fn what_is_hidden_wholly_gives_nothing() {
    for engine in engines(&half_plane(-3.0)) {
        let receiver = Receiver {
            irradiance: 0.0,
            point: DVec3::ZERO,
            normal: DVec3::Z,
        };
        let gather = gather_one(&*engine, HYBRID, 1e-3, &constant(&QUAD), receiver);
        assert_eq!(
            (gather.irradiance, gather.visibility),
            (Spectrum::ZERO, Some(0.0))
        );
        assert!(gather.unoccluded.x > 0.1);
    }
}

#[test]
fn a_blocker_before_a_source_that_is_not_constant_hides_its_own_light() {
    let visible = cut(&QUAD, 0.2);
    let receiver = Receiver {
        irradiance: 0.0,
        point: DVec3::ZERO,
        normal: DVec3::Z,
    };
    let expected = integral(receiver, &visible);
    for engine in engines(&half_plane(0.1)) {
        let gather = gather_one(&*engine, HYBRID, 1e-4, &linear(&QUAD), receiver);
        close(
            gather.irradiance,
            expected,
            0.02 * expected,
            "the bright end is hidden",
        );
    }
}

#[test]
fn tighter_thresholds_have_smaller_errors() {
    let (blocker, receivers) = (half_plane(0.1), row_of_receivers(64));
    for engine in engines(&blocker) {
        let rms = |threshold: f64| {
            let gathers = gather(
                &*engine,
                threshold,
                &linear(&QUAD),
                &receivers,
                receivers.len(),
            );
            let error = |(gather, (receiver, _)): (&Gather, &(Receiver, u32))| {
                let line = 0.2 - receiver.point.x;
                f64::from(gather.irradiance.x) - integral(*receiver, &cut(&QUAD, line))
            };
            let squares = gathers.iter().zip(&receivers).map(error).map(|e| e * e);
            (squares.sum::<f64>() / receivers.len() as f64).sqrt()
        };
        let errors = [0.3, 0.03, 0.003, 0.0003].map(rms);
        assert!(
            errors.windows(2).all(|pair| pair[1] < 0.9 * pair[0]),
            "{errors:?}"
        );
        assert!(errors[3] < 0.05 * errors[0], "{errors:?}");
    }
}

#[test]
fn blocks_and_scratch_do_not_change_a_bit() {
    let (blocker, receivers) = (half_plane(0.1), row_of_receivers(75));
    let source = linear(&QUAD);
    for engine in engines(&blocker) {
        let all = gather(&*engine, 1e-3, &source, &receivers, receivers.len());
        assert!(
            all.iter()
                .any(|g| g.visibility.is_some_and(|v| v > 0.0 && v < 1.0))
        );
        for block in [1, 7, 32] {
            assert_eq!(
                gather(&*engine, 1e-3, &source, &receivers, block),
                all,
                "blocks of {block}"
            );
        }
        let mut reversed = receivers.clone();
        reversed.reverse();
        let mut back = gather(&*engine, 1e-3, &source, &reversed, 32);
        back.reverse();
        assert_eq!(back, all, "{}", engine.info().name);
    }
}

/// Points along x below the source: before, in and behind the shadow line of the half-plane.
fn row_of_receivers(count: u32) -> Vec<(Receiver, u32)> {
    let point = |i: u32| dvec3(f64::from(i) / f64::from(count) * 1.6 - 0.8, 0.15, 0.0);
    (0..count)
        .map(|i| {
            (
                Receiver {
                    irradiance: 0.0,
                    point: point(i),
                    normal: DVec3::Z,
                },
                i,
            )
        })
        .collect()
}

/// A blocker at half the height that reaches from x = `edge` far beyond the source.
fn half_plane(edge: f64) -> [DVec3; 4] {
    [
        dvec3(edge, -9.0, 0.5),
        dvec3(9.0, -9.0, 0.5),
        dvec3(9.0, 9.0, 0.5),
        dvec3(edge, 9.0, 0.5),
    ]
}

/// The part of a source on the left of x = `line`.
fn cut(corners: &[DVec3], line: f64) -> Vec<DVec3> {
    polygon::clip(corners, |p| line - p.x).corners().to_vec()
}

fn area(corners: &[DVec3]) -> f64 {
    polygon::vector_area(corners).length()
}
