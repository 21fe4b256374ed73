//! The lit mesh of a solution in the formats that other programs read.

use super::CliError;
use super::names::names_of;
use crate::output::{GlbFacts, VtuFacts, write_glb, write_obj, write_ply, write_vtu};
use crate::radiometry::radiance_from_radiosity;
use crate::render::Tone;
use crate::solution::{LitMesh, LitVertex, Solution};
use clap::ValueEnum;
use glam::Vec3;
use rustc_hash::FxHashSet;
use std::path::Path;
use std::str::FromStr;

/// A format for lit meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum MeshFormat {
    /// Binary glTF, for Blender, browsers and game engines: `COLOR_0` for the eye, `_RADIOSITY` for computing
    Glb,
    /// Wavefront OBJ with vertex colours
    Obj,
    /// Binary PLY with radiosity and irradiance
    Ply,
    /// VTK, for ParaView: radiosity, irradiance, illuminance, element level and estimated error as fields
    Vtu,
}

impl MeshFormat {
    /// The format that a file's name asks for.
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        <Self as ValueEnum>::from_str(&extension, true).map_err(|_| {
            let names: Vec<_> = Self::value_variants()
                .iter()
                .map(|f| f.extension())
                .collect();
            CliError::Usage(format!(
                "found the file name {}; expected one that ends in .{}",
                path.display(),
                names.join(", .")
            ))
        })
    }

    /// What its files' names end in.
    pub(super) fn extension(self) -> &'static str {
        match self {
            MeshFormat::Glb => "glb",
            MeshFormat::Obj => "obj",
            MeshFormat::Ply => "ply",
            MeshFormat::Vtu => "vtu",
        }
    }
}

/// Formats by their names, separated by commas; `none` is the empty list.
#[derive(Debug, Clone)]
pub(super) struct Formats(pub(super) Vec<MeshFormat>);

impl FromStr for Formats {
    type Err = String;

    fn from_str(list: &str) -> Result<Self, String> {
        if list.trim() == "none" {
            return Ok(Self(Vec::new()));
        }
        let mut formats = Vec::new();
        for name in list.split(',') {
            let format = <MeshFormat as ValueEnum>::from_str(name.trim(), true).map_err(|_| {
                match name.trim() {
                    "none" => "found `none` beside others; expected it alone".to_owned(),
                    _ => format!("found `{name}`; expected glb, obj, ply, vtu or none"),
                }
            })?;
            if !formats.contains(&format) {
                formats.push(format);
            }
        }
        Ok(Self(formats))
    }
}

/// A solution with what all formats need of it.
pub(super) struct Exporter<'a> {
    pub(super) solution: &'a Solution,
    pub(super) lit: &'a LitMesh,
    /// For the colours that are seen.
    pub(super) tone: Tone,
    /// Lumens per watt.
    pub(super) efficacy: f64,
}

impl Exporter<'_> {
    pub(super) fn write(&self, format: MeshFormat, path: &Path) -> Result<(), CliError> {
        match format {
            MeshFormat::Glb => self.glb(path),
            MeshFormat::Vtu => self.vtu(path),
            MeshFormat::Obj => Ok(write_obj(path, self.lit, |vertex| {
                Vec3::from(self.colour(vertex).map(f32::from)) / 255.0
            })?),
            MeshFormat::Ply => {
                let errors = self.solution.triangle_errors(self.lit);
                Ok(write_ply(path, self.lit, errors.as_deref(), |vertex| {
                    self.colour(vertex)
                })?)
            }
        }
    }

    fn colour(&self, vertex: &LitVertex) -> [u8; 3] {
        self.tone.colour(radiance_from_radiosity(vertex.radiosity))
    }

    /// By vertex whether it is on one side of a sheet that radiates from both.
    fn two_sided(&self) -> Vec<bool> {
        let mesh = &self.solution.mesh;
        let backs = mesh.patches.iter().filter(|patch| patch.back);
        let both: FxHashSet<u32> = backs.map(|patch| patch.surface).collect();
        let mut two_sided = vec![false; self.lit.vertices.len()];
        for triangle in &self.lit.triangles {
            let patch = mesh.elements.patch_of(triangle.element);
            if both.contains(&mesh.patch(patch).surface) {
                triangle
                    .vertices
                    .iter()
                    .for_each(|v| two_sided[*v as usize] = true);
            }
        }
        two_sided
    }

    fn glb(&self, path: &Path) -> Result<(), CliError> {
        let two_sided = self.two_sided();
        let names = names_of(self.solution);
        let facts = GlbFacts {
            name: &self.solution.report.scene,
            metres_per_unit: self.solution.metres_per_unit,
            cameras: &self.solution.cameras,
            names: &names,
            exposure: self.tone.exposure(),
            two_sided: &two_sided,
        };
        Ok(write_glb(path, self.lit, &facts, |vertex| {
            self.tone.display(radiance_from_radiosity(vertex.radiosity))
        })?)
    }

    fn vtu(&self, path: &Path) -> Result<(), CliError> {
        let errors = self.solution.triangle_errors(self.lit);
        let mesh = &self.solution.mesh;
        let levels = self.lit.triangles.iter();
        let levels: Vec<u8> = levels
            .map(|triangle| mesh.element(triangle.element).level)
            .collect();
        let facts = VtuFacts {
            metres_per_unit: self.solution.metres_per_unit,
            efficacy: self.efficacy,
            levels: &levels,
            errors: errors.as_deref(),
        };
        Ok(write_vtu(path, self.lit, &facts)?)
    }
}
