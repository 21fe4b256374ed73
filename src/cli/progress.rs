//! The terminal's view of a solve: a bar, and ctrl-C.

use super::say;
use super::say::is_quiet;
use crate::output::{Estimated, History, Moment, abandon_drafts};
use crate::solver::{Control, Estimate, Observer, Phase, Progress};
use clap::ValueEnum;
use hangup::keep_hangup_ignored;
use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Set by ctrl-C or a termination signal.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Between two lines of JSON.
const PAUSE: Duration = Duration::from_millis(200);

/// Lets ctrl-C end a solve cleanly; a second one ends the process.
pub(super) fn catch_interrupts() {
    let handler = || {
        if INTERRUPTED.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        say::aside("\nstopping: writing the solution so far (once more to quit at once)");
    };
    if let Err(error) = keep_hangup_ignored(|| ctrlc::set_handler(handler)) {
        say::warning(&format!("ctrl-C will lose the solution: {error}"));
    }
}

/// Lets ctrl-C end a run that has nothing to show before its end: half-written files go.
pub(super) fn leave_nothing_on_interrupt() {
    let handler = || {
        abandon_drafts();
        say::aside("\ninterrupted: the file that was being written is not left behind");
        std::process::exit(130);
    };
    if let Err(error) = keep_hangup_ignored(|| ctrlc::set_handler(handler)) {
        say::warning(&format!(
            "ctrl-C may leave a temporary file behind: {error}"
        ));
    }
}

/// Whether ctrl-C or a termination signal asked to stop.
pub(super) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::SeqCst)
}

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Look {
    /// A bar on a terminal, nothing elsewhere
    Auto,
    /// One JSON object a line on standard output, in place of the table at the end
    Json,
    /// Nothing
    None,
}

/// Shows progress, passes interrupts on, and stops the solve when a checkpoint is due.
pub(super) struct Watch {
    bar: Option<ProgressBar>,
    json: bool,
    tolerance: f64,
    told: Option<Instant>,
    /// When the solve is to be left for a checkpoint.
    pub due: Option<Instant>,
    /// When it is to be left for somebody to see it.
    pub seen: Option<Instant>,
    /// How the solve went so far.
    pub history: History,
    /// The rounds before this one, and their shots.
    earlier: (usize, u64),
}

impl Watch {
    /// Watches until unshot over emitted power has fallen to `tolerance`.
    pub(super) fn new(tolerance: f64, look: Look) -> Self {
        let shown = look == Look::Auto && !is_quiet();
        Self {
            bar: shown.then(bar),
            json: look == Look::Json,
            tolerance: tolerance.clamp(1e-9, 0.5),
            told: None,
            due: None,
            seen: None,
            history: History::default(),
            earlier: (0, 0),
        }
    }

    /// Takes the bar off the terminal.
    pub(super) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Shots of all rounds, where the round that is under way has so many.
    fn counted(&mut self, shots: u64) -> u64 {
        let last = self.history.moments.last().map_or(0, |last| last.shots);
        let (rounds, before) = self.earlier;
        if before + shots < last {
            self.earlier = (rounds + 1, last);
        }
        self.earlier.1 + shots
    }

    fn show(&mut self, now: &Progress, unshot: f64) {
        let done = self.done(now, unshot);
        if let Some(bar) = &self.bar {
            bar.set_position((done * STEPS as f64) as u64);
            bar.set_message(message(now, unshot, done));
        }
        let recent = |told: Instant| told.elapsed() < PAUSE;
        if self.json && !self.told.is_some_and(recent) {
            self.told = Some(Instant::now());
            say::line(line(now, unshot, done));
        }
    }

    /// About how much of the time has passed. Unshot power falls geometrically, so its logarithm tells how far there is to go;
    /// gathering takes about as long as the shots did.
    fn done(&self, now: &Progress, unshot: f64) -> f64 {
        // The logarithm of 1 makes a zero that is negative.
        let shot = (unshot.max(1e-12).ln() / self.tolerance.ln()).clamp(0.0, 1.0) + 0.0;
        match now.phase {
            Phase::Shooting | Phase::Refining => 0.6 * shot,
            Phase::Gathering { done, of } => 0.6 + 0.35 * f64::from(done) / f64::from(of.max(1)),
            Phase::Estimating => 0.95,
        }
    }
}

/// A bar that moves even where a batch of work takes long.
fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{spinner} {bar:24} {elapsed} {msg}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(STEPS).with_style(style);
    bar.set_message("preparing");
    bar.enable_steady_tick(Duration::from_millis(120));
    bar
}

/// What is being done for how long, on a terminal, where it cannot be said how far it is.
pub(super) fn sign_of_life(message: String) -> ProgressBar {
    let style = ProgressStyle::with_template("{spinner} {elapsed} {msg}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_spinner());
    let sign = ProgressBar::new_spinner().with_style(style);
    sign.set_message(message);
    sign.enable_steady_tick(Duration::from_millis(120));
    sign
}

/// What it is at, how far it is, how fast, and how long it may take.
fn message(now: &Progress, unshot: f64, done: f64) -> String {
    let seconds = now.elapsed.as_secs_f64();
    let at = match now.phase {
        Phase::Shooting | Phase::Refining => {
            format!("shot {}, {:.2}% unshot", now.shots + 1, 100.0 * unshot)
        }
        Phase::Gathering { done, of } => format!("gathering once more, patch {done} of {of}"),
        Phase::Estimating => "estimating the error".to_owned(),
    };
    let left = match seconds > 2.0 && done > 0.02 {
        true => format!(
            ", about {} left",
            HumanDuration(Duration::from_secs_f64(seconds * (1.0 - done) / done))
        ),
        false => String::new(),
    };
    let (elements, rate) = (HumanCount(now.elements as u64), rate(now));
    format!("{at}  {elements} elements  {rate:.1} Mrays/s{left}")
}

/// Millions of rays a second.
fn rate(now: &Progress) -> f64 {
    now.rays as f64 / now.elapsed.as_secs_f64().max(1e-3) / 1e6
}

/// Progress for a program.
fn line(now: &Progress, unshot: f64, done: f64) -> serde_json::Value {
    let phase = match now.phase {
        Phase::Shooting => "shooting",
        Phase::Refining => "refining",
        Phase::Gathering { .. } => "gathering",
        Phase::Estimating => "estimating",
    };
    serde_json::json!({
        "event": "progress",
        "phase": phase,
        "seconds": now.elapsed.as_secs_f64(),
        "shots": now.shots,
        "elements": now.elements,
        "vertices": now.vertices,
        "rays": now.rays,
        "mrays_per_second": rate(now),
        "unshot": unshot,
        "done": done,
    })
}

/// Whether a time has come.
pub(super) fn is_due(when: Option<Instant>) -> bool {
    when.is_some_and(|when| Instant::now() >= when)
}

impl Observer for Watch {
    fn progress(&mut self, now: &Progress) -> Control {
        let emitted = now.emitted.element_sum().max(f64::MIN_POSITIVE);
        let unshot = now.unshot.element_sum() / emitted;
        self.show(now, unshot);
        if matches!(now.phase, Phase::Shooting | Phase::Refining) {
            let shots = self.counted(now.shots);
            self.history.moments.push(Moment {
                round: self.earlier.0,
                shots,
                seconds: now.elapsed.as_secs_f64(),
                unshot,
                elements: now.elements,
            });
        }
        if is_interrupted() || [self.due, self.seen].into_iter().any(is_due) {
            Control::Stop
        } else {
            Control::Continue
        }
    }

    fn estimated(&mut self, found: &Estimate) {
        self.history.estimates.push(Estimated {
            shots: self.earlier.1 + found.shots,
            seconds: found.elapsed.as_secs_f64(),
            n_rms: found.n_rms,
        });
    }
}
