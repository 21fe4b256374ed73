//! What cannot be solved, and how that is said.

use super::{folder, names, radiosity, scene, solve, text};
use std::fs;
use std::time::{Duration, Instant};

#[test]
fn a_path_that_is_not_there_is_bad_input() {
    let folder = folder();
    for command in [
        &["info"][..],
        &["solve", "-o", text(&folder.path().join("out"))],
    ] {
        radiosity(&[command, &["no/such/scene.obj"]].concat())
            .assert_refused(3, &["no/such/scene.obj", "no such file"]);
    }
    assert!(
        names(folder.path()).is_empty(),
        "no folder for results that will not come"
    );
}

#[test]
fn a_scene_whose_geometry_is_missing_names_the_file() {
    let folder = folder();
    fs::write(
        folder.path().join("scene.toml"),
        "geometry = \"gone.obj\"\n",
    )
    .expect("can be written");
    solve(folder.path(), &folder.path().join("out"), "").assert_refused(3, &["gone.obj"]);
}

#[test]
fn a_scene_without_surfaces_is_bad_input() {
    let folder = folder();
    let path = folder.path().join("empty.obj");
    fs::write(&path, "v 0 0 0\nv 1 0 0\n").expect("can be written");
    solve(&path, &folder.path().join("out"), "").assert_refused(3, &["empty.obj"]);
}

#[test]
fn an_output_that_cannot_be_written_is_found_out_before_the_solve() {
    let folder = folder();
    let file = folder.path().join("file");
    fs::write(&file, "in the way").expect("can be written");
    let started = Instant::now();
    for output in [file.clone(), file.join("out")] {
        let run = solve(&scene("cornell-box"), &output, "--preset accurate");
        run.assert_refused(1, &["cannot write to", text(&file)]);
    }
    assert!(
        started.elapsed() < Duration::from_secs(10),
        "an accurate solve takes minutes"
    );
    assert_eq!(
        fs::read_to_string(&file).expect("is still there"),
        "in the way"
    );
}

#[test]
#[cfg(not(embree))]
fn embree_is_refused_with_advice_where_it_was_not_built() {
    let folder = folder();
    let run = solve(&scene("geometry"), folder.path(), "--engine embree");
    run.assert_refused(1, &["built without Embree", "obvhs"]);
}

#[test]
#[cfg(embree)]
fn embree_solves_where_it_was_built() {
    let folder = folder();
    let flags = "--engine embree --preset draft --no-pictures --max-shots 1";
    let run = solve(&scene("geometry"), folder.path(), flags);
    run.assert_success();
    assert!(run.out.contains("by embree"), "{}", run.out);
}

#[test]
fn wrong_usage_ends_with_2() {
    let folder = folder();
    let output = text(folder.path());
    let geometry = scene("geometry");
    for flags in [
        "--engine magic",
        "--preset best",
        "--preset draft --target-error 1%",
        "--target-error 1",
        "--audit-points 0 --target-error 1%",
        "--eps-v 2",
        "--eps-d=-1",
        "--eps-d nan",
        "--local-share 1.5",
        "--max-depth 18",
        "--tolerance inf",
        "--time-limit 0",
        "--threads=-1",
        "--threads 100000",
        "--audit-points 1000001",
        "--unknown",
    ] {
        let run = solve(&geometry, folder.path(), flags);
        assert_eq!(run.code, Some(2), "{flags}: {}", run.err);
        let name = flags.split([' ', '=']).next().unwrap_or_default();
        assert!(run.err.contains(name), "{flags}: {}", run.err);
    }
    let eaten = radiosity(&["solve", "--checkpoint", text(&geometry), "-o", output]);
    assert_eq!(eaten.code, Some(2), "{}", eaten.err);
    assert!(
        eaten.err.contains("name it before the flag"),
        "{}",
        eaten.err
    );
    assert_eq!(
        radiosity(&["solve", text(&geometry)]).code,
        Some(2),
        "there is no output"
    );
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_negative_number_is_a_value_that_is_refused_and_no_unknown_flag() {
    for (flags, expected) in [
        (["--tolerance", "-1"], "expected a number from 0 to 1"),
        // Percent were meant, and it would have ended before the first shot.
        (["--tolerance", "5"], "expected a number from 0 to 1"),
        (["--meshing-power", "-1"], "expected a number, 0 or more"),
        (["--eps-d", "-0.5"], "expected a positive number"),
        (["--time-limit", "-3"], "expected a duration"),
        (["--threads", "-2"], "expected a number of threads"),
        (["--formats", "none,ply"], "expected it alone"),
    ] {
        let run = radiosity(&[&["solve", "room.obj", "-o", "out"], &flags[..]].concat());
        run.assert_refused(2, &[flags[0], flags[1], expected]);
    }
}

#[test]
fn a_result_never_replaces_a_file_of_the_scene() {
    let folder = folder();
    let lit = folder.path().join("lit");
    fs::create_dir(&lit).expect("can be made");
    let floor = super::floor(&folder);
    let obj = fs::read_to_string(floor).expect("was written");
    fs::write(lit.join("solution.obj"), &obj).expect("can be written");
    fs::write(lit.join("scene.toml"), "geometry = \"solution.obj\"\n").expect("can be written");
    let before = names(&lit);
    let by_another_way = folder.path().join("lit/../lit");
    for scene in [&lit, &lit.join("solution.obj")] {
        let run = solve(scene, &by_another_way, "--formats glb,obj");
        run.assert_refused(2, &["solution.obj", "belongs to the scene", "-o"]);
        let kept = fs::read_to_string(lit.join("solution.obj")).expect("is still there");
        assert_eq!((kept, names(&lit)), (obj.clone(), before.clone()));
    }
    solve(&lit, &lit, "--no-pictures").assert_success();

    // Nor when a solve of it goes on elsewhere, whether its geometry was named or its folder.
    let first = folder.path().join("first");
    for (scene, format) in [(lit.join("solution.ply"), "ply"), (lit.clone(), "obj")] {
        solve(&scene, &first, "--no-pictures").assert_success();
        let resume = ["resume", text(&first), "-o", text(&lit)];
        let lost = format!("solution.{format}");
        radiosity(&[&resume[..], &["--formats", format]].concat()).assert_refused(2, &[&lost]);
    }
}

#[test]
fn a_picture_never_replaces_a_texture() {
    let folder = folder();
    let texture = folder.path().join("mesh.png");
    let mut png = Vec::new();
    radiosity::codec::encode_png(&mut png, 1, 1, &[[200; 3]]).expect("can be encoded");
    fs::write(&texture, &png).expect("can be written");
    let corners = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,CORNERS"}],
        "images":[{"uri":"mesh.png"}],"textures":[{"source":0}]}"#;
    let scene = folder.path().join("mesh.gltf");
    fs::write(&scene, gltf.replace("CORNERS", corners)).expect("can be written");
    let run = solve(&scene, folder.path(), "");
    run.assert_refused(2, &["mesh.png", "belongs to the scene"]);
    solve(&scene, folder.path(), "--no-pictures").assert_success();
    assert_eq!(fs::read(&texture).expect("is still there"), png);
}

#[test]
fn the_report_is_there_when_a_picture_cannot_be_written() {
    let folder = folder();
    fs::create_dir(folder.path().join("shaded.exr")).expect("can be made");
    let flags = "--max-shots 1 --formats none";
    solve(&scene("geometry"), folder.path(), flags).assert_refused(1, &["shaded.exr"]);
    let kept = ["report.json", "shaded.exr", "solution.rad"];
    assert_eq!(names(folder.path()), kept);
}
