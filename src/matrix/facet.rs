//! A flat convex piece of a radiating side, and what every pair asks of it.

use super::convex::Convex;
use crate::geometry::{bounds, polygon};
use glam::DVec3;

/// A convex polygon that radiates from the side from which its corners run counter-clockwise.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    pub shape: Convex,
    /// Unit normal of the radiating side.
    pub normal: DVec3,
    pub centroid: DVec3,
    pub area: f64,
    /// No corner is farther than this from the centroid.
    pub radius: f64,
    /// Box around the corners.
    pub low: DVec3,
    pub high: DVec3,
    /// The first four corners component by component, so that they are done at once; a triangle repeats one.
    columns: [[f64; 4]; 3],
}

impl Facet {
    /// `None` where there is no area.
    pub fn new(shape: Convex) -> Option<Self> {
        if shape.is_empty() {
            return None;
        }
        let corners = shape.corners();
        let vector_area = polygon::vector_area(corners);
        let area = vector_area.length();
        let normal = vector_area / area;
        if !normal.is_finite() {
            return None;
        }
        let centroid = polygon::centroid(corners);
        let radius = corners
            .iter()
            .map(|c| c.distance_squared(centroid))
            .fold(0.0, f64::max)
            .sqrt();
        let (low, high) = bounds(corners.iter().copied());
        let quad = shape.quad();
        Some(Self {
            columns: std::array::from_fn(|axis| quad.map(|corner| corner[axis])),
            shape,
            normal,
            centroid,
            area,
            radius,
            low,
            high,
        })
    }

    pub fn corners(&self) -> &[DVec3] {
        self.shape.corners()
    }

    /// Least and greatest height of the corners over the plane where `normal` · x = `offset`, in units of the normal's length.
    pub fn range_over(&self, normal: DVec3, offset: f64) -> (f64, f64) {
        let [x, y, z] = &self.columns;
        let h: [f64; 4] =
            std::array::from_fn(|k| normal.x * x[k] + normal.y * y[k] + normal.z * z[k] - offset);
        let least = |a: f64, b: f64| if a < b { a } else { b };
        let most = |a: f64, b: f64| if a > b { a } else { b };
        let first = (
            least(least(h[0], h[1]), least(h[2], h[3])),
            most(most(h[0], h[1]), most(h[2], h[3])),
        );
        let others = self
            .corners()
            .iter()
            .skip(4)
            .map(|c| normal.dot(*c) - offset);
        others.fold(first, |(low, high), h| (least(h, low), most(h, high)))
    }

    /// Height of a point over the plane, on the radiating side.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.centroid)
    }

    /// The part that lies in front of another facet's plane: itself, less of it, or nothing. Points within `reach` of the plane
    /// lie on it.
    pub fn in_front_of(&self, other: &Facet, reach: f64) -> Option<Part<'_>> {
        let middle = other.height(self.centroid);
        if middle >= self.radius {
            return Some(Part::Whole(self));
        }
        if middle <= reach - self.radius {
            return None;
        }
        let heights = self.corners().iter().map(|c| other.height(*c));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        });
        if high <= reach {
            None
        } else if low >= -reach {
            Some(Part::Whole(self))
        } else {
            let above = self.shape.divide(|c| other.height(c), reach).above;
            Facet::new(above).map(|facet| Part::Cut(Box::new(facet)))
        }
    }
}

/// What of a facet lies in front of a plane.
pub(super) enum Part<'a> {
    Whole(&'a Facet),
    Cut(Box<Facet>),
}

impl std::ops::Deref for Part<'_> {
    type Target = Facet;

    fn deref(&self) -> &Facet {
        match self {
            Part::Whole(facet) => facet,
            Part::Cut(facet) => facet,
        }
    }
}
