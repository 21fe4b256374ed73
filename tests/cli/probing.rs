//! `radiosity probe`.

use super::{draft, radiosity, text};
use std::fs;
use std::path::Path;

/// A point on the floor of the Cornell box, one in the open, one on the floor that looks down.
const POINTS: &str = "name,x,y,z,nx,ny,nz,note\n\
                      floor,150,0,400,0,1,0,\"kept, as it is\"\n\
                      open,278,273,280,0,1,0,\n\
                      below,150,0,400,0,-1,0,\n";

fn rows(table: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(table.as_bytes());
    reader
        .records()
        .map(|record| {
            record
                .expect("is a table")
                .iter()
                .map(str::to_owned)
                .collect()
        })
        .collect()
}

fn assert_probed(table: &str) {
    let rows = rows(table);
    let light = [
        "radiosity_r",
        "radiosity_g",
        "radiosity_b",
        "irradiance_r",
        "irradiance_g",
        "irradiance_b",
    ];
    assert_eq!(
        rows[0][..8],
        ["name", "x", "y", "z", "nx", "ny", "nz", "note"]
    );
    assert_eq!(rows[0][8..], light);
    assert_eq!(
        rows[1][..8],
        ["floor", "150", "0", "400", "0", "1", "0", "kept, as it is"]
    );
    let numbers: Vec<f64> = rows[1][8..]
        .iter()
        .map(|cell| cell.parse().expect("is a number"))
        .collect();
    for (channel, reflectance) in [0.725, 0.71, 0.68].into_iter().enumerate() {
        let (radiosity, irradiance) = (numbers[channel], numbers[channel + 3]);
        assert!(
            irradiance > 0.0 && (radiosity / irradiance / reflectance - 1.0).abs() < 1e-5,
            "{numbers:?}"
        );
    }
    for missed in &rows[2..] {
        assert!(missed[8..].iter().all(String::is_empty), "{missed:?}");
    }
    assert_eq!(rows.len(), 4);
}

#[test]
fn points_get_their_light_and_other_columns_stay() {
    let (folder, solved) = draft("cornell-box");
    let points = folder.path().join("points.csv");
    fs::write(&points, POINTS).expect("can be written");

    let run = radiosity(&["probe", text(&solved), text(&points)]);
    run.assert_success();
    assert_probed(&run.out);
    assert!(
        run.err.contains("2 points lie on no surface"),
        "{}",
        run.err
    );

    let output = folder.path().join("lit.csv");
    let run = radiosity(&["probe", text(&solved), text(&points), "-o", text(&output)]);
    run.assert_success();
    assert_eq!(run.out, "");
    let once = fs::read_to_string(&output).expect("was written");
    assert_probed(&once);

    let again = radiosity(&["probe", text(&solved), text(&output)]);
    assert_eq!(again.out, once, "the light of an earlier probe is replaced");
}

#[test]
fn tables_without_places_are_refused_with_their_line() {
    let (folder, solved) = draft("geometry");
    let refused = |content: &str, words: &[&str]| {
        let points = folder.path().join("points.csv");
        fs::write(&points, content).expect("can be written");
        let run = radiosity(&["probe", text(&solved), text(&points)]);
        run.assert_refused(3, words);
        assert_eq!(run.out, "", "half a table");
    };
    refused("x,y,z\n0,0,0\n", &["points.csv:1", "`nx`"]);
    refused(
        "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n0,0,high,0,1,0\n",
        &["points.csv:3", "`high`", "column z"],
    );
    refused(
        "x,y,z,nx,ny,nz\n0,0,inf,0,1,0\n",
        &["points.csv:2", "`inf`"],
    );
    refused(
        "x,y,z,nx,ny,nz\n0,0\n",
        &["points.csv:2", "2 columns", "expected 6"],
    );
    refused("", &["points.csv:1"]);
    refused(
        "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n0,0,0,0,-0,0\n",
        &["points.csv:3", "normal 0,0,0", "direction"],
    );
    let points = folder.path().join("points.csv");
    fs::write(&points, b"x,y,z,nx,ny,nz\n0,0,0,0,1,\xff\n").expect("can be written");
    let run = radiosity(&["probe", text(&solved), text(&points)]);
    run.assert_refused(3, &["points.csv:2", "not UTF-8"]);
    let missing = folder.path().join("none.csv");
    radiosity(&["probe", text(&solved), text(&missing)]).assert_refused(3, &["none.csv"]);
    radiosity(&["probe", text(Path::new("/nowhere")), text(&missing)])
        .assert_refused(3, &["/nowhere/solution.rad"]);
}

#[test]
fn both_ways_to_probe_are_told() {
    for arguments in [
        &["probe", "out", "--spacing", "1"][..],
        &["probe", "--help"],
    ] {
        let run = radiosity(arguments);
        let said = run.out + &run.err;
        for way in ["<SOLUTION> <POINTS>\n", "<SOLUTION> --grid <PLANE>\n"] {
            let way = format!("radiosity probe [OPTIONS] {way}");
            assert!(said.contains(&way), "{said}");
        }
    }
}

#[test]
fn a_table_of_points_may_name_threads() {
    let (folder, solved) = draft("cornell-box");
    let points = folder.path().join("points.csv");
    fs::write(&points, POINTS).expect("can be written");
    let run = radiosity(&["probe", text(&solved), text(&points), "--threads", "1"]);
    run.assert_success();
    assert_probed(&run.out);
}
