//! A solve that is left and taken up again: the same bits, no work twice.

use super::common::ENGINE;
use super::common::sessions::Batches;
use super::{bits, bundled, draft, engines, file, solved, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::{Prober, Solution};
use radiosity::solver::{Options, Preset, Silent, StopReason};
use radiosity::visibility::EngineChoice;
use radiosity::{Run, Settings, SolveError, solve};

/// Bytes of a solution file before its payload.
pub(super) const HEADER: usize = 24;

pub(super) fn settings(options: Options, engine: EngineChoice, threads: usize) -> Settings {
    Settings {
        options,
        engine,
        threads,
        ..Settings::default()
    }
}

/// Solves to an error.
fn to(n_rms: f64) -> Settings {
    Settings {
        target: Some(radiosity::Target {
            n_rms,
            fixed: Default::default(),
        }),
        ..settings(draft(), ENGINE, 0)
    }
}

/// Solves in sessions of so many batches; between them there is nothing but the file. Returns the number of sessions as well.
pub(super) fn in_sessions(scene: &Scene, how: &Settings, batches: usize) -> (Solution, usize) {
    let mut run = Run::new(scene.clone(), how.clone()).expect("can be solved");
    for session in 1.. {
        let reason = run.go(&mut Batches(batches)).expect("can be solved");
        if reason != StopReason::Interrupted {
            return (run.finish(), session);
        }
        let bytes = file(&run.finish());
        let solution = Solution::decode(&bytes).expect("was just written");
        assert!(file(&solution) == bytes, "a file is read as it was written");
        run = Run::resume(solution, how.clone()).expect("can be resumed");
    }
    unreachable!("sessions go on until the solve ends")
}

#[test]
fn a_solve_in_sessions_ends_with_the_same_bits() {
    for (name, batches) in [("geometry", 1), ("cornell-box", 7), ("emission", 40)] {
        let scene = bundled(name);
        for engine in engines() {
            let whole = bits(solved_by(&scene, draft(), engine, 1));
            let (solution, sessions) = in_sessions(&scene, &settings(draft(), engine, 1), batches);
            assert!(sessions > 4, "{name}: {sessions}");
            assert!(bits(solution) == whole, "{name} by {engine}");
        }
    }
}

#[test]
fn what_was_left_on_one_thread_goes_on_with_seven() {
    let scene = bundled("geometry");
    let engine = EngineChoice::Obvhs;
    let whole = solved_by(&scene, draft(), engine, 7);
    let mut run = Run::new(scene, settings(draft(), engine, 1)).expect("can be solved");
    run.go(&mut Batches(20)).expect("can be solved");
    let mut run = Run::resume(run.finish(), settings(draft(), engine, 7)).expect("can be resumed");
    run.go(&mut Silent).expect("can be solved");
    assert!(bits(run.finish()) == bits(whole));
}

#[test]
fn a_target_in_sessions_is_reached_by_the_same_rounds() {
    let how = to(0.03);
    let scene = bundled("secondary");
    let whole = radiosity::solve(&scene, &how, &mut Silent).expect("can be solved");
    // One stop, in the last round or the only one.
    let mut run = Run::new(scene, how.clone()).expect("can be solved");
    run.go(&mut Batches(30)).expect("can be solved");
    let state = run.set_aside().unwrap_or(run.solution());
    let left = Solution::decode(&file(state)).expect("was just written");
    let mut run = Run::resume(left, how).expect("can be resumed");
    run.go(&mut Silent).expect("can be solved");
    assert!(bits(run.finish()) == bits(whole));
}

#[test]
fn a_round_that_is_left_twice_does_not_replace_the_one_before() {
    let how = to(0.003);
    let again = |solution: &Solution| Solution::decode(&file(solution)).expect("was just written");
    let mut run = Run::new(bundled("secondary"), how.clone()).expect("can be solved");
    while run.set_aside().is_none() {
        let reason = run.go(&mut Batches(10)).expect("can be solved");
        assert_eq!(reason, StopReason::Interrupted, "one round is not enough");
    }
    let state = again(run.set_aside().expect("is there"));
    let before = again(&run.finish());
    let mut run = Run::resume(state, how).expect("can be resumed");
    run.fall_back_on(before.clone());
    run.go(&mut Batches(2)).expect("can be solved");
    assert!(run.set_aside().is_some());
    assert_eq!(run.finish().light, before.light);
}

/// On the coarse mesh of another error the first round misses; how far says nothing of what its options come to.
#[test]
fn a_target_after_another_is_reached_as_by_a_solve_from_nothing() {
    let scene = bundled("secondary");
    let coarse = radiosity::solve(&scene, &to(0.2), &mut Silent).expect("can be solved");
    let anew = radiosity::solve(&scene, &to(0.015), &mut Silent).expect("can be solved");
    let mut run = Run::resume(coarse, to(0.015)).expect("can be resumed");
    run.go(&mut Silent).expect("can be solved");
    let resumed = run.finish();
    let rounds = |of: &Solution| of.report.target.as_ref().map(|target| target.rounds);
    assert_eq!(rounds(&resumed), rounds(&anew).map(|rounds| rounds + 1));
    assert_eq!(resumed.light, anew.light);
}

/// What an interrupted solve leaves adds up: light that is under way has not been forgotten.
#[test]
fn the_ledger_closes_wherever_a_solve_is_left() {
    let scene = bundled("cornell-box");
    let mut run = Run::new(scene, settings(draft(), ENGINE, 0)).expect("can be solved");
    let mut within_a_shot = 0;
    let mut shots = 0;
    while run.go(&mut Batches(2)).expect("can be solved") == StopReason::Interrupted {
        let report = &run.solution().report;
        let power = &report.power;
        assert!(power.residual.abs() < 0.05 * power.emitted, "{power:?}");
        within_a_shot += usize::from(report.shots == shots);
        shots = report.shots;
    }
    assert!(
        within_a_shot > 3,
        "some were left between passes of refinement"
    );
}

#[test]
fn a_finished_solve_goes_on_to_a_tighter_tolerance() {
    let scene = bundled("cornell-box");
    let loose = Options {
        tolerance: 0.2,
        regather: false,
        ..Preset::Draft.options()
    };
    let tight = Options {
        tolerance: 0.01,
        ..loose.clone()
    };
    let first = solved(&scene, loose);
    let shots = first.report.shots;
    let mut run = Run::resume(first, settings(tight.clone(), ENGINE, 0)).expect("can be resumed");
    assert_eq!(run.go(&mut Silent).ok(), Some(StopReason::Converged));
    let mut resumed = run.finish();
    let with = std::mem::take(&mut resumed.report.resumed_with);
    assert_eq!(with, [format!("other options after {shots} shots")]);
    let at_once = solved(&scene, tight);
    assert!(resumed.report.shots > shots);
    assert!(bits(resumed) == bits(at_once), "whatever the tolerance");
}

#[test]
fn a_finished_solve_with_the_same_options_has_nothing_to_do() {
    let first = solved(&bundled("geometry"), draft());
    let known = bits(first.clone());
    let mut run = Run::resume(first, settings(draft(), ENGINE, 0)).expect("can be resumed");
    assert_eq!(run.go(&mut Silent).ok(), Some(StopReason::Converged));
    assert!(bits(run.finish()) == known);
}

#[test]
fn a_file_of_the_first_format_is_shown_but_not_continued() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/format-1");
    let solution = Solution::read(&path.join("solution.rad")).expect("is still read");
    assert_eq!((solution.report.shots, solution.report.vertices), (2, 164));
    assert_eq!(solution.report.options.limits.max_depth, 2);
    // The middle of the floor, 1 m below a lamp of 1 m² and π W/m²: C-14's form factor of parallel squares, at a point.
    let middle = Prober::new(&solution).probe(DVec3::new(0.5, 0.0, 0.5), DVec3::Y);
    let irradiance = f64::from(middle.expect("lies on the floor").irradiance.x);
    let leg = 0.5 / 1.25f64.sqrt();
    let factor = 4.0 / std::f64::consts::PI * leg * leg.atan();
    assert!(
        (irradiance / (std::f64::consts::PI * factor) - 1.0).abs() < 0.02,
        "{irradiance}"
    );
    let error = Run::resume(solution, Settings::default()).err();
    assert!(matches!(error, Some(SolveError::NotKept)));
}

/// Such a file is one of today without the list that it ends with.
#[test]
fn a_file_of_the_second_format_is_continued() {
    let how = settings(draft(), EngineChoice::Obvhs, 1);
    let scene = bundled("emission");
    let mut run = Run::new(scene.clone(), how.clone()).expect("can be solved");
    run.go(&mut Batches(3)).expect("can be solved");
    let mut old = file(&run.finish());
    assert_eq!(old.pop(), Some(0), "no surface is beside a gap");
    let payload = &old[HEADER..];
    let (length, checksum) = (payload.len() as u64, crc32fast::hash(payload));
    old[8..12].copy_from_slice(&2u32.to_le_bytes());
    old[12..20].copy_from_slice(&length.to_le_bytes());
    old[20..24].copy_from_slice(&checksum.to_le_bytes());
    let solution = Solution::decode(&old).expect("is still read");
    let mut run = Run::resume(solution, how.clone()).expect("can be resumed");
    run.go(&mut Silent).expect("can be solved");
    let whole = solve(&scene, &how, &mut Silent).expect("can be solved");
    assert_eq!(run.finish().light.irradiance, whole.light.irradiance);
}
