//! glTF that is refused, and how that is said.

use super::Files;
use super::gltf::{files, square};
use super::gltf_lights::with_light;
use super::mutations::{assert_sound, damage};
use serde_json::{Value, json};

/// The message for the square with one value changed.
fn refusal(pointer: &str, value: Value) -> String {
    let mut document = square();
    let (parent, key) = pointer.rsplit_once('/').expect("is a pointer");
    let parent = document.pointer_mut(parent).expect("is there");
    match key.parse::<usize>() {
        Ok(index) => parent[index] = value,
        Err(_) => parent[key] = value,
    }
    files(&document).refusal("it.gltf")
}

#[test]
fn what_is_wrong_is_said() {
    let data = |text: &str| json!(format!("data:;base64,{text}"));
    for (pointer, value, words) in [
        (
            "/nodes/0",
            json!({ "mesh": 7 }),
            &["breaks the rules", "mesh"][..],
        ),
        (
            "/nodes/0",
            json!({ "children": [0] }),
            &["node 0 twice in the tree"],
        ),
        (
            "/images",
            json!([{ "name": "nowhere" }]),
            &["image 0 without a source", "`uri` or `bufferView`"],
        ),
        (
            "/images",
            json!([{ "bufferView": 0 }]),
            &["image 0 without a type", "`mimeType`"],
        ),
        (
            "/cameras",
            json!([{ "type": "perspective",
                     "orthographic": { "xmag": 1, "ymag": 1, "zfar": 9, "znear": 1 } }]),
            &["camera 0 without its view", "`perspective`"],
        ),
        (
            "/cameras",
            json!([{ "type": "orthographic", "perspective": { "yfov": 1, "znear": 1 } }]),
            &["camera 0 without its view", "`orthographic`"],
        ),
        (
            "/accessors/0/count",
            json!(5),
            &["accessor 0 beyond the end", "mesh 0"],
        ),
        (
            "/accessors/2/count",
            json!(1u64 << 62),
            &["accessor 2 beyond the end"],
        ),
        (
            "/accessors/0/byteOffset",
            json!(u64::MAX),
            &["accessor 0 beyond the end"],
        ),
        (
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            &["buffer view 0 beyond the end"],
        ),
        (
            "/bufferViews/2/byteOffset",
            json!(12),
            &["index 16256 of 4 vertices"],
        ),
        (
            "/accessors/2/componentType",
            json!(5126),
            &["accessor 2 of a wrong kind"],
        ),
        (
            "/buffers/0/uri",
            json!("none.bin"),
            &["none.bin unreadable"],
        ),
        (
            "/buffers/0/uri",
            json!("../none.bin"),
            &["`../none.bin`", "stays in the folder"],
        ),
        (
            "/buffers/0/uri",
            json!("http://x/y"),
            &["`http://x/y`", "relative path"],
        ),
        (
            "/buffers/0/uri",
            json!("%FF%"),
            &["`%FF%`", "relative path"],
        ),
        (
            "/buffers/0/uri",
            data("AAAA"),
            &["buffer 0 with 3 bytes", "92 bytes"],
        ),
        ("/buffers/0/uri", data("!"), &["the data", "base64"]),
        ("/meshes/0/primitives/0/mode", json!(1), &["no polygons"]),
        (
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            &["`KHR_draco_mesh_compression`", "without compression"],
        ),
    ] {
        let message = refusal(pointer, value);
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
        assert!(message.starts_with("it.gltf: found "), "{message}");
    }
}

#[test]
fn lights_without_a_surface_need_a_word() {
    let message = files(&with_light(json!({ "type": "point" }))).refusal("it.gltf");
    for word in ["1 lights that have no surface", "`point_light_radius`"] {
        assert!(message.contains(word), "{message}");
    }
    let toml = "geometry = 'it.gltf'\npoint_light_radius = 0.1\n";
    let sun = with_light(json!({ "type": "directional" })).to_string();
    let message = Files::new(&[("it.gltf", sun), ("scene.toml", toml.into())]).refusal("");
    assert!(message.contains("a directional light"), "{message}");
    let toml = "geometry = 'it.gltf'\npoint_light_radius = -1\n";
    let message = Files::new(&[
        ("it.gltf", square().to_string()),
        ("scene.toml", toml.into()),
    ]);
    let message = message.refusal("");
    assert!(
        message.contains("scene.toml:2: found point_light_radius = -1"),
        "{message}"
    );
}

#[test]
fn lights_stand_where_polygons_may() {
    let refusal = |place: f64, radius: f64| {
        let mut document = with_light(json!({ "type": "point" }));
        document["nodes"][1]["translation"] = json!([0, place, 0]);
        let toml = format!("geometry = 'it.gltf'\npoint_light_radius = {radius:e}\n");
        let files = [("it.gltf", document.to_string()), ("scene.toml", toml)];
        Files::new(&files).refusal("")
    };
    for (place, radius) in [(2e18, 1.0), (9e17, 9e17)] {
        let message = refusal(place, radius);
        assert!(
            message.starts_with("it.gltf: found a light at [0, "),
            "{message}"
        );
        assert!(message.ends_with("expected finite coordinates, at most 1e18"));
    }
    let message = refusal(1.0, 2e18);
    assert!(
        message.contains("expected a radius up to 1e18"),
        "{message}"
    );
}

#[test]
fn other_files_are_not_gltf() {
    for content in [
        "",
        "glTF",
        "{",
        "[]",
        "glTF\x02\0\0\0\u{7f}\u{7f}\u{7f}\u{7f}",
        "{}",
    ] {
        for name in ["it.gltf", "it.glb"] {
            let message = Files::new(&[(name, content)]).refusal(name);
            assert!(message.starts_with(&format!("{name}: found ")), "{message}");
        }
    }
}

#[test]
fn mutated_files_never_panic() {
    let spot = json!({ "type": "spot", "spot": {} });
    let mut document = with_light(spot);
    document["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
    document["materials"][0]["doubleSided"] = json!(true);
    let toml = "geometry = 'it.gltf'\npoint_light_radius = 0.1\n";
    let text = document.to_string();
    let files = Files::new(&[("it.gltf", text.as_str()), ("scene.toml", toml)]);
    assert_sound(&files.accepted("").0);
    let accepted = damage(&files, "it.gltf", text.as_bytes(), 600);
    assert!((10..600).contains(&accepted), "{accepted} of 600");
}
