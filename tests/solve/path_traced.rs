//! Whole scenes against an independent, unbiased path tracer, whose noise (0.04 % to 0.2 % in the median) is taken out in
//! quadrature. Tables in `tests/data`.

use super::common::reference::{Deviation, table};
use super::{bundled, solved};
use radiosity::solver::Preset;

/// What may remain. Relative errors are not bounded where shadows are sharper than the preset's elements.
struct Bounds {
    n_rms: f64,
    rms_rel: Option<f64>,
    bias: f64,
}

fn assert_within(scene: &str, name: &str, preset: Preset, bounds: Bounds) {
    let solution = solved(&bundled(scene), preset.options());
    let deviation = Deviation::of(&solution, &table(name));
    assert_eq!(deviation.missed, 0);
    assert!(deviation.n_rms <= bounds.n_rms, "{deviation:?}");
    assert!(
        bounds
            .rms_rel
            .is_none_or(|bound| deviation.rms_rel <= bound),
        "{deviation:?}"
    );
    assert!(deviation.bias.abs() <= bounds.bias, "{deviation:?}");
}

#[test]
fn cornell_box_draft() {
    let bounds = Bounds {
        n_rms: 0.06,
        rms_rel: Some(0.15),
        bias: 0.02,
    };
    assert_within(
        "cornell-box",
        "cornell_irradiance.csv",
        Preset::Draft,
        bounds,
    );
}

#[test]
fn cornell_box_standard() {
    let bounds = Bounds {
        n_rms: 0.02,
        rms_rel: Some(0.05),
        bias: 0.007,
    };
    assert_within(
        "cornell-box",
        "cornell_irradiance.csv",
        Preset::Standard,
        bounds,
    );
}

#[test]
fn shadow_draft() {
    let bounds = Bounds {
        n_rms: 0.10,
        rms_rel: None,
        bias: 0.03,
    };
    assert_within("shadow", "shadow_irradiance.csv", Preset::Draft, bounds);
}

#[test]
fn shadow_standard() {
    let bounds = Bounds {
        n_rms: 0.04,
        rms_rel: None,
        bias: 0.01,
    };
    assert_within("shadow", "shadow_irradiance.csv", Preset::Standard, bounds);
}

#[test]
fn secondary_standard() {
    let bounds = Bounds {
        n_rms: 0.04,
        rms_rel: Some(0.10),
        bias: 0.01,
    };
    assert_within(
        "secondary",
        "secondary_irradiance.csv",
        Preset::Standard,
        bounds,
    );
}
