//! Solving until the estimated error is small enough.

use super::{Settings, SolveError, solve};
use crate::scene::Scene;
use crate::solution::{Solution, TargetReport};
use crate::solver::{Observer, Options, StopReason};
use std::time::Instant;

/// The most solves on the way to a target.
const ROUNDS: usize = 5;

/// Points of the estimate at least.
const FEWEST_POINTS: usize = 256;

/// The strictest options that are tried; see [`Options::at`].
const STRICTEST: f64 = 2.5;

/// The loosest.
const LOOSEST: f64 = -0.5;

/// The nRMS of a plain scene, about, at strictness 0 and how many times less it is at 1: where the first solve starts.
const USUAL: (f64, f64) = (0.025, 5.0);

/// Solves `scene` with thresholds that keep the estimated nRMS error of the irradiance below `target`: first with those that
/// usually do, then with stricter ones in proportion to what was missed. `adjust` has the last word on the options of each
/// round. The report's `target` says whether it was reached; if not, the solution is the best there was.
pub fn solve_to_error(
    scene: &Scene,
    settings: &Settings,
    target: f64,
    adjust: &dyn Fn(Options) -> Options,
    observer: &mut dyn Observer,
) -> Result<Solution, SolveError> {
    let started = Instant::now();
    let limit = settings.options.time_limit;
    let mut strictness = ((USUAL.0 / target).ln() / USUAL.1.ln()).clamp(LOOSEST, STRICTEST);
    let mut best: Option<Solution> = None;
    let mut rounds = 0;
    loop {
        rounds += 1;
        let mut options = adjust(Options::at(strictness));
        options.audit_points = options.audit_points.max(FEWEST_POINTS);
        options.time_limit = limit.map(|limit| limit.saturating_sub(started.elapsed()));
        let settings = Settings {
            options,
            ..settings.clone()
        };
        let mut solution = solve(scene, &settings, observer)?;
        let stopped = solution.report.stop_reason != StopReason::Converged;
        let estimate = solution.report.audit.map_or(0.0, |audit| audit.n_rms);
        solution.report.target = Some(TargetReport {
            n_rms: target,
            reached: estimate <= target && !stopped,
            rounds,
        });
        if let Some(previous) = best.take().filter(|_| stopped) {
            return Ok(stopped_after(previous, solution));
        }
        if estimate <= target || stopped || strictness >= STRICTEST || rounds == ROUNDS {
            return Ok(solution);
        }
        // A little more than what is missing, so that one more round is enough.
        strictness += (estimate / target).ln() / USUAL.1.ln() * 1.1 + 0.08;
        strictness = strictness.min(STRICTEST);
        best = Some(solution);
    }
}

/// A complete solution is worth more than the beginning of a stricter one.
fn stopped_after(mut complete: Solution, stopped: Solution) -> Solution {
    complete.report.stop_reason = stopped.report.stop_reason;
    complete
}
