//! glTF: what becomes of lights that have no surface.

use super::Files;
use super::gltf::square;
use glam::DVec3;
use radiosity::radiometry::WHITE_EFFICACY;
use radiosity::scene::Scene;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// A square with a light of 895 cd above.
pub fn with_light(kind: Value) -> Value {
    let mut document = square();
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    let mut light = json!({ "color": [1.0, 0.5, 0.0], "intensity": 895.0 });
    for (key, value) in kind.as_object().expect("is an object") {
        light[key] = value.clone();
    }
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    document["nodes"][0]["children"] = json!([1]);
    let nodes = document["nodes"].as_array_mut().expect("is a list");
    nodes.push(json!({
        "name": "bulb", "translation": [0, 0, 2],
        "extensions": { "KHR_lights_punctual": { "light": 0 } },
    }));
    document
}

fn with_radius(document: &Value, radius: f64) -> (Scene, Vec<String>) {
    with_settings(document, &format!("point_light_radius = {radius}"))
}

fn with_settings(document: &Value, toml: &str) -> (Scene, Vec<String>) {
    let toml = format!("geometry = 'it.gltf'\n{toml}\n");
    Files::new(&[("it.gltf", document.to_string()), ("scene.toml", toml)]).accepted("")
}

#[test]
fn points_of_light_become_spheres_of_the_same_flux_on_request() {
    let document = with_light(json!({ "type": "point" }));
    let (scene, _) = with_radius(&document, 0.1);
    let summary = scene.summary();
    assert_eq!((summary.emitters, summary.two_sided), (20, 0));
    // 895 cd are 5 W/sr at 179 lm/W.
    let watts = 4.0 * PI * 895.0 / WHITE_EFFICACY;
    let expected = DVec3::new(watts, watts / 2.0, 0.0);
    assert!(summary.emitted_power.distance(expected) < 1e-4 * watts);
    for surface in scene.surfaces.iter().skip(1) {
        let centre = scene.positions(surface).sum::<DVec3>() / 3.0 - DVec3::new(0.0, 0.0, 2.0);
        assert!(centre.length() < 0.1 && centre.dot(scene.normal(surface)) > 0.0);
    }
    let (scene, warnings) = with_radius(&document, 0.0);
    assert_eq!((scene.summary().emitters, warnings.len()), (0, 1));
    assert!(warnings[0].contains("1 lights that have no surface left out"));
}

#[test]
fn spots_become_squares_as_bright_along_their_axis() {
    let spot = json!({ "type": "spot", "spot": { "outerConeAngle": 0.5 } });
    let (scene, warnings) = with_radius(&with_light(spot), 0.1);
    let lamp = &scene.surfaces[1];
    assert!(scene.normal(lamp).distance(DVec3::NEG_Z) < 1e-9);
    let radiance = scene.materials[lamp.material as usize].emitted_radiance;
    let intensity = f64::from(radiance.x) * scene.area(lamp);
    assert!((intensity - 5.0).abs() < 1e-4, "{intensity} W/sr");
    assert!(warnings[0].contains("spot lights"), "{warnings:?}");
}

/// The same bulb, of 0.1 m, in scenes of other units.
#[test]
fn the_flux_of_a_light_is_that_of_its_candela_whatever_the_unit() {
    for (light, share) in [
        (json!({ "type": "point" }), 4.0 * PI),
        (json!({ "type": "spot", "spot": {} }), PI),
    ] {
        let document = with_light(light);
        for (unit, metres) in [("m", 1.0), ("cm", 0.01), ("ft", 0.3048)] {
            let toml = format!("unit = '{unit}'\npoint_light_radius = {}", 0.1 / metres);
            let (scene, _) = with_settings(&document, &toml);
            let watts = share * 895.0 / WHITE_EFFICACY;
            let found = scene.summary().emitted_power.x;
            assert!((found - watts).abs() < 1e-4 * watts, "{found} W in {unit}");
        }
    }
}
