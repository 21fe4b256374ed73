//! Polygons from a Wavefront OBJ file.

use super::SceneError;
use super::obj_guard::CheckedObj;
use super::text::TextFile;
use super::weld::Welder;
use glam::DVec3;
use std::io::Read;

/// Polygons as the file has them: any number of corners, planar or not.
#[derive(Default)]
pub(super) struct Polygons {
    /// No two positions are equal, and each one is used.
    pub positions: Vec<DVec3>,
    /// The corners of all polygons, one polygon after the other.
    corners: Vec<u32>,
    /// For each polygon where its corners end.
    ends: Vec<usize>,
    /// For each polygon the index of its material in the library.
    pub materials: Vec<u32>,
    /// For each polygon the line where it stands.
    pub lines: Vec<u32>,
}

impl Polygons {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The position indices of a polygon's corners, in order.
    pub fn corners(&self, polygon: usize) -> &[u32] {
        let begin = if polygon == 0 {
            0
        } else {
            self.ends[polygon - 1]
        };
        &self.corners[begin..self.ends[polygon]]
    }
}

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

    let mut polygons = Polygons {
        lines: checked.polygon_lines,
        ..Default::default()
    };
    let mut welder = Welder::default();
    for model in &models {
        polygons.append(&model.mesh, &mut welder, materials.default.unwrap_or(0));
    }
    polygons.positions = welder.into_positions();
    Ok(polygons)
}

impl Polygons {
    fn append(&mut self, mesh: &tobj::Mesh, welder: &mut Welder, default: usize) {
        let welded: Vec<u32> = mesh
            .positions
            .chunks_exact(3)
            .map(|p| welder.index(DVec3::new(p[0], p[1], p[2])))
            .collect();
        self.corners
            .extend(mesh.indices.iter().map(|i| welded[*i as usize]));
        let polygons = match mesh.face_arities.len() {
            0 => mesh.indices.len() / 3,
            n => n,
        };
        let mut end = self.ends.last().copied().unwrap_or(0);
        for polygon in 0..polygons {
            end += mesh
                .face_arities
                .get(polygon)
                .map_or(3, |arity| *arity as usize);
            self.ends.push(end);
        }
        let material = mesh.material_id.unwrap_or(default) as u32;
        self.materials.resize(self.ends.len(), material);
    }
}
