//! glTF: from which sides its materials radiate and shine.

use super::Files;
use super::gltf::{load, square};
use glam::{DVec3, Vec3};
use radiosity::scene::{Scene, Sides};
use serde_json::json;

#[test]
fn emission_is_in_candela_and_both_sides_of_a_double_sided_sheet_shine() {
    let mut document = square();
    document["extensionsUsed"] = json!(["KHR_materials_emissive_strength"]);
    document["materials"][0]["emissiveFactor"] = json!([1.0, 0.5, 0.25]);
    document["materials"][0]["extensions"] =
        json!({ "KHR_materials_emissive_strength": { "emissiveStrength": 1790.0 } });
    let (scene, _) = load(&document);
    let radiance = scene.materials[0].emitted_radiance;
    assert!(
        radiance.distance(Vec3::new(10.0, 5.0, 2.5)) < 1e-5,
        "{radiance}"
    );
    assert_eq!(scene.surfaces.len(), 1);

    document["materials"][0]["doubleSided"] = json!(true);
    let (scene, _) = load(&document);
    assert_eq!(scene.surfaces.len(), 2);
    let normals = [0, 1].map(|side| scene.normal(&scene.surfaces[side]));
    assert_eq!(normals, [DVec3::Z, DVec3::NEG_Z]);
    assert!(scene.surfaces.iter().all(|s| s.sides == Sides::Front));

    document["materials"][0]["emissiveFactor"] = json!([0, 0, 0]);
    let (scene, _) = load(&document);
    assert_eq!(
        (scene.surfaces.len(), scene.surfaces[0].sides),
        (1, Sides::Both)
    );
}

/// The only square of a double-sided material, with a scene file that goes on like that.
fn double_sided(toml: &str) -> Scene {
    let mut document = square();
    document["materials"][0]["doubleSided"] = json!(true);
    let toml = format!("geometry = 'it.gltf'\n{toml}\n");
    let files = [("it.gltf", document.to_string()), ("scene.toml", toml)];
    Files::new(&files).accepted("").0
}

#[test]
fn what_a_scene_file_makes_shine_shines_from_both_sides_of_a_double_sided_sheet() {
    let shines = |toml: &str| {
        let scene = double_sided(&format!("{toml}\n[material.paint]\nemitted_radiance = 2"));
        let both = scene.surfaces.iter().any(|s| s.sides == Sides::Both);
        (scene.summary().emitters, both)
    };
    assert_eq!(shines(""), (2, false));
    assert_eq!(shines("sides = 'both'"), (2, false));
    assert_eq!(shines("sides = 'front'"), (1, false));
}

#[test]
fn auto_is_what_the_file_says() {
    for (toml, sides) in [
        ("", Sides::Both),
        ("sides = 'auto'", Sides::Both),
        ("material.paint.sides = 'auto'", Sides::Both),
        (
            "sides = 'front'\nmaterial.paint.sides = 'auto'",
            Sides::Both,
        ),
        ("sides = 'front'", Sides::Front),
    ] {
        assert_eq!(double_sided(toml).surfaces[0].sides, sides, "{toml}");
    }
    let toml = "geometry = 'it.gltf'\nsides = 'auto'\n";
    let files = [
        ("it.gltf", square().to_string()),
        ("scene.toml", toml.into()),
    ];
    let (sheet, _) = Files::new(&files).accepted("");
    assert_eq!(sheet.surfaces[0].sides, Sides::Front, "as glTF has it");
}
