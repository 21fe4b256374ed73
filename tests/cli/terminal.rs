//! What the command says, how, and to whom.

use super::{folder, names, radiosity, scene, solve, text};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A quick solve with those flags.
fn quick(flags: &str) -> super::Run {
    let folder = folder();
    let flags = format!("--preset draft --no-pictures --formats none {flags}");
    let run = solve(&scene("cornell-box"), folder.path(), &flags);
    run.assert_success();
    run
}

#[test]
fn json_lines_tell_a_program_how_far_it_is() {
    let run = quick("--progress json");
    let lines: Vec<Value> = run
        .out
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}")))
        .collect();
    let (last, before) = lines.split_last().expect("says something");
    assert_eq!(last["event"], "done");
    assert_eq!(last["report"]["stop_reason"], "converged");
    assert_eq!(before[0]["event"], "progress");
    assert_eq!(before[0]["phase"], "shooting");
    let done = |line: &Value| line["done"].as_f64().expect("is a number");
    let is_share = |done: f64| done.is_sign_positive() && done <= 1.0;
    assert!(before.iter().all(|line| is_share(done(line))));
    for key in [
        "seconds",
        "shots",
        "elements",
        "rays",
        "mrays_per_second",
        "unshot",
    ] {
        assert!(before.iter().all(|line| line[key].is_number()), "{key}");
    }
    assert_eq!(run.err, "");
}

#[test]
fn quiet_says_nothing_and_colours_are_for_terminals() {
    let run = quick("--quiet");
    assert_eq!((run.out.as_str(), run.err.as_str()), ("", ""));
    let folder = folder();
    let path = super::floor(&folder);
    let run = solve(&path, folder.path(), "--no-pictures");
    assert!(run.err.starts_with("warning: "), "{}", run.err);
    let quiet = solve(&path, folder.path(), "--no-pictures -q");
    assert_eq!((quiet.code, quiet.err.as_str()), (Some(0), ""));
    let failing = solve(Path::new("/nowhere"), folder.path(), "-q");
    failing.assert_refused(3, &["/nowhere"]);
    assert!(!run.err.contains('\u{1b}') && !failing.err.contains('\u{1b}'));
}

#[test]
fn many_warnings_are_counted() {
    let folder = folder();
    let mut toml = String::from("geometry = 'a.obj'\n");
    toml += "[material.m0]\nreflectance = 1\n";
    let mut obj = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let mut mtl = String::new();
    for number in 0..30 {
        obj += &format!("usemtl m{number}\nf 1 2 3\n");
    }
    for number in 0..30 {
        mtl += &format!("v {number} 0 2\n");
    }
    fs::write(folder.path().join("a.obj"), obj + &mtl).expect("can be written");
    fs::write(folder.path().join("scene.toml"), toml).expect("can be written");
    let run = radiosity(&["info", text(folder.path())]);
    run.assert_success();
    let said = run
        .err
        .lines()
        .filter(|line| line.starts_with("warning: "))
        .count();
    assert_eq!(said, 21, "{}", run.err);
    let last = run.err.lines().last().unwrap_or_default();
    assert!(
        last.contains("more warnings; the report of a solve has all of them"),
        "{last}"
    );
}

#[test]
fn help_has_examples_defaults_and_exit_codes() {
    let help = radiosity(&["--help"]).out;
    for words in ["Examples:", "Exit codes:", "130  interrupted", "NO_COLOR"] {
        assert!(help.contains(words), "`{words}` is not in:\n{help}");
    }
    let help = radiosity(&["solve", "--help"]).out;
    for words in [
        "Examples:",
        "standard     accurate",
        "epsilon_fd",
        "0.004",
        "[default: ply,glb,vtu]",
    ] {
        assert!(help.contains(words), "`{words}` is not in:\n{help}");
    }
    for command in [
        "resume",
        "render",
        "view",
        "probe",
        "export",
        "form-factors",
        "info",
    ] {
        let help = radiosity(&[command, "--help"]).out;
        assert!(help.contains("Examples:\n  radiosity "), "{command}");
    }
}

#[test]
fn completions_and_man_pages_know_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = radiosity(&["completions", shell]);
        run.assert_success();
        assert!(
            run.out.contains("form-factors") && run.out.contains("target-error"),
            "{shell}"
        );
    }
    radiosity(&["completions", "cmd"]).assert_refused(2, &["cmd"]);
    let folder = folder();
    radiosity(&["man", "-o", text(folder.path())]).assert_success();
    let pages = names(folder.path());
    for page in [
        "radiosity.1",
        "radiosity-solve.1",
        "radiosity-form-factors.1",
        "radiosity-man.1",
    ] {
        assert!(
            pages.contains(&page.to_owned()),
            "{page} is not in {pages:?}"
        );
    }
    let solve = fs::read_to_string(folder.path().join("radiosity-solve.1")).expect("was written");
    assert!(solve.contains(".TH radiosity-solve 1") && solve.contains("\\-\\-target\\-error"));
}
