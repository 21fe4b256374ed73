//! Polygons from a Wavefront OBJ file.

use super::SceneError;
use super::obj_guard::CheckedObj;
use super::polygons::Polygons;
use super::text::TextFile;
use super::weld::Welder;
use glam::DVec3;
use std::io::Read;

/// Reads the polygons of a checked file whose materials are known.
pub(super) fn read(
    file: &TextFile,
    checked: CheckedObj,
    materials: &super::mtl::Library,
) -> Result<Polygons, SceneError> {
    const LIBRARY: &str = "mtllib checked\n";
    let mut text = LIBRARY
        .as_bytes()
        .chain(checked.vertex_lines.as_bytes())
        .chain(checked.face_lines.as_bytes());
    let loaded = tobj::load_obj_buf(&mut text, &tobj::LoadOptions::default(), |_| {
        materials.for_tobj()
    });
    let (models, _) = loaded.map_err(|error| {
        file.error(
            None,
            format!("polygons that cannot be read ({error})"),
            "a polygonal OBJ file",
        )
    })?;

    let mut polygons = Polygons::with_lines(checked.polygon_lines, checked.corners);
    let mut welder = Welder::with_room(checked.vertices as usize);
    for model in models {
        append(
            &mut polygons,
            &model.mesh,
            &mut welder,
            materials.default.unwrap_or(0),
        );
    }
    polygons.positions = welder.into_positions();
    Ok(polygons)
}

fn append(polygons: &mut Polygons, mesh: &tobj::Mesh, welder: &mut Welder, default: usize) {
    let welded: Vec<u32> = mesh
        .positions
        .chunks_exact(3)
        .map(|p| welder.index(DVec3::new(p[0], p[1], p[2])))
        .collect();
    let mut corners = mesh.indices.iter().map(|i| welded[*i as usize]);
    let count = match mesh.face_arities.len() {
        0 => mesh.indices.len() / 3,
        n => n,
    };
    let material = mesh.material_id.unwrap_or(default) as u32;
    for polygon in 0..count {
        let arity = mesh.face_arities.get(polygon).copied().unwrap_or(3);
        polygons.push(corners.by_ref().take(arity as usize), material);
    }
}
