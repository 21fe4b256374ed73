//! Everything that pairs are worked out from: facets, what may come between them, and the limits of accuracy.

use super::body::with_bodies;
use super::facet::{Facet, Part};
use super::join::joined;
use super::occluder::Occluder;
use super::tree::Tree;
use super::unhindered::Nodes;
use crate::scene::Scene;
use crate::visibility::{Triangles, Visibility};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

/// Vertices of one flat surface miss its plane by up to this fraction of the scene's extent: files carry six or seven digits.
const FLAT: f64 = 1e-6;

/// A surface touches what is nearer than this fraction of the extent.
const TOUCH: f64 = 1e-7;

/// Corners no higher over a plane than this fraction of the extent lie in it.
const HORIZON: f64 = 1e-7;

/// Of the tolerance of a row, what the errors of the formulas may come to that serve where nothing lies between.
const UNHINDERED: f64 = 0.1;

/// No unhindered exchange may be off by more than this, however little of its row it is.
const LEAST_ACCURATE_UNHINDERED: f64 = 1e-3;

/// No visible share may be off by more than this, however little of its row it is.
const LEAST_ACCURATE: f64 = 0.02;

impl std::fmt::Debug for Space {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (facets, occluders) = (self.facets.len(), self.occluders.len());
        write!(f, "Space of {facets} facets and {occluders} occluders")
    }
}

/// The facets of all rows with all that comes between them, in the frame.
pub(super) struct Space {
    /// In the order of the rows.
    pub facets: Vec<Facet>,
    pub nodes: Vec<Nodes>,
    pub occluders: Vec<Occluder>,
    pub tree: Tree,
    pub extent: f64,
    pub horizon: f64,
    /// How accurate the row of each facet must be.
    pub budgets: Vec<Budget>,
    pub visibility: Box<dyn Visibility>,
}

impl Space {
    pub fn new(
        facets: Vec<Facet>,
        occluders: Vec<Occluder>,
        extent: f64,
        budgets: Vec<Budget>,
        visibility: Box<dyn Visibility>,
    ) -> Self {
        Self {
            nodes: facets.iter().map(Nodes::new).collect(),
            tree: Tree::new(&facets),
            facets,
            occluders,
            extent,
            horizon: HORIZON * extent,
            budgets,
            visibility,
        }
    }
}

/// The errors that the pairs of facets of a row may have: half of the tolerance in proportion to what they exchange, half of it equal for all, so that the
/// root of the sum of their squares comes to the tolerance at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Budget {
    /// Of the visible share of any pair, as far as errors in proportion to the entries go.
    relative: f64,
    /// Of any exchange, as far as equal errors go.
    absolute: f64,
    /// Of what any pair exchanges unhindered, relative.
    pub accuracy: f64,
}

impl Budget {
    /// For a row of the given area and length (see [`row_lengths`]) that so many pairs of facets make up.
    pub fn new(tolerance: f64, area: f64, length: f64, pairs: usize) -> Self {
        let relative = tolerance / length.max(f64::MIN_POSITIVE);
        Self {
            relative: 0.5 * relative,
            absolute: 0.5 * tolerance * area / (pairs as f64).sqrt(),
            accuracy: (UNHINDERED * relative).min(LEAST_ACCURATE_UNHINDERED),
        }
    }
}

impl Space {
    /// The relative error that what a pair exchanges unhindered may have.
    pub fn accuracy(&self, i: u32, j: u32) -> f64 {
        let [i, j] = [i, j].map(|k| self.budgets[k as usize].accuracy);
        i.min(j)
    }

    /// The error that the visible share of a pair may have that would exchange `whole` unhindered.
    pub fn share_tolerance(&self, i: u32, j: u32, whole: f64) -> f64 {
        let share = |k: u32| {
            let Budget {
                relative, absolute, ..
            } = self.budgets[k as usize];
            relative + absolute / whole
        };
        share(i).min(share(j)).min(LEAST_ACCURATE)
    }
}

/// The length of each row, the root of the sum of the squares of its entries, as if nothing were hidden and all facets were disks
/// (Eq. 1); `of_row` are the facets of the rows.
pub(super) fn row_lengths(facets: &[Facet], of_row: &[Range<u32>]) -> Vec<f64> {
    let square = |i: &Facet| -> f64 {
        let entries = facets.iter().map(|j| {
            let r = j.centroid - i.centroid;
            let cosines = [i.normal.dot(r), -j.normal.dot(r)].map(|c| c.max(0.0));
            let square = r.length_squared();
            let entry = i.area * j.area * cosines[0] * cosines[1]
                / (square * (PI * square + j.area)).max(f64::MIN_POSITIVE);
            entry * entry
        });
        entries.sum()
    };
    let length = |range: &Range<u32>| {
        let members = &facets[range.start as usize..range.end as usize];
        let area: f64 = members.iter().map(|facet| facet.area).sum();
        members.iter().map(square).sum::<f64>().sqrt() / area.max(f64::MIN_POSITIVE)
    };
    of_row.par_iter().map(length).collect()
}

impl Part<'_> {
    pub fn is_whole(&self) -> bool {
        matches!(self, Part::Whole(_))
    }
}

/// The surfaces of a scene, with neighbours in one plane joined, and convex bodies that they bound; `positions` are its vertices in a
/// frame of the given extent.
pub(super) fn occluders(scene: &Scene, positions: &[DVec3], extent: f64) -> Vec<Occluder> {
    let polygons = scene
        .surfaces
        .iter()
        .map(|s| s.corners.indices().to_vec())
        .collect();
    let surfaces = joined(polygons, positions, FLAT * extent);
    let occluder = |surface: super::join::Joined| {
        let mut occluder = Occluder::new(surface.corners, TOUCH * extent)?;
        let warp = occluder.front().warp(&surface.vertices);
        occluder.thicken(warp + TOUCH * extent);
        Some(occluder)
    };
    let surfaces = surfaces.into_iter().filter_map(occluder).collect();
    with_bodies(surfaces, FLAT * extent)
}

/// The same as triangles, for rays.
pub(super) fn triangles(scene: &Scene, positions: &[DVec3]) -> Triangles {
    let surfaces = scene.surfaces.iter();
    Triangles {
        vertices: positions.iter().map(|p| p.as_vec3()).collect(),
        indices: surfaces.flat_map(|s| s.corners.triangles()).collect(),
    }
}
