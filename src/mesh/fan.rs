//! The interpolant: linear on the triangles around the centre of each element.

use super::{Mesh, UNIT};
use crate::radiometry::Spectrum;
use glam::DVec3;

/// A corner of a fan triangle with its barycentric weight.
pub type Weighted = (u32, f32);

impl Mesh {
    /// The triangles of a leaf's fan; see [`Element::fan`](super::Element::fan).
    pub fn fan(&self, leaf: u32) -> impl Iterator<Item = [u32; 3]> + use<> {
        self.element(leaf).fan()
    }

    /// The leaf that covers the point (u, v) of a patch, coordinates clamped to the patch.
    pub fn leaf_at(&self, patch: u32, u: f64, v: f64) -> u32 {
        let of = self.patch(patch);
        let (columns, rows) = of.grid;
        let cell = |x: f64, n: u32| ((x * f64::from(n)).max(0.0) as u32).min(n - 1);
        let mut element = of.roots.start + cell(v, rows) * columns + cell(u, columns);
        while !self.elements.is_leaf(element) {
            element = self.child_at(element, u, v);
        }
        element
    }

    /// The child of a split element that covers the point (u, v).
    pub fn child_at(&self, element: u32, u: f64, v: f64) -> u32 {
        let of = self.element(element);
        let lattice = |vertex: u32| self.lattice_of(vertex);
        let steps = |x: f64| x * f64::from(UNIT);
        let (u, v) = (steps(u), steps(v));
        let quarter = if of.corners().len() == 4 {
            let middle = lattice(of.centre);
            match (u >= f64::from(middle.u), v >= f64::from(middle.v)) {
                (false, false) => 0,
                (true, false) => 1,
                (true, true) => 2,
                (false, true) => 3,
            }
        } else {
            // Barycentric coordinates in the element; sizes are signed in the middle children.
            let (a, b, c) = (
                lattice(of.corners[0]),
                lattice(of.corners[1]),
                lattice(of.corners[2]),
            );
            let difference = |p: u32, q: u32| f64::from(p) - f64::from(q);
            let (bu, bv) = (difference(b.u, a.u), difference(b.v, a.v));
            let (cu, cv) = (difference(c.u, a.u), difference(c.v, a.v));
            let (pu, pv) = (u - f64::from(a.u), v - f64::from(a.v));
            let determinant = bu * cv - bv * cu;
            let beta = (pu * cv - pv * cu) / determinant;
            let gamma = (bu * pv - bv * pu) / determinant;
            match (beta, gamma) {
                (b, _) if b > 0.5 => 1,
                (_, c) if c > 0.5 => 2,
                (b, c) if b + c < 0.5 => 0,
                _ => 3,
            }
        };
        of.children + quarter
    }

    /// Longest extent of an element in (u, v), where the patch is 1.
    pub fn unit_side(&self, element: u32) -> f64 {
        let lattice = |v: u32| self.lattice_of(v);
        let step = |(_, a, b): (usize, u32, u32)| {
            lattice(a)
                .u
                .abs_diff(lattice(b).u)
                .max(lattice(a).v.abs_diff(lattice(b).v))
        };
        f64::from(self.element(element).sides().map(step).max().unwrap_or(0)) / f64::from(UNIT)
    }

    /// The fan triangle of a leaf that covers a point of its plane, with barycentric weights; a point a hair outside
    /// gets the nearest triangle's continuation, clamped to it.
    pub fn interpolate(&self, leaf: u32, point: DVec3) -> [Weighted; 3] {
        let of = self.element(leaf);
        let patch = self.patch(of.patch);
        let normal = patch.normal;
        let position = |vertex: u32| patch.position(self.lattice_of(vertex));
        let centre = position(of.centre);
        let mut next = position(of.corners[0]);
        let mut best = ([(0, 0.0); 3], f64::NEG_INFINITY);
        for triangle in of.fan() {
            let (b, c) = (next, position(triangle[2]));
            next = c;
            let area = (b - centre).cross(c - centre).dot(normal);
            let beta = (point - centre).cross(c - centre).dot(normal) / area;
            let gamma = (b - centre).cross(point - centre).dot(normal) / area;
            let alpha = 1.0 - beta - gamma;
            let inside = alpha.min(beta).min(gamma);
            if inside > best.1 {
                let clamped = [alpha, beta, gamma].map(|w| w.max(0.0));
                let sum: f64 = clamped.iter().sum();
                let weight = |i: usize| (triangle[i], (clamped[i] / sum) as f32);
                best = ([weight(0), weight(1), weight(2)], inside);
            }
            if inside >= 0.0 {
                break;
            }
        }
        best.0
    }

    /// What the interpolant of values at vertices is at a point of a leaf.
    pub fn interpolated(
        &self,
        leaf: u32,
        point: DVec3,
        value: impl Fn(u32) -> Spectrum,
    ) -> Spectrum {
        let weighted = self.interpolate(leaf, point);
        weighted.iter().map(|(v, w)| value(*v) * *w).sum()
    }
}
