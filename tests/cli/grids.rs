//! `radiosity probe --grid`.

use super::{draft, folder, names, radiosity, solve, text};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A room of 2 m by 2 m by 4 m that is black, with a square light of 1 m in the middle of its ceiling.
fn room(folder: &TempDir) -> PathBuf {
    let obj = "mtllib room.mtl\n\
               v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nv 0 4 0\nv 2 4 0\nv 2 4 2\nv 0 4 2\n\
               v .5 3.999 .5\nv 1.5 3.999 .5\nv 1.5 3.999 1.5\nv .5 3.999 1.5\n\
               usemtl black\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n\
               usemtl lamp\nf 9 10 11 12\n";
    let mtl = "newmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
    fs::write(folder.path().join("room.mtl"), mtl).expect("can be written");
    let path = folder.path().join("room.obj");
    fs::write(&path, obj).expect("can be written");
    path
}

fn solved(scene: &Path, folder: &TempDir) -> PathBuf {
    let output = folder.path().join("solved");
    let quick = "--preset draft --no-pictures --formats none";
    solve(scene, &output, quick).assert_success();
    output
}

/// The columns of lux and place, of the rows with light.
fn lit(table: &str) -> Vec<([f64; 3], f64)> {
    let number = |cell: &str| cell.parse::<f64>().expect("is a number");
    let rows = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect::<Vec<_>>());
    rows.filter(|row| !row[9].is_empty())
        .map(|row| ([0, 1, 2].map(|i| number(row[i])), number(row[9])))
        .collect()
}

/// Form factor from a point below the corner of a rectangle of `a` by `b`, at the distance `c`, parallel to it.
fn below_corner(a: f64, b: f64, c: f64) -> f64 {
    let part = |a: f64, b: f64| {
        let root = a.hypot(c);
        a / root * (b / root).atan()
    };
    (part(a, b) + part(b, a)) / std::f64::consts::TAU
}

#[test]
fn a_plane_of_work_has_the_illuminance_of_the_closed_form() {
    let folder = folder();
    let solution = solved(&room(&folder), &folder);
    let (table, picture) = (
        folder.path().join("grid.csv"),
        folder.path().join("grid.png"),
    );
    let plane = [
        "probe",
        text(&solution),
        "--grid",
        "y=1m",
        "--spacing",
        "50cm",
    ];
    let files = ["-o", text(&table), "--picture", text(&picture)];
    let run = radiosity(&[&plane[..], &files].concat());
    run.assert_success();
    let rows = lit(&fs::read_to_string(&table).expect("was written"));
    assert_eq!(rows.len(), 16);
    let mut sum = 0.0;
    for ([x, y, z], lux) in &rows {
        assert_eq!(*y, 1.0);
        // The light as a sum of signed rectangles with a corner above the point.
        let span = |at: f64| [0.5 - at, 1.5 - at];
        let [[x0, x1], [z0, z1]] = [span(*x), span(*z)];
        let signed =
            |a: f64, b: f64| a.signum() * b.signum() * below_corner(a.abs(), b.abs(), 2.999);
        let factor = signed(x1, z1) - signed(x0, z1) - signed(x1, z0) + signed(x0, z0);
        let expected = 179.0 * std::f64::consts::PI * factor;
        assert!(
            (lux / expected - 1.0).abs() < 2e-3,
            "{lux} lx for {expected} at {x}, {z}"
        );
        sum += lux;
    }
    let mean = format!("mean {:.4} lx", sum / 16.0);
    assert!(
        run.out.contains("4 x 4 points\n") && run.out.contains(&mean),
        "{}",
        run.out
    );
    let least = rows
        .iter()
        .map(|(_, lux)| *lux)
        .fold(f64::INFINITY, f64::min);
    let uniformity = format!("minimum/mean {:.4}", least / (sum / 16.0));
    assert!(run.out.contains(&uniformity), "{}", run.out);
    let picture = radiosity::codec::decode_png(&fs::read(&picture).expect("was written"));
    let picture = picture.unwrap_or_else(|reason| panic!("{reason}"));
    assert!(picture.width > 400 && picture.colours.contains(&[255; 3]));
}

/// A closed room of L shape with a lamp: a quarter of the box around it is outside.
#[test]
fn points_outside_of_the_room_are_left_out() {
    let folder = folder();
    let plan = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]];
    let mut room = String::from("mtllib it.mtl\n");
    for y in [0, 3] {
        plan.iter()
            .for_each(|[x, z]| room += &format!("v {x} {y} {z}\n"));
    }
    room += "usemtl wall\nf 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
    for i in 0..6 {
        let (a, b) = (i + 1, (i + 1) % 6 + 1);
        room += &format!("f {a} {b} {} {}\n", b + 6, a + 6);
    }
    room += "v .8 2.9 .8\nv 1.2 2.9 .8\nv 1.2 2.9 1.2\nv .8 2.9 1.2\nusemtl lamp\nf 13 14 15 16\n";
    let path = folder.path().join("it.obj");
    fs::write(&path, room).expect("can be written");
    let materials = "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 9 9 9\n";
    fs::write(folder.path().join("it.mtl"), materials).expect("can be written");
    let output = folder.path().join("out");
    solve(&path, &output, "--no-pictures --preset draft").assert_success();
    for grid in ["y=1", "-y=1"] {
        let run = radiosity(&["probe", text(&output), "--grid", grid, "--spacing", "0.25"]);
        run.assert_success();
        let said = "16 x 16 points, 64 of them inside solids or outside of rooms and left out";
        assert!(run.err.contains(said), "{}", run.err);
    }
    let run = radiosity(&["probe", text(&output), "--grid", "y=5"]);
    run.assert_success();
    assert!(run.err.contains("all of them"), "{}", run.err);
}

#[test]
fn planes_face_either_way_and_points_in_solids_are_left_out() {
    let (_folder, solution) = draft("cornell-box");
    let probe = |grid: &str, more: &[&str]| {
        let plane = ["probe", text(&solution), "--grid", grid];
        radiosity(&[&plane[..], more].concat())
    };
    let jpeg = probe("y=100mm", &["--picture", "lux.jpg"]);
    assert_eq!(jpeg.code, Some(2));
    assert!(jpeg.err.contains(".png"), "{}", jpeg.err);
    // 100 mm above the floor some points lie inside the two blocks.
    let run = probe("y=100mm", &["--spacing", "0.05m"]);
    run.assert_success();
    assert!(
        run.err
            .contains("of them inside solids or outside of rooms and left out"),
        "{}",
        run.err
    );
    let empty = run.out.lines().filter(|row| row.ends_with(",,,")).count();
    let (rows, share) = (
        run.out.lines().count() - 1,
        165.0 * 165.0 * 2.0 / (550.0 * 560.0),
    );
    let found = empty as f64 / rows as f64;
    assert!(
        (found - share).abs() < 0.05,
        "{empty} of {rows} points in the blocks"
    );
    let mean = |grid: &str| {
        let run = probe(grid, &["--region", "100,100,400,200", "--spacing", "100"]);
        run.assert_success();
        let rows = lit(&run.out);
        assert_eq!(rows.len(), 3, "{}", run.out);
        rows.iter().map(|(_, lux)| lux).sum::<f64>() / 3.0
    };
    assert!(
        mean("y=450") > 2.0 * mean("-y=450"),
        "most light comes from above"
    );
    let run = probe("y=450", &["--region", "100,100,400,200", "--efficacy", "1"]);
    let lumens = lit(&run.out)[0].1;
    let run = probe("y=450", &["--region", "100,100,400,200"]);
    assert!((lit(&run.out)[0].1 / lumens / 179.0 - 1.0).abs() < 1e-4);
}

#[test]
fn grids_that_make_no_sense_are_refused() {
    let (folder, solution) = draft("geometry");
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let run = radiosity(&[&["probe", text(&solution)][..], arguments].concat());
        run.assert_refused(code, words);
        assert_eq!(run.out, "", "half a table");
    };
    refused(&["--grid", "u=1"], 2, &["such as y=0.8m"]);
    refused(&["--grid", "y"], 2, &["such as y=0.8m"]);
    refused(
        &["--grid", "y=1", "--spacing", "tiny"],
        2,
        &["such as 0.25m"],
    );
    refused(
        &["--grid", "y=1", "--region", "0,0,0,1"],
        2,
        &["span an area"],
    );
    refused(
        &["--grid", "y=1", "points.csv"],
        2,
        &["cannot be used with"],
    );
    refused(
        &["--spacing", "1m", "points.csv"],
        2,
        &["cannot be used with"],
    );
    refused(&[], 2, &["required"]);
    refused(
        &["--grid", "y=1", "--spacing", "1e-9"],
        2,
        &["4000000 at most"],
    );
    refused(&["--grid", "y=1", "--spacing", "0"], 2, &["such as 0.25m"]);
    assert_eq!(names(folder.path()), ["solved"]);
}
