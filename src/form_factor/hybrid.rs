//! Which formula for which pair: the five-times rule.

use super::disk::point_to_disk;
use super::polygon::{point_to_quad, point_to_visible_polygon};
use super::source::Cell;
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

/// What a point sees of a cell, occlusion left aside.
#[derive(Debug, Clone, Copy)]
pub struct Sight {
    /// Form factor from the point to the cell.
    pub form_factor: f64,
    /// Relative error that Eq. (1) may have here, to leading order; 0 for Eq. (2).
    pub uncertainty: f64,
    /// Whether the horizon cuts the cell.
    pub cut: bool,
}

impl Sight {
    const NOTHING: Sight = Sight {
        form_factor: 0.0,
        uncertainty: 0.0,
        cut: false,
    };

    /// By Eq. (2), of a polygon of three or four corners; a triangle repeats its first.
    #[inline(always)]
    pub fn near(receiver: Receiver, corners: [DVec3; 4], count: usize, cut: bool) -> Self {
        let corners = corners.map(|corner| corner - receiver.point);
        let form_factor = if cut {
            point_to_visible_polygon(receiver.normal, &corners[..count]).0
        } else {
            point_to_quad(receiver.normal, corners).max(0.0)
        };
        Self {
            form_factor,
            uncertainty: 0.0,
            cut,
        }
    }
}

impl Receiver {
    /// How high a point is above its horizon.
    #[inline(always)]
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.point)
    }
}

impl Formula {
    /// The form factor from `receiver` to one cell of a source with unit normal `source_normal`.
    ///
    /// The largest projected width is taken for its bound that holds in every direction, the cell's diameter.
    #[inline(always)]
    pub fn sight(self, receiver: Receiver, cell: &Cell, source_normal: DVec3) -> Sight {
        let to = cell.centroid - receiver.point;
        if source_normal.dot(to) >= 0.0 {
            return Sight::NOTHING;
        }
        let height = receiver.normal.dot(to);
        if height <= -cell.radius {
            return Sight::NOTHING;
        }
        let far = match self {
            Formula::Hybrid(factor) => to.length_squared() > (factor * cell.diameter).powi(2),
            Formula::Disk => true,
            Formula::Polygon => false,
        };
        let cut = height < cell.radius && self != Formula::Disk && cut_by_horizon(receiver, cell);
        if far && !cut {
            let form_factor = point_to_disk(receiver.normal, to, source_normal, cell.area);
            let uncertainty = cell.diameter * cell.diameter / to.length_squared();
            return Sight {
                form_factor,
                uncertainty,
                cut: false,
            };
        }
        Sight::near(receiver, cell.corners(), cell.corner_count(), cut)
    }
}

fn cut_by_horizon(receiver: Receiver, cell: &Cell) -> bool {
    let corners = cell.corners();
    corners.iter().any(|corner| receiver.height(*corner) < 0.0)
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
