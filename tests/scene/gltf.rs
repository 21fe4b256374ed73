//! glTF: what its meshes, materials, cameras and lights become.

use super::Files;
use glam::{DVec3, Vec3};
use radiosity::codec::{base64, encode_png};
use radiosity::scene::{Corners, Scene, Sides};
use serde_json::{Value, json};

/// A square of 1 m in the plane z = 0 that faces +z, as two triangles; accessors: positions, texture coordinates, indices.
pub fn square() -> Value {
    let mut bytes = Vec::new();
    let corners = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for [x, y] in corners {
        bytes.extend([x, y, 0.0].map(f32::to_le_bytes).as_flattened());
    }
    for [x, y] in corners {
        bytes.extend([x, 1.0 - y].map(f32::to_le_bytes).as_flattened());
    }
    let indices = [0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes);
    bytes.extend(indices.as_flattened());
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "floor" }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0,
        }] }],
        "materials": [{
            "name": "paint",
            "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1.0] },
        }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
              "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 12 },
        ],
        "buffers": [{
            "byteLength": bytes.len(),
            "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes)),
        }],
    })
}

pub fn files(document: &Value) -> Files {
    Files::new(&[("it.gltf", document.to_string())])
}

pub fn load(document: &Value) -> (Scene, Vec<String>) {
    files(document).accepted("it.gltf")
}

#[test]
fn two_triangles_of_a_square_are_a_quad_again() {
    let (scene, warnings) = load(&square());
    assert_eq!(warnings, [""; 0]);
    assert_eq!((scene.input_polygons, scene.surfaces.len()), (1, 1));
    assert_eq!(scene.surfaces[0].corners, Corners::Quad([0, 1, 2, 3]));
    assert_eq!(scene.surfaces[0].sides, Sides::Front);
    assert_eq!(scene.normal(&scene.surfaces[0]), DVec3::Z);
    assert_eq!(scene.metres_per_unit, 1.0);
    assert_eq!(scene.materials[0].name, "paint");
    assert_eq!(scene.materials[0].reflectance, Vec3::new(0.5, 0.25, 0.125));
    assert!(!scene.materials[0].emits());
}

#[test]
fn nodes_move_turn_and_mirror() {
    let mut document = square();
    document["nodes"] = json!([
        { "children": [1], "translation": [10, 0, 0] },
        { "mesh": 0, "scale": [2, 3, -1], "rotation": [0, 0, 0.5f64.sqrt(), 0.5f64.sqrt()] },
    ]);
    let (scene, _) = load(&document);
    // A quarter turn about z takes x to y and y to -x; the mirror faces the square the other way.
    let (low, high) = scene.bounds();
    assert!(low.distance(DVec3::new(7.0, 0.0, 0.0)) < 1e-6, "{low}");
    assert!(high.distance(DVec3::new(10.0, 2.0, 0.0)) < 1e-6, "{high}");
    assert!(scene.normal(&scene.surfaces[0]).distance(DVec3::NEG_Z) < 1e-9);
}

#[test]
fn instances_that_are_not_read_are_not_lost_without_a_word() {
    let mut document = square();
    document["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    let (scene, warnings) = load(&document);
    assert_eq!(scene.surfaces.len(), 1);
    let said = |w: &String| w.contains("`EXT_mesh_gpu_instancing` is not read");
    assert!(warnings.iter().any(said), "{warnings:?}");
}

#[test]
fn a_scene_file_has_the_last_word() {
    let document = square();
    let toml = "geometry = 'it.gltf'\nunit = 'cm'\nup = 'z'\nsides = 'both'\n\
                [material.paint]\nreflectance = 0.75\nemitted_radiance = 2\n\
                [[camera]]\nname = 'a'\neye = [0, -3, 1]\nlook_at = [0, 0, 0]\n";
    let files = [
        ("it.gltf", document.to_string()),
        ("scene.toml", toml.into()),
    ];
    let (scene, _) = Files::new(&files).accepted("");
    assert_eq!(scene.materials[0].reflectance, Vec3::splat(0.75));
    assert_eq!(scene.materials[0].emitted_radiance, Vec3::splat(2.0));
    assert_eq!(
        (scene.surfaces[0].sides, scene.metres_per_unit),
        (Sides::Both, 0.01)
    );
    assert_eq!(
        scene.normal(&scene.surfaces[0]),
        DVec3::Y,
        "z of the file is up"
    );
    let camera = &scene.cameras[0];
    assert_eq!(
        (camera.eye, camera.up),
        (DVec3::new(0.0, 1.0, 3.0), DVec3::Y)
    );
}

/// The document with a texture: `media` of those bytes.
pub fn textured(media: &str, bytes: &[u8]) -> Value {
    let mut document = square();
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    document["textures"] = json!([{ "source": 0 }]);
    let uri = format!("data:{media};base64,{}", base64(bytes));
    document["images"] = json!([{ "uri": uri }]);
    document
}

pub fn png(width: u32, height: u32, pixels: &[[u8; 3]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    encode_png(&mut bytes, width, height, pixels).expect("memory can be written to");
    bytes
}

/// The reflectance of the only material, over the factor of the square's.
fn mean(document: &Value) -> Vec3 {
    let (scene, warnings) = load(document);
    assert_eq!(warnings, [""; 0]);
    assert_eq!(scene.materials.len(), 1);
    scene.materials[0].reflectance / Vec3::new(0.5, 0.25, 0.125)
}

#[test]
fn reflectance_is_the_mean_of_the_texture_under_the_polygon() {
    let rows = png(1, 2, &[[255, 0, 0], [0, 0, 255]]);
    let document = textured("image/png", &rows);
    // Light is averaged, not its code; to the 8 bits in which means are kept.
    assert!(mean(&document).distance(Vec3::new(0.5, 0.0, 0.5)) < 6e-3);
    let mut upper = document.clone();
    upper["extensionsUsed"] = json!(["KHR_texture_transform"]);
    upper["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "scale": [1.0, 0.5] } });
    assert!(mean(&upper).distance(Vec3::X) < 1e-6);
}

/// White and black tiles, as large as half the texture and as small as a hundredth of the square.
#[test]
fn a_texture_that_is_repeated_often_has_the_same_mean() {
    let tile = |i: u32| [if (i % 8 < 4) ^ (i / 8 < 4) { 255 } else { 0 }; 3];
    let tiles: Vec<[u8; 3]> = (0..64).map(tile).collect();
    let mut document = textured("image/png", &png(8, 8, &tiles));
    document["extensionsUsed"] = json!(["KHR_texture_transform"]);
    for repeats in [1, 2, 8, 16, 32, 50] {
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
            json!({ "KHR_texture_transform": { "scale": [repeats, repeats] } });
        let mean = mean(&document);
        assert!((mean - 0.5).abs().max_element() < 0.02, "{repeats}: {mean}");
    }
}

#[test]
fn polygons_of_one_material_have_the_colours_of_their_places() {
    // Each corner of the square has a texel, and the triangles are bent apart.
    let texels = [[255, 0, 0], [0, 255, 0], [255, 0, 0], [0, 255, 0]];
    let mut document = textured("image/png", &png(2, 2, &texels));
    document["nodes"] = json!([{ "mesh": 0 }, { "mesh": 1, "translation": [0, 0, 1] }]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    let mut other = document["meshes"][0].clone();
    other["primitives"][0]["indices"] = json!(3);
    document["meshes"] = json!([document["meshes"][0], other]);
    // The second node has the triangle 0, 1, 2 alone, which lies mostly over the right half.
    let accessors = document["accessors"].as_array_mut().expect("is a list");
    accessors.push(json!({ "bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR" }));
    let (scene, _) = load(&document);
    let of = |surface: usize| {
        let material = scene.surfaces[surface].material as usize;
        scene.materials[material].reflectance / Vec3::new(0.5, 0.25, 0.125)
    };
    assert_eq!((scene.surfaces.len(), scene.materials.len()), (2, 2));
    assert!(
        scene
            .materials
            .iter()
            .all(|material| material.name == "paint")
    );
    assert!(of(0).distance(Vec3::new(0.5, 0.5, 0.0)) < 6e-3, "{}", of(0));
    assert!(
        of(1).distance(Vec3::new(0.25, 0.75, 0.0)) < 4e-2,
        "{}",
        of(1)
    );
}

/// 8 x 8 pixels of the colour 200, 100, 50.
const JPEG: &str = "\
    /9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAAMCAgMCAgMDAwMEAwMEBQgFBQQEBQoHBwYIDAoMDAsKCwsNDhIQDQ4RDgsLEBYQERMUFRUVDA8XGB\
    YUGBIUFRT/2wBDAQMEBAUEBQkFBQkUDQsNFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBT/wAARCAAI\
    AAgDAREAAhEBAxEB/8QAFAABAAAAAAAAAAAAAAAAAAAABP/EABQQAQAAAAAAAAAAAAAAAAAAAAD/xAAVAQEBAAAAAAAAAAAAAAAAAAAHCP/EAB\
    QRAQAAAAAAAAAAAAAAAAAAAAD/2gAMAwEAAhEDEQA/ACA9SD//2Q==";

#[test]
fn jpeg_textures_are_read() {
    let bytes = radiosity::codec::from_base64(JPEG).expect("is base64");
    let linear = |code: f32| radiosity::radiometry::linear(code / 255.0);
    let colour = mean(&textured("image/jpeg", &bytes));
    let expected = Vec3::new(linear(200.0), linear(100.0), linear(50.0));
    assert!(colour.distance(expected) < 0.02, "{colour}");
}

#[test]
fn textures_that_cannot_be_read_are_ignored_with_a_warning() {
    let broken = png(1, 1, &[[9; 3]]);
    for (media, bytes) in [("image/png", &broken[..40]), ("image/webp", b"RIFF")] {
        let (scene, warnings) = load(&textured(media, bytes));
        assert_eq!(scene.materials[0].reflectance, Vec3::new(0.5, 0.25, 0.125));
        assert!(warnings[0].contains("1 textures ignored"), "{warnings:?}");
    }
}

#[test]
fn colours_of_vertices_are_left_out_with_a_warning() {
    let mut document = square();
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(0);
    let (scene, warnings) = load(&document);
    assert_eq!(scene.materials[0].reflectance, Vec3::new(0.5, 0.25, 0.125));
    let expected = "it.gltf: 1 primitives whose vertices have colours taken without them";
    assert_eq!(warnings, [expected]);
}

#[test]
fn cameras_look_along_their_negative_z() {
    let mut document = square();
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    document["cameras"] = json!([
        { "type": "perspective", "perspective": { "aspectRatio": 2.0, "yfov": 1.0, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "zfar": 9, "znear": 1 } },
    ]);
    let nodes = document["nodes"].as_array_mut().expect("is a list");
    nodes.push(json!({ "name": "a/b", "camera": 0, "translation": [1, 2, 3], "scale": [2, 2, 2] }));
    nodes.push(json!({ "camera": 1 }));
    let (scene, warnings) = load(&document);
    let camera = &scene.cameras[0];
    assert_eq!((scene.cameras.len(), camera.name.as_str()), (1, "camera 1"));
    assert_eq!(camera.eye, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(camera.look_at - camera.eye, DVec3::NEG_Z);
    assert_eq!(
        (camera.up, camera.width, camera.height),
        (DVec3::Y, 1024, 512)
    );
    let expected = 2.0 * (2.0 * 0.5f64.tan()).atan().to_degrees();
    assert!((camera.horizontal_fov - expected).abs() < 1e-5);
    assert_eq!(warnings, ["it.gltf: 1 orthographic cameras left out"]);
}

#[test]
fn cameras_whose_names_no_folder_of_pictures_can_have_are_numbered() {
    let mut document = square();
    let names = ["report.json", &"c".repeat(300), "fine", "fine"];
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4]);
    document["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } },
    ]);
    let nodes = document["nodes"].as_array_mut().expect("is a list");
    nodes.extend(names.map(|name| json!({ "name": name, "camera": 0, "translation": [1, 2, 3] })));
    let (scene, _) = load(&document);
    let given: Vec<&str> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(given, ["camera 1", "camera 2", "fine", "fine 2"]);
}

#[test]
fn strips_fans_quantised_and_sparse_accessors_are_read() {
    for (mode, indices, normal) in [
        (5, [0u16, 1, 3, 2, 2, 2], DVec3::Z),
        (6, [0u16, 1, 2, 3, 3, 3], DVec3::Z),
    ] {
        let mut document = square();
        let bytes = indices.map(u16::to_le_bytes);
        let uri = format!("data:;base64,{}", base64(bytes.as_flattened()));
        document["buffers"] = json!([document["buffers"][0], { "byteLength": 12, "uri": uri }]);
        document["bufferViews"][2] = json!({ "buffer": 1, "byteLength": 12 });
        document["accessors"][2]["count"] = json!(4);
        document["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let (scene, _) = load(&document);
        let area: f64 = scene.surfaces.iter().map(|s| scene.area(s)).sum();
        assert_eq!(
            (area, scene.normal(&scene.surfaces[0])),
            (1.0, normal),
            "{mode}"
        );
    }
    let mut document = square();
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    document["accessors"][0] = json!({
        "componentType": 5121, "normalized": true, "count": 4, "type": "VEC3",
        "min": [0, 0, 0], "max": [255, 255, 0],
        "sparse": { "count": 3,
            "indices": { "bufferView": 4, "componentType": 5121 },
            "values": { "bufferView": 3 } },
    });
    let bytes = [255u8, 0, 0, 255, 255, 0, 0, 255, 0, 1, 2, 3];
    let uri = format!("data:;base64,{}", base64(&bytes));
    document["buffers"] = json!([document["buffers"][0], { "byteLength": 12, "uri": uri }]);
    let views = document["bufferViews"].as_array_mut().expect("is a list");
    views.push(json!({ "buffer": 1, "byteLength": 9 }));
    views.push(json!({ "buffer": 1, "byteOffset": 9, "byteLength": 3 }));
    let (scene, _) = load(&document);
    assert_eq!(scene.bounds(), (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)));
}

#[test]
fn what_has_no_material_is_the_default_one() {
    let mut document = square();
    document["meshes"][0]["primitives"][0]
        .as_object_mut()
        .map(|primitive| primitive.remove("material"));
    let (scene, warnings) = load(&document);
    assert_eq!(scene.materials[0].name, "default");
    assert_eq!(scene.materials[0].reflectance, Vec3::splat(0.5));
    let expected = "it.gltf: 1 polygon without a material, given a grey of 0.5";
    assert_eq!(warnings, [expected]);
}
