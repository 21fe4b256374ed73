//! PLY in its three formats, and what is refused.

use super::Files;
use super::mutations::{assert_sound, damage};
use glam::DVec3;
use radiosity::scene::Corners;

const TEXT: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\n\
                    property float y\nproperty float z\nproperty uchar red\nelement edge 1\nproperty list uchar int v\n\
                    element face 1\nproperty list uchar int vertex_indices\nend_header\n\
                    0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n2 0 1\n4 0 1 2 3\n";

/// The square in binary.
fn binary(big: bool) -> Vec<u8> {
    let name = if big { "big" } else { "little" };
    let header = TEXT.split("end_header\n").next().expect("has a header");
    let header = header.replace("ascii", &format!("binary_{name}_endian"));
    let mut bytes = format!("{header}end_header\n").into_bytes();
    let mut put = |number: &[u8]| match big {
        true => bytes.extend(number.iter().rev()),
        false => bytes.extend(number),
    };
    for corner in [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        for coordinate in [corner[0], corner[1], 0.0] {
            put(&coordinate.to_le_bytes());
        }
        put(&[9]);
    }
    put(&[2]);
    [0i32, 1].iter().for_each(|v| put(&v.to_le_bytes()));
    put(&[4]);
    [0i32, 1, 2, 3].iter().for_each(|v| put(&v.to_le_bytes()));
    bytes
}

#[test]
fn all_three_formats_say_the_same() {
    for bytes in [TEXT.as_bytes().to_vec(), binary(false), binary(true)] {
        let (scene, warnings) = Files::new(&[("it.ply", bytes)]).accepted("it.ply");
        assert_eq!(scene.surfaces[0].corners, Corners::Quad([0, 1, 2, 3]));
        assert_eq!(scene.normal(&scene.surfaces[0]), DVec3::Z);
        assert_eq!(scene.bounds(), (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)));
        let expected = [
            "it.ply: colours of the vertices ignored",
            "it.ply: 1 polygon without a material, given a grey of 0.5",
        ];
        assert_eq!(warnings, expected);
    }
}

#[test]
fn a_scene_file_gives_it_unit_axis_and_light() {
    let toml = "geometry = 'it.ply'\nunit = 'mm'\nup = 'z'\n[material.default]\nreflectance = 0.2\nemitted_radiance = 3\n";
    let (scene, warnings) = Files::new(&[("it.ply", TEXT), ("scene.toml", toml)]).accepted("");
    assert_eq!(scene.normal(&scene.surfaces[0]), DVec3::Y);
    assert_eq!(scene.summary().emitters, 1);
    assert_eq!((scene.metres_per_unit, warnings.len()), (0.001, 1));
}

#[test]
fn what_is_wrong_is_said() {
    for (from, to, words) in [
        ("ply\n", "plx\n", &["it.ply:1", "`plx`", "`ply`"][..]),
        (
            "ascii",
            "utf8",
            &["it.ply:2", "`utf8`", "binary_little_endian"],
        ),
        ("format ascii 1.0\n", "", &["no `format`"]),
        (
            "element vertex 4",
            "element vertex x",
            &["it.ply:4", "`x`", "a count"],
        ),
        (
            "element vertex 4",
            "element vertex 9",
            &["in vertex 6 of 9", "the header says"],
        ),
        ("property float z\n", "", &["vertices without a place"]),
        ("float y", "real y", &["it.ply:6", "`property real y`"]),
        ("vertex_indices", "corners", &["faces without corners"]),
        (
            "element face 1\n",
            "element fact 1\n",
            &["no `element face`"],
        ),
        ("end_header\n", "", &["it.ply:13", "`0 0 0 9`"]),
        ("4 0 1 2 3", "4 0 1 2 4", &["vertex 4 of 4 in face 0 of 1"]),
        ("4 0 1 2 3", "4 0 1 2 -3", &["-3", "face 0"]),
        (
            "4 0 1 2 3",
            "2 0 1 2 3",
            &[
                "found a polygon with 2 corners in face 0 of 1",
                "expected 3 to 4096 corners",
            ],
        ),
        ("4 0 1 2 3", "4 0 1", &["the end of the file in face 0"]),
        (
            "1 1 0 9",
            "1 nan 0 9",
            &[
                "the position",
                "vertex 2 of 4",
                "expected finite coordinates",
            ],
        ),
        ("1 1 0 9", "1 one 0 9", &["`one` in vertex 2"]),
    ] {
        assert!(TEXT.contains(from), "{from}");
        let message = Files::new(&[("it.ply", TEXT.replacen(from, to, 1))]).refusal("it.ply");
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
    }
}

#[test]
fn mutated_files_never_panic() {
    for bytes in [TEXT.as_bytes().to_vec(), binary(false)] {
        let toml = "geometry = 'it.ply'\n";
        let files = Files::new(&[
            ("it.ply", bytes.as_slice()),
            ("scene.toml", toml.as_bytes()),
        ]);
        assert_sound(&files.accepted("").0);
        let accepted = damage(&files, "it.ply", &bytes, 500);
        assert!((1..500).contains(&accepted), "{accepted} of 500");
    }
}
