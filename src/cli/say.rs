//! What the command says besides its results: warnings, counted, and errors; in colour on a terminal only.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by `--quiet`.
static QUIET: AtomicBool = AtomicBool::new(false);

/// More warnings than this at once are counted only.
const MOST: usize = 20;

/// From now on nothing but errors is said.
pub(super) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Whether nothing but errors is to be said.
pub(super) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// One line of warning.
pub(super) fn warning(text: &str) {
    if !is_quiet() {
        eprintln!("{} {text}", marked("warning:", "33"));
    }
}

/// Several, and how many there are if they are not shown.
pub(super) fn warnings(texts: &[String]) {
    texts.iter().take(MOST).for_each(|text| warning(text));
    if texts.len() > MOST {
        let more = texts.len() - MOST;
        warning(&format!(
            "{more} more warnings; all of them are in the report"
        ));
    }
}

/// The reason why the command ends.
pub(super) fn error(text: &str) {
    eprintln!("{} {text}", marked("error:", "31"));
}

/// In bold and that colour, where somebody looks and has not asked for none (<https://no-color.org>).
fn marked(word: &str, colour: &str) -> String {
    let plain = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    match std::io::stderr().is_terminal() && !plain {
        true => format!("\u{1b}[1;{colour}m{word}\u{1b}[0m"),
        false => word.to_owned(),
    }
}
