//! Solving until the estimated error is small enough: rounds with stricter and stricter options.

use super::SolveError;
use crate::solution::TargetReport;
use crate::solver::{Changes, Options};

/// The most solves on the way to a target.
const ROUNDS: usize = 5;

/// Points of the estimate at least.
const FEWEST_POINTS: usize = 256;

/// The strictest options that are tried; see [`Options::at`].
const STRICTEST: f64 = 2.5;

/// The loosest.
const LOOSEST: f64 = -1.0;

/// The estimated nRMS of the Cornell box, about, at strictness -1, 0, 1 and 2: where the first solve starts.
const USUAL: [f64; 4] = [0.034, 0.0112, 0.0052, 0.0017];

/// How many times less it is a step further on.
const STEP: f64 = 2.2;

/// An error to be reached, in place of thresholds: the scene is solved with those that usually do, then with stricter ones in
/// proportion to what was missed. The report's `target` says whether it was reached; if not, the solution is the best there was.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The estimated nRMS error of the irradiance is to be below this.
    pub n_rms: f64,
    /// Options that are not for the target to choose.
    pub fixed: Changes,
}

impl Target {
    /// What the report says before the first round.
    pub(super) fn report(&self) -> TargetReport {
        let above = USUAL.iter().filter(|usual| **usual > self.n_rms).count();
        let step = above.clamp(1, USUAL.len() - 1);
        let [from, to] = [USUAL[step - 1], USUAL[step]];
        let strictness = step as f64 - 2.0 + (from / self.n_rms).ln() / (from / to).ln();
        TargetReport {
            n_rms: self.n_rms,
            reached: false,
            rounds: 1,
            strictness: strictness.clamp(LOOSEST, STRICTEST),
            inherited: false,
            fixed: self.fixed.clone(),
        }
    }
}

impl TargetReport {
    /// The options of the round that is under way.
    pub(super) fn options(&self) -> Result<Options, SolveError> {
        let found = self.n_rms;
        if found.is_nan() || found <= 0.0 {
            return Err(SolveError::Option(format!(
                "n_rms is {found}; expected more than 0"
            )));
        }
        let options = Options::at(self.strictness).with(&self.fixed);
        let mut options = options.map_err(SolveError::Option)?;
        options.audit_points = options.audit_points.max(FEWEST_POINTS);
        Ok(options)
    }

    /// Takes in what a complete round has come to; whether another is worth it, with stricter options.
    pub(super) fn needs_another(&mut self, estimate: f64) -> bool {
        self.reached = estimate <= self.n_rms;
        if self.reached || self.strictness >= STRICTEST || self.rounds == ROUNDS {
            return false;
        }
        self.rounds += 1;
        // What the mesh of other options comes to says nothing of these.
        if std::mem::take(&mut self.inherited) {
            return true;
        }
        // A little more than what is missing, so that one more round is enough.
        self.strictness += (estimate / self.n_rms).ln() / STEP.ln() * 1.1 + 0.08;
        self.strictness = self.strictness.min(STRICTEST);
        true
    }
}
