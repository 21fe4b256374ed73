//! What stands behind the triangles that rays meet.

use crate::geometry::{Frame, polygon::vector_area};
use crate::mesh::{Mesh, Regions, regions};
use crate::scene::{Scene, Sides};
use glam::DVec3;
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
    /// What stands behind one of them.
    fn at(&self, triangle: u32) -> Backing;

    /// The first surface of those that are meshed as one with another.
    fn region(&self, surface: u32) -> u32;

    /// Whether all of them radiate from both sides.
    fn is_two_sided(&self) -> bool;
}

impl Behind for Vec<Backing> {
    fn at(&self, triangle: u32) -> Backing {
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
    /// By triangle.
    surfaces: Vec<u32>,
}

impl<'a> Surfaces<'a> {
    pub fn new(scene: &'a Scene, mesh: &Mesh) -> Self {
        let numbered = (0..).zip(&scene.surfaces);
        let triangles = numbered.flat_map(|(number, surface)| {
            let count = surface.corners.indices().len() - 2;
            std::iter::repeat_n(number, count)
        });
        let mut surfaces: Vec<u32> = triangles.collect();
        surfaces.shrink_to_fit();
        Self {
            scene,
            frame: mesh.frame,
            regions: OnceLock::new(),
            surfaces,
        }
    }
}

impl Behind for Surfaces<'_> {
    fn at(&self, triangle: u32) -> Backing {
        let number = self.surfaces[triangle as usize];
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

    fn region(&self, surface: u32) -> u32 {
        let found = || regions(self.scene, &self.frame);
        self.regions.get_or_init(found).first(surface)
    }

    fn is_two_sided(&self) -> bool {
        let mut surfaces = self.scene.surfaces.iter();
        surfaces.all(|surface| surface.sides == Sides::Both)
    }
}
