//! The error that a solve states of itself, against the one that it has.

use super::common::reference::{Deviation, table};
use super::{bundled, furnace, solved};
use radiosity::scene::Scene;
use radiosity::solver::{Audit, Options, Preset, Silent};
use radiosity::{Settings, solve_to_error};

fn audit(scene: &Scene, options: Options) -> Audit {
    let report = solved(scene, options).report;
    report.audit.expect("there is light")
}

#[test]
fn the_estimate_is_within_a_factor_of_two_of_the_true_error() {
    for name in ["cornell-box", "shadow", "secondary", "geometry", "huge"] {
        let samples = table(&format!("{}_irradiance.csv", name.trim_end_matches("-box")));
        for preset in [Preset::Draft, Preset::Standard] {
            let solution = solved(&bundled(name), preset.options());
            let estimate = solution.report.audit.expect("there is light").n_rms;
            let error = Deviation::of(&solution, &samples).n_rms;
            assert!(
                (0.5..=2.0).contains(&(estimate / error)),
                "{name}, {preset:?}: estimated {estimate:.4}, true {error:.4}"
            );
        }
    }
}

#[test]
fn a_target_is_reached() {
    let scene = bundled("secondary");
    let samples = table("secondary_irradiance.csv");
    for target in [0.04, 0.01] {
        let settings = Settings::default();
        let solution =
            solve_to_error(&scene, &settings, target, &|o| o, &mut Silent).expect("can be solved");
        let report = solution.report.target.expect("was asked for");
        assert!(report.reached, "{report:?}");
        let error = Deviation::of(&solution, &samples).n_rms;
        assert!(error <= 1.5 * target, "{error} for {target}");
    }
}

#[test]
fn a_target_out_of_reach_is_said_to_be() {
    let limits = |options: Options| Options {
        max_shots: Some(1),
        ..options
    };
    let solution = solve_to_error(
        &bundled("secondary"),
        &Settings::default(),
        0.001,
        &limits,
        &mut Silent,
    )
    .expect("can be solved");
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
