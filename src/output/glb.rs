//! The solution as a binary glTF 2.0 file: what Blender, browsers and game engines open.

use super::blocks::{Block, bounds, floats, indices, needs_double, offsets};
use super::{WriteError, write_atomically};
use crate::scene::{Camera, Names};
use crate::solution::{LitMesh, LitVertex};
use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::Path;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// What a glTF file says besides the mesh.
#[derive(Debug, Clone, Copy)]
pub struct GlbFacts<'a> {
    /// Name of the scene.
    pub name: &'a str,
    /// Length of one scene unit in metres: glTF is in metres.
    pub metres_per_unit: f64,
    /// The cameras to hand on.
    pub cameras: &'a [Camera],
    /// What the polygons belong to: each group becomes a mesh with a node of its name.
    pub names: &'a Names,
    /// Stops of the exposure that is baked into the colours, for the file to state.
    pub exposure: f64,
    /// By vertex whether it is on one side of a sheet that radiates from both; may be empty, if there are none.
    pub two_sided: &'a [bool],
}

/// The two sides of a sheet are moved apart by twice this fraction of the extent: a renderer that does not cull back faces would
/// show both in one place.
const APART: f64 = 1e-5;

/// Writes triangles in metres, y up, that any glTF viewer shows lit: a mesh for each group of polygons, or one.
///
/// `COLOR_0` is `display` of the vertex, linear and from 0 to 1, in 16 bits; the material is unlit
/// (`KHR_materials_unlit`), so nothing is shaded once more. The light itself is in the attributes `_RADIOSITY` and
/// `_IRRADIANCE` (W/m², linear Rec. 709, float), and the meshes' `extras` state quantities, units and exposure. A scene far
/// from its origin is moved there by the translation of its nodes, as glTF knows single precision only.
///
/// # Errors
/// When the file cannot be written, or would exceed the 4 GiB of the format.
///
/// # Panics
/// If an index of the mesh is out of range.
pub fn write_glb(
    path: &Path,
    mesh: &LitMesh,
    facts: &GlbFacts,
    display: impl Fn(&LitVertex) -> Vec3,
) -> Result<(), WriteError> {
    let places = Places::of(mesh, facts);
    let objects = objects(mesh, facts);
    let blocks = blocks(mesh, &places, &objects, &display);
    write_atomically(path, |out| {
        let mut text = document(mesh, facts, &places, &objects, &blocks).to_string();
        while !text.len().is_multiple_of(4) {
            text.push(' ');
        }
        let binary = offsets(&blocks, 0).1;
        let length = 12 + 8 + text.len() as u64 + 8 + binary;
        let length = u32::try_from(length).map_err(|_| too_large(length))?;
        write_words(out, [u32::from_le_bytes(*b"glTF"), 2, length])?;
        write_words(out, [text.len() as u32, u32::from_le_bytes(*b"JSON")])?;
        out.write_all(text.as_bytes())?;
        write_words(out, [binary as u32, u32::from_le_bytes(*b"BIN\0")])?;
        blocks.iter().try_for_each(|block| block.write(out))
    })
}

fn too_large(bytes: u64) -> io::Error {
    let reason = format!("{bytes} bytes are more than the 4 GiB that a .glb can have");
    io::Error::new(io::ErrorKind::InvalidInput, reason)
}

fn write_words<const N: usize>(out: &mut impl Write, words: [u32; N]) -> io::Result<()> {
    out.write_all(words.map(u32::to_le_bytes).as_flattened())
}

/// From scene units to single-precision metres.
struct Places<'a> {
    origin: DVec3,
    metres: f64,
    /// From the middle of a sheet to its sides, in scene units.
    apart: f64,
    two_sided: &'a [bool],
}

impl<'a> Places<'a> {
    fn of(mesh: &LitMesh, facts: &GlbFacts<'a>) -> Self {
        let (low, high) = bounds(mesh.positions.iter().copied());
        Self {
            origin: match needs_double(&mesh.positions) {
                true => (low + high) / 2.0,
                false => DVec3::ZERO,
            },
            metres: facts.metres_per_unit,
            apart: APART * (high - low).max_element(),
            two_sided: facts.two_sided,
        }
    }

    /// In the order of the vertices.
    fn all(&self, mesh: &'a LitMesh) -> impl Iterator<Item = Vec3> + '_ {
        let both = self
            .two_sided
            .iter()
            .copied()
            .chain(std::iter::repeat(false));
        mesh.vertices.iter().zip(both).map(|(vertex, both)| {
            let mut place = mesh.positions[vertex.position as usize] - self.origin;
            if both {
                place += self.apart * vertex.normal.as_dvec3();
            }
            (place * self.metres).as_vec3()
        })
    }
}

/// Triangles of one group of polygons.
struct Object<'a> {
    name: &'a str,
    /// Indices into the mesh's triangles.
    triangles: Vec<u32>,
}

/// The groups in the order in which triangles come to them; those of none have the scene's name.
fn objects<'a>(mesh: &LitMesh, facts: &GlbFacts<'a>) -> Vec<Object<'a>> {
    let mut objects: Vec<Object> = Vec::new();
    let mut numbers: FxHashMap<&str, usize> = FxHashMap::default();
    for (number, triangle) in (0..).zip(&mesh.triangles) {
        let name = facts.names.group(triangle.polygon).unwrap_or(facts.name);
        let object = *numbers.entry(name).or_insert_with(|| {
            let triangles = Vec::new();
            objects.push(Object { name, triangles });
            objects.len() - 1
        });
        objects[object].triangles.push(number);
    }
    objects
}

/// Of all vertices position, normal, colour, radiosity and irradiance; then the indices of each object.
fn blocks<'a>(
    mesh: &'a LitMesh,
    places: &'a Places<'a>,
    objects: &'a [Object],
    display: &'a impl Fn(&LitVertex) -> Vec3,
) -> Vec<Block<'a>> {
    let (vertices, count) = (|| mesh.vertices.iter(), mesh.vertices.len());
    let colour = |vertex: &LitVertex| {
        let [r, g, b] = display(vertex)
            .to_array()
            .map(|x| ((65535.0 * x.clamp(0.0, 1.0)).round() as u16).to_le_bytes());
        [r[0], r[1], g[0], g[1], b[0], b[1], 255, 255]
    };
    let of_vertices = [
        Block::new(count, move || places.all(mesh).map(floats)),
        Block::new(count, move || vertices().map(|v| floats(v.normal))),
        Block::new(count, move || vertices().map(colour)),
        Block::new(count, move || vertices().map(|v| floats(v.radiosity))),
        Block::new(count, move || vertices().map(|v| floats(v.irradiance))),
    ];
    let corners = objects.iter().map(|object| {
        Block::new(object.triangles.len(), move || {
            let triangles = object.triangles.iter();
            triangles.map(|t| indices(mesh.triangles[*t as usize].vertices))
        })
    });
    of_vertices.into_iter().chain(corners).collect()
}

/// Blocks before those of the objects.
const VERTEX_BLOCKS: usize = 5;

/// The JSON of the file.
fn document(
    mesh: &LitMesh,
    facts: &GlbFacts,
    places: &Places,
    objects: &[Object],
    blocks: &[Block],
) -> Value {
    let nodes = nodes(facts, places, objects);
    let mut document = json!({
        "asset": {
            "version": "2.0",
            "generator": concat!("radiosity ", env!("CARGO_PKG_VERSION")),
        },
        "scene": 0,
        "scenes": [{ "name": facts.name, "nodes": Vec::from_iter(0..nodes.len()) }],
        "nodes": nodes,
    });
    if !facts.cameras.is_empty() {
        document["cameras"] = facts.cameras.iter().map(|c| camera(c, facts)).collect();
    }
    // glTF has no empty arrays: a mesh without triangles is left out.
    if !objects.is_empty() {
        document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
        document["materials"] = json!([{
            "name": "radiosity",
            "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 1 },
            "extensions": { "KHR_materials_unlit": {} },
        }]);
        let meshes = objects.iter().enumerate();
        document["meshes"] = meshes
            .map(|(n, object)| described(n, object, facts))
            .collect();
        document["accessors"] = accessors(mesh, places, objects);
        let (begins, end) = offsets(blocks, 0);
        let target = |view| {
            if view < VERTEX_BLOCKS {
                ARRAY_BUFFER
            } else {
                ELEMENT_ARRAY_BUFFER
            }
        };
        let views = begins.iter().zip(blocks).enumerate().map(|(view, (begin, block))| {
            json!({ "buffer": 0, "byteOffset": begin, "byteLength": block.bytes, "target": target(view) })
        });
        document["bufferViews"] = views.collect();
        document["buffers"] = json!([{ "byteLength": end }]);
    }
    document
}

fn described(number: usize, object: &Object, facts: &GlbFacts) -> Value {
    json!({
        "name": object.name,
        "primitives": [{
            "attributes": {
                "POSITION": 0, "NORMAL": 1, "COLOR_0": 2, "_RADIOSITY": 3, "_IRRADIANCE": 4,
            },
            "indices": VERTEX_BLOCKS + number,
            "material": 0,
        }],
        "extras": {
            "_RADIOSITY": { "quantity": "radiosity", "unit": "W/m^2", "colour": "linear Rec. 709" },
            "_IRRADIANCE": { "quantity": "irradiance", "unit": "W/m^2", "colour": "linear Rec. 709" },
            "COLOR_0": {
                "quantity": "tone-mapped radiance = radiosity / pi, for display only",
                "exposure_stops": facts.exposure,
            },
        },
    })
}

fn accessors(mesh: &LitMesh, places: &Places, objects: &[Object]) -> Value {
    let vertices = mesh.vertices.len();
    let (low, high) = bounds(places.all(mesh).map(|place| place.as_dvec3()));
    let vectors = |view| json!({ "bufferView": view, "componentType": FLOAT, "count": vertices, "type": "VEC3" });
    let mut positions = vectors(0);
    positions["min"] = json!(low.to_array());
    positions["max"] = json!(high.to_array());
    let of_vertices = [
        positions,
        vectors(1),
        json!({
            "bufferView": 2, "componentType": UNSIGNED_SHORT, "normalized": true,
            "count": vertices, "type": "VEC4",
        }),
        vectors(3),
        vectors(4),
    ];
    let corners = objects.iter().zip(VERTEX_BLOCKS..).map(|(object, view)| {
        let count = 3 * object.triangles.len();
        json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" })
    });
    of_vertices.into_iter().chain(corners).collect()
}

/// A node for each object, at least one, then one for each camera.
fn nodes(facts: &GlbFacts, places: &Places, objects: &[Object]) -> Vec<Value> {
    let mut lit: Vec<Value> = objects
        .iter()
        .enumerate()
        .map(|(mesh, object)| json!({ "name": object.name, "mesh": mesh }))
        .collect();
    if lit.is_empty() {
        lit.push(json!({ "name": facts.name }));
    }
    if places.origin != DVec3::ZERO {
        let origin = (places.origin * places.metres).to_array();
        lit.iter_mut()
            .for_each(|node| node["translation"] = json!(origin));
    }
    let cameras = facts.cameras.iter().zip(0..).map(|(camera, number)| {
        // A glTF camera looks along its own -z, with its y up.
        let back = (camera.eye - camera.look_at).normalize();
        let right = camera.up.cross(back).normalize();
        let axes = [right, back.cross(right), back, camera.eye * places.metres];
        let columns = axes.iter().zip([0, 0, 0, 1]);
        let matrix: Vec<Value> = columns
            .flat_map(|(axis, last)| [json!(axis.x), json!(axis.y), json!(axis.z), json!(last)])
            .collect();
        json!({ "name": camera.name, "camera": number, "matrix": matrix })
    });
    lit.into_iter().chain(cameras).collect()
}

fn camera(camera: &Camera, facts: &GlbFacts) -> Value {
    let aspect = f64::from(camera.width) / f64::from(camera.height);
    let half_width = (camera.horizontal_fov / 2.0).to_radians().tan();
    let distance = camera.eye.distance(camera.look_at) * facts.metres_per_unit;
    json!({
        "name": camera.name,
        "type": "perspective",
        "perspective": {
            "aspectRatio": aspect,
            "yfov": 2.0 * (half_width / aspect).atan(),
            "znear": 1e-3 * distance,
        },
    })
}
