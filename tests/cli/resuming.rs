//! Checkpoints, `resume`, `--from` and limits.

use super::{
    RESULTS, Run, command, common, draft, folder, names, radiosity, report, scene, solution, solve,
    text,
};
use radiosity::solver::{Preset, StopReason};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

const DRAFT: [&str; 3] = ["--preset", "draft", "--no-pictures"];

fn run(arguments: &[&[&str]]) -> Run {
    radiosity(&arguments.concat())
}

/// The solution in a folder, without what may differ from run to run.
fn bits(folder: &Path) -> Vec<u8> {
    common::sessions::bits(solution(folder))
}

/// Starts a command and kills it after a while, if it has not ended by then. No signal that could be caught.
fn killed(arguments: &[&[&str]], after: Duration) -> bool {
    let mut child = command()
        .args(arguments.concat())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("can be started");
    sleep(after);
    let ended = child.try_wait().expect("can be asked").is_some();
    child.kill().expect("can be killed");
    child.wait().expect("ends");
    !ended
}

#[test]
fn killed_at_any_moment_a_solve_resumes_to_the_same_bits() {
    let folder = folder();
    let (whole, pieces) = (folder.path().join("whole"), folder.path().join("pieces"));
    let cornell = scene("cornell-box");
    let solve = ["solve", text(&cornell), "-o"];
    run(&[&solve, &[text(&whole)], &DRAFT]).assert_success();

    let often = ["--no-pictures", "--checkpoint", "0.01"];
    let first = [&solve[..], &[text(&pieces)], &DRAFT, &often[1..]];
    let again = [&["resume", text(&pieces)], &often[..]];
    let has = |name: &str| pieces.join(name).exists();
    let mut kills = 0;
    for attempt in 0..200 {
        // The golden ratio spreads the moments; they come later and later, so that there is an end.
        let moment = (f64::from(attempt) * 0.618_034).fract();
        let after = Duration::from_secs_f64(0.02 + 0.3 * moment + 0.01 * f64::from(attempt));
        let arguments = if has("checkpoint.rad") {
            &again[..]
        } else {
            &first[..]
        };
        kills += usize::from(killed(arguments, after));
        if has("solution.rad") && !has("checkpoint.rad") {
            break;
        }
    }
    assert!(kills >= 3, "{kills}");
    assert!(bits(&pieces) == bits(&whole), "after {kills} kills");
    // What the kills have left half-written is cleared away by whoever comes next.
    run(&[&solve, &[text(&pieces)], &DRAFT]).assert_success();
    assert_eq!(names(&pieces), RESULTS);
}

#[test]
fn a_report_repeats_its_solve_from_anywhere() {
    let folder = folder();
    let [first, second, third] = ["1", "2", "3"].map(|name| folder.path().join(name));
    let emission = scene("emission");
    let [scenes, name] = [emission.parent(), emission.file_name().map(Path::new)];
    let options = [
        "--preset",
        "draft",
        "--eps-d",
        "0.3",
        "--max-shots",
        "20",
        "--no-pictures",
    ];
    let engine = ["--engine", "obvhs"];
    let solve = ["solve", text(name.expect("has one")), "-o", text(&first)];
    let solved = command()
        .current_dir(scenes.expect("is in one"))
        .args([&solve[..], &options, &engine].concat())
        .output();
    Run::from(solved.expect("can be started")).assert_success();
    let first_report = first.join("report.json");
    let from = [
        "solve",
        "--from",
        text(&first_report),
        "--no-pictures",
        "-o",
    ];
    run(&[&from, &[text(&second)]]).assert_success();
    assert!(bits(&second) == bits(&first));
    let more = run(&[&from, &[text(&third), "--max-shots", "21"]]);
    more.assert_success();
    assert!(bits(&third) != bits(&first), "flags have the last word");

    fs::write(&first_report, "{}").expect("can be written");
    run(&[&from, &[text(&second)]]).assert_refused(3, &["report.json", "missing field"]);
    fs::remove_file(&first_report).expect("is there");
    run(&[&from, &[text(&second)]]).assert_refused(3, &["cannot read", "report.json"]);
}

#[test]
fn a_solution_goes_on_with_stricter_options_and_other_emitters() {
    let (folder, solved) = draft("cornell-box");
    let before = solution(&solved);
    // Named by its file or by its folder.
    let resumed = run(&[&[
        "resume",
        text(&solved.join("solution.rad")),
        "--tolerance",
        "0.001",
        "--no-pictures",
    ]]);
    resumed.assert_success();
    let after = solution(&solved);
    assert!(after.report.shots > before.report.shots);
    assert!(after.report.power.unshot.abs() < before.report.power.unshot.abs() + 1e-3);
    assert_eq!(
        after.report.options.epsilon_d,
        before.report.options.epsilon_d
    );

    // The same box with half the light.
    let dim = folder.path().join("dim");
    copy(&scene("cornell-box"), &dim);
    let settings = fs::read_to_string(dim.join("scene.toml")).expect("is there");
    let light = &after
        .continuation
        .as_ref()
        .expect("is kept")
        .scene
        .materials;
    let light = light.iter().find(|m| m.emits()).expect("there is a light");
    let half: Vec<f32> = (light.emitted_radiance * 0.5).to_array().to_vec();
    let settings = format!(
        "{settings}\n[material.{}]\nemitted_radiance = {half:?}\n",
        light.name
    );
    fs::write(dim.join("scene.toml"), settings).expect("can be written");
    let output = folder.path().join("half");
    let arguments = [
        "resume",
        text(&solved),
        "--scene",
        text(&dim),
        "-o",
        text(&output),
    ];
    run(&[&arguments, &["--no-pictures"]]).assert_success();
    let relit = solution(&output);
    let ratio = relit.report.power.absorbed / after.report.power.absorbed;
    assert!((ratio - 0.5).abs() < 0.005, "{ratio}");

    let shadow = scene("shadow");
    let other = ["resume", text(&solved), "--scene", text(&shadow)];
    run(&[&other]).assert_refused(3, &["other emitters", "surfaces"]);
}

#[test]
fn a_preset_takes_the_place_of_a_target_and_of_a_solves_own_options() {
    let folder = folder();
    let flags = "--no-pictures --target-error 20%";
    solve(&scene("geometry"), folder.path(), flags).assert_success();
    let resumed = |flags: &[&str]| {
        let output = text(folder.path());
        let resume = ["resume", output, "--no-pictures", "--formats", "none"];
        run(&[&resume, flags]).assert_success();
        solution(folder.path()).report
    };
    assert!(resumed(&[]).target.is_some(), "goes on as it was");
    let report = resumed(&["--preset", "draft"]);
    assert_eq!(report.target, None);
    assert_eq!(report.options, Preset::Draft.options());
    assert_eq!(resumed(&[]).options, Preset::Draft.options());

    let help = run(&[&["resume", "--help"]]).out;
    assert!(!help.contains("(the default)"), "{help}");
}

/// Copies the files of a folder.
fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).expect("can be made");
    for name in names(from) {
        fs::copy(from.join(&name), to.join(&name)).expect("can be copied");
    }
}

#[test]
fn a_solution_that_was_written_stands_even_if_its_meshes_cannot_be() {
    let folder = folder();
    let output = folder.path().join("out");
    fs::create_dir_all(output.join("solution.glb")).expect("can be made");
    let flags = "--preset draft --no-pictures --checkpoint 1h --formats glb";
    solve(&scene("geometry"), &output, flags).assert_refused(1, &["solution.glb"]);
    // Without a checkpoint, from which `resume` would begin anew.
    assert_eq!(
        names(&output),
        ["report.json", "solution.glb", "solution.rad"]
    );
    let solved = solution(&output);
    assert_eq!(solved.report.stop_reason, StopReason::Converged);
}

#[test]
fn what_cannot_be_resumed_is_refused() {
    let folder = folder();
    let empty = text(folder.path());
    run(&[&["resume", empty]]).assert_refused(3, &["neither checkpoint.rad nor solution.rad"]);
    run(&[&["resume", "no/such/folder"]]).assert_refused(3, &["no/such/folder"]);
    fs::write(folder.path().join("checkpoint.rad"), "RADIOSOL and more").expect("can be written");
    run(&[&["resume", empty]]).assert_refused(3, &["checkpoint.rad", "not a solution"]);

    let old = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/format-1");
    let output = folder.path().join("out");
    run(&[&["resume", text(&old), "-o", text(&output)]]).assert_refused(3, &["earlier version"]);
    run(&[
        &["render", text(&old), "-o", text(&output)],
        &["--width", "16", "--height", "16"],
    ])
    .assert_success();
}

#[test]
fn limits_end_the_refinement_and_say_so() {
    let folder = folder();
    let cornell = scene("cornell-box");
    let limited = |limit: &str| {
        let flag = limit.split(' ').next().unwrap_or_default();
        let output = folder.path().join(flag.trim_start_matches('-'));
        let flags = format!("--no-pictures --engine obvhs --tolerance 0.05 {limit}");
        let run = solve(&cornell, &output, &flags);
        run.assert_success();
        let warning = format!("warning: {flag} ended the refinement");
        assert!(run.err.contains(&warning), "{}", run.err);
        (
            solution(&output).report,
            report(&output)["peak_memory"].as_u64(),
        )
    };
    let (report, _) = limited("--max-elements 8000");
    assert!(
        (7000..=8100).contains(&report.elements),
        "{}",
        report.elements
    );
    let limit: u64 = 80 << 20;
    let (report, peak) = limited("--memory-limit 80MiB");
    assert!(report.elements > 7000, "{}", report.elements);
    assert!(peak.is_none_or(|peak| peak <= limit), "{peak:?}");
}

#[test]
fn a_scene_that_does_not_fit_into_the_memory_limit_is_refused_with_the_cause() {
    let folder = folder();
    let path = folder.path().join("many.obj");
    let mut obj = String::new();
    for i in 0..40_000 {
        obj += &format!("v {i} 0 0\nv {i} 0 1\nv {i} 1 0\nf -3 -2 -1\n");
    }
    fs::write(&path, obj).expect("can be written");
    let output = folder.path().join("out");
    let limited = |engine: &str| {
        let flags = format!("--memory-limit 1MiB --engine {engine}");
        solve(&path, &output, &flags)
    };
    let words = ["40000 triangles", "1 MiB may be used", "--memory-limit"];
    limited("obvhs").assert_refused(1, &words);
    if cfg!(embree) {
        limited("embree").assert_refused(1, &["Embree cannot", "out of memory", "1 MiB"]);
    }
}
