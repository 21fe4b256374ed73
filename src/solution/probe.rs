//! Reading the light at points of the scene.

use super::Solution;
use crate::geometry::{self, polygon};
use crate::radiometry::Spectrum;
use glam::DVec3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A point lies on a surface if it is this close to it, as a fraction of the scene's extent.
pub const MATCH: f64 = 1e-5;

/// The light at a point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Irradiance E, W/m².
    pub irradiance: Spectrum,
    /// Radiosity B = M + ρE, W/m².
    pub radiosity: Spectrum,
    /// The leaf of the mesh that the point lies on.
    pub element: u32,
}

/// Finds the patch at a point; made once for many points.
pub struct Prober<'a> {
    solution: &'a Solution,
    patches: RTree<GeomWithData<Rectangle<[f64; 3]>, u32>>,
    tolerance: f64,
}

impl<'a> Prober<'a> {
    /// Indexes the patches of a solution.
    pub fn new(solution: &'a Solution) -> Self {
        let tolerance = MATCH * solution.mesh.frame.extent();
        let boxes = solution
            .mesh
            .patches
            .iter()
            .zip(0..)
            .map(|(patch, number)| {
                let (low, high) = geometry::bounds(patch.corners().iter().copied());
                GeomWithData::new(
                    Rectangle::from_corners(low.to_array(), high.to_array()),
                    number,
                )
            });
        Self {
            solution,
            patches: RTree::bulk_load(boxes.collect()),
            tolerance,
        }
    }

    /// The light at `point` (scene units) on the surface there that faces along `normal`, interpolated on the solution's
    /// mesh. Of several within [`MATCH`] it is the one that faces that way best, then the nearest. `None` where there is none.
    pub fn probe(&self, point: DVec3, normal: DVec3) -> Option<Probe> {
        let mesh = &self.solution.mesh;
        let point = mesh.frame.enter(point);
        let normal = normal.normalize_or_zero();
        let margin = DVec3::splat(self.tolerance);
        let envelope = AABB::from_corners((point - margin).to_array(), (point + margin).to_array());
        let mut best: Option<(f64, f64, u32)> = None;
        for candidate in self.patches.locate_in_envelope_intersecting(envelope) {
            let patch = mesh.patch(candidate.data);
            let facing = patch.normal.dot(normal);
            let distance = polygon::distance(point, patch.corners(), patch.normal);
            if facing > 0.5 && distance <= self.tolerance {
                // Normals that agree to single precision agree.
                let rank = ((facing * 1e6).round(), -distance, candidate.data);
                let better = |b: &(f64, f64, u32)| {
                    rank.0 > b.0 || (rank.0 == b.0 && (rank.1, b.2) > (b.1, rank.2))
                };
                if best.as_ref().is_none_or(better) {
                    best = Some(rank);
                }
            }
        }
        best.map(|(_, _, patch)| self.on_patch(patch, point))
    }

    fn on_patch(&self, patch: u32, point: DVec3) -> Probe {
        let Solution { mesh, light, .. } = self.solution;
        let of = mesh.patch(patch);
        let (u, v) = of.coordinates(point);
        let element = mesh.leaf_at(patch, u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let weighted = mesh.interpolate(element, point);
        let irradiance = if weighted.iter().all(|(v, _)| mesh.buried[*v as usize]) {
            Spectrum::ZERO
        } else {
            weighted
                .iter()
                .map(|(v, w)| light.irradiance[*v as usize] * *w)
                .sum()
        };
        Probe {
            irradiance,
            radiosity: of.exitance + of.reflectance * irradiance,
            element,
        }
    }
}
