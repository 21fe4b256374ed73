//! The floor of the scene Emission, whose light is known in closed form: one square of light on the left, the same cut into
//! a hundred on the right, both standing on the floor.
//!
//! Compared 10 cm and more from the lights: nearer, the exact irradiance falls by half within one element.

use super::common::closed_form::emission_floor;
use super::common::reference::Deviation;
use super::{bundled, solved};
use glam::DVec3;
use radiosity::solution::Prober;
use radiosity::solver::Preset;

/// The bounds are what ε_r and the smallest element of the preset allow: most of the error lies next to the lights.
#[test]
fn a_standard_solve_has_the_exact_floor() {
    let solution = solved(&bundled("emission"), Preset::Standard.options());
    let deviation = Deviation::of(&solution, &emission_floor());
    assert_eq!(deviation.missed, 0);
    assert!(deviation.n_rms <= 0.012, "{deviation:?}");
    assert!(deviation.rms_rel <= 0.02, "{deviation:?}");
    assert!(deviation.bias.abs() <= 0.005, "{deviation:?}");
    assert!(deviation.max_rel <= 0.15, "{deviation:?}");
}

/// Each of the hundred brings a two-hundredth of the power; what they do to the mesh must add up.
#[test]
fn a_hundred_small_lights_light_the_floor_as_one_large_one() {
    let solution = solved(&bundled("emission"), Preset::Standard.options());
    let prober = Prober::new(&solution);
    let samples = emission_floor();
    let mean = samples.iter().map(|s| s.irradiance.x).sum::<f64>() / samples.len() as f64;
    let difference = |point: DVec3| {
        let mirrored = DVec3::new(-point.x, point.y, point.z);
        let [a, b] = [point, mirrored].map(|p| {
            prober
                .probe(p, DVec3::Y)
                .map(|probe| f64::from(probe.irradiance.x))
        });
        a.zip(b).map(|(a, b)| (a - b) / mean)
    };
    let differences: Vec<f64> = samples.iter().filter_map(|s| difference(s.point)).collect();
    assert_eq!(differences.len(), samples.len());
    let rms = (differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64).sqrt();
    assert!(rms <= 0.015, "{rms}");
}
