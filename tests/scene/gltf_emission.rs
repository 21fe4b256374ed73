//! glTF: how much light emissive textures give off.

use super::gltf::{load, png, textured};
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Pixels along a side.
const SIDE: u32 = 128;

/// The square of 1 m² with an emissive texture that is black but for the pixels that are `lit`, at full strength π · 10⁶ W/m².
fn glowing(lit: impl Fn(u32, u32) -> bool) -> Value {
    let pixel = |i: u32| [if lit(i % SIDE, i / SIDE) { 255 } else { 0 }; 3];
    let pixels: Vec<[u8; 3]> = (0..SIDE * SIDE).map(pixel).collect();
    let mut document = textured("image/png", &png(SIDE, SIDE, &pixels));
    document["extensionsUsed"] =
        json!(["KHR_materials_emissive_strength", "KHR_texture_transform"]);
    let material = &mut document["materials"][0];
    material["pbrMetallicRoughness"] = json!({ "baseColorFactor": [0.5, 0.5, 0.5, 1.0] });
    material["emissiveFactor"] = json!([1, 1, 1]);
    material["emissiveTexture"] = json!({ "index": 0 });
    let strength = json!({ "emissiveStrength": 179e6 });
    material["extensions"] = json!({ "KHR_materials_emissive_strength": strength });
    document
}

#[track_caller]
fn assert_lit(document: &Value, share: f64) {
    let (scene, _) = load(document);
    let watts = scene.summary().emitted_power.x;
    let expected = PI * 1e6 * share;
    assert!(
        (watts - expected).abs() <= 1e-3 * expected,
        "{watts} W for {expected} W"
    );
}

#[test]
fn a_few_bright_texels_of_many_give_off_what_they_should() {
    let all = f64::from(SIDE * SIDE);
    for few in [1, 2, 3, 5] {
        let lit = |x: u32, y: u32| (60..60 + few).contains(&x) && (40..40 + few).contains(&y);
        assert_lit(&glowing(lit), f64::from(few * few) / all);
    }
    // On the line where two triangles of the square meet, and in a corner.
    assert_lit(&glowing(|x, y| x == 63 && y == 64), 1.0 / all);
    assert_lit(&glowing(|x, y| x == 0 && y == 0), 1.0 / all);
    assert_lit(&glowing(|_, _| true), 1.0);
    assert_eq!(load(&glowing(|_, _| false)).0.summary().emitters, 0);
}

#[test]
fn repeated_turned_and_clamped_they_do_as_well() {
    let all = f64::from(SIDE * SIDE);
    let placed = |transform: Value, wrap: u32| {
        let mut document = glowing(|x, y| x == 0 && y == 70);
        document["materials"][0]["emissiveTexture"]["extensions"] =
            json!({ "KHR_texture_transform": transform });
        document["samplers"] = json!([{ "wrapS": wrap, "wrapT": wrap }]);
        document["textures"][0]["sampler"] = json!(0);
        document
    };
    const CLAMP: u32 = 33071;
    const REPEAT: u32 = 10497;
    const MIRROR: u32 = 33648;
    for wrap in [REPEAT, MIRROR] {
        assert_lit(&placed(json!({ "offset": [-2, 6] }), wrap), 1.0 / all);
        assert_lit(&placed(json!({ "scale": [2, 2] }), wrap), 1.0 / all);
        assert_lit(&placed(json!({ "scale": [5.5, 1] }), wrap), {
            // Repeated, it is the first of each of six tiles; mirrored it is at the beginning, and twice beside every other seam.
            if wrap == REPEAT {
                6.0 / 5.5 / all
            } else {
                5.0 / 5.5 / all
            }
        });
    }
    // The row of the lit texel goes on to the left.
    let left = placed(json!({ "offset": [-1, 0] }), CLAMP);
    assert_lit(&left, 1.0 / f64::from(SIDE));
}
