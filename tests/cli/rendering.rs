//! `radiosity render`.

use super::{PICTURES, draft, folder, names, radiosity, solve, text, two_cameras};
use std::path::Path;

/// Width and height of a PNG file.
fn size(path: &Path) -> (u32, u32) {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("was written"));
    let reader = png::Decoder::new(file).read_info().expect("is a PNG file");
    (reader.info().width, reader.info().height)
}

#[test]
fn a_solution_is_drawn_from_elsewhere() {
    let (folder, solved) = draft("geometry");
    let output = folder.path().join("pictures");
    let view = [
        "--eye",
        "-3,2,0.5",
        "--look-at",
        "0,0.2,0",
        "--fov",
        "50",
        "--width",
        "64",
        "--height",
        "48",
        "--exposure",
        "-1",
    ];
    radiosity(&[&["render", text(&solved), "-o", text(&output)], &view[..]].concat())
        .assert_success();
    assert_eq!(names(&output), PICTURES);
    assert_eq!(size(&output.join("shaded.png")), (64, 48));
}

#[test]
fn the_scene_s_own_camera_draws_beside_the_solution() {
    let (_folder, solved) = draft("geometry");
    radiosity(&[
        "render",
        text(&solved),
        "--camera",
        "front",
        "--width",
        "40",
        "--height",
        "40",
    ])
    .assert_success();
    assert!(
        PICTURES
            .iter()
            .all(|name| names(&solved).iter().any(|n| n == name))
    );
    assert_eq!(size(&solved.join("wireframe.png")), (40, 40));
}

#[test]
fn another_camera_leaves_the_pictures_of_the_first_alone() {
    let folder = folder();
    let scene = two_cameras(&folder, 16);
    let output = folder.path().join("solved");
    solve(&scene, &output, "--formats none").assert_success();
    let drawn = |flags: &[&str]| {
        let render = ["render", text(&output), "--camera", "second"];
        radiosity(&[&render[..], flags].concat()).assert_success();
    };
    drawn(&["--width", "24"]);
    assert_eq!(size(&output.join("shaded.png")), (16, 16));
    assert_eq!(size(&output.join("second/shaded.png")), (24, 16));
    // In a folder of its own it is the first.
    let elsewhere = folder.path().join("elsewhere");
    drawn(&["-o", text(&elsewhere)]);
    assert_eq!(names(&elsewhere), PICTURES);
}

#[test]
fn a_plan_is_drawn_with_another_way_up() {
    let (folder, solved) = draft("geometry");
    let output = folder.path().join("plan");
    let view = "--eye 0,2.9,0 --look-at 0,0,0 --up 0,0,-1 --width 64 --height 64";
    let view: Vec<&str> = view.split(' ').collect();
    radiosity(&[&["render", text(&solved), "-o", text(&output)], &view[..]].concat())
        .assert_success();
    assert_eq!(size(&output.join("shaded.png")), (64, 64));
}

#[test]
fn a_view_that_cannot_be_is_refused() {
    let (_folder, solved) = draft("geometry");
    let refused = |arguments: &[&str], words: &[&str]| {
        radiosity(&[&["render", text(&solved)], arguments].concat()).assert_refused(2, words);
    };
    refused(&["--camera", "back"], &["`back`", "front"]);
    refused(&["--fov", "180"], &["180"]);
    let down = ["--eye", "0,3,0", "--look-at", "0,0,0"];
    refused(&down, &["up direction", "--up"]);
    let usage = radiosity(&["render", text(&solved), "--eye", "1,2"]);
    assert_eq!(usage.code, Some(2), "{}", usage.err);
    assert!(usage.err.contains("three numbers"), "{}", usage.err);
}

#[test]
fn a_window_needs_a_display_or_the_program_that_has_one() {
    let without = |arguments: &[&str]| -> super::Run {
        let mut command = super::command();
        for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(name);
        }
        let run = command.args(arguments).output().expect("can be started");
        run.into()
    };
    let words = match cfg!(feature = "viewer") {
        true => "no window can be opened",
        false => "--features viewer",
    };
    let folder = folder();
    let output = folder.path().join("out");
    let scene = super::scene("cornell-box");
    let solve = ["solve", text(&scene), "-o", text(&output), "--watch"];
    for arguments in [&["view", "out"][..], &solve] {
        let run = without(arguments);
        run.assert_refused(1, &[words]);
        assert_eq!(run.err.lines().count(), 1, "{}", run.err);
    }
    assert!(!output.exists(), "nothing was begun");
}

#[test]
fn a_solution_is_found_by_its_folder_and_by_its_file() {
    let (folder, solved) = draft("geometry");
    let file = solved.join("solution.rad");
    let copy = folder.path().join("copy.glb");
    radiosity(&["render", text(&file), "--width", "32", "--height", "32"]).assert_success();
    assert!(solved.join("shaded.png").is_file(), "beside the solution");
    radiosity(&["export", text(&file), "-o", text(&copy)]).assert_success();
    radiosity(&["probe", text(&file), "--grid", "y=0.5"]).assert_success();
}

#[test]
fn where_there_is_only_a_checkpoint_the_way_on_is_named() {
    let (_folder, solved) = draft("geometry");
    std::fs::rename(solved.join("solution.rad"), solved.join("checkpoint.rad"))
        .expect("can be renamed");
    for command in [
        &["render"][..],
        &["export", "-o", "a.glb"],
        &["probe", "points.csv"],
    ] {
        let (name, more) = command.split_first().expect("has a name");
        let run = radiosity(&[&[*name, text(&solved)], more].concat());
        run.assert_refused(3, &["checkpoint.rad", "radiosity resume"]);
    }
}
