//! What rows stand for: names, sides, parts.

use crate::setup::{close, portable};
use radiosity::codec::{base64, encode_png};
use radiosity::matrix::{By, Enclosure, MatrixError, Options, Row};
use radiosity::scene::NamedScene;
use serde_json::{Value, json};
use std::fs;

const OBJ: &str = "mtllib m.mtl\n\
    v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
    v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    usemtl plain\n\
    f 1 2 3 4\n\
    o lid\nusemtl sheet\nf 5 8 7 6\n\
    g walls\nusemtl plain\nf 1 5 6 2\nf 2 6 7 3\n";

fn load(toml: &str, obj: &str) -> NamedScene {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    fs::write(folder.path().join("s.obj"), obj).expect("can be written");
    fs::write(
        folder.path().join("m.mtl"),
        "newmtl plain\nKd 0.5 0.5 0.5\nnewmtl sheet\nKd 0.2 0.2 0.2\n",
    )
    .expect("can be written");
    fs::write(
        folder.path().join("scene.toml"),
        format!("geometry = \"s.obj\"\n{toml}"),
    )
    .expect("can be written");
    NamedScene::load(folder.path()).expect("is a scene")
}

fn rows(named: &NamedScene, options: Options) -> Vec<Row> {
    Enclosure::new(named, &options)
        .expect("radiates")
        .rows()
        .to_vec()
}

fn labels(rows: &[Row]) -> Vec<&str> {
    rows.iter().map(|row| row.label.as_str()).collect()
}

#[test]
fn surfaces_go_by_the_names_of_the_file_in_its_order() {
    let found = rows(&load("", OBJ), portable());
    assert_eq!(labels(&found), ["1", "lid", "walls:1", "walls:2"]);
    assert!(
        found
            .iter()
            .all(|row| (row.area - 1.0).abs() < 1e-12 && !row.back)
    );
}

#[test]
fn a_two_sided_material_gives_two_rows_and_nothing_else_does() {
    let found = rows(
        &load("[material.sheet]\nsides = \"both\"\n", OBJ),
        portable(),
    );
    assert_eq!(
        labels(&found),
        ["1", "lid", "lid back", "walls:1", "walls:2"]
    );
    assert!(found[2].back);
    let all = rows(&load("sides = \"both\"\n", OBJ), portable());
    assert_eq!(all.len(), 8);
}

#[test]
fn groups_and_materials_collect_surfaces() {
    let named = load("unit = \"mm\"\n", OBJ);
    let groups = rows(
        &named,
        Options {
            by: By::Group,
            ..portable()
        },
    );
    assert_eq!(labels(&groups), ["1", "lid", "walls"]);
    close(groups[2].area, 2e-6, 1e-18, "two walls of 1 mm²");
    let materials = rows(
        &named,
        Options {
            by: By::Material,
            ..portable()
        },
    );
    assert_eq!(labels(&materials), ["plain", "sheet"]);
    close(materials[0].reflectance.x, 0.5, 1e-7, "reflectance");
}

/// Two triangles of 0.5 m² and 2 m², each a node `chair` with the material `wood`, over the white and over the black half of its texture.
fn chairs() -> Value {
    let mut bytes = Vec::new();
    bytes.extend([0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes));
    bytes.extend([0.25f32, 0.5].repeat(3).into_iter().map(f32::to_le_bytes));
    bytes.extend([0.75f32, 0.5].repeat(3).into_iter().map(f32::to_le_bytes));
    let mut halves = Vec::new();
    encode_png(&mut halves, 2, 1, &[[255; 3], [0; 3]]).expect("memory can be written to");
    let uri = |bytes: &[u8]| format!("data:;base64,{}", base64(bytes));
    let mesh = |half: u32| json!({ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": half }, "material": 0 }] });
    json!({
        "asset": { "version": "2.0" },
        "nodes": [
            { "name": "chair", "mesh": 0 },
            { "name": "chair", "mesh": 1, "translation": [0, 0, 1], "scale": [2, 2, 1] },
        ],
        "meshes": [mesh(1), mesh(2)],
        "materials": [{ "name": "wood", "pbrMetallicRoughness": {
            "baseColorFactor": [0.8, 0.8, 0.8, 1.0], "baseColorTexture": { "index": 0 },
        } }],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": uri(&halves) }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 36, "byteLength": 24 },
            { "buffer": 0, "byteOffset": 60, "byteLength": 24 },
        ],
        "buffers": [{ "byteLength": 84, "uri": uri(bytes.as_flattened()) }],
    })
}

#[test]
fn what_has_one_name_in_a_gltf_file_is_one_row_with_the_mean_of_its_colours() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("it.gltf");
    fs::write(&path, chairs().to_string()).expect("can be written");
    let named = NamedScene::load(&path).expect("is a scene");
    assert_eq!(named.scene.materials.len(), 2, "one for each colour");
    let by = |by: By| rows(&named, Options { by, ..portable() });
    assert_eq!(labels(&by(By::Surface)), ["chair:1", "chair:2"]);
    for (name, found) in [("chair", by(By::Group)), ("wood", by(By::Material))] {
        assert_eq!(labels(&found), [name]);
        close(found[0].area, 2.5, 1e-12, "area");
        close(found[0].reflectance.x, 0.8 * 0.5 / 2.5, 1e-7, "reflectance");
    }
}

#[test]
fn materials_that_are_in_no_file_are_rows_all_the_same() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("it.obj");
    let sheets = "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl oak\nf 1 2 3 4\nusemtl glass\nf 4 3 2 1\n";
    fs::write(&path, sheets).expect("can be written");
    let named = NamedScene::load(&path).expect("is a scene");
    let warnings = &named.scene.warnings;
    assert!(warnings[0].contains("`mtllib none.mtl`"), "{warnings:?}");
    let options = Options {
        by: By::Material,
        ..portable()
    };
    assert_eq!(labels(&rows(&named, options)), ["oak", "glass"]);
    // Light depends on them.
    assert!(NamedScene::load_lit(&path).is_err());
}

#[test]
fn names_that_look_like_those_of_other_rows_are_told_apart() {
    let sheets = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\no lid back\nf 1 2 3\no lid\nf 4 5 6\n";
    let found = rows(&load("sides = \"both\"\n", sheets), portable());
    let expected = ["lid back", "lid back back", "lid", "lid back'"];
    assert_eq!(labels(&found), expected);
}

#[test]
fn parts_are_no_larger_than_asked_and_numbered() {
    let obj = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 3\no slab\nf 1 2 3 4\no fin\nf 1 2 5\n";
    let found = rows(
        &load("", obj),
        Options {
            max_area: Some(0.3),
            ..portable()
        },
    );
    let slab: Vec<&Row> = found
        .iter()
        .filter(|row| row.label.starts_with("slab/"))
        .collect();
    let fin: Vec<&Row> = found
        .iter()
        .filter(|row| row.label.starts_with("fin/"))
        .collect();
    assert_eq!((slab.len(), fin.len()), (8, 16));
    assert!(found.iter().all(|row| row.area <= 0.3 + 1e-12));
    close(
        slab.iter().map(|row| row.area).sum(),
        2.0,
        1e-12,
        "area of the slab",
    );
    close(
        fin.iter().map(|row| row.area).sum(),
        3.0,
        1e-12,
        "area of the fin",
    );
    assert_eq!(labels(&found)[7..9], ["slab/8", "fin/1"]);
}

#[test]
fn a_strip_is_cut_across_only_wherever_its_corners_begin() {
    let obj = "v 0 0 0\nv 1000 0 0\nv 1000 1 0\nv 0 1 0\nv 0 0 1\nv 1000 0 1\nv 1000 1 1\nv 0 1 1\n\
        o long\nf 1 2 3 4\no short\nf 6 7 8 5\n";
    let options = Options {
        max_area: Some(500.0),
        ..portable()
    };
    let found = rows(&load("", obj), options);
    assert_eq!(labels(&found), ["long/1", "long/2", "short/1", "short/2"]);
}

/// Cells of a grid are alike in its coordinates, not in area.
#[test]
fn no_part_of_a_quad_that_is_no_parallelogram_is_larger_than_asked() {
    let obj = "v 0 0 0\nv 1.4 0 0\nv 0.8 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let options = Options {
        max_area: Some(0.3),
        ..portable()
    };
    let found = rows(&load("", obj), options);
    let sum = found.iter().map(|row| row.area).sum();
    close(sum, 1.1, 1e-12, "area of the trapezoid");
    for row in &found {
        assert!(row.area < 0.3001, "{}: {}", row.label, row.area);
    }
}

#[test]
fn as_many_parts_are_counted_as_would_be_made() {
    let triangle = load("", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let options = Options {
        max_area: Some(0.5 / 300_000.0),
        ..portable()
    };
    let refused = Enclosure::new(&triangle, &options);
    let made = 548 * 548;
    assert!(
        matches!(refused, Err(MatrixError::TooLarge { pieces, .. }) if pieces == made),
        "{refused:?}"
    );
}

#[test]
fn a_polygon_of_many_corners_is_one_row() {
    let mut obj = String::new();
    for k in 0..12 {
        let angle = f64::from(k) / 12.0 * std::f64::consts::TAU;
        obj += &format!("v {} {} 0\n", angle.cos(), angle.sin());
    }
    obj += "f 1 2 3 4 5 6 7 8 9 10 11 12\nv 0 0 1\nv 0 1 1\nv 1 1 1\nv 1 0 1\nf 13 14 15 16\n";
    let found = rows(&load("", &obj), portable());
    assert_eq!(labels(&found), ["1", "2"]);
    close(found[0].area, 3.0, 1e-12, "area of a twelve-sided polygon");
}

#[test]
fn surfaces_that_lie_over_one_another_are_named() {
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nv 1.5 0.5 0\nv 1.5 1.5 0\nv 0.5 1.5 0\nf 1 2 3 4\nf 5 6 7 8\n";
    let named = load("", obj);
    let enclosure = Enclosure::new(&named, &portable()).expect("radiates");
    let named: Vec<&String> = enclosure
        .warnings()
        .iter()
        .filter(|w| w.contains("overlaps"))
        .collect();
    assert_eq!(named.len(), 1);
    assert!(
        named[0].contains("s.obj:10") && named[0].contains("s.obj:9"),
        "{named:?}"
    );
}

/// The back of one faces as the front of the other.
#[test]
fn surfaces_wound_the_opposite_way_are_named_where_one_has_two_sides() {
    let obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nv 1.5 0.5 0\nv 1.5 1.5 0\nv 0.5 1.5 0\n\
        usemtl plain\nf 1 2 3 4\nusemtl sheet\nf 8 7 6 5\n";
    let count = |toml: &str| {
        let enclosure = Enclosure::new(&load(toml, obj), &portable()).expect("radiates");
        let warnings = enclosure.warnings().iter();
        warnings.filter(|w| w.contains("overlaps")).count()
    };
    assert_eq!(count(""), 0);
    assert_eq!(count("material.plain.sides = \"both\"\n"), 1);
    assert_eq!(count("material.sheet.sides = \"both\"\n"), 1);
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let named = load("", OBJ);
    for options in [
        Options {
            tolerance: 0.0,
            ..portable()
        },
        Options {
            max_area: Some(f64::NAN),
            ..portable()
        },
        Options {
            max_area: Some(-1.0),
            ..portable()
        },
    ] {
        assert!(matches!(
            Enclosure::new(&named, &options),
            Err(MatrixError::Option { .. })
        ));
    }
}
