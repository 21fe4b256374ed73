//! `radiosity form-factors`.

use super::{finished, folder, names, radiosity, scene, start, text, wait_until};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;
use tempfile::TempDir;

/// A closed unit cube of six named faces, radiating inwards.
pub(super) fn cube(folder: &TempDir) -> PathBuf {
    let path = folder.path().join("cube.obj");
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
               o back\nf 1 2 3 4\no front\nf 5 8 7 6\no floor\nf 1 5 6 2\no top\nf 4 3 7 8\no left\nf 1 4 8 5\no right\nf 2 6 7 3\n";
    fs::write(&path, obj).expect("can be written");
    path
}

/// F between faces of a cube: opposite (C-11) and beside (C-14).
pub(super) const OPPOSITE: f64 = 0.19982489569838746;
const BESIDE: f64 = 0.20004377607540316;

fn assert_cube(value: f64, i: usize, j: usize) {
    let expected = match (i, j) {
        _ if i == j => 0.0,
        _ if i / 2 == j / 2 => OPPOSITE,
        _ => BESIDE,
    };
    assert!(
        (value - expected).abs() < 1e-6,
        "F_{i}{j} = {value}, not {expected}"
    );
}

pub(super) fn form_factors(input: &Path, output: &Path, more: &[&str]) -> super::Run {
    radiosity(&[&["form-factors", text(input), "-o", text(output)], more].concat())
}

#[test]
fn a_dense_table_has_a_row_for_every_surface_that_ends_in_its_factors() {
    let folder = folder();
    let output = folder.path().join("F.csv");
    let run = form_factors(&cube(&folder), &output, &[]);
    run.assert_success();
    assert!(
        run.out.contains("6 rows") && run.out.contains("closed"),
        "{}",
        run.out
    );
    assert_eq!(
        names(folder.path()),
        ["F.certificate.json", "F.csv", "cube.obj"]
    );
    let table = fs::read_to_string(&output).expect("was written");
    assert!(
        table.starts_with("# radiosity") && table.contains("F_ij, dimensionless"),
        "{table}"
    );
    let lines: Vec<&str> = table
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    assert_eq!(lines.len(), 7);
    assert!(lines[0].starts_with(
        "label,area_m2,covered_m2,row_sum,row_error,limited,to back,to front,to floor"
    ));
    for (i, line) in lines[1..].iter().enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(
            cells[0],
            ["back", "front", "floor", "top", "left", "right"][i]
        );
        for (j, cell) in cells[cells.len() - 6..].iter().enumerate() {
            assert_cube(cell.parse().expect("is a number"), i, j);
        }
    }
    let json = fs::read_to_string(folder.path().join("F.certificate.json")).expect("was written");
    let report: serde_json::Value = serde_json::from_str(&json).expect("is JSON");
    assert_eq!(report["closed"], true);
    assert_eq!(
        report["certificate"]["row_sums"].as_array().map(Vec::len),
        Some(6)
    );
    assert_eq!(report["labels"][2], "floor");
}

/// The array of a name in an .npz: what its head says, and its bytes.
fn array(path: &Path, name: &str) -> (String, Vec<u8>) {
    let file = fs::File::open(path).expect("was written");
    let mut zip = zip::ZipArchive::new(file).expect("is a zip");
    let mut bytes = Vec::new();
    let mut entry = zip.by_name(&format!("{name}.npy")).expect("is in it");
    entry.read_to_end(&mut bytes).expect("can be read");
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!((10 + length) % 64, 0, "the data are aligned");
    let data = bytes.split_off(10 + length);
    (String::from_utf8_lossy(&bytes[10..]).into_owned(), data)
}

#[test]
fn numpy_reads_the_matrix_with_areas_and_labels() {
    let folder = folder();
    let output = folder.path().join("F.npz");
    form_factors(&cube(&folder), &output, &[]).assert_success();
    let (head, data) = array(&output, "F");
    assert!(
        head.contains("'descr': '<f8'") && head.contains("'shape': (6, 6,)"),
        "{head}"
    );
    for (k, bytes) in data.chunks_exact(8).enumerate() {
        let value = f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
        assert_cube(value, k / 6, k % 6);
    }
    let (head, data) = array(&output, "label");
    assert!(head.contains("'<U5'") && head.contains("(6,)"), "{head}");
    let first: String = data
        .chunks_exact(4)
        .take(5)
        .filter_map(|c| char::from_u32(u32::from(c[0])))
        .collect();
    assert_eq!(first.trim_end_matches('\0'), "back");
    let (_, areas) = array(&output, "area");
    assert_eq!(areas.len(), 48);
}

#[test]
fn a_sparse_matrix_counts_its_entries_and_says_what_it_left_out() {
    let folder = folder();
    let output = folder.path().join("F.mtx");
    let run = form_factors(&cube(&folder), &output, &["--cut-off", "0.2"]);
    run.assert_success();
    assert!(run.out.contains("left out: 6 entries"), "{}", run.out);
    let matrix = fs::read_to_string(&output).expect("was written");
    let mut lines = matrix.lines().filter(|line| !line.starts_with('%'));
    assert!(matrix.starts_with("%%MatrixMarket matrix coordinate real general\n"));
    let counts: Vec<usize> = lines
        .next()
        .expect("sizes")
        .split_whitespace()
        .map(|n| n.parse().expect("a count"))
        .collect();
    assert_eq!(counts, [6, 6, 24]);
    let entries: Vec<&str> = lines.collect();
    assert_eq!(entries.len(), 24);
    for entry in entries {
        let cells: Vec<f64> = entry
            .split_whitespace()
            .map(|n| n.parse().expect("a number"))
            .collect();
        assert_cube(cells[2], cells[0] as usize - 1, cells[1] as usize - 1);
    }
}

#[test]
fn an_open_scene_is_said_to_be_open_and_not_forced_shut() {
    let folder = folder();
    let output = folder.path().join("F.csv");
    let run = form_factors(&scene("cornell-box"), &output, &["--solve"]);
    run.assert_success();
    assert!(
        run.out.contains("open, ") && run.out.contains("escapes"),
        "{}",
        run.out
    );
    let solved = fs::read_to_string(folder.path().join("F.radiosity.csv")).expect("was written");
    assert!(
        solved.starts_with("label,area_m2,exitance_r_W_m2"),
        "{solved}"
    );
    let run = form_factors(
        &scene("cornell-box"),
        &folder.path().join("G.csv"),
        &["--enforce", "closure"],
    );
    run.assert_refused(3, &["open", "row sum"]);
    assert!(!folder.path().join("G.csv").exists());
}

#[test]
fn bad_input_is_refused_with_its_reason() {
    let folder = folder();
    let cube = cube(&folder);
    form_factors(&cube, &folder.path().join("F.xlsx"), &[])
        .assert_refused(2, &["xlsx", ".csv, .npz or .mtx"]);
    form_factors(Path::new("no/such.obj"), &folder.path().join("F.csv"), &[])
        .assert_refused(3, &["no/such.obj"]);
    form_factors(&cube, &folder.path().join("no/such/F.csv"), &[])
        .assert_refused(1, &["cannot write", "F.csv"]);
    form_factors(&cube, &folder.path().join("F.csv"), &["--max-area", "1e-9"])
        .assert_refused(3, &["6000000 pieces", "200000", "larger max-area"]);
    fs::create_dir(folder.path().join("D.csv")).expect("can be made");
    form_factors(&cube, &folder.path().join("D.csv"), &[])
        .assert_refused(1, &["D.csv", "directory"]);
    fs::remove_dir(folder.path().join("D.csv")).expect("is empty");
    for flags in [
        ["--tolerance", "0"],
        ["--max-area", "nan"],
        ["--by", "colour"],
        ["--enforce", "peace"],
        ["--cut-off", "inf"],
        ["--cut-off", "2"],
        ["--cut-off", "0.1"],
    ] {
        assert_eq!(
            form_factors(&cube, &folder.path().join("F.csv"), &flags).code,
            Some(2),
            "{flags:?}"
        );
    }
    assert_eq!(names(folder.path()), ["cube.obj"]);
}

#[test]
fn walls_that_face_outwards_are_named() {
    let folder = folder();
    let obj = fs::read_to_string(cube(&folder)).expect("was written");
    let turned = |which: &str| {
        let mut lines: Vec<String> = Vec::new();
        let mut name = "";
        for line in obj.lines() {
            name = line.strip_prefix("o ").unwrap_or(name);
            let corners = line.strip_prefix("f ").filter(|_| which.contains(name));
            lines.push(corners.map_or(line.to_owned(), |corners| {
                let turned: Vec<&str> = corners.split(' ').rev().collect();
                format!("f {}", turned.join(" "))
            }));
        }
        let path = folder.path().join("turned.obj");
        fs::write(&path, lines.join("\n")).expect("can be written");
        let run = form_factors(&path, &folder.path().join("F.csv"), &[]);
        run.assert_success();
        run
    };
    let run = turned("floor");
    assert!(run.out.contains("open"), "{}", run.out);
    assert!(
        run.err.contains("1 of 6 rows see no other (`floor`)"),
        "{}",
        run.err
    );
    let run = turned("back front floor top left right");
    assert!(run.err.contains("no row sees any other"), "{}", run.err);
    let json = fs::read_to_string(folder.path().join("F.certificate.json")).expect("was written");
    assert!(json.contains("no row sees any other"), "{json}");
}

#[test]
fn more_than_all_is_not_called_open() {
    let folder = folder();
    let path = cube(&folder);
    let mut obj = fs::read_to_string(&path).expect("was written");
    // Part of the floor is there twice.
    obj += "v .2 0 .2\nv .2 0 .8\nv .8 0 .8\nv .8 0 .2\no rug\nf 9 10 11 12\n";
    fs::write(&path, obj).expect("can be written");
    let run = form_factors(&path, &folder.path().join("F.csv"), &[]);
    run.assert_success();
    assert!(!run.out.contains("open"), "{}", run.out);
    assert!(run.out.contains("too large, "), "{}", run.out);
    assert!(
        run.err.contains("5 rows (`back`, ") && run.err.contains("sum up to more than 1"),
        "{}",
        run.err
    );
    let json = fs::read_to_string(folder.path().join("F.certificate.json")).expect("was written");
    assert!(json.contains("\"exceeding\""), "{json}");
}

#[test]
#[cfg(unix)]
fn an_interrupted_run_leaves_nothing_behind() {
    let folder = folder();
    let output = folder.path().join("F.csv");
    let box_ = scene("cornell-box");
    // Minutes of work.
    let matrix = ["form-factors", text(&box_), "-o", text(&output)];
    let child = start(&[&matrix[..], &["--max-area", "2e-4"]].concat());
    let is_writing = || !names(folder.path()).is_empty();
    // That the folder can be written to is tried first, so it must last.
    wait_until(|| {
        let begun = is_writing();
        sleep(Duration::from_millis(200));
        begun && is_writing()
    });
    assert!(names(folder.path())[0].ends_with(".part"));
    super::send("INT", &child);
    let run = finished(child);
    assert_eq!(run.code, Some(130), "{}", run.err);
    assert!(
        names(folder.path()).is_empty(),
        "{:?}",
        names(folder.path())
    );
}
