//! What ends a solve before it has converged, and how that is said.

use super::{Run, folder, radiosity, report, scene, solve, text};
use std::fs;
use std::path::Path;

/// Runs `solve` or `resume` without pictures, and gives the warnings of its report too.
fn ended(command: &str, of: &Path, output: &Path, more: &[&str]) -> (Run, Vec<String>) {
    let (run, report) = reported(command, of, output, more);
    let warnings = report["warnings"].as_array().expect("is a list");
    let warnings = warnings.iter().filter_map(|w| w.as_str());
    (run, warnings.map(str::to_owned).collect())
}

/// The same, with its report.
fn reported(command: &str, of: &Path, output: &Path, more: &[&str]) -> (Run, serde_json::Value) {
    let begin = [command, text(of), "-o", text(output), "--no-pictures"];
    let run = radiosity(&[&begin[..], &["--formats", "none"], more].concat());
    run.assert_success();
    (run, report(output))
}

#[test]
fn every_limit_that_ends_something_is_in_a_warning_and_in_the_report() {
    let folder = folder();
    let output = folder.path().join("out");
    let geometry = scene("geometry");
    let floor = super::floor(&folder);
    for (of, flags, begins) in [
        (
            &geometry,
            &["--max-shots", "2"][..],
            &["--max-shots ended the solve before it had converged, after 2 shots: "][..],
        ),
        (
            &geometry,
            &["--max-shots", "1"],
            &["--max-shots ended the solve before it had converged, after 1 shot: "],
        ),
        (
            &geometry,
            &["--time-limit", "0.000001"],
            &["--time-limit ended the solve before it had converged"],
        ),
        (
            &geometry,
            &["--max-elements", "100", "--preset", "draft"],
            &["--max-elements ended the refinement after "],
        ),
        (
            &geometry,
            &["--target-error", "1%", "--max-elements", "100"],
            &["--max-elements ended", "--target-error was not reached"],
        ),
        (
            &geometry,
            &["--target-error", "1%", "--max-shots", "2"],
            &[
                "--max-shots ended the solve",
                "--target-error was not reached: solve 1 was cut short",
            ],
        ),
        (&floor, &[], &["no surface emits light"]),
    ] {
        let (run, warnings) = ended("solve", of, &output, flags);
        for begin in begins {
            let said = format!("warning: {begin}");
            assert_eq!(run.err.matches(&said).count(), 1, "{}", run.err);
            let kept = warnings.iter().filter(|w| w.starts_with(begin));
            assert_eq!(kept.count(), 1, "{warnings:?}");
        }
        let page = fs::read_to_string(output.join("report.html")).expect("was written");
        assert!(page.contains(begins[0]), "{page}");
        assert!(!page.contains(">-0.000000<"), "{page}");
    }
}

#[test]
fn what_ended_a_session_before_is_not_said_of_the_next() {
    let folder = folder();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let geometry = scene("geometry");
    let draft = ["--preset", "draft", "--max-shots", "1"];
    ended("solve", &geometry, &first, &draft);
    let (run, warnings) = ended("resume", &first, &second, &["--max-shots", "3"]);
    let said = "warning: --max-shots ended the solve before it had converged, after 3 shots";
    assert!(run.err.contains(said), "{}", run.err);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let (run, warnings) = ended("resume", &second, &second, &["--max-shots", "100000"]);
    assert_eq!((run.err.as_str(), warnings), ("", Vec::new()));
}

#[test]
fn a_report_that_does_not_give_its_solve_again_says_so() {
    let folder = folder();
    let [first, second, third] = ["1", "2", "3"].map(|name| folder.path().join(name));
    let geometry = scene("geometry");
    let draft = ["--preset", "draft"];
    let (_, plain) = reported("solve", &geometry, &first, &draft);
    assert_eq!(plain["resumed_with"], serde_json::json!([]));
    let shots = plain["shots"].as_u64().expect("is a count");
    let stricter = ["--tolerance", "0.001"];
    let (_, report) = reported("resume", &first, &second, &stricter);
    let with = format!("other options after {shots} shots");
    assert_eq!(report["resumed_with"], serde_json::json!([with]));
    let repeated = |of: &Path| {
        let from = of.join("report.json");
        let solve = ["solve", "--from", text(&from), "-o", text(&third)];
        let run = radiosity(&[&solve[..], &["--no-pictures"]].concat());
        run.assert_success();
        run.err
    };
    let warning = format!("taken up again with {with}");
    assert!(repeated(&second).contains(&warning));
    assert_eq!(repeated(&first), "");
    let short = ["--preset", "draft", "--time-limit", "0.000001"];
    reported("solve", &geometry, &first, &short);
    assert!(repeated(&first).contains("was ended by the time limit"));
}

#[test]
fn the_memory_limit_holds_for_the_largest_picture_too() {
    let folder = folder();
    let floor = super::floor(&folder);
    let geometry = floor.file_name().and_then(|name| name.to_str());
    let toml = format!(
        "geometry = \"{}\"\n[[camera]]\nname = 'wide'\neye = [0, 5, 0]\nlook_at = [0.1, 0, 0]\nwidth = 16384\nheight = 16384\n",
        geometry.expect("has a name")
    );
    fs::write(folder.path().join("scene.toml"), toml).expect("can be written");
    let output = folder.path().join("out");
    let limited = |flags: &str| {
        let flags = format!("--memory-limit 100MB {flags}");
        solve(folder.path(), &output, &flags)
    };
    let words = [
        "a picture of 24.7 GB",
        "100 MB may be used",
        "--memory-limit",
    ];
    limited("").assert_refused(1, &words);
    limited("--no-pictures").assert_success();
}

#[test]
#[cfg(target_os = "linux")]
fn a_remark_that_nobody_can_read_does_not_lose_the_solution() {
    let folder = folder();
    let output = folder.path().join("out");
    let full = || fs::File::create("/dev/full").expect("can be opened");
    // It has converged of nothing, which is worth a warning.
    let floor = super::floor(&folder);
    let solve = ["solve", text(&floor), "-o", text(&output), "--no-pictures"];
    let status = super::command().args(solve).stderr(full()).status();
    assert_eq!(status.expect("can be started").code(), Some(0));
    assert!(output.join("solution.rad").exists());
    let status = super::command()
        .args(["info", "no.obj"])
        .stderr(full())
        .status();
    assert_eq!(status.expect("can be started").code(), Some(3));
}
