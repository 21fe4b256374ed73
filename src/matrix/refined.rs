//! What refinement found: an integral over the tiles of a facet, with its error.

use super::look::Sums;

/// An integral with its error.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Refined {
    pub sums: Sums,
    /// How much the last refinement of each tile changed what it would see unhindered, and how much of that is visible.
    pub off: Sums,
    /// The root of the sum of the squares of the tiles' errors.
    pub error: f64,
    /// The sum of those with a sign: of tiles along one shadow they have the same.
    pub shift: f64,
    /// How often quarters were quartered at most.
    pub depth: u32,
}

impl Refined {
    pub fn add(&mut self, part: Self) {
        self.sums = [self.sums, part.sums].into_iter().sum();
        self.off = [self.off, part.off].into_iter().sum();
        self.error = self.error.hypot(part.error);
        self.shift += part.shift;
        self.depth = self.depth.max(part.depth);
    }

    /// With what the points missed of the `whole` that is exchanged unhindered: it is visible as far as the tiles are that caused it.
    pub fn completed(mut self, whole: f64) -> Self {
        let missed = whole - self.sums.all;
        let seen = self.off.share();
        self.sums.visible += missed * seen;
        self.sums.all = whole;
        self.error = self.error.hypot(missed * seen * (1.0 - seen));
        self
    }

    /// The visible share of what is exchanged unhindered, with its error.
    pub fn share(&self, whole: f64) -> (f64, f64) {
        let visible = (self.sums.visible / whole).clamp(0.0, 1.0);
        (visible, self.error.max(self.shift.abs()) / whole)
    }
}
