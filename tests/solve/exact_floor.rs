//! The floor of the scene Emission, whose light is known in closed form: one square of light on the left, the same cut into
//! a hundred on the right, both standing on the floor.
//!
//! Compared 10 cm and more from the lights: nearer, the exact irradiance falls by half within one element.

use super::common::closed_form::emission_floor;
use super::common::reference::Deviation;
use super::{bundled, by_preset, solved};
use glam::DVec3;
use radiosity::mesh::MeshLimits;
use radiosity::solution::Prober;
use radiosity::solver::{FormFactorRule, Options, Preset};

fn floor_by(preset: Preset) -> Deviation {
    let deviation = Deviation::of(&by_preset("emission", preset), &emission_floor());
    assert_eq!(deviation.missed, 0);
    deviation
}

#[test]
fn a_standard_solve_has_the_exact_floor() {
    let deviation = floor_by(Preset::Standard);
    assert!(deviation.max_rel <= 0.015, "{deviation:?}");
    assert!(deviation.rms_rel <= 0.003, "{deviation:?}");
    assert!(deviation.bias.abs() <= 0.001, "{deviation:?}");
}

#[test]
fn an_accurate_solve_has_it_to_a_third_of_a_percent() {
    let deviation = floor_by(Preset::Accurate);
    assert!(deviation.max_rel <= 0.003, "{deviation:?}");
    assert!(deviation.rms_rel <= 0.001, "{deviation:?}");
    assert!(deviation.bias.abs() <= 0.001, "{deviation:?}");
}

/// Irradiance is interpolated linearly, so half the element is a quarter of the error; half a metre and more from the lights,
/// where the coarsest of these meshes follows the curve already.
#[test]
fn uniform_refinement_converges_with_the_square_of_the_size() {
    let far: Vec<_> = (emission_floor().into_iter())
        .filter(|s| (2.0 - s.point.x.abs()).hypot((s.point.z.abs() - 0.5).max(0.0)) >= 0.5)
        .collect();
    let error = |size: f64| {
        let options = Options {
            limits: MeshLimits {
                initial_size: size,
                ..Preset::Standard.options().limits
            },
            meshing_power: f64::INFINITY,
            form_factor: FormFactorRule::Polygon,
            ..Preset::Standard.options()
        };
        Deviation::of(&solved(&bundled("emission"), options), &far).n_rms
    };
    let errors = [1.0 / 16.0, 1.0 / 32.0, 1.0 / 64.0].map(error);
    for pair in errors.windows(2) {
        assert!((3.6..4.4).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

/// Each of the hundred brings a two-hundredth of the power; what they do to the mesh must add up.
#[test]
fn a_hundred_small_lights_light_the_floor_as_one_large_one() {
    let solution = by_preset("emission", Preset::Standard);
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
