//! The command: what it writes, what it says, and the code with which it ends.

mod damaged;
mod ended;
mod exporting;
mod grids;
mod heat;
mod interrupted;
mod matrices;
mod pages;
mod probing;
mod refused;
mod rendering;
mod resuming;
mod solving;
mod terminal;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A run that has ended.
struct Run {
    code: Option<i32>,
    out: String,
    err: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("prints UTF-8");
        Self {
            code: output.status.code(),
            out: text(output.stdout),
            err: text(output.stderr),
        }
    }
}

impl Run {
    fn assert_success(&self) {
        assert_eq!(self.code, Some(0), "{}", self.err);
    }

    /// The run failed with this code and a message of one line that holds all of these words.
    fn assert_refused(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "{}", self.err);
        let message = self
            .err
            .lines()
            .find(|line| line.starts_with("error: "))
            .unwrap_or_default();
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {}", self.err);
        }
        assert!(!self.err.contains("panicked"), "{}", self.err);
    }
}

fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_radiosity"));
    command.stdin(Stdio::null());
    command
}

/// Runs the command to its end.
fn radiosity<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Run {
    command()
        .args(arguments)
        .output()
        .expect("can be started")
        .into()
}

/// A scene of the project.
fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("paths of tests are UTF-8")
}

/// A folder that is removed at the end of its test.
fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

/// Writes an OBJ file of one floor of 1 m, and says where it is.
fn floor(folder: &TempDir) -> PathBuf {
    let path = folder.path().join("floor.obj");
    std::fs::write(&path, "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n")
        .expect("can be written");
    path
}

/// A draft of a scene of the project without pictures, in the folder `solved` of a temporary one.
fn draft(name: &str) -> (TempDir, PathBuf) {
    let folder = folder();
    let output = folder.path().join("solved");
    radiosity(&[
        "solve",
        text(&scene(name)),
        "-o",
        text(&output),
        "--preset",
        "draft",
        "--no-pictures",
    ])
    .assert_success();
    (folder, output)
}

/// The names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("is a folder");
    let mut names: Vec<String> = entries
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}
