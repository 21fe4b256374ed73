//! From the primitives of a mesh to polygons.

use super::nodes::Placed;
use super::texture::Corner;
use super::{Building, accessor};
use crate::scene::polygon::{is_planar, is_strictly_convex};
use crate::scene::{SceneError, limits};
use ::gltf::mesh::Mode;
use ::gltf::{Mesh, Primitive, Semantic};
use glam::{DVec2, DVec3};

/// Adds the triangles of a primitive, those that follow one another joined to quads where these are flat and convex:
/// exporters cut quads in two, and a quad is the better patch.
pub(super) fn add(
    building: &mut Building,
    placed: &Placed,
    mesh: &Mesh,
    primitive: &Primitive,
) -> Result<(), SceneError> {
    building.noticed.morphs += usize::from(primitive.morph_targets().len() > 0);
    let fault = |found: String| {
        let expected = "triangles whose numbers lie in the file's buffers";
        building
            .file
            .error(format!("{found}, in mesh {}", mesh.index()), expected)
    };
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        return Ok(());
    };
    let positions = accessor::vectors::<3>(building.file, &positions).map_err(fault)?;
    let to_scene = |p: &[f64; 3]| placed.to_scene.transform_point3(DVec3::from(*p));
    let positions: Vec<DVec3> = positions.iter().map(to_scene).collect();
    let allowed = |p: &DVec3| p.abs().max_element() <= limits::COORDINATE && !p.is_nan();
    if !positions.iter().all(allowed) {
        return Err(fault("a coordinate that is not finite".into()));
    }
    let indices = match primitive.indices() {
        Some(indices) => accessor::indices(building.file, &indices).map_err(fault)?,
        None => (0..positions.len() as u32).collect(),
    };
    if let Some(wrong) = indices.iter().find(|i| **i as usize >= positions.len()) {
        return Err(fault(format!(
            "index {wrong} of {} vertices",
            positions.len()
        )));
    }
    let Some(mut triangles) = triangles(primitive.mode(), &indices) else {
        building.noticed.lines += 1;
        return Ok(());
    };
    building.noticed.colours += usize::from(primitive.get(&Semantic::Colors(0)).is_some());
    if placed.to_scene.determinant() < 0.0 {
        // A mirrored mesh shows its other side.
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    let corners = Corners {
        welded: positions
            .iter()
            .map(|p| building.welder.index(*p))
            .collect(),
        texture: building.palette.coordinates(primitive).map_err(fault)?,
        positions,
    };
    corners.add(&triangles, building, primitive);
    Ok(())
}

fn triangles(mode: Mode, indices: &[u32]) -> Option<Vec<[u32; 3]>> {
    match mode {
        Mode::Triangles => Some(indices.as_chunks::<3>().0.to_vec()),
        // Every other triangle of a strip runs the other way.
        Mode::TriangleStrip => Some(
            indices
                .windows(3)
                .enumerate()
                .map(|(i, t)| match i % 2 {
                    0 => [t[0], t[1], t[2]],
                    _ => [t[1], t[0], t[2]],
                })
                .collect(),
        ),
        Mode::TriangleFan => Some(
            indices
                .windows(2)
                .skip(1)
                .map(|edge| [indices[0], edge[0], edge[1]])
                .collect(),
        ),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

/// The vertices of a primitive.
struct Corners {
    positions: Vec<DVec3>,
    welded: Vec<u32>,
    /// Coordinates in the textures of the material; empty where there are none.
    texture: Vec<[DVec2; 2]>,
}

impl Corners {
    fn add(&self, triangles: &[[u32; 3]], building: &mut Building, primitive: &Primitive) {
        let mut rest = triangles;
        while let [first, after @ ..] = rest {
            let (quad, used) = match after.first().and_then(|next| self.quad(*first, *next)) {
                Some(quad) => (Some(quad), 2),
                None => (None, 1),
            };
            let lit: Vec<[Corner; 3]> = rest[..used].iter().map(|t| self.textured(t)).collect();
            let material = building.palette.material(primitive.material(), &lit);
            let polygon = quad.as_ref().map_or(&first[..], |quad| &quad[..]);
            let welded = polygon.iter().map(|v| self.welded[*v as usize]);
            building.push(welded, material);
            rest = &rest[used..];
        }
    }

    fn textured(&self, triangle: &[u32; 3]) -> [Corner; 3] {
        triangle.map(|v| Corner {
            position: self.positions[v as usize],
            texture: self.texture.get(v as usize).copied().unwrap_or_default(),
        })
    }

    /// The corners of two triangles together, if they make a flat and convex quad.
    fn quad(&self, a: [u32; 3], b: [u32; 3]) -> Option<[u32; 4]> {
        let same = |v: u32, w: u32| self.welded[v as usize] == self.welded[w as usize];
        for turn in 0..3 {
            let [p, q, r] = [a[turn], a[(turn + 1) % 3], a[(turn + 2) % 3]];
            // The side from r to p is shared, and runs the other way in the other triangle.
            let shared = (0..3).find(|i| same(b[*i], p) && same(b[(i + 1) % 3], r));
            if let Some(side) = shared {
                let quad = [p, q, r, b[(side + 2) % 3]];
                let places = quad.map(|v| self.positions[v as usize]);
                let fine = is_planar(&places) && is_strictly_convex(&places);
                return fine.then_some(quad);
            }
        }
        None
    }
}
