//! What can be wrong with a scene's files, said so that the user can mend it.

use std::path::{Path, PathBuf};

/// Why a scene could not be loaded.
///
/// The message reads `FILE:LINE: found THIS; expected THAT`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{}: found {found}; expected {expected}", .file.display(), .line.map_or(String::new(), |n| format!(":{n}")))]
pub struct SceneError {
    /// The file (or folder) at fault.
    pub file: PathBuf,
    /// The line at fault, counted from 1, where there is one.
    pub line: Option<usize>,
    /// What the file has there.
    pub found: String,
    /// What it should have instead.
    pub expected: String,
}

impl SceneError {
    pub(super) fn new(
        file: &Path,
        line: impl Into<Option<usize>>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        SceneError {
            file: file.to_path_buf(),
            line: line.into(),
            found: found.into(),
            expected: expected.into(),
        }
    }
}
