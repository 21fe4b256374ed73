//! Whole scenes against path tracing, whose noise (0.01 % to 0.2 % in the median) is taken out in quadrature. Tables in
//! `tests/data`: Cornell box, Shadow and Secondary by a program that shares nothing with this one, Geometry and Huge by
//! `examples/path_trace.rs`, which shares with the solver the reader of scenes and the engine that traces rays.

use super::by_preset;
use super::common::reference::{Deviation, table};
use radiosity::solver::Preset::{self, Draft, Standard};

fn deviation(scene: &'static str, preset: Preset) -> Deviation {
    let solution = by_preset(scene, preset);
    let name = scene.trim_end_matches("-box");
    let deviation = Deviation::of(&solution, &table(&format!("{name}_irradiance.csv")));
    assert_eq!(deviation.missed, 0);
    deviation
}

/// Of the Global Illumination Test Scenes; relative errors are not bounded where shadows are sharper than the elements.
fn assert_test_scene(scene: &'static str) {
    for (preset, n_rms, bias) in [(Draft, 0.10, 0.03), (Standard, 0.04, 0.01)] {
        let found = deviation(scene, preset);
        assert!(found.n_rms <= n_rms, "{preset:?}: {found:?}");
        assert!(found.bias.abs() <= bias, "{preset:?}: {found:?}");
    }
}

#[test]
fn cornell_box() {
    for (preset, n_rms, rms_rel, bias) in [(Draft, 0.06, 0.15, 0.02), (Standard, 0.02, 0.05, 0.007)]
    {
        let found = deviation("cornell-box", preset);
        assert!(found.n_rms <= n_rms, "{preset:?}: {found:?}");
        assert!(found.rms_rel <= rms_rel, "{preset:?}: {found:?}");
        assert!(found.bias.abs() <= bias, "{preset:?}: {found:?}");
    }
}

#[test]
fn shadow() {
    assert_test_scene("shadow");
}

#[test]
fn secondary() {
    assert_test_scene("secondary");
}

#[test]
fn geometry() {
    assert_test_scene("geometry");
}

#[test]
fn huge() {
    assert_test_scene("huge");
}
