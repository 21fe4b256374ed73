//! The surfaces of a scene, as they are split.

use super::Piece;
use super::outline::Outlines;
use crate::geometry::Frame;
use crate::scene::{Material, Scene, Surface};
use glam::DVec3;

/// The surfaces of a scene, in the frame.
pub(super) struct Shapes<'a> {
    pub surfaces: &'a [Surface],
    materials: &'a [Material],
    pub positions: Vec<DVec3>,
    outlines: Outlines,
}

impl<'a> Shapes<'a> {
    pub fn new(scene: &'a Scene, frame: &Frame) -> Self {
        Self {
            surfaces: &scene.surfaces,
            materials: &scene.materials,
            positions: scene.positions_in(frame),
            outlines: Outlines::new(&scene.surfaces),
        }
    }

    pub fn corners(&self, surface: u32) -> Vec<DVec3> {
        let corners = self.surfaces[surface as usize].corners;
        corners.places(&self.positions).collect()
    }

    pub fn emits(&self, surface: u32) -> bool {
        self.materials[self.surfaces[surface as usize].material as usize].emits()
    }

    pub fn outline(&self, surface: u32) -> [bool; 4] {
        self.outlines.of(&self.surfaces[surface as usize])
    }

    pub fn whole(&self, surface: u32) -> Piece {
        Piece::new(surface, &self.corners(surface), self.outline(surface))
    }
}
