//! The error of each element: how much of what the audit found goes with the element's residual, and how much with its light.
//!
//! The residual of an element, the light at its centre less the mean of its corners, is a multiple of the error of linear
//! interpolation there, whatever test or limit ended its refinement. Source sampling, the five-times rule and light that is
//! unshot err in proportion to the light. The squares of both, with one factor each, add up to the square of the error; the
//! factors are fitted to the points of the audit.

use super::light::Light;
use crate::mesh::Mesh;
use crate::radiometry::Power;
use serde::{Deserialize, Serialize};

/// What makes an error: squared, the sum of the squares of these parts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorModel {
    /// Part of the residual of the element.
    pub of_residual: f64,
    /// Part of the irradiance of the element.
    pub of_irradiance: f64,
}

/// The squares, mean of the channels, that belong to a leaf: of its residual, and of its irradiance.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Squares {
    residual: f64,
    irradiance: f64,
}

impl Squares {
    pub(super) fn of(mesh: &Mesh, light: &Light, leaf: u32) -> Self {
        let element = mesh.element(leaf);
        let at = |v: u32| light.irradiance[v as usize].as_dvec3();
        let corners = element.corners();
        let mean = corners.iter().map(|v| at(*v)).sum::<Power>() / corners.len() as f64;
        let centre = at(element.centre);
        Self {
            residual: (centre - mean).length_squared() / 3.0,
            irradiance: (centre + mean).length_squared() / 12.0,
        }
    }

    /// How large the residual is for the light; 0 without light.
    fn unevenness(&self) -> f64 {
        if self.irradiance > 0.0 {
            self.residual / self.irradiance
        } else {
            0.0
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            residual: self.residual + other.residual,
            irradiance: self.irradiance + other.irradiance,
        }
    }
}

impl ErrorModel {
    /// The model under which two halves of the points, those with the small and those with the large residuals for their light,
    /// have the mean square errors that were found; `found` holds the square of each point's error with its leaf's squares.
    pub(super) fn fit(mut found: Vec<(f64, Squares)>) -> Self {
        found.sort_by(|(_, a), (_, b)| a.unevenness().total_cmp(&b.unevenness()));
        let sum = |half: &[(f64, Squares)]| {
            half.iter()
                .fold((0.0, Squares::default()), |(error, squares), (e, s)| {
                    (error + e, squares.plus(*s))
                })
        };
        let (low, high) = found.split_at(found.len() / 2);
        let ((e, low), (f, high)) = (sum(low), sum(high));
        let determinant = low.residual * high.irradiance - high.residual * low.irradiance;
        let part = |numerator: f64, denominator: f64| {
            let square = numerator / denominator;
            if square.is_finite() {
                square.max(0.0).sqrt()
            } else {
                0.0
            }
        };
        let both = Self {
            of_residual: part(e * high.irradiance - f * low.irradiance, determinant),
            of_irradiance: part(f * low.residual - e * high.residual, determinant),
        };
        let all = low.plus(high);
        if both.of_residual == 0.0 {
            let of_irradiance = part(e + f, all.irradiance);
            return Self {
                of_irradiance,
                ..both
            };
        }
        if both.of_irradiance == 0.0 {
            let of_residual = part(e + f, all.residual);
            return Self {
                of_residual,
                ..both
            };
        }
        both
    }

    /// The estimated RMS error of the irradiance on a leaf of the mesh, in W/m², channels pooled.
    pub fn at(&self, mesh: &Mesh, light: &Light, leaf: u32) -> f64 {
        let Squares {
            residual,
            irradiance,
        } = Squares::of(mesh, light, leaf);
        (self.of_residual.powi(2) * residual + self.of_irradiance.powi(2) * irradiance).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_that_made_the_errors_are_found() {
        let made = |of_residual: f64, of_irradiance: f64| {
            let points = (1..100).map(|i| {
                let squares = Squares {
                    residual: 1e-4 * f64::from(i * i % 97),
                    irradiance: f64::from(1 + i % 7),
                };
                let square = of_residual.powi(2) * squares.residual
                    + of_irradiance.powi(2) * squares.irradiance;
                (square, squares)
            });
            ErrorModel::fit(points.collect())
        };
        for (residual, irradiance) in [(0.3, 0.002), (0.0, 0.01), (0.5, 0.0)] {
            let model = made(residual, irradiance);
            assert!((model.of_residual - residual).abs() < 1e-6, "{model:?}");
            assert!((model.of_irradiance - irradiance).abs() < 1e-6, "{model:?}");
        }
    }
}
