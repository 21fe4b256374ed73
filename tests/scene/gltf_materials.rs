//! glTF: what its materials reflect, and by which names they are known.

use super::Files;
use super::gltf::{load, png, square, textured};
use glam::Vec3;
use serde_json::json;

#[test]
fn of_specular_glossiness_the_diffuse_colour_is_the_reflectance() {
    const NAME: &str = "KHR_materials_pbrSpecularGlossiness";
    let mut document = square();
    document["extensionsUsed"] = json!([NAME]);
    document["extensionsRequired"] = json!([NAME]);
    document["materials"][0]["extensions"] =
        json!({ NAME: { "diffuseFactor": [0.1, 0.2, 0.3, 1.0] } });
    let (scene, warnings) = load(&document);
    assert_eq!(warnings, [""; 0]);
    assert_eq!(scene.materials[0].reflectance, Vec3::new(0.1, 0.2, 0.3));

    // Its texture is meant too, and not that of the base colour.
    let mut document = textured("image/png", &png(1, 1, &[[0, 255, 0]]));
    let material = &mut document["materials"][0];
    let red = png(1, 1, &[[255, 0, 0]]);
    material["extensions"] = json!({ NAME: { "diffuseFactor": [0.5, 0.5, 0.5, 1.0], "diffuseTexture": { "index": 1 } } });
    let uri = format!("data:image/png;base64,{}", radiosity::codec::base64(&red));
    document["images"]
        .as_array_mut()
        .expect("is a list")
        .push(json!({ "uri": uri }));
    document["textures"]
        .as_array_mut()
        .expect("is a list")
        .push(json!({ "source": 1 }));
    let (scene, _) = load(&document);
    assert_eq!(scene.materials[0].reflectance, Vec3::new(0.5, 0.0, 0.0));
}

#[test]
fn a_scene_file_may_speak_of_materials_that_nothing_has() {
    let mut document = square();
    let materials = document["materials"].as_array_mut().expect("is a list");
    materials.extend([json!({ "name": "spare" }), json!({})]);
    let with = |name: &str| {
        let toml = format!("geometry = 'it.gltf'\n[material.'{name}']\nreflectance = 0.125\n");
        Files::new(&[("it.gltf", document.to_string()), ("scene.toml", toml)])
    };
    for name in ["spare", "material 3"] {
        let (scene, warnings) = with(name).accepted("");
        assert_eq!((scene.materials.len(), warnings.len()), (1, 0));
        assert_eq!(scene.materials[0].reflectance, Vec3::new(0.5, 0.25, 0.125));
    }
    let expected = "scene.toml:2: found the material `paper`; expected a material of the geometry: `paint`, `spare`, `material 3`";
    assert_eq!(with("paper").refusal(""), expected);
}

/// The quarter of the texture next to its origin, u to the right and v down, is turned from there to above the origin: which is the lower left
/// quarter, as the texture comes again there.
#[test]
fn textures_are_turned_counter_clockwise_as_seen_in_the_texture() {
    let quarters = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]];
    let mut document = textured("image/png", &png(2, 2, &quarters));
    document["extensionsUsed"] = json!(["KHR_texture_transform"]);
    let mut turned = |turns: f64, scale: [f64; 2], offset: [f64; 2]| {
        let angle = turns * std::f64::consts::TAU;
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = json!({
            "KHR_texture_transform": { "rotation": angle, "scale": scale, "offset": offset },
        });
        let (scene, _) = load(&document);
        scene.materials[0].reflectance / Vec3::new(0.5, 0.25, 0.125)
    };
    let quarter = [0.5, 0.5];
    let cases = [
        (0.0, quarter, [0.0, 0.0], Vec3::X),
        (0.25, quarter, [0.0, 0.0], Vec3::Z),
        (-0.25, quarter, [0.0, 0.0], Vec3::Y),
        (0.5, quarter, [0.0, 0.0], Vec3::ONE),
        // Scaled before it is turned, and moved after.
        (0.25, [1.0, 0.5], [0.0, 0.0], (Vec3::X + Vec3::Z) / 2.0),
        (0.25, quarter, [0.5, 0.0], Vec3::ONE),
    ];
    for (turns, scale, offset, expected) in cases {
        let found = turned(turns, scale, offset);
        assert!(found.distance(expected) < 6e-3, "{turns}: {found}");
    }
}
