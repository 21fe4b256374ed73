//! `radiosity solve`, `radiosity info`.

use super::{
    PICTURES, RESULTS, draft, finished, floor, folder, names, radiosity, report, scene, solution,
    solve, start, text,
};
use std::fs;

#[test]
fn a_solve_leaves_solution_mesh_pictures_and_report() {
    let folder = folder();
    let flags = "--preset draft --max-shots 1";
    let run = solve(&scene("geometry"), folder.path(), flags);
    run.assert_success();
    let mut expected = [&RESULTS[..], &PICTURES].concat();
    expected.sort_unstable();
    assert_eq!(names(folder.path()), expected);
    assert!(
        run.out.contains("Geometry") && run.out.contains("largest number of shots"),
        "{}",
        run.out
    );
    assert_eq!(solution(folder.path()).report.shots, 1);
}

#[test]
fn the_report_holds_every_figure() {
    let (_folder, solved) = draft("cornell-box");
    let report = report(&solved);
    let keys = [
        "scene",
        "engine",
        "threads",
        "input_patches",
        "shots",
        "meshing_shots",
        "max_depth",
        "elements",
        "vertices",
        "rays",
        "seconds",
        "stop_reason",
        "power",
        "power_rgb",
        "options",
    ];
    for key in keys {
        assert!(!report[key].is_null(), "no {key}");
    }
    for (part, keys) in [
        ("engine", &["name", "version", "isa", "packet_width"][..]),
        (
            "seconds",
            &["load", "build", "engine", "solve", "parts", "write"],
        ),
        (
            "power",
            &["emitted", "absorbed", "escaped", "unshot", "residual"],
        ),
        (
            "power_rgb",
            &["emitted", "absorbed", "escaped", "unshot", "residual"],
        ),
    ] {
        for key in keys {
            assert!(!report[part][key].is_null(), "no {part}.{key}");
        }
    }
    assert_eq!(report["scene"], "Cornell box");
    assert_eq!(report["input_patches"], 19);
    assert_eq!(report["stop_reason"], "converged");
    assert_eq!(report["options"]["tolerance"], 0.006, "the draft's");
    let emitted = report["power"]["emitted"].as_f64().expect("is a number");
    let expected = 3.0 * std::f64::consts::PI * 0.130 * 0.105;
    assert!(
        (emitted / expected - 1.0).abs() < 1e-6,
        "{emitted} W, where 130 mm by 105 mm of radiance 1 give {expected}"
    );
}

#[test]
fn threads_and_options_are_those_asked_for() {
    let folder = folder();
    let output = folder.path().join("new/and/deep");
    let flags = "--preset draft --no-pictures --threads 1 --engine obvhs --max-shots 3 --eps-d 0.5";
    solve(&scene("cornell-box"), &output, flags).assert_success();
    let report = report(&output);
    assert_eq!(report["threads"], 1);
    assert_eq!(report["engine"]["name"], "obvhs");
    assert_eq!(report["shots"], 3);
    assert_eq!(report["stop_reason"], "max-shots");
    assert_eq!(report["options"]["epsilon_d"], 0.5);
    assert_eq!(names(&output), RESULTS);
}

#[test]
fn a_profile_accounts_for_the_time() {
    let folder = folder();
    let flags = "--preset draft --no-pictures --profile";
    let run = solve(&scene("cornell-box"), folder.path(), flags);
    run.assert_success();
    for part in ["build engine", "shoot", "gather", "rays took"] {
        assert!(run.out.contains(part), "no {part}: {}", run.out);
    }
    let seconds = &report(folder.path())["seconds"];
    let of = |part: &str| seconds["parts"][part].as_f64().expect("seconds");
    let parts = [
        "selecting",
        "shooting",
        "refining",
        "gathering",
        "estimating",
    ];
    let sum: f64 = parts.into_iter().map(of).sum();
    let solve = seconds["solve"].as_f64().expect("seconds");
    assert!(
        sum <= solve && sum > 0.5 * solve,
        "{sum} of {solve}: {}",
        run.out
    );
    assert!(of("rays") > 0.0 && of("shooting") > 0.0 && of("gathering") > 0.0);
}

#[test]
fn without_an_emitter_all_is_black_and_a_warning_says_why() {
    let folder = folder();
    let output = folder.path().join("out");
    let run = solve(&floor(&folder), &output, "--preset draft");
    run.assert_success();
    assert!(run.err.contains("no surface emits"), "{}", run.err);
    assert!(run.out.contains("nothing emits"), "{}", run.out);
    assert_eq!(report(&output)["stop_reason"], "no-emitter");
    let irradiance = solution(&output).light.irradiance;
    assert!(irradiance.iter().all(|e| *e == glam::Vec3::ZERO));
}

/// A lamp in a box whose faces look outwards.
#[test]
fn a_room_turned_inside_out_is_said_to_lose_its_light() {
    let folder = folder();
    let room = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n\
        usemtl wall\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 1 5 7 3\nf 2 4 8 6\nf 3 7 8 4\n";
    let lamp = "v .4 .9 .4\nv .6 .9 .4\nv .6 .9 .6\nv .4 .9 .6\nusemtl lamp\nf 9 10 11 12\n";
    let materials = "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
    let path = folder.path().join("room.obj");
    fs::write(&path, format!("mtllib room.mtl\n{room}{lamp}")).expect("can be written");
    fs::write(folder.path().join("room.mtl"), materials).expect("can be written");
    let output = folder.path().join("out");
    let run = solve(&path, &output, "--preset draft");
    run.assert_success();
    let warning = "light falls on the backs of surfaces that radiate from the front only: 100% of the emitted power";
    assert!(run.err.contains(warning), "{}", run.err);
    let power = &report(&output)["power"];
    assert_eq!(power["onto_backs"], power["escaped"]);
}

/// A lamp above a floor that looks up.
#[test]
fn a_lamp_that_looks_away_from_everything_is_said_to_lose_its_light() {
    let folder = folder();
    let lamp_looking = |order: &str| {
        let scene = format!(
            "mtllib lit.mtl\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nusemtl floor\nf 1 2 3 4\n\
             v .4 .5 .4\nv .6 .5 .4\nv .6 .5 .6\nv .4 .5 .6\nusemtl lamp\nf {order}\n"
        );
        let path = folder.path().join("lit.obj");
        fs::write(&path, scene).expect("can be written");
        let materials = "newmtl floor\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
        fs::write(folder.path().join("lit.mtl"), materials).expect("can be written");
        let run = solve(&path, &folder.path().join("out"), "");
        run.assert_success();
        run.err
    };
    let warning = "light leaves the scene without falling on anything: 100.0% of the emitted power";
    let (up, down) = (lamp_looking("8 7 6 5"), lamp_looking("5 6 7 8"));
    assert!(up.contains(warning), "{up}");
    assert!(!down.contains("light leaves the scene"), "{down}");
}

#[test]
fn options_that_clusters_pass_over_are_warned_of_once() {
    let folder = folder();
    let (path, output) = (floor(&folder), folder.path().join("out"));
    let said = |flags: &str| {
        let run = solve(&path, &output, &format!("--no-pictures {flags}"));
        run.assert_success();
        run.err
    };
    let begin = "no effect on patches that shoot as clusters";
    let options = "--raw-form-factors --shooting mean --form-factor polygon";
    assert!(!said(options).contains(begin), "one patch is no cluster");
    assert!(!said("--cluster-from 0").contains(begin));
    let said = said(&format!("{options} --cluster-from 0"));
    let warning = format!(
        "{begin}, as all do with more than 0 (cluster_from): raw_form_factors, shooting = mean, form_factor = polygon"
    );
    assert!(said.contains(&warning), "{said}");
    let page = fs::read_to_string(output.join("report.html")).expect("was written");
    assert!(page.contains(&warning), "{page}");
    radiosity(&["resume", text(&output), "--no-pictures"]).assert_success();
    let warnings = report(&output)["warnings"].to_string();
    assert_eq!(warnings.matches(begin).count(), 1, "{warnings}");
}

#[test]
fn a_solve_whose_progress_nobody_reads_any_more_is_not_lost() {
    let folder = folder();
    let output = folder.path().join("out");
    let box_ = scene("cornell-box");
    let solve = ["solve", text(&box_), "-o", text(&output), "--no-pictures"];
    let more = ["--preset", "draft", "--progress", "json"];
    let mut child = start(&[&solve[..], &more].concat());
    drop(child.stdout.take());
    finished(child).assert_success();
    assert!(output.join("solution.rad").exists() && output.join("report.json").exists());
}

#[test]
fn info_says_what_a_scene_holds() {
    let run = radiosity(&["info", text(&scene("cornell-box"))]);
    run.assert_success();
    for words in [
        "Cornell box",
        "0.001 m",
        "polygons      19",
        "19 (0 triangles, 19 quads)",
        "emitters      1",
        "front 768x768",
        "red",
    ] {
        assert!(run.out.contains(words), "`{words}` is not in:\n{}", run.out);
    }
}
