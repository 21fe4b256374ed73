//! Tables that are read: where their columns are, and why one cannot be read.

use super::CliError;
use csv::{ErrorKind, Reader, ReaderBuilder, StringRecord, Trim};
use std::fs::File;
use std::path::Path;

/// A table of text between commas, with comments after `#`.
pub(super) fn open(path: &Path) -> Result<Reader<File>, CliError> {
    let mut how = ReaderBuilder::new();
    how.trim(Trim::All).comment(Some(b'#'));
    how.from_path(path).map_err(|e| unreadable(path, &e))
}

/// Why a table cannot be read.
pub(super) fn unreadable(path: &Path, error: &csv::Error) -> CliError {
    let name = path.display();
    let line = error.position().map_or(0, csv::Position::line);
    let (found, expected) = match error.kind() {
        ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => (
            format!("{len} columns"),
            format!("{expected_len} as in the lines before"),
        ),
        ErrorKind::Utf8 { .. } => ("bytes that are not UTF-8".into(), "text".into()),
        _ => return CliError::Input(format!("cannot read {name}: {error}")),
    };
    CliError::Input(format!("{name}:{line}: found {found}, expected {expected}"))
}

/// Where the column of a name is, if there is one. A byte order mark stays with the first name.
pub(super) fn place_of(header: &StringRecord, name: &str) -> Option<usize> {
    let mut fields = header.iter();
    fields.position(|field| field.trim_start_matches('\u{feff}') == name)
}

/// Where a column is that must be there.
pub(super) fn column(header: &StringRecord, path: &Path, name: &str) -> Result<usize, CliError> {
    place_of(header, name).ok_or_else(|| {
        let found = header.iter().collect::<Vec<_>>().join(",");
        let between = match header.len() == 1 && found.contains([';', '\t']) {
            true => " with commas between the columns",
            false => "",
        };
        let line = header.position().map_or(1, csv::Position::line).max(1);
        CliError::Input(format!(
            "{}:{line}: found the columns `{found}`, expected one named `{name}`{between}",
            path.display()
        ))
    })
}
