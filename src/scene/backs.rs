//! Polygons that lie back to back: a sheet that a file has as two of them, with the same corners the one and the other way around.

use super::Surface;
use super::weld::MixingHasher;
use crate::geometry::polygon::vector_area;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::hash::Hasher;

/// All surfaces of one polygon, which follow one another.
struct Outline<'a> {
    first: u32,
    surfaces: &'a [Surface],
}

/// For each surface of which the polygon lies back to back with another, the first surface of that one. On this thread alone, so that others
/// may wait for it.
pub(crate) fn back_to_back(surfaces: &[Surface], positions: &[DVec3]) -> FxHashMap<u32, u32> {
    let mut first = 0;
    let outlines: Vec<Outline> = surfaces
        .chunk_by(|a, b| a.polygon == b.polygon)
        .map(|surfaces| {
            let outline = Outline { first, surfaces };
            first += surfaces.len() as u32;
            outline
        })
        .collect();
    let numbers = 0..outlines.len() as u32;
    let mut hashed: Vec<(u64, u32)> = numbers
        .zip(&outlines)
        .map(|(number, outline)| (outline.hash(), number))
        .collect();
    hashed.sort_unstable();
    let mut backs = FxHashMap::default();
    for alike in hashed.chunk_by(|a, b| a.0 == b.0).filter(|of| of.len() > 1) {
        let alike = || alike.iter().map(|(_, number)| &outlines[*number as usize]);
        for one in alike() {
            let back = alike().find(|other| one.is_back_to_back_with(other, positions));
            let surfaces = (one.first..).take(one.surfaces.len());
            backs.extend(
                back.into_iter()
                    .flat_map(|back| surfaces.clone().map(|of| (of, back.first))),
            );
        }
    }
    backs
}

impl Outline<'_> {
    /// The vertices, sorted.
    fn vertices(&self) -> Vec<u32> {
        let corners = self.surfaces.iter().flat_map(|of| of.corners.indices());
        let mut vertices: Vec<u32> = corners.copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    fn hash(&self) -> u64 {
        let mut hasher = MixingHasher::default();
        self.vertices()
            .into_iter()
            .for_each(|v| hasher.write_u32(v));
        hasher.finish()
    }

    fn area_vector(&self, positions: &[DVec3]) -> DVec3 {
        let of = |surface: &Surface| {
            let corners: Vec<DVec3> = surface.corners.places(positions).collect();
            vector_area(&corners)
        };
        self.surfaces.iter().map(of).sum()
    }

    fn is_back_to_back_with(&self, other: &Self, positions: &[DVec3]) -> bool {
        let [here, there] = [self, other].map(|of| of.area_vector(positions));
        here.dot(there) < 0.0 && self.vertices() == other.vertices()
    }
}
