//! The terminal's view of a solve: a bar, and ctrl-C.

use crate::solver::{Control, Observer, Progress};
use indicatif::{HumanCount, ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Set by ctrl-C or a termination signal.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Lets ctrl-C end a solve cleanly; a second one ends the process.
pub(super) fn catch_interrupts() {
    let handler = || {
        if INTERRUPTED.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        eprintln!("\nstopping: writing the solution so far (once more to quit at once)");
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        eprintln!("warning: ctrl-C will lose the solution: {error}");
    }
}

/// Whether ctrl-C or a termination signal asked to stop.
pub(super) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::SeqCst)
}

/// Shows progress, passes interrupts on, and stops the solve when a checkpoint is due.
pub(super) struct Bar {
    bar: ProgressBar,
    tolerance: f64,
    /// When the solve is to be left for a checkpoint.
    pub due: Option<Instant>,
}

impl Bar {
    /// A bar that is full when unshot over emitted power has fallen to `tolerance`; nothing is shown off a terminal.
    pub(super) fn new(tolerance: f64) -> Self {
        let style = ProgressStyle::with_template("{bar:24} {elapsed} {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self {
            bar: ProgressBar::new(STEPS).with_style(style),
            tolerance: tolerance.clamp(1e-9, 0.5),
            due: None,
        }
    }

    /// Takes the bar off the terminal.
    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Bar {
    fn progress(&mut self, now: &Progress) -> Control {
        let unshot = now.unshot.element_sum() / now.emitted.element_sum();
        // Unshot power falls geometrically, so its logarithm tells how far there is to go.
        let done = (unshot.max(1e-12).ln() / self.tolerance.ln()).clamp(0.0, 1.0);
        self.bar.set_position((done * STEPS as f64) as u64);
        let rate = now.rays as f64 / now.elapsed.as_secs_f64().max(1e-3) / 1e6;
        self.bar.set_message(format!(
            "unshot {:.2}%  shot {}  {} elements  {rate:.1} Mrays/s",
            100.0 * unshot,
            now.shots + 1,
            HumanCount(now.elements as u64),
        ));
        if is_interrupted() || self.due.is_some_and(|due| Instant::now() >= due) {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}
