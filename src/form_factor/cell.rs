//! A cell of a source: three or four corners, and how they are split into four.

use super::division::Division;
use crate::geometry::polygon;
use crate::radiometry::Spectrum;
use glam::DVec3;
use std::ops::{Add, Sub};

/// The two shapes that shoot, and their quarters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SourceShape {
    /// Three corners; split at the midpoints into three corner triangles and the middle one.
    Triangle,
    /// Four corners; split at the midpoints and the mean of the corners.
    Quad,
}

/// A cell of the source.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    corners: [DVec3; 4],
    shape: SourceShape,
    /// Centre of mass: where Eq. (1) is evaluated.
    pub(super) centroid: DVec3,
    pub(super) area: f64,
    /// The longest distance between two corners.
    pub(super) diameter: f64,
    /// The longest distance from the centroid to a corner.
    pub(super) radius: f64,
    /// Mean unshot radiosity.
    pub(super) radiosity: Spectrum,
    /// Largest difference, in any channel, between a child's radiosity and the cell's.
    pub(super) variation: f32,
}

impl Cell {
    pub(super) fn new(corners: [DVec3; 4], shape: SourceShape) -> Self {
        let count = shape.corners();
        let used = &corners[..count];
        let centroid = polygon::centroid(used);
        let radius = used
            .iter()
            .map(|c| c.distance_squared(centroid))
            .fold(0.0, f64::max)
            .sqrt();
        Self {
            corners,
            shape,
            centroid,
            area: polygon::vector_area(used).length(),
            diameter: polygon::diameter(used),
            radius,
            radiosity: Spectrum::ZERO,
            variation: 0.0,
        }
    }

    pub(super) fn shape(&self) -> SourceShape {
        self.shape
    }

    /// All four stored corners; a triangle repeats its first.
    pub(super) fn corners(&self) -> [DVec3; 4] {
        self.corners
    }

    /// Three or four.
    pub(super) fn corner_count(&self) -> usize {
        self.shape.corners()
    }

    /// The three or four corners.
    pub(super) fn outline(&self) -> &[DVec3] {
        &self.corners[..self.corner_count()]
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The point at (s, t) of the unit square, mapped onto the cell evenly in area for triangles and parallelograms.
    pub fn at(&self, s: f64, t: f64) -> DVec3 {
        let [a, b, c, d] = self.corners;
        let (s, t) = self.shape.folded(s, t);
        match self.shape {
            SourceShape::Quad => a.lerp(b, s).lerp(d.lerp(c, s), t),
            SourceShape::Triangle => a + (b - a) * s + (c - a) * t,
        }
    }

    pub(super) fn children(&self, division: Division, level: u32) -> [[DVec3; 4]; 4] {
        division.children(
            level,
            self.corners,
            |a, b| (a + b) * 0.5,
            |[a, b, c, d]| (a + b + c + d) * 0.25,
        )
    }
}

impl SourceShape {
    /// Three or four.
    pub const fn corners(self) -> usize {
        match self {
            SourceShape::Triangle => 3,
            SourceShape::Quad => 4,
        }
    }

    /// The place in a triangle that stands for one beyond its long side, in the unit square.
    #[inline(always)]
    pub(super) fn folded<T>(self, s: T, t: T) -> (T, T)
    where
        T: Copy + PartialOrd + From<u8> + Add<Output = T> + Sub<Output = T>,
    {
        let one = T::from(1);
        if self == SourceShape::Triangle && s + t > one {
            (one - s, one - t)
        } else {
            (s, t)
        }
    }

    /// The corners of the four quarters, in the order in which the mesh numbers the children of an element.
    pub fn children<P: Copy>(
        self,
        corners: [P; 4],
        midpoint: impl Fn(P, P) -> P,
        centre: impl Fn([P; 4]) -> P,
    ) -> [[P; 4]; 4] {
        let [a, b, c, d] = corners;
        match self {
            SourceShape::Quad => {
                let (ab, bc, cd, da) = (
                    midpoint(a, b),
                    midpoint(b, c),
                    midpoint(c, d),
                    midpoint(d, a),
                );
                let m = centre(corners);
                [
                    [a, ab, m, da],
                    [ab, b, bc, m],
                    [m, bc, c, cd],
                    [da, m, cd, d],
                ]
            }
            SourceShape::Triangle => {
                let (ab, bc, ca) = (midpoint(a, b), midpoint(b, c), midpoint(c, a));
                [
                    [a, ab, ca, a],
                    [ab, b, bc, ab],
                    [ca, bc, c, ca],
                    [bc, ca, ab, bc],
                ]
            }
        }
    }
}
