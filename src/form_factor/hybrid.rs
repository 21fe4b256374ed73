//! Which formula for which pair: the five-times rule.

use crate::geometry::polygon::{self, Clipped};
use glam::DVec3;

/// A point that receives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receiver {
    /// Where it is.
    pub point: DVec3,
    /// Unit normal of the side that receives.
    pub normal: DVec3,
    /// What it has received so far, largest channel: thresholds follow it.
    pub irradiance: f32,
}

/// The formula for a pair of a point and a source cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Formula {
    /// Eq. (1) where the distance exceeds this many times the cell's largest projected width, Eq. (2) elsewhere.
    Hybrid(f64),
    /// Eq. (1) everywhere.
    Disk,
    /// Eq. (2) everywhere.
    Polygon,
}

impl Receiver {
    /// How high a point is above its horizon.
    #[inline(always)]
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.point)
    }
}

/// What the horizon leaves of a polygon, relative to the receiver.
pub fn above_horizon(receiver: Receiver, corners: &[DVec3]) -> Clipped {
    let mut relative = [DVec3::ZERO; 4];
    for (relative, corner) in relative.iter_mut().zip(corners) {
        *relative = *corner - receiver.point;
    }
    polygon::clip(&relative[..corners.len()], |corner| {
        receiver.normal.dot(corner)
    })
}

/// The point at (s, t) in the unit square, mapped into what is left of a cell cut by the horizon.
pub fn point_in_cut(cut: &Clipped, s: f64, t: f64) -> DVec3 {
    let corners = cut.corners();
    let from = polygon::centroid(corners);
    let k = (s * corners.len() as f64) as usize % corners.len();
    let along = corners[k].lerp(
        corners[(k + 1) % corners.len()],
        (s * corners.len() as f64).fract(),
    );
    from.lerp(along, 0.9 * t.sqrt())
}
