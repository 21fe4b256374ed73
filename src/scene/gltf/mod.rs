//! glTF 2.0: `.gltf` with the files it names, and `.glb`.
//!
//! The crate `gltf` reads and checks the JSON; what the JSON says of the buffers is checked here, as the crate takes it on
//! trust. By the standard lengths are in metres, y is up, and emission is luminance in cd/m², which becomes radiance at
//! [`WHITE_EFFICACY`] lumens per watt.

mod accessor;
mod camera;
mod complete;
mod coverage;
mod file;
mod lights;
mod materials;
mod nodes;
mod primitives;
mod texture;

use super::SceneError;
use super::geometry::{Geometry, Reading};
use super::weld::Welder;
use crate::radiometry::WHITE_EFFICACY;
use file::File;
use glam::DVec3;
use lights::Lights;
use materials::Palette;
use nodes::Placed;
use rustc_hash::FxHashMap;
use std::path::Path;

/// Says where a node has its mesh once more. A file can be read without, but most of what is in it would be missing.
const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// Reads a glTF file.
pub(super) fn read(
    path: &Path,
    how: Reading,
    warnings: &mut Vec<String>,
) -> Result<Geometry, SceneError> {
    let file = File::open(path)?;
    let placed = nodes::placed(&file)?;
    let lights = Lights::of(&file, &placed, how)?;
    let mut building = Building {
        file: &file,
        geometry: Geometry::default(),
        welder: Welder::default(),
        palette: Palette::new(&file),
        noticed: Noticed::default(),
        current_group: None,
        group_numbers: FxHashMap::default(),
    };
    for node in &placed {
        building.mesh(node)?;
    }
    lights.shine(&mut building);
    let cameras = camera::cameras(&placed, &mut building.noticed);
    let Building {
        mut geometry,
        welder,
        palette,
        noticed,
        ..
    } = building;
    noticed.report(path, warnings);
    let mut extensions = file.document.extensions_used();
    if extensions.any(|name| name == INSTANCES) {
        let path = path.display();
        warnings.push(format!(
            "{path}: the extension `{INSTANCES}` is not read: a mesh with many places is in one of them"
        ));
    }
    palette.report(path, warnings);
    geometry.polygons.positions = welder.into_positions();
    geometry.library = palette.finish();
    geometry.cameras = cameras;
    Ok(geometry)
}

/// A geometry that grows.
struct Building<'a> {
    file: &'a File<'a>,
    geometry: Geometry,
    welder: Welder,
    palette: Palette<'a>,
    noticed: Noticed,
    current_group: Option<u32>,
    group_numbers: FxHashMap<String, u32>,
}

impl Building<'_> {
    /// Adds a polygon of the group that was begun last.
    fn push(&mut self, corners: impl IntoIterator<Item = u32>, material: u32) {
        self.geometry.polygons.push(corners, material);
        self.geometry.group_of.push(self.current_group);
    }

    /// Begins a group, or goes on with that of the same name.
    fn group(&mut self, name: Option<&str>) {
        let next = self.geometry.groups.len() as u32;
        let name = name.map_or_else(|| format!("node {}", next + 1), str::to_owned);
        let number = *self.group_numbers.entry(name.clone()).or_insert(next);
        if number == next {
            self.geometry.groups.push(name);
        }
        self.current_group = Some(number);
    }

    fn mesh(&mut self, placed: &Placed) -> Result<(), SceneError> {
        let Some(mesh) = placed.node.mesh() else {
            return Ok(());
        };
        self.group(placed.node.name().or(mesh.name()));
        self.noticed.skins += usize::from(placed.node.skin().is_some());
        for primitive in mesh.primitives() {
            primitives::add(self, placed, &mesh, &primitive)?;
        }
        Ok(())
    }
}

/// Things that were left out or taken for something simpler.
#[derive(Default)]
struct Noticed {
    skins: usize,
    morphs: usize,
    lines: usize,
    colours: usize,
    orthographic: usize,
    lights: usize,
    spots: usize,
}

impl Noticed {
    fn report(&self, path: &Path, warnings: &mut Vec<String>) {
        for (count, what) in [
            (
                self.skins,
                "meshes with a skeleton taken in their rest pose",
            ),
            (self.morphs, "meshes with morph targets taken without them"),
            (self.lines, "primitives of points or lines left out"),
            (
                self.colours,
                "primitives whose vertices have colours taken without them",
            ),
            (self.orthographic, "orthographic cameras left out"),
            (self.lights, "lights that have no surface left out"),
            (
                self.spots,
                "spot lights taken as small squares, bright along the axis as stated but without a cone",
            ),
        ] {
            warn(warnings, path, count, what);
        }
    }
}

/// Notes something that was met `count` times.
fn warn(warnings: &mut Vec<String>, path: &Path, count: usize, what: &str) {
    if count > 0 {
        warnings.push(format!("{}: {count} {what}", path.display()));
    }
}

/// Radiance (W m⁻² sr⁻¹) of a luminance in cd/m², or radiant intensity (W/sr) of a luminous one in cd.
fn watts(photometric: DVec3) -> DVec3 {
    photometric / WHITE_EFFICACY
}
