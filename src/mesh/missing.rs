//! Surfaces of which the front has no patch, or not on all of it: others have the light there.

use super::{Mesh, regions};
use crate::geometry::polygon::vector_area;
use crate::scene::{Scene, Surface};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// This share of an area is no rounding error.
const MISSED: f64 = 1e-3;

impl Mesh {
    /// How many there are among some of the surfaces of a scene that this is the mesh of; those that are meshed as one count as one.
    pub fn missing(&self, scene: &Scene, among: impl Fn(&Surface) -> bool) -> usize {
        let regions = regions(scene, &self.frame);
        let positions = scene.positions_in(&self.frame);
        // What there is, and what of it has patches.
        let mut areas: FxHashMap<u32, [f64; 2]> = FxHashMap::default();
        let some = (0..)
            .zip(&scene.surfaces)
            .filter(|(_, surface)| among(surface));
        for (number, surface) in some {
            let corners: Vec<DVec3> = surface.corners.places(&positions).collect();
            let [all, _] = areas.entry(regions.first(number)).or_default();
            *all += vector_area(&corners).length();
        }
        for patch in self.patches.iter().filter(|patch| !patch.back) {
            if let Some([_, meshed]) = areas.get_mut(&regions.first(patch.surface)) {
                *meshed += patch.area;
            }
        }
        let is_missing = |[all, meshed]: &&[f64; 2]| *meshed < (1.0 - MISSED) * all;
        areas.values().filter(is_missing).count()
    }
}
