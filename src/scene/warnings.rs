//! Counting what is suspicious: one warning a kind, with how often and where first.

use std::path::Path;

/// How often something was met, and on which line first.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Tally {
    pub count: usize,
    pub first_line: usize,
}

impl Tally {
    /// Notes one more at `line`, 0 if the file has no lines.
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
        let (file, count) = (file.display(), self.count);
        let plural = if count == 1 { "" } else { "s" };
        warnings.push(match (self.first_line, count) {
            (0, _) => format!("{file}: {count} {noun}{plural} {what}"),
            (line, 1) => format!("{file}:{line}: 1 {noun} {what}"),
            (line, _) => format!("{file}:{line}: {count} {noun}s {what} (first here)"),
        });
    }
}
