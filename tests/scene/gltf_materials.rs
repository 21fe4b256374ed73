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
