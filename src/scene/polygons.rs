//! Polygons as files have them.

use glam::DVec3;

/// Polygons as the file has them: any number of corners, planar or not.
#[derive(Default)]
pub(super) struct Polygons {
    /// No two positions are equal, and each one is used.
    pub positions: Vec<DVec3>,
    /// The corners of all polygons, one polygon after the other.
    corners: Vec<u32>,
    /// For each polygon where its corners end.
    ends: Vec<usize>,
    /// For each polygon the index of its material in the library.
    pub materials: Vec<u32>,
    /// For each polygon the line where it stands; empty if the file has no lines.
    pub lines: Vec<u32>,
}

impl Polygons {
    /// None yet, but the lines where they stand, with room for these and for so many corners.
    pub fn with_lines(lines: Vec<u32>, corners: usize) -> Self {
        Self {
            positions: Vec::new(),
            corners: Vec::with_capacity(corners),
            ends: Vec::with_capacity(lines.len()),
            materials: Vec::with_capacity(lines.len()),
            lines,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The position indices of a polygon's corners, in order.
    pub fn corners(&self, polygon: usize) -> &[u32] {
        let end = |of: usize| self.ends[of];
        let begin = polygon.checked_sub(1).map_or(0, end);
        &self.corners[begin..end(polygon)]
    }

    /// Adds one, of position indices.
    pub fn push(&mut self, corners: impl IntoIterator<Item = u32>, material: u32) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
        self.materials.push(material);
    }

    /// The line where a polygon stands; 0 if the file has no lines.
    pub fn line(&self, polygon: usize) -> usize {
        self.lines.get(polygon).map_or(0, |line| *line as usize)
    }
}
