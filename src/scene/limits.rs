//! The bounds of what a scene may hold, each far outside of what any real one does.

use std::ops::RangeInclusive;

/// The largest coordinate, in scene units; what is traced is scaled first.
pub(super) const COORDINATE: f64 = 1e18;

/// The shortest and the longest unit of length, in metres: areas and powers in it stay numbers.
pub(super) const UNIT: RangeInclusive<f64> = 1e-12..=1e12;

/// The largest radiance, W m⁻² sr⁻¹: what is summed of it stays within single precision.
pub(super) const RADIANCE: f32 = 1e30;

/// The most corners of one polygon: splitting one takes time that grows with their square.
pub(super) const CORNERS: usize = 4096;

/// The most pixels along a side of a picture.
pub(super) const PIXELS: u32 = 16384;
