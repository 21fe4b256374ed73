//! Ctrl-C and a termination signal keep what has been solved.

use super::{Run, command, folder, radiosity, scene, text};
use radiosity::solution::Solution;
use radiosity::solver::StopReason;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

#[test]
#[cfg(unix)]
fn an_interrupted_solve_writes_the_solution_so_far_and_ends_with_130() {
    let folder = end_by("INT");
    // It goes on where it was, if asked to, with stops of its own.
    let solved = folder.path().join("solved");
    let begun = Solution::read(&solved.join("solution.rad")).expect("was written");
    let more = (begun.report.shots + 1).to_string();
    radiosity(&[
        "resume",
        text(&solved),
        "--max-shots",
        &more,
        "--no-pictures",
    ])
    .assert_success();
    let resumed = Solution::read(&solved.join("solution.rad")).expect("was written");
    assert_eq!(resumed.report.stop_reason, StopReason::MaxShots);
    assert!(resumed.report.rays > begun.report.rays);
}

#[test]
#[cfg(unix)]
fn a_terminated_solve_does_the_same() {
    end_by("TERM");
}

/// Ends a solve of minutes by a signal after a second; the folder with what it leaves.
#[cfg(unix)]
fn end_by(signal: &str) -> TempDir {
    let folder = folder();
    let output = folder.path().join("solved");
    let scene = scene("cornell-box");
    // A reference that would take minutes.
    let arguments = [
        "solve",
        text(&scene),
        "-o",
        text(&output),
        "--preset",
        "accurate",
        "--eps-d",
        "0.01",
        "--no-pictures",
    ];
    let child = command()
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("can be started");
    // The folder is made just before interrupts are caught.
    let started = Instant::now();
    while !output.exists() && started.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(20));
    }
    sleep(Duration::from_secs(1));
    // The shell's own `kill`: the program of that name is in a package of its own.
    let kill = Command::new("sh")
        .args(["-c", &format!("kill -{signal} {}", child.id())])
        .status();
    assert!(kill.expect("can be started").success());

    let run: Run = child.wait_with_output().expect("ends").into();
    assert_eq!(run.code, Some(130), "{}", run.err);
    assert!(
        run.err.contains("writing the solution so far"),
        "{}",
        run.err
    );
    assert!(run.out.contains("interrupted"), "{}", run.out);
    let solution =
        Solution::read(&output.join("solution.rad")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(solution.report.stop_reason, StopReason::Interrupted);
    assert!(output.join("report.json").exists());
    radiosity(&["render", text(&output), "--width", "32", "--height", "32"]).assert_success();
    folder
}

#[test]
#[cfg(unix)]
fn pictures_that_are_interrupted_are_left_out() {
    let folder = folder();
    let floor = super::floor(&folder);
    let mut toml = format!("geometry = \"{}\"\n", "floor.obj");
    for name in ["first", "second"] {
        toml +=
            &format!("[[camera]]\nname = '{name}'\neye = [0.5, 3, 0.4]\nlook_at = [0.5, 0, 0.5]\n");
        toml += "width = 6000\nheight = 6000\n";
    }
    let scene = floor.with_file_name("scene.toml");
    std::fs::write(&scene, toml).expect("can be written");
    let output = folder.path().join("solved");
    let arguments = ["solve", text(&scene), "-o", text(&output)];
    let child = command()
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("can be started");
    // Of the meshes the last.
    let started = Instant::now();
    while !output.join("solution.vtu").exists() && started.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
    let kill = Command::new("sh")
        .args(["-c", &format!("kill -INT {}", child.id())])
        .status();
    assert!(kill.expect("can be started").success());
    let run: Run = child.wait_with_output().expect("ends").into();
    assert_eq!(run.code, Some(130), "{}", run.err);
    let written = super::names(&output);
    let expected = [
        "report.html",
        "report.json",
        "solution.glb",
        "solution.ply",
        "solution.rad",
        "solution.vtu",
    ];
    assert_eq!(written, expected);
}

#[test]
#[cfg(unix)]
fn what_nohup_started_outlives_its_terminal() {
    let folder = folder();
    let output = folder.path().join("solved");
    let geometry = scene("geometry");
    // `exec` keeps what `trap` has the shell ignore, as `nohup` does.
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$@\"", "sh"])
        .arg(env!("CARGO_BIN_EXE_radiosity"))
        .args(["solve", text(&geometry), "-o", text(&output), "--preset"])
        .args(["draft", "--progress", "json", "--no-pictures"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("can be started");
    let mut said = BufReader::new(child.stdout.take().expect("is a pipe"));
    // What it says first comes when signals are caught.
    let mut first = String::new();
    said.read_line(&mut first).expect("can be read");
    let kill = Command::new("sh")
        .args(["-c", &format!("kill -HUP {}", child.id())])
        .status();
    assert!(kill.expect("can be started").success());
    let mut rest = String::new();
    said.read_to_string(&mut rest).expect("can be read");
    assert!(child.wait().expect("ends").success());
    let solution = Solution::read(&output.join("solution.rad")).expect("was written");
    assert_eq!(solution.report.stop_reason, StopReason::Converged, "{rest}");
}
