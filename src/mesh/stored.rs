//! A mesh as files have it: with what follows from the rest written out. What a file says of that must be so.

use super::patches::{Known, MOST_ALONG};
use super::restore::check;
use super::{Element, Lattice, Mesh, MeshLimits, Patch, Patches};
use crate::geometry::Frame;
use crate::radiometry::Spectrum;
use glam::DVec3;
use rustc_hash::FxHashMap;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};
use std::ops::Range;

/// A mesh that was read and not looked at yet.
#[derive(Deserialize)]
pub struct StoredMesh {
    frame: Frame,
    patches: Vec<StoredPatch>,
    elements: Vec<Element>,
    vertices: Vec<StoredVertex>,
    buried: Vec<bool>,
    limits: MeshLimits,
}

#[derive(Serialize, Deserialize)]
struct StoredPatch {
    surface: u32,
    polygon: u32,
    corners: [DVec3; 4],
    corner_count: u8,
    outline: [bool; 4],
    back: bool,
    normal: DVec3,
    area: f64,
    reflectance: Spectrum,
    exitance: Spectrum,
    roots: Range<u32>,
    grid: (u32, u32),
    vertices: Vec<u32>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct StoredVertex {
    pub(super) patch: u32,
    pub(super) lattice: Lattice,
    point: DVec3,
}

impl Serialize for Mesh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let patch = |(number, of): (u32, Patch)| StoredPatch::new(of, self.vertices_of(number));
        let element = |number: u32| self.element(number);
        let vertex = |number: u32| StoredVertex {
            patch: self.vertices.patch_of(number),
            lattice: self.lattice_of(number),
            point: self.point(number),
        };
        let (elements, vertices) = (self.elements.len() as u32, self.vertices.len() as u32);
        let mut mesh = serializer.serialize_struct("Mesh", 6)?;
        mesh.serialize_field("frame", &self.frame)?;
        mesh.serialize_field("patches", &List((0..).zip(self.patches.iter()).map(patch)))?;
        mesh.serialize_field("elements", &List((0..elements).map(element)))?;
        mesh.serialize_field("vertices", &List((0..vertices).map(vertex)))?;
        mesh.serialize_field("buried", &self.buried)?;
        mesh.serialize_field("limits", &self.limits)?;
        mesh.end()
    }
}

/// What an iterator gives, as a list.
struct List<I>(I);

impl<I: Iterator<Item: Serialize> + Clone> Serialize for List<I> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.clone())
    }
}

impl StoredMesh {
    /// The mesh with these [`Mesh::clearances`], if what it says is sound, with what is not stored. Errors say what does not fit.
    pub fn restored(self, clearances: &[(u32, f32)]) -> Result<Mesh, String> {
        let is_sound = |(patch, clearance): &(u32, f32)| {
            (*patch as usize) < self.patches.len() && clearance.is_finite() && *clearance > 0.0
        };
        check(clearances.iter().all(is_sound), "a clearance")?;
        let (mut patches, mut known) = (Patches::default(), Known::default());
        let (mut later, mut listed) = (FxHashMap::default(), 0);
        for (number, of) in (0..).zip(self.patches) {
            let is_its_own = |v: &u32| {
                let vertex = self.vertices.get(*v as usize);
                vertex.is_some_and(|vertex| vertex.patch == number)
            };
            let is_sound = of.vertices.is_sorted_by(|a, b| a < b);
            check(
                is_sound && of.vertices.iter().all(is_its_own),
                "a vertex of a patch",
            )?;
            listed += of.vertices.len();
            let (patch, vertices) = of.patch(&patches, self.elements.len())?;
            let first = patch.first_vertices().len();
            if vertices.len() > first {
                later.insert(number, vertices[first..].to_vec());
            }
            patches.push(&patch, &mut known);
        }
        check(listed == self.vertices.len(), "a vertex of no patch")?;
        let mut mesh = Mesh {
            patches,
            later,
            clearances: clearances.iter().copied().collect(),
            ..Mesh::empty(self.frame, self.limits)
        };
        mesh.make_grids();
        mesh.restore(&self.elements, &self.vertices, &self.buried)?;
        Ok(mesh)
    }
}

impl StoredPatch {
    fn new(of: Patch, vertices: impl Iterator<Item = u32>) -> Self {
        let corners = of.corners();
        let at = |number: usize| *corners.get(number).unwrap_or(&corners[0]);
        Self {
            surface: of.surface,
            polygon: of.polygon,
            corners: [0, 1, 2, 3].map(at),
            corner_count: corners.len() as u8,
            outline: of.outline,
            back: of.back,
            normal: of.normal,
            area: of.area,
            reflectance: of.reflectance,
            exitance: of.exitance,
            roots: of.roots.clone(),
            grid: of.grid,
            vertices: vertices.collect(),
        }
    }

    /// The patch and its vertices, if its parts fit each other and those `before` it, and there are as many elements as it needs.
    fn patch(self, before: &Patches, elements: usize) -> Result<(Patch, Vec<u32>), String> {
        check(matches!(self.corner_count, 3 | 4), "a patch")?;
        let corners = &self.corners[..usize::from(self.corner_count)];
        let patch = Patch {
            outline: self.outline,
            reflectance: self.reflectance,
            exitance: self.exitance,
            roots: self.roots,
            grid: self.grid,
            first_vertex: self.vertices.first().copied().unwrap_or(0),
            ..Patch::new(self.surface, self.polygon, corners, self.back)
        };
        let within = |x: f32| (0.0..=1.0).contains(&x);
        let is_sound = patch.corners == self.corners
            && patch.area == self.area
            && patch.normal == self.normal
            && patch.area > 0.0
            && patch.reflectance.to_array().into_iter().all(within)
            && patch.exitance.is_finite();
        check(is_sound, "a patch")?;
        let (element, vertex) = before.first_after();
        let Range { start, end } = patch.roots;
        let is_known = start == element && end > start && end as usize <= elements;
        check(is_known, "a root element")?;
        let is_side = |count: u32| count.is_power_of_two() && count <= MOST_ALONG;
        let (columns, rows) = patch.grid;
        let is_full = is_side(columns) && is_side(rows) && columns * rows == end - start;
        check(
            is_full && !(patch.is_triangle() && end - start > 1),
            "a grid",
        )?;
        let first = patch.first_vertices();
        let is_known = first.start == vertex && self.vertices.starts_with(&Vec::from_iter(first));
        check(is_known, "a vertex of a patch")?;
        Ok((patch, self.vertices))
    }
}
