//! A run from its start, or where it was left, to its written results.

use super::CliError;
use super::error::Code;
use super::profile::profile;
use super::progress::{Look, Watch, is_due, is_interrupted};
use super::results::{CHECKPOINT, SOLUTION};
use super::say::{self, is_quiet};
use super::solve::{How, summary, write_beside};
use crate::output::write_atomically;
use crate::render::View;
use crate::solution::Solution;
use crate::solver::StopReason;
use crate::threads::pool;
use crate::{Run, SolveError};
use std::path::Path;
use std::time::{Duration, Instant};

#[cfg(feature = "viewer")]
pub(super) use super::window::Watching;

/// Who looks on sees no more than this often what has become of the light.
const FRAME: Duration = Duration::from_millis(100);

/// Checkpoints take at most this share of the time, and so do pictures: where one takes longer, they become fewer.
const SHARE: f64 = 0.05;

/// Where the results go, and how they are come by.
pub(super) struct Session<'a> {
    pub output: &'a Path,
    pub how: &'a How,
    pub started: Instant,
    /// Warnings of the report that have been shown.
    pub known_warnings: usize,
}

/// Somebody who looks on while a solve converges.
pub(super) trait Audience {
    /// Whether there is still somebody.
    fn is_there(&self) -> bool;
    /// Shows what there is.
    fn see(&self, so_far: &Solution);
}

/// A window that this program cannot open.
#[cfg(not(feature = "viewer"))]
pub(super) enum Watching {}

#[cfg(not(feature = "viewer"))]
impl Watching {
    pub fn new() -> Result<Self, CliError> {
        Err(super::view::without_window())
    }

    fn around(self, _: &Session, _: Run) -> Result<Code, CliError> {
        match self {}
    }
}

impl Session<'_> {
    /// Goes on to the end, or until it is interrupted, and writes what there is; in a window if there is to be one.
    pub fn complete(&self, run: Run, watching: Option<Watching>) -> Result<Code, CliError> {
        match watching {
            Some(window) => window.around(self, run),
            None => self.finish(run, None),
        }
    }

    /// The same, before an audience. What it sees does not change what is computed.
    pub fn finish(&self, mut run: Run, audience: Option<&dyn Audience>) -> Result<Code, CliError> {
        run.reserve(self.pictures(run.solution()))?;
        // Before the solve, whose result would be lost if they could not be started.
        let pool = pool(self.how.threads).map_err(SolveError::from)?;
        let mut watch = Watch::new(run.solution().report.options.tolerance, self.how.progress);
        self.solve(&mut run, &mut watch, audience)?;
        let set_aside = run.set_aside();
        if let Some(state) = set_aside {
            self.save(state)?;
        }
        let is_left = set_aside.is_some();
        let mut solution = run.finish();
        present(audience, &solution);
        self.warn(&solution);
        let started = Instant::now();
        // The solution is written by one thread; others make triangles of it meanwhile.
        let file = self.output.join(SOLUTION);
        let (written, lit) = pool.install(|| {
            let write = || write_atomically(&file, |out| solution.write(out));
            let is_shown = !self.how.formats.0.is_empty() || !self.how.no_pictures;
            rayon::join(write, || is_shown.then(|| solution.lit_mesh()))
        });
        written?;
        if !is_left {
            // It is in the solution now, or belongs to a run before this one; `resume` takes it before a solution, so it goes even if
            // nothing else can be written.
            let _ = std::fs::remove_file(self.output.join(CHECKPOINT));
        }
        let place = (self.output, started);
        let history = &watch.history;
        pool.install(|| write_beside(&mut solution, lit, place, self.how, history))?;
        self.say(&solution)?;
        // Also one that came while results were written, which they are now.
        Ok(match is_interrupted() {
            true => Code::Interrupted,
            false => Code::Success,
        })
    }

    /// Goes on to the end, or until it is interrupted, and leaves the solve only for checkpoints and for the audience.
    fn solve(
        &self,
        run: &mut Run,
        watch: &mut Watch,
        audience: Option<&dyn Audience>,
    ) -> Result<(), CliError> {
        if let Some(interval) = self.how.checkpoint {
            let took = self.save(run.solution())?;
            watch.due = Some(next(interval, took));
        }
        watch.seen = audience.map(|_| Instant::now());
        while run.go(watch)? == StopReason::Interrupted && !is_interrupted() {
            if is_due(watch.seen) {
                watch.seen = present(audience, run.solution());
            }
            if !is_due(watch.due) {
                continue;
            }
            watch.due = self.how.checkpoint.map(|interval| {
                // A solve is worth more than its checkpoint: what cannot be saved now may be saved later.
                let took = self.save(run.solution()).unwrap_or_else(|error| {
                    say::warning(&error.to_string());
                    interval
                });
                next(interval, took)
            });
        }
        watch.clear();
        Ok(())
    }

    /// Says what it came to, in the way that was asked for.
    fn say(&self, solution: &Solution) -> Result<(), CliError> {
        let seconds = self.started.elapsed().as_secs_f64();
        if self.how.progress == Look::Json {
            return say::result(format!("{}\n", done(solution, seconds)?));
        }
        if is_quiet() {
            return Ok(());
        }
        say::result(summary(solution, seconds))?;
        match self.how.profile {
            true => say::result(profile(&solution.report)),
            false => Ok(()),
        }
    }

    /// Memory for the largest of the pictures, bytes.
    fn pictures(&self, of: &Solution) -> u64 {
        let drawn = of.cameras.iter().filter(|_| !self.how.no_pictures);
        drawn.map(View::bytes_for).max().unwrap_or(0)
    }

    /// Writes the state; says how long that took.
    fn save(&self, state: &Solution) -> Result<Duration, CliError> {
        let started = Instant::now();
        write_atomically(&self.output.join(CHECKPOINT), |out| state.write(out))?;
        Ok(started.elapsed())
    }

    /// What came to light in the solve.
    fn warn(&self, solution: &Solution) {
        let report = &solution.report;
        let known = self.known_warnings.min(report.warnings.len());
        say::warnings(&report.warnings[known..]);
    }
}

/// The end for a program.
fn done(solution: &Solution, seconds: f64) -> Result<serde_json::Value, CliError> {
    let report = serde_json::to_value(&solution.report);
    let report = report.map_err(|e| CliError::System(e.to_string()))?;
    Ok(serde_json::json!({ "event": "done", "seconds": seconds, "report": report }))
}

/// Shows what there is; says when to show more, if anybody is there.
fn present(audience: Option<&dyn Audience>, so_far: &Solution) -> Option<Instant> {
    let started = Instant::now();
    let audience = audience.filter(|audience| audience.is_there())?;
    audience.see(so_far);
    Some(next(FRAME, started.elapsed()))
}

/// When the next checkpoint or picture is due, if the last one took so long.
fn next(interval: Duration, took: Duration) -> Instant {
    Instant::now() + interval.max(took.div_f64(SHARE))
}
