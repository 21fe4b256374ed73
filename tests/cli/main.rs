//! The command: what it writes, what it says, and the code with which it ends.

mod damaged;
mod ended;
mod exporting;
mod grids;
mod heat;
#[cfg(unix)]
mod interrupted;
mod matrices;
mod pages;
mod probing;
mod refused;
mod rendering;
mod resuming;
mod solving;
mod terminal;

#[path = "../common/mod.rs"]
mod common;

use radiosity::solution::Solution;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The pictures of a camera, sorted.
const PICTURES: [&str; 4] = ["mesh.png", "shaded.exr", "shaded.png", "wireframe.png"];

/// What a solve leaves where there are no pictures, sorted.
const RESULTS: [&str; 6] = [
    "report.html",
    "report.json",
    "solution.glb",
    "solution.ply",
    "solution.rad",
    "solution.vtu",
];

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

/// `radiosity solve`, with flags between which there are spaces.
fn solve(scene: &Path, output: &Path, flags: &str) -> Run {
    let solve = ["solve", text(scene), "-o", text(output)];
    let flags: Vec<&str> = flags.split_whitespace().collect();
    radiosity(&[&solve[..], &flags].concat())
}

/// Starts the command and keeps what it prints.
fn start<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Child {
    command()
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("can be started")
}

/// Waits for a command that was started.
fn finished(child: Child) -> Run {
    child.wait_with_output().expect("ends").into()
}

/// Waits until a command has come so far; a minute at most, as it may have failed.
fn wait_until(is_reached: impl Fn() -> bool) {
    let started = Instant::now();
    while !is_reached() && started.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
}

/// Sends a signal, with the shell's own `kill`: the program of that name is in a package of its own.
#[cfg(unix)]
fn send(signal: &str, to: &Child) {
    let kill = Command::new("sh")
        .args(["-c", &format!("kill -{signal} {}", to.id())])
        .status();
    assert!(kill.expect("can be started").success());
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

/// Writes a scene of that floor with the square cameras `first` and `second`, of so many pixels a side, and says where it is.
fn two_cameras(folder: &TempDir, side: u32) -> PathBuf {
    let mut toml = String::from("geometry = 'floor.obj'\n");
    for name in ["first", "second"] {
        toml += &format!(
            "[[camera]]\nname = '{name}'\neye = [0.5, 3, 0.4]\nlook_at = [0.5, 0, 0.5]\nwidth = {side}\nheight = {side}\n"
        );
    }
    let scene = floor(folder).with_file_name("scene.toml");
    std::fs::write(&scene, toml).expect("can be written");
    scene
}

/// A draft of a scene of the project without pictures, in the folder `solved` of a temporary one.
fn draft(name: &str) -> (TempDir, PathBuf) {
    let folder = folder();
    let output = folder.path().join("solved");
    solve(&scene(name), &output, "--preset draft --no-pictures").assert_success();
    (folder, output)
}

/// The solution in a folder.
fn solution(folder: &Path) -> Solution {
    Solution::read(&folder.join("solution.rad")).unwrap_or_else(|error| panic!("{error}"))
}

/// The report in a folder.
fn report(folder: &Path) -> serde_json::Value {
    let json = std::fs::read(folder.join("report.json")).expect("was written");
    serde_json::from_slice(&json).expect("is JSON")
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
