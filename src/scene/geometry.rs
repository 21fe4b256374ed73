//! What a geometry file says, whatever its format.

use super::mtl::Library;
use super::polygons::Polygons;
use super::text::TextFile;
use super::{Camera, SceneError, gltf, mtl, obj, obj_guard, ply};
use glam::DVec3;
use std::path::Path;

/// The endings of geometry files, for messages.
pub(super) const ENDINGS: &str = ".obj, .glb, .gltf or .ply";

/// Polygons with their materials and names, cameras if the format has them.
#[derive(Default)]
pub(super) struct Geometry {
    pub polygons: Polygons,
    pub library: Library,
    /// Names of groups, objects or nodes.
    pub groups: Vec<String>,
    /// For every polygon its group.
    pub group_of: Vec<Option<u32>>,
    pub cameras: Vec<Camera>,
}

impl Geometry {
    /// Turns the whole by `turned`.
    pub fn turn_up(&mut self, turned: fn(DVec3) -> DVec3) {
        let positions = &mut self.polygons.positions;
        positions.iter_mut().for_each(|p| *p = turned(*p));
        for camera in &mut self.cameras {
            for part in [&mut camera.eye, &mut camera.look_at, &mut camera.up] {
                *part = turned(*part);
            }
        }
    }
}

/// How a geometry file is to be read, as the settings say and as it is needed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    /// Radius in scene units of the emitters that stand for lights without extent; 0 leaves these lights out.
    pub point_light_radius: Option<f64>,
    /// Length of a scene unit: what a small surface radiates follows from its area in m².
    pub metres_per_unit: f64,
    /// Whether a scene is read without the files of its materials, if they are missing.
    pub spares_materials: bool,
}

impl Default for Reading {
    fn default() -> Self {
        Self {
            point_light_radius: None,
            metres_per_unit: 1.0,
            spares_materials: false,
        }
    }
}

/// The format of a geometry file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Obj,
    Gltf,
    Ply,
}

impl Format {
    /// By the ending of the file's name.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "obj" => Some(Format::Obj),
            "glb" | "gltf" => Some(Format::Gltf),
            "ply" => Some(Format::Ply),
            _ => None,
        }
    }
}

/// Reads a geometry file.
pub(super) fn read(
    path: &Path,
    format: Format,
    how: Reading,
    warnings: &mut Vec<String>,
) -> Result<Geometry, SceneError> {
    match format {
        Format::Obj => read_obj(path, how, warnings),
        Format::Gltf => gltf::read(path, how, warnings),
        Format::Ply => ply::read(path, warnings),
    }
}

/// Checks the OBJ file, reads its materials, then its polygons.
fn read_obj(path: &Path, how: Reading, warnings: &mut Vec<String>) -> Result<Geometry, SceneError> {
    let file = TextFile::read(path, "an .obj file")?;
    let mut checked = obj_guard::check(&file)?;
    let library = mtl::read(&file, &checked, how.spares_materials, warnings)?;
    checked
        .unknown
        .report(warnings, path, "line", "of unknown kind skipped");
    let (groups, group_of) = (
        std::mem::take(&mut checked.groups),
        std::mem::take(&mut checked.polygon_groups),
    );
    Ok(Geometry {
        polygons: obj::read(&file, checked, &library)?,
        library,
        groups,
        group_of,
        cameras: Vec::new(),
    })
}
