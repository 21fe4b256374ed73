//! Which sides of a surface are sides of the input polygon, where the reader split that.

use crate::scene::Surface;
use rustc_hash::FxHashMap;

/// A side by its polygon and its vertices, the lower first.
type Side = (u32, u32, u32);

/// The sides that two surfaces of one input polygon share: where it was cut.
pub(super) struct Outlines {
    cuts: FxHashMap<Side, u32>,
}

impl Outlines {
    pub fn new(surfaces: &[Surface]) -> Self {
        // The surfaces of one polygon follow one another; one alone has no cuts.
        let split = surfaces
            .chunk_by(|a, b| a.polygon == b.polygon)
            .filter(|group| group.len() > 1);
        let mut cuts = FxHashMap::default();
        for side in split.flatten().flat_map(sides) {
            *cuts.entry(side).or_insert(0) += 1;
        }
        cuts.retain(|_, count| *count > 1);
        Self { cuts }
    }

    /// Which sides of a surface are not cuts.
    pub fn of(&self, surface: &Surface) -> [bool; 4] {
        let mut outline = [true; 4];
        for (slot, side) in outline.iter_mut().zip(sides(surface)) {
            *slot = !self.cuts.contains_key(&side);
        }
        outline
    }
}

fn sides(surface: &Surface) -> impl Iterator<Item = Side> {
    let corners = surface.corners.indices();
    (0..corners.len()).map(move |i| {
        let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
        (surface.polygon, a.min(b), a.max(b))
    })
}
