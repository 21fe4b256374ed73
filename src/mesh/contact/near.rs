//! Which surfaces come near one another.

use crate::scene::Surface;
use glam::DVec3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The boxes around all surfaces of a scene, in a tree.
pub(super) struct Neighbours {
    tree: RTree<GeomWithData<Rectangle<[f64; 3]>, u32>>,
}

impl Neighbours {
    pub fn new(surfaces: &[Surface], positions: &[DVec3]) -> Self {
        let boxes = surfaces.iter().zip(0..).map(|(surface, number)| {
            let corners = surface
                .corners
                .indices()
                .iter()
                .map(|v| positions[*v as usize]);
            let (low, high) = bounds(corners);
            GeomWithData::new(
                Rectangle::from_corners(low.to_array(), high.to_array()),
                number,
            )
        });
        Self {
            tree: RTree::bulk_load(boxes.collect()),
        }
    }

    /// The surfaces whose boxes come closer than `margin` to the box around `corners`.
    pub fn of(&self, corners: &[DVec3], margin: f64) -> impl Iterator<Item = u32> + '_ {
        let (low, high) = bounds(corners.iter().copied());
        let margin = DVec3::splat(margin);
        let envelope = AABB::from_corners((low - margin).to_array(), (high + margin).to_array());
        self.tree
            .locate_in_envelope_intersecting(envelope)
            .map(|found| found.data)
    }
}

fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    })
}
