//! Whole scenes against an independent, unbiased path tracer, whose noise (0.04 % to 0.2 % in the median) is taken out in
//! quadrature. Tables in `tests/data`.

use super::common::reference::{Deviation, read};
use super::{bundled, solved};
use radiosity::solver::Preset;
use std::path::Path;

/// Bounds of nRMS, rmsRel and |bias|.
fn assert_within(scene: &str, table: &str, preset: Preset, [n_rms, rms_rel, bias]: [f64; 3]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(table);
    let samples = read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let solution = solved(&bundled(scene), preset.options());
    let deviation = Deviation::of(&solution, &samples);
    eprintln!("{scene} {preset:?} {deviation:?} {}", solution.report.seconds.solve);
    assert_eq!(deviation.missed, 0);
    assert!(deviation.n_rms <= n_rms, "{deviation:?}");
    assert!(deviation.rms_rel <= rms_rel, "{deviation:?}");
    assert!(deviation.bias.abs() <= bias, "{deviation:?}");
}

#[test]
fn cornell_box_draft() {
    assert_within("cornell-box", "cornell_irradiance.csv", Preset::Draft, [0.06, 0.15, 0.02]);
}

#[test]
fn cornell_box_standard() {
    assert_within("cornell-box", "cornell_irradiance.csv", Preset::Standard, [0.02, 0.05, 0.007]);
}

#[test]
fn shadow_draft() {
    assert_within("shadow", "shadow_irradiance.csv", Preset::Draft, [0.10, f64::INFINITY, 0.03]);
}

#[test]
fn shadow_standard() {
    assert_within("shadow", "shadow_irradiance.csv", Preset::Standard, [0.04, f64::INFINITY, 0.01]);
}

#[test]
fn secondary_draft() {
    assert_within("secondary", "secondary_irradiance.csv", Preset::Draft, [0.10, f64::INFINITY, 0.03]);
}

#[test]
fn secondary_standard() {
    assert_within("secondary", "secondary_irradiance.csv", Preset::Standard, [0.04, f64::INFINITY, 0.01]);
}
