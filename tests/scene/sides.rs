//! Which sides radiate when nobody says so.

use super::{Files, obj};
use radiosity::scene::{Scene, Sides};

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

/// A cube from outside, in lines.
const CUBE: [&str; 6] = [
    "f 1 4 3 2",
    "f 5 6 7 8",
    "f 1 2 6 5",
    "f 3 4 8 7",
    "f 2 3 7 6",
    "f 1 5 8 4",
];

/// The cube as a room, seen from inside.
fn turned() -> [String; 6] {
    CUBE.map(|face| {
        let corners: Vec<&str> = face[2..].split(' ').rev().collect();
        format!("f {}", corners.join(" "))
    })
}

fn cube(faces: &[&str]) -> Scene {
    obj(&format!("{CORNERS}{}\n", faces.join("\n"))).0
}

#[track_caller]
fn assert_all(scene: &Scene, sides: Sides) {
    assert!(
        scene.surfaces.iter().all(|surface| surface.sides == sides),
        "{:?}",
        scene.surfaces
    );
}

#[test]
fn a_closed_box_radiates_from_its_front() {
    assert_all(&cube(&CUBE), Sides::Front);
    assert_all(
        &cube(&turned().each_ref().map(String::as_str)),
        Sides::Front,
    );
}

/// Its front would be seen by nobody.
#[test]
fn a_box_that_is_inside_out_has_two_sides() {
    let room = format!("{CORNERS}{}\n", turned().join("\n"));
    let sheet = |x: f64| format!("v {x} 0.4 0.5\nv {x} 0.6 0.4\nv {x} 0.5 0.6\nf 9 10 11\n");
    let (beside, _) = obj(&format!("{room}{}", sheet(2.0)));
    assert_all(&beside, Sides::Both);
    let warning = "obj:9: 6 polygons of closed solids that are inside out made two-sided";
    assert!(
        beside.warnings.iter().any(|w| w.contains(warning)),
        "{:?}",
        beside.warnings
    );
    let (inside, _) = obj(&format!("{room}{}", sheet(0.5)));
    let skin = inside.surfaces.iter().take(6);
    assert!(skin.clone().all(|surface| surface.sides == Sides::Front));
    assert!(!inside.warnings.iter().any(|w| w.contains("inside out")));
}

#[test]
fn an_open_box_and_a_sheet_have_two_sides() {
    assert_all(&cube(&CUBE[1..]), Sides::Both);
    assert_all(&cube(&CUBE[..1]), Sides::Both);
}

#[test]
fn a_flipped_face_makes_the_box_two_sided() {
    let mut faces = CUBE;
    faces[0] = "f 1 2 3 4";
    assert_all(&cube(&faces), Sides::Both);
}

#[test]
fn a_face_in_pieces_closes_the_box_as_well() {
    let mut faces = CUBE;
    faces[0] = "f 1 4 3\nf 1 3 2";
    assert_all(&cube(&faces), Sides::Front);
}

/// Shading seams repeat positions; the box is closed all the same.
#[test]
fn repeated_positions_are_welded() {
    let mut text = String::new();
    for face in CUBE {
        for corner in face[2..].split(' ') {
            let index: usize = corner.parse().expect("is a number");
            text.push_str(CORNERS.lines().nth(index - 1).expect("is a corner"));
            text.push('\n');
        }
        text.push_str("f -4 -3 -2 -1\n");
    }
    let (scene, _) = obj(&text);
    assert_eq!(scene.vertices.len(), 8);
    assert_all(&scene, Sides::Front);
}

/// A needle without area, made to close a crack, is left out but still closes it.
#[test]
fn polygons_without_area_close_cracks() {
    let text = format!(
        "{CORNERS}v 0.5 0 0\n{}\nf 1 4 3 2\nf 1 2 9\n",
        CUBE[1..].join("\n").replace("f 1 2 6 5", "f 1 9 2 6 5")
    );
    let (scene, _) = obj(&text);
    assert_eq!(scene.summary().two_sided, 0, "{:?}", scene.surfaces);
}

#[test]
fn a_repeated_face_does_not_open_a_box() {
    let mut faces = CUBE.to_vec();
    faces.push("f 3 2 1 4");
    assert_all(&cube(&faces), Sides::Front);
}

/// A wall and a lamp with the same corners: in either order, with another wall, and where a scene file alone makes one of them shine.
#[test]
fn of_repeated_polygons_the_one_that_emits_stays() {
    let mtl =
        "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\nnewmtl paint\nKd .2 .2 .2\n";
    let square = "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\n";
    let kept = |materials: &[&str], toml: &str| {
        let faces: String = (materials.iter().zip(["1 2 3 4", "2 3 4 1", "4 1 2 3"]))
            .map(|(name, corners)| format!("usemtl {name}\nf {corners}\n"))
            .collect();
        let text = format!("mtllib it.mtl\n{square}{faces}");
        let toml = format!("geometry = 'it.obj'\n{toml}");
        let files = [("it.obj", &*text), ("it.mtl", mtl), ("scene.toml", &*toml)];
        let (scene, warnings) = Files::new(&files).accepted("");
        assert_eq!((scene.surfaces.len(), warnings.len()), (1, 1));
        assert!(warnings[0].contains("repeated polygon"), "{warnings:?}");
        let number = scene.surfaces[0].material as usize;
        scene.materials[number].name.clone()
    };
    assert_eq!(kept(&["wall", "lamp"], ""), "lamp");
    assert_eq!(kept(&["lamp", "wall"], ""), "lamp");
    assert_eq!(kept(&["wall", "lamp", "paint"], ""), "lamp");
    assert_eq!(kept(&["paint", "wall"], ""), "paint");
    let paint_shines =
        "[material.lamp]\nemitted_radiance = 0\n[material.paint]\nemitted_radiance = 1\n";
    assert_eq!(kept(&["wall", "lamp", "paint"], paint_shines), "paint");
}

#[test]
fn every_component_is_judged_alone() {
    let sheet = "v 5 0 0\nv 6 0 0\nv 6 1 0\nf 9 10 11";
    let mut faces = CUBE.to_vec();
    faces.push(sheet);
    let scene = cube(&faces);
    assert_all(
        &Scene {
            surfaces: scene.surfaces[..6].to_vec(),
            ..scene.clone()
        },
        Sides::Front,
    );
    assert_eq!(scene.surfaces[6].sides, Sides::Both);
}

#[test]
fn boxes_that_share_an_edge_and_sheets_back_to_back_are_closed() {
    // A second box beyond the edge from corner 3 to corner 7: shares (1, 1, 0) and (1, 1, 1).
    let second = "v 2 1 0\nv 2 2 0\nv 1 2 0\nv 2 1 1\nv 2 2 1\nv 1 2 1\n\
                  f 3 11 10 9\nf 7 12 13 14\nf 3 9 12 7\nf 10 11 14 13\nf 9 10 13 12\nf 3 7 14 11";
    let mut faces = CUBE.to_vec();
    faces.push(second);
    assert_all(&cube(&faces), Sides::Front);
    assert_all(&cube(&["f 1 2 3 4", "f 4 3 2 1"]), Sides::Front);
}

/// Else the back of each would be the front of the other once more. One of five corners is cut in another way when it is turned.
#[test]
fn sheets_back_to_back_radiate_from_a_side_each_whatever_the_rule() {
    let five = "v 3 0 0\nv 5 0 0\nv 6 2 0\nv 4 4 0\nv 3 3 0\nf 9 10 11 12 13\nf 11 10 9 13 12";
    let text = format!("{CORNERS}f 1 2 3 4\nf 4 3 2 1\nf 5 6 7\n{five}\n");
    for rule in ["both", "auto"] {
        let toml = format!("geometry = 'it.obj'\nsides = '{rule}'");
        let (scene, _) =
            Files::new(&[("it.obj", text.as_str()), ("scene.toml", &toml)]).accepted("");
        for surface in &scene.surfaces {
            let is_single = surface.polygon == 2;
            let expected = if is_single { Sides::Both } else { Sides::Front };
            assert_eq!(surface.sides, expected, "{rule}: {surface:?}");
        }
    }
}

#[test]
fn settings_come_before_the_shape_and_materials_before_the_scene() {
    let text = format!(
        "{CORNERS}usemtl a\n{}\nusemtl b\n{}\n",
        CUBE[..3].join("\n"),
        CUBE[3..5].join("\n")
    );
    let sides = |toml: &str| {
        let toml = format!("geometry = 'it.obj'\n{toml}");
        let (scene, _) =
            Files::new(&[("it.obj", text.as_str()), ("scene.toml", &toml)]).accepted("");
        (scene.surfaces[0].sides, scene.surfaces[3].sides)
    };
    assert_eq!(sides(""), (Sides::Both, Sides::Both));
    assert_eq!(sides("sides = 'auto'"), (Sides::Both, Sides::Both));
    assert_eq!(sides("sides = 'front'"), (Sides::Front, Sides::Front));
    assert_eq!(
        sides("sides = 'front'\nmaterial.b.sides = 'both'"),
        (Sides::Front, Sides::Both)
    );
    assert_eq!(
        sides("material.a.sides = 'front'"),
        (Sides::Front, Sides::Both)
    );
    assert_eq!(
        sides("sides = 'front'\nmaterial.a.sides = 'auto'"),
        (Sides::Both, Sides::Front)
    );
}
