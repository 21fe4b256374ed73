//! What a scene amounts to, in numbers.

use super::polygon;
use super::{Corners, Material, Scene, Sides, Surface};
use crate::geometry;
use crate::radiometry::Power;
use glam::DVec3;
use std::f64::consts::PI;

/// Counts and totals of a [`Scene`].
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Polygons as read from the file.
    pub polygons: usize,
    /// Surfaces, after polygons were split and unusable ones left out.
    pub surfaces: usize,
    /// Surfaces with three corners.
    pub triangles: usize,
    /// Surfaces with four corners.
    pub quads: usize,
    /// Surfaces that radiate from both sides.
    pub two_sided: usize,
    /// Surfaces that give light of their own.
    pub emitters: usize,
    /// The lowest and the highest coordinates, in scene units.
    pub bounds: (DVec3, DVec3),
    /// The area of all surfaces, each counted once, in m².
    pub area: f64,
    /// The power that all emitters give off, πLA, in W.
    pub emitted_power: Power,
    /// One entry for each of [`Scene::materials`].
    pub materials: Vec<MaterialSummary>,
}

/// How much of a scene has a certain material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialSummary {
    /// The material.
    pub material: Material,
    /// Surfaces with it.
    pub surfaces: usize,
    /// Their area, in m².
    pub area: f64,
    /// The power that they emit, in W.
    pub emitted_power: Power,
}

impl Scene {
    /// The positions of a surface's corners, in scene units.
    pub fn positions(&self, surface: &Surface) -> impl ExactSizeIterator<Item = DVec3> {
        self.four_corners(surface)
            .into_iter()
            .take(surface.corners.indices().len())
    }

    /// The area of a surface, in square scene units.
    pub fn area(&self, surface: &Surface) -> f64 {
        polygon::area(&self.four_corners(surface))
    }

    /// The unit normal of a surface, on its front.
    pub fn normal(&self, surface: &Surface) -> DVec3 {
        polygon::doubled_area_vector(&self.four_corners(surface)).normalize_or(DVec3::Y)
    }

    /// The corners of a surface, the last of a triangle twice.
    fn four_corners(&self, surface: &Surface) -> [DVec3; 4] {
        let indices = match surface.corners {
            Corners::Triangle([a, b, c]) => [a, b, c, c],
            Corners::Quad(indices) => indices,
        };
        indices.map(|index| self.vertices[index as usize])
    }

    /// The lowest and the highest coordinates of all surfaces, in scene units.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let surfaces = self.surfaces.iter();
        geometry::bounds(surfaces.flat_map(|surface| self.positions(surface)))
    }

    /// Counts and totals for a report.
    pub fn summary(&self) -> Summary {
        let mut materials: Vec<MaterialSummary> =
            self.materials.iter().map(MaterialSummary::unused).collect();
        for surface in &self.surfaces {
            let entry = &mut materials[surface.material as usize];
            entry.surfaces += 1;
            entry.area += self.area(surface) * self.metres_per_unit * self.metres_per_unit;
        }
        for entry in &mut materials {
            entry.emitted_power = PI * entry.area * entry.material.emitted_radiance.as_dvec3();
        }
        let count = |test: fn(&Surface) -> bool| {
            self.surfaces.iter().filter(|surface| test(surface)).count()
        };
        Summary {
            polygons: self.input_polygons,
            surfaces: self.surfaces.len(),
            triangles: count(|surface| matches!(surface.corners, Corners::Triangle(_))),
            quads: count(|surface| matches!(surface.corners, Corners::Quad(_))),
            two_sided: count(|surface| surface.sides == Sides::Both),
            emitters: materials
                .iter()
                .filter(|m| m.material.emits())
                .map(|m| m.surfaces)
                .sum(),
            bounds: self.bounds(),
            area: materials.iter().map(|m| m.area).sum(),
            emitted_power: materials.iter().map(|m| m.emitted_power).sum(),
            materials,
        }
    }
}

impl MaterialSummary {
    fn unused(material: &Material) -> Self {
        MaterialSummary {
            material: material.clone(),
            surfaces: 0,
            area: 0.0,
            emitted_power: Power::ZERO,
        }
    }
}
