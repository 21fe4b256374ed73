//! What the command says: results on standard output; warnings, counted, and errors beside it, in colour on a terminal only.

use super::CliError;
use std::io::{ErrorKind, IsTerminal, Write};
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

/// A power, in W, for a line of text.
pub(super) fn watts(power: f64) -> String {
    match power.abs() {
        0.0 | 1e-3..1e9 => format!("{power:.4} W"),
        _ => format!("{power:.4e} W"),
    }
}

/// A result on standard output. That whoever reads has read enough is no failure.
pub(super) fn result(text: impl AsRef<[u8]>) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::System(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// A line on standard output in the course of the work, which goes on if nobody can read it.
pub(super) fn line(text: impl std::fmt::Display) {
    let _ = result(format!("{text}\n"));
}

/// Lines on standard error. Where it leads nowhere any more, as when its terminal is gone or a disk is full, the work goes on: what it
/// writes must not be lost for want of a remark.
pub(super) fn aside(text: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// One line of warning.
pub(super) fn warning(text: &str) {
    if !is_quiet() {
        aside(format_args!("{} {text}", marked("warning:", "33")));
    }
}

/// Several, and how many there are if they are not shown.
pub(super) fn warnings(texts: &[String]) {
    texts.iter().take(MOST).for_each(|text| warning(text));
    if texts.len() > MOST {
        let more = texts.len() - MOST;
        warning(&format!(
            "{more} more warnings; the report of a solve has all of them"
        ));
    }
}

/// The reason why the command ends.
pub(super) fn error(text: &str) {
    aside(format_args!("{} {text}", marked("error:", "31")));
}

/// In bold and that colour, where somebody looks and has not asked for none (<https://no-color.org>).
fn marked(word: &str, colour: &str) -> String {
    let plain = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    match std::io::stderr().is_terminal() && !plain {
        true => format!("\u{1b}[1;{colour}m{word}\u{1b}[0m"),
        false => word.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::watts;

    #[test]
    fn no_power_is_shown_as_nothing_or_as_a_row_of_digits() {
        assert_eq!(watts(0.0), "0.0000 W");
        assert_eq!(watts(12.34567), "12.3457 W");
        assert_eq!(watts(1.25e-6), "1.2500e-6 W");
        assert_eq!(watts(4e20), "4.0000e20 W");
    }
}
