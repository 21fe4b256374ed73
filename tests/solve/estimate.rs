//! The error that a solve states of itself, against the one that it has.

use super::common::reference::{Deviation, table};
use super::{bundled, by_preset, furnace, solved};
use radiosity::scene::Scene;
use radiosity::solution::{Prober, Solution};
use radiosity::solver::{Audit, Changes, Options, Preset, Silent};
use radiosity::{Settings, Target, solve};

fn audit(scene: &Scene, options: Options) -> Audit {
    let report = solved(scene, options).report;
    report.audit.expect("there is light")
}

#[test]
fn the_estimate_is_within_a_factor_of_two_of_the_true_error() {
    for name in ["cornell-box", "shadow", "secondary", "geometry", "huge"] {
        let samples = table(&format!("{}_irradiance.csv", name.trim_end_matches("-box")));
        for preset in [Preset::Draft, Preset::Standard] {
            let solution = by_preset(name, preset);
            let estimate = solution.report.audit.expect("there is light").n_rms;
            let error = Deviation::of(&solution, &samples).n_rms;
            assert!(
                (0.5..=2.0).contains(&(estimate / error)),
                "{name}, {preset:?}: estimated {estimate:.4}, true {error:.4}"
            );
        }
    }
}

/// Places are sorted by what their elements are said to be off: the quarter with the largest estimates has most of the error,
/// and in each half the estimate is of the size of the error.
#[test]
fn elements_that_are_said_to_be_off_are() {
    for (name, file) in [
        ("cornell-box", "cornell_irradiance.csv"),
        ("shadow", "shadow_irradiance.csv"),
        ("geometry", "geometry_irradiance.csv"),
    ] {
        // The 256 points of the preset leave a factor of two to chance: half of the error of a half is at a few places.
        let options = Options {
            audit_points: 4096,
            ..Preset::Standard.options()
        };
        let solution = solved(&bundled(name), options);
        let prober = Prober::new(&solution);
        let mut squares: Vec<(f64, f64)> = table(file)
            .iter()
            .map(|sample| {
                let probe = prober
                    .probe(sample.point, sample.normal)
                    .expect("on a surface");
                let error = probe.irradiance.as_dvec3() - sample.irradiance;
                let noise = sample.standard_error.length_squared();
                let estimate = solution.element_error(probe.element).expect("was audited");
                (
                    estimate.powi(2),
                    (error.length_squared() - noise).max(0.0) / 3.0,
                )
            })
            .collect();
        squares.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sums = |part: &[(f64, f64)]| {
            let sum = |of: fn(&(f64, f64)) -> f64| part.iter().map(of).sum::<f64>();
            (sum(|s| s.0), sum(|s| s.1))
        };
        let (_, all) = sums(&squares);
        let (_, worst) = sums(&squares[squares.len() * 3 / 4..]);
        assert!(worst > 0.35 * all, "{name}: {}", worst / all);
        for half in squares.chunks(squares.len().div_ceil(2)) {
            let (estimated, found) = sums(half);
            let ratio = (estimated / found).sqrt();
            assert!((0.4..=2.5).contains(&ratio), "{name}: {ratio}");
        }
    }
}

fn towards(n_rms: f64, fixed: Changes) -> Solution {
    let settings = Settings {
        target: Some(Target { n_rms, fixed }),
        ..Settings::default()
    };
    solve(&bundled("secondary"), &settings, &mut Silent).expect("can be solved")
}

#[test]
fn a_target_is_reached() {
    let samples = table("secondary_irradiance.csv");
    for target in [0.04, 0.01] {
        let solution = towards(target, Changes::new());
        let report = solution.report.target.as_ref().expect("was asked for");
        assert!(report.reached, "{report:?}");
        let error = Deviation::of(&solution, &samples).n_rms;
        assert!(error <= 1.5 * target, "{error} for {target}");
    }
}

#[test]
fn a_target_out_of_reach_is_said_to_be() {
    let one_shot = Changes::from_iter([("max_shots".to_owned(), 1.into())]);
    let solution = towards(0.001, one_shot);
    assert!(!solution.report.target.expect("was asked for").reached);
}

#[test]
fn what_is_sent_and_what_is_received_add_up_to_one_in_a_closed_room() {
    let audit = audit(&furnace::cuboid(), Preset::Standard.options());
    let sent = audit.sent_sum.expect("all light was gathered again");
    for span in [audit.received_sum, sent] {
        assert!(
            (span.mean - 1.0).abs() < 1e-3 && span.least > 0.99 && span.most < 1.01,
            "{span:?}"
        );
    }
}

#[test]
fn looking_changes_nothing() {
    let scene = bundled("secondary");
    let blind = Options {
        audit_points: 0,
        ..Options::default()
    };
    let [with, without] = [Options::default(), blind].map(|options| solved(&scene, options));
    assert_eq!(with.light, without.light);
    assert_eq!(without.report.audit, None);
}
