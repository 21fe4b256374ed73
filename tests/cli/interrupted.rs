//! Ctrl-C and a termination signal keep what has been solved.

use super::{
    RESULTS, finished, folder, names, radiosity, scene, send, solution, start, text, two_cameras,
    wait_until,
};
use radiosity::solver::StopReason;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use tempfile::TempDir;

#[test]
fn an_interrupted_solve_writes_the_solution_so_far_and_ends_with_130() {
    let folder = end_by("INT");
    // It goes on where it was, if asked to, with stops of its own.
    let solved = folder.path().join("solved");
    let begun = solution(&solved);
    let more = (begun.report.shots + 1).to_string();
    radiosity(&[
        "resume",
        text(&solved),
        "--max-shots",
        &more,
        "--no-pictures",
    ])
    .assert_success();
    let resumed = solution(&solved);
    assert_eq!(resumed.report.stop_reason, StopReason::MaxShots);
    assert!(resumed.report.rays > begun.report.rays);
}

#[test]
fn a_terminated_solve_does_the_same() {
    end_by("TERM");
}

/// Ends a solve of minutes by a signal after a second; the folder with what it leaves.
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
    let child = start(&arguments);
    // The folder is made just before interrupts are caught.
    wait_until(|| output.exists());
    sleep(Duration::from_secs(1));
    send(signal, &child);

    let run = finished(child);
    assert_eq!(run.code, Some(130), "{}", run.err);
    assert!(
        run.err.contains("writing the solution so far"),
        "{}",
        run.err
    );
    assert!(run.out.contains("interrupted"), "{}", run.out);
    let left = solution(&output);
    assert_eq!(left.report.stop_reason, StopReason::Interrupted);
    assert!(output.join("report.json").exists());
    radiosity(&["render", text(&output), "--width", "32", "--height", "32"]).assert_success();
    folder
}

#[test]
fn pictures_that_are_interrupted_are_left_out() {
    let folder = folder();
    let scene = two_cameras(&folder, 6000);
    let output = folder.path().join("solved");
    let arguments = ["solve", text(&scene), "-o", text(&output)];
    let child = start(&arguments);
    // Of the meshes the last.
    wait_until(|| output.join("solution.vtu").exists());
    send("INT", &child);
    let run = finished(child);
    assert_eq!(run.code, Some(130), "{}", run.err);
    assert_eq!(names(&output), RESULTS);
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
    send("HUP", &child);
    let mut rest = String::new();
    said.read_to_string(&mut rest).expect("can be read");
    assert!(child.wait().expect("ends").success());
    let stop_reason = solution(&output).report.stop_reason;
    assert_eq!(stop_reason, StopReason::Converged, "{rest}");
}
