//! `radiosity export`, and the formats that `radiosity solve` writes.

use super::{Run, command, draft, floor, folder, names, radiosity, text};
use std::fs;

#[test]
fn a_solution_is_exported_as_solve_itself_writes_it() {
    let (folder, solved) = draft("geometry");
    for format in ["glb", "ply", "vtu"] {
        let output = folder.path().join(format!("again.{format}"));
        radiosity(&["export", text(&solved), "-o", text(&output)]).assert_success();
        let (first, again) = (
            fs::read(solved.join(format!("solution.{format}"))),
            fs::read(&output),
        );
        assert!(
            first.expect("solve wrote it") == again.expect("export wrote it"),
            "{format} differs"
        );
    }
}

#[test]
fn exposure_changes_colours_and_efficacy_lux() {
    let (folder, solved) = draft("geometry");
    let export = |name: &str, flag: &str, value: &str| {
        let output = folder.path().join(name);
        radiosity(&["export", text(&solved), "-o", text(&output), flag, value]).assert_success();
        fs::read(&output).expect("was written")
    };
    assert_ne!(
        export("a.obj", "--exposure", "-1"),
        export("b.obj", "--exposure", "2.5")
    );
    let [one, many] = ["1", "179"].map(|efficacy| {
        let vtu = export(&format!("{efficacy}.vtu"), "--efficacy", efficacy);
        illuminance(&vtu)
    });
    assert!(one.iter().any(|lux| *lux > 0.0));
    assert_eq!(one.len(), many.len());
    for (one, many) in one.into_iter().zip(many) {
        assert!((179.0 * one - many).abs() <= 1e-6 * many, "{one}, {many}");
    }
}

/// The array `illuminance (lx)` of a `.vtu`.
fn illuminance(vtu: &[u8]) -> Vec<f32> {
    const START: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
    let start = vtu.windows(START.len()).position(|bytes| bytes == START);
    let (header, data) = vtu.split_at(start.expect("has data") + START.len());
    let header = String::from_utf8_lossy(header);
    let array = header.split("Name=\"illuminance (lx)\"").nth(1);
    let offset = array.and_then(|array| array.split("offset=\"").nth(1)?.split('"').next());
    let offset: usize = offset
        .and_then(|text| text.parse().ok())
        .expect("is stated");
    let (length, numbers) = data[offset..].split_at(8);
    let length = u64::from_le_bytes(length.try_into().expect("8 bytes")) as usize;
    let numbers = numbers[..length].as_chunks::<4>().0.iter();
    numbers.map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

#[test]
fn endings_that_are_no_format_are_refused() {
    let (folder, solved) = draft("geometry");
    for name in ["mesh.stl", "mesh", ".glb"] {
        let output = folder.path().join(name);
        let run = radiosity(&["export", text(&solved), "-o", text(&output)]);
        run.assert_refused(2, &[name, ".glb, .obj, .ply, .vtu"]);
    }
    assert_eq!(names(folder.path()), ["solved"]);
    radiosity(&["export", "/nowhere", "-o", "/nowhere/a.glb"])
        .assert_refused(3, &["/nowhere/solution.rad"]);
}

#[test]
fn solve_writes_the_formats_that_are_asked_for() {
    let folder = folder();
    let scene = floor(&folder);
    for (list, expected) in [
        ("none", &["report.html", "report.json", "solution.rad"][..]),
        (
            "obj, vtu,obj",
            &[
                "report.html",
                "report.json",
                "solution.obj",
                "solution.rad",
                "solution.vtu",
            ],
        ),
    ] {
        let output = folder.path().join("out").join(&list[..3]);
        let solve = ["solve", text(&scene), "-o", text(&output), "--no-pictures"];
        radiosity(&[&solve[..], &["--formats", list]].concat()).assert_success();
        assert_eq!(names(&output), expected, "{list}");
    }
    let wrong = radiosity(&["solve", text(&scene), "-o", "x", "--formats", "glb,stl"]);
    wrong.assert_refused(2, &["`stl`", "glb, obj, ply, vtu or none"]);
}

#[test]
fn a_written_glb_is_a_scene_again() {
    let (_folder, solved) = draft("cornell-box");
    let run = radiosity(&["info", text(&solved.join("solution.glb"))]);
    run.assert_success();
    for words in [
        "unit          1 m",
        "emitters      0",
        "camera        front",
    ] {
        assert!(run.out.contains(words), "`{words}` is not in:\n{}", run.out);
    }
}

#[test]
fn objects_keep_their_names_in_a_scene_with_a_warning_wherever_its_path_starts() {
    let folder = folder();
    let obj = "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 1 0\nv 0 1 1\nv 1 1 1\nv 1 1 0\n\
               o floor\nf 1 2 3 4\nf 1 1 2\no ceiling\nf 5 8 7 6\n";
    let path = folder.path().join("room.obj");
    fs::write(&path, obj).expect("can be written");
    for scene in ["room.obj", text(&path)] {
        let solve = ["solve", scene, "-o", "out", "--no-pictures"];
        let run = command()
            .current_dir(folder.path())
            .args(solve)
            .output()
            .expect("can be started");
        let run = Run::from(run);
        run.assert_success();
        assert!(run.err.contains("without area"), "{}", run.err);
        let glb = folder.path().join("out/solution.glb");
        let gltf = gltf::Gltf::open(glb).unwrap_or_else(|error| panic!("{error}"));
        let names: Vec<_> = gltf.meshes().filter_map(|mesh| mesh.name()).collect();
        assert_eq!(names, ["floor", "ceiling"], "{scene}");
    }
}

#[test]
fn the_cornell_box_has_its_size_in_metres_and_its_camera() {
    let (_folder, solved) = draft("cornell-box");
    let (document, _) = gltf::Gltf::open(solved.join("solution.glb"))
        .map(|gltf| (gltf.document, gltf.blob))
        .unwrap_or_else(|error| panic!("{error}"));
    let camera = document.cameras().next().expect("has a camera");
    assert_eq!(camera.name(), Some("front"));
    let positions = document.accessors().next().expect("has positions");
    let highest = positions.max().expect("is stated");
    for (coordinate, millimetres) in [556.0, 548.8, 559.2].into_iter().enumerate() {
        let metres = highest[coordinate].as_f64().expect("is a number");
        assert!((1000.0 * metres - millimetres).abs() < 0.5, "{highest}");
    }
}
