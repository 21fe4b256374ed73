//! One radiating side of a surface, or of a piece of it.

use super::grid::Grid;
use super::lattice::{Lattice, UNIT};
use crate::radiometry::Spectrum;
use glam::DVec3;
use std::ops::Range;

/// See [`Patch::side_key`].
pub type SideKey = [[u64; 3]; 2];

/// A planar convex polygon that shoots, and carries elements that receive.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Index into `Scene::surfaces`; the first of several that are meshed as one.
    pub surface: u32,
    /// The input polygon it lies on: that of `surface`.
    pub polygon: u32,
    /// Corners in the frame, counter-clockwise seen from the radiating side; a triangle repeats its first.
    pub(super) corners: [DVec3; 4],
    pub(super) corner_count: u8,
    /// Which of its sides are sides of the input polygon, rather than cuts through it.
    pub outline: [bool; 4],
    /// Whether it is the back of its surface.
    pub back: bool,
    /// Unit normal of the radiating side.
    pub normal: DVec3,
    /// Area in frame units squared.
    pub area: f64,
    /// Reflectance ρ.
    pub reflectance: Spectrum,
    /// Exitance M, W/m².
    pub exitance: Spectrum,
    /// Elements of the coarsest grid.
    pub roots: Range<u32>,
    /// Columns and rows of the coarsest grid; (1, 1) for a triangle.
    pub grid: (u32, u32),
    /// The first vertex of that, which others follow.
    pub(super) first_vertex: u32,
}

impl Patch {
    #[inline(always)]
    pub(super) fn new(surface: u32, polygon: u32, corners: &[DVec3], back: bool) -> Self {
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let d = *corners.get(3).unwrap_or(&a);
        // No loop: who asks for neither normal nor area does not pay for them.
        let vector_area = ((b - a).cross(c - a) + (c - a).cross(d - a)) * 0.5;
        let area = vector_area.length();
        Self {
            surface,
            polygon,
            corners: [a, b, c, d],
            corner_count: corners.len() as u8,
            outline: [true; 4],
            back,
            normal: vector_area / area,
            area,
            reflectance: Spectrum::ZERO,
            exitance: Spectrum::ZERO,
            roots: 0..0,
            grid: (1, 1),
            first_vertex: 0,
        }
    }

    /// Its three or four corners.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..usize::from(self.corner_count)]
    }

    /// A side by the bits of its ends in order, the same from every patch that has it; and whether the second corner is its first end.
    pub fn side_key(&self, side: usize) -> (SideKey, bool) {
        let corners = self.corners();
        // No zero but the positive one: both are the same place.
        let bits = |corner: DVec3| (corner + 0.0).to_array().map(f64::to_bits);
        let [a, b] = [side, (side + 1) % corners.len()].map(|i| bits(corners[i]));
        let turned = a > b;
        (if turned { [b, a] } else { [a, b] }, turned)
    }

    /// The vertices of its coarsest grid.
    pub fn first_vertices(&self) -> Range<u32> {
        let grid = Grid {
            is_triangle: self.is_triangle(),
            columns: self.grid.0,
            rows: self.grid.1,
        };
        self.first_vertex..self.first_vertex + grid.vertices()
    }

    /// Whether it has three corners.
    pub fn is_triangle(&self) -> bool {
        self.corner_count == 3
    }

    /// Position of a lattice point, in the frame.
    pub fn position(&self, lattice: Lattice) -> DVec3 {
        let (u, v) = lattice.unit();
        self.position_at(u, v)
    }

    /// Position of the point with coordinates (u, v) in [0, 1]; see [`Lattice`].
    pub fn position_at(&self, u: f64, v: f64) -> DVec3 {
        let [a, b, c, d] = self.corners;
        if self.is_triangle() {
            a * (1.0 - u - v) + b * u + c * v
        } else {
            (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v
        }
    }

    /// The coordinates (u, v) of a point of the plane; outside [0, 1] if it lies beside the patch.
    pub fn coordinates(&self, point: DVec3) -> (f64, f64) {
        let [a, b, c, d] = self.corners;
        if self.is_triangle() {
            let twice = self.normal * (1.0 / (2.0 * self.area));
            let v = (b - a).cross(point - a).dot(twice);
            let u = (point - a).cross(c - a).dot(twice);
            return (u, v);
        }
        // Newton on the bilinear map; exact after one step for parallelograms.
        let (mut u, mut v) = (0.5, 0.5);
        for _ in 0..20 {
            let residual = point - self.position_at(u, v);
            let along_u = (b - a) * (1.0 - v) + (c - d) * v;
            let along_v = (d - a) * (1.0 - u) + (c - b) * u;
            let jacobian = along_u.cross(along_v).dot(self.normal);
            if jacobian.abs() < 1e-300 {
                break;
            }
            let du = residual.cross(along_v).dot(self.normal) / jacobian;
            let dv = along_u.cross(residual).dot(self.normal) / jacobian;
            (u, v) = (u + du, v + dv);
            if du.abs() + dv.abs() < 1e-14 {
                break;
            }
        }
        (u, v)
    }

    /// Whether a lattice point lies on the border.
    pub fn on_border(&self, lattice: Lattice) -> bool {
        let Lattice { u, v } = lattice;
        if self.is_triangle() {
            u == 0 || v == 0 || u + v == UNIT
        } else {
            u == 0 || v == 0 || u == UNIT || v == UNIT
        }
    }

    /// The side of the patch on which two lattice points lie, if they lie on one.
    pub fn common_side(&self, a: Lattice, b: Lattice) -> Option<usize> {
        let low = |x: [u32; 2]| x == [0, 0];
        let high = |x: [u32; 2]| x == [UNIT, UNIT];
        let (u, v, sum) = ([a.u, b.u], [a.v, b.v], [a.u + a.v, b.u + b.v]);
        if low(v) {
            Some(0)
        } else if self.is_triangle() {
            if high(sum) {
                Some(1)
            } else {
                low(u).then_some(2)
            }
        } else if high(u) {
            Some(1)
        } else if high(v) {
            Some(2)
        } else {
            low(u).then_some(3)
        }
    }
}
