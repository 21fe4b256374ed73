//! Counting what is suspicious: one warning a kind, with how often and where first.

use std::path::Path;

/// How often something was met, and on which line first.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Tally {
    pub count: usize,
    pub first_line: usize,
}

impl Tally {
    /// Notes one more at `line`.
    pub fn add(&mut self, line: usize) {
        if self.count == 0 {
            self.first_line = line;
        }
        self.count += 1;
    }

    /// `FILE:LINE: 3 polygons WHAT`, into `warnings` if there was any.
    pub fn report(&self, warnings: &mut Vec<String>, file: &Path, noun: &str, what: &str) {
        if self.count == 0 {
            return;
        }
        let (file, line, plural) = (
            file.display(),
            self.first_line,
            if self.count == 1 { "" } else { "s" },
        );
        let first = if self.count == 1 { "" } else { " (first here)" };
        warnings.push(format!(
            "{file}:{line}: {} {noun}{plural} {what}{first}",
            self.count
        ));
    }
}
