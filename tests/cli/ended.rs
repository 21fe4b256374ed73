//! What ends a solve before it has converged, and how that is said.

use super::{Run, folder, radiosity, scene, text};
use std::fs;
use std::path::Path;

/// Runs `solve` or `resume` without pictures, and gives the warnings of its report too.
fn ended(command: &str, of: &Path, output: &Path, more: &[&str]) -> (Run, Vec<String>) {
    let begin = [command, text(of), "-o", text(output), "--no-pictures"];
    let run = radiosity(&[&begin[..], &["--formats", "none"], more].concat());
    run.assert_success();
    let json = fs::read(output.join("report.json")).expect("was written");
    let report: serde_json::Value = serde_json::from_slice(&json).expect("is JSON");
    let warnings = report["warnings"].as_array().expect("is a list");
    let warnings = warnings.iter().filter_map(|w| w.as_str());
    let warnings = warnings.map(str::to_owned).collect();
    (run, warnings)
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
