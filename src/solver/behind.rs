//! What stands behind the triangles that rays meet.

use crate::geometry::{Frame, polygon::vector_area};
use crate::mesh::{Mesh, Regions, regions};
use crate::scene::{Scene, Sides, back_to_back};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::sync::OnceLock;

/// What stands behind a triangle of the visibility scene.
#[derive(Debug, Clone, Copy)]
pub(super) struct Backing {
    /// Unit normal of the front.
    pub normal: DVec3,
    /// The sides that radiate.
    pub sides: Sides,
    /// Index into `Scene::surfaces`.
    pub surface: u32,
}

/// Knows what stands behind each triangle of a visibility scene.
pub(super) trait Behind: Sync {
    /// What a ray in some direction meets in one of them: of two surfaces that lie back to back the one that faces it.
    fn at(&self, triangle: u32, direction: DVec3) -> Backing;

    /// The first surface of those that are meshed as one with another.
    fn region(&self, surface: u32) -> u32;

    /// Whether all of them radiate from both sides.
    fn is_two_sided(&self) -> bool;
}

impl Behind for Vec<Backing> {
    fn at(&self, triangle: u32, _: DVec3) -> Backing {
        self[triangle as usize]
    }

    fn region(&self, surface: u32) -> u32 {
        surface
    }

    fn is_two_sided(&self) -> bool {
        self.iter().all(|of| of.sides == Sides::Both)
    }
}

/// The surfaces behind the triangles of a scene's [`occluders`](super::occluders). There may be millions, so what is seldom asked for is
/// found when it is.
pub(super) struct Surfaces<'a> {
    scene: &'a Scene,
    frame: Frame,
    regions: OnceLock<Regions>,
    /// Where surfaces lie back to back, of each the other.
    backs: OnceLock<FxHashMap<u32, u32>>,
    firsts: Firsts,
}

/// Which triangles are the first ones of their surfaces: a bit each, and how many there are before each word of bits.
struct Firsts {
    words: Vec<u64>,
    before: Vec<u32>,
}

impl Firsts {
    /// Those of surfaces with so many triangles each.
    fn of(counts: impl Iterator<Item = usize>) -> Self {
        let mut words = Vec::new();
        let mut first = 0;
        for count in counts {
            words.resize(first / 64 + 1, 0u64);
            words[first / 64] |= 1 << (first % 64);
            first += count;
        }
        words.resize(first.div_ceil(64), 0);
        words.shrink_to_fit();
        let mut sum = 0;
        let before = words.iter().map(|word| {
            sum += word.count_ones();
            sum - word.count_ones()
        });
        Self {
            before: before.collect(),
            words,
        }
    }

    /// The surface of a triangle.
    fn surface(&self, triangle: u32) -> u32 {
        let (word, bit) = (triangle as usize / 64, triangle % 64);
        let up_to_it = self.words[word] << (63 - bit);
        self.before[word] + up_to_it.count_ones() - 1
    }
}

impl Backing {
    /// Whether a ray in some direction ends on a side that does not radiate.
    pub fn is_dark(&self, direction: DVec3) -> bool {
        self.sides == Sides::Front && self.normal.dot(direction) > 0.0
    }
}

impl<'a> Surfaces<'a> {
    pub fn new(scene: &'a Scene, mesh: &Mesh) -> Self {
        let surfaces = scene.surfaces.iter();
        let triangles = surfaces.map(|surface| surface.corners.indices().len() - 2);
        Self {
            scene,
            frame: mesh.frame,
            regions: OnceLock::new(),
            backs: OnceLock::new(),
            firsts: Firsts::of(triangles),
        }
    }

    fn backing(&self, number: u32) -> Backing {
        let surface = &self.scene.surfaces[number as usize];
        let at = |v: u32| self.frame.enter(self.scene.vertices[v as usize]);
        let corners = surface.corners.indices();
        let fourth = *corners.get(3).unwrap_or(&corners[0]);
        let places = [corners[0], corners[1], corners[2], fourth].map(at);
        Backing {
            normal: vector_area(&places[..corners.len()]).normalize_or(DVec3::Z),
            sides: surface.sides,
            surface: number,
        }
    }

    /// The surface that lies back to back with another, if one does.
    fn back(&self, surface: u32) -> Option<u32> {
        let found = || back_to_back(&self.scene.surfaces, &self.scene.vertices);
        self.backs.get_or_init(found).get(&surface).copied()
    }
}

impl Behind for Surfaces<'_> {
    fn at(&self, triangle: u32, direction: DVec3) -> Backing {
        let number = self.firsts.surface(triangle);
        let met = self.backing(number);
        // A ray ends on both, and an engine names any of the two.
        let back = met.is_dark(direction).then(|| self.back(number)).flatten();
        back.map_or(met, |back| self.backing(back))
    }

    fn region(&self, surface: u32) -> u32 {
        let found = || regions(self.scene, &self.frame);
        self.regions.get_or_init(found).first(surface)
    }

    fn is_two_sided(&self) -> bool {
        let mut surfaces = self.scene.surfaces.iter();
        surfaces.all(|surface| surface.sides == Sides::Both)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_of_the_surface_that_was_cut_into_it() {
        let counts: Vec<usize> = (0..200).map(|i| 1 + i * i % 2).collect();
        let firsts = Firsts::of(counts.iter().copied());
        let numbered = (0..).zip(&counts);
        let surfaces = numbered.flat_map(|(number, count)| std::iter::repeat_n(number, *count));
        for (triangle, surface) in (0..).zip(surfaces) {
            assert_eq!(firsts.surface(triangle), surface, "{triangle}");
        }
        assert!(Firsts::of(std::iter::empty()).words.is_empty());
    }
}
