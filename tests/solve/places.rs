//! Size and place of a scene do not matter: there is no epsilon in metres.

use super::common::reference::{Deviation, read};
use super::{bundled, draft, solved};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solver::Options;
use std::path::Path;

/// The Cornell box with every length multiplied, then moved; solved, and held against the box as it is.
fn deviation(factor: f64, extents: f64) -> Deviation {
    let options = Options { max_shots: Some(40), ..draft() };
    let original = bundled("cornell-box");
    let (low, high) = original.bounds();
    let shift = DVec3::new(1.0, -0.5, 0.25) * extents * (high - low).max_element() * factor;
    let place = |point: DVec3| point * factor + shift;
    let moved = Scene { vertices: original.vertices.iter().map(|v| place(*v)).collect(), ..original.clone() };

    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cornell_irradiance.csv");
    let mut samples = read(&table).unwrap_or_else(|error| panic!("{error}"));
    let solution = solved(&original, options.clone());
    let prober = radiosity::solution::Prober::new(&solution);
    for sample in &mut samples {
        let here = prober.probe(sample.point, sample.normal).expect("lies on a surface");
        sample.irradiance = here.irradiance.as_dvec3();
        sample.standard_error = DVec3::ZERO;
        sample.point = place(sample.point);
    }
    let deviation = Deviation::of(&solved(&moved, options), &samples);
    eprintln!("{factor} {extents} {deviation:?}");
    deviation
}

/// Lengths in the frame differ by up to a factor of two, so rounding in single precision does; a decision may then
/// fall differently here and there.
fn assert_same(deviation: Deviation) {
    assert_eq!(deviation.missed, 0);
    assert!(deviation.n_rms <= 0.002, "{deviation:?}");
    assert!(deviation.bias.abs() <= 0.0005, "{deviation:?}");
}

#[test]
fn a_millionth_of_the_size() {
    assert_same(deviation(1e-6, 0.0));
}

#[test]
fn a_million_times_the_size() {
    assert_same(deviation(1e6, 0.0));
}

#[test]
fn a_million_extents_from_the_origin() {
    assert_same(deviation(1.0, 1e6));
}
