//! The radiosity of an enclosure from its matrix: B_i = M_i + ρ_i Σ_j F_ij B_j, solved directly rather than shot by shot.
//!
//! Each row has one radiosity, so the result is that of an enclosure of so many uniform zones. With A_i/ρ_i on both sides the
//! system is symmetric and positive definite: (A_i/ρ_i) B_i - Σ_j A_i F_ij B_j = (A_i/ρ_i) M_i. Rows that reflect nothing are
//! known beforehand.

use super::dense::Matrix;
use super::linear::{Symmetric, conjugate_gradients};
use crate::radiometry::Power;

/// Below this reflectance a row reflects nothing.
const BLACK: f64 = 1e-12;

/// The light of one row, per channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Radiosity B, W/m².
    pub radiosity: Power,
    /// Irradiance H from the other rows, W/m².
    pub irradiance: Power,
    /// Net flux A (B - H) that leaves, W.
    pub net_flux: Power,
}

impl Matrix {
    /// Solves for all rows, with the reflectances and exitances of their surfaces.
    pub fn balance(&self) -> Vec<Balance> {
        let reflectance: Vec<Power> = self.rows.iter().map(|row| row.reflectance).collect();
        let exitance: Vec<Power> = self.rows.iter().map(|row| row.exitance).collect();
        self.balance_of(&reflectance, &exitance)
    }

    /// Solves with given reflectances (0 ≤ ρ < 1) and exitances, one for each row. For heat the exitance is εσT⁴ and the reflectance
    /// 1 - ε.
    ///
    /// # Panics
    /// If there are more rows than values.
    pub fn balance_of(&self, reflectance: &[Power], exitance: &[Power]) -> Vec<Balance> {
        let n = self.len();
        let mut balances = vec![
            Balance {
                radiosity: Power::ZERO,
                irradiance: Power::ZERO,
                net_flux: Power::ZERO
            };
            n
        ];
        for channel in 0..3 {
            let rho: Vec<f64> = reflectance[..n].iter().map(|r| r[channel]).collect();
            let emitted: Vec<f64> = exitance[..n].iter().map(|m| m[channel]).collect();
            let radiosity = self.solve_channel(&rho, &emitted);
            for (i, balance) in balances.iter_mut().enumerate() {
                let irradiance: f64 = self.row(i).iter().zip(&radiosity).map(|(f, b)| f * b).sum();
                balance.radiosity[channel] = radiosity[i];
                balance.irradiance[channel] = irradiance;
                balance.net_flux[channel] = self.rows[i].area * (radiosity[i] - irradiance);
            }
        }
        balances
    }

    fn solve_channel(&self, rho: &[f64], emitted: &[f64]) -> Vec<f64> {
        let n = self.len();
        let area = |i: usize| self.rows[i].area;
        // A row that is covered altogether exchanges nothing.
        let reflects: Vec<bool> = (0..n).map(|i| rho[i] > BLACK && area(i) > 0.0).collect();
        let right: Vec<f64> = (0..n)
            .map(|i| {
                if !reflects[i] {
                    return 0.0;
                }
                let black = self
                    .row(i)
                    .iter()
                    .zip(emitted)
                    .zip(&reflects)
                    .filter(|(_, reflects)| !**reflects);
                let from_black: f64 = black.map(|((f, m), _)| f * m).sum();
                area(i) * (emitted[i] / rho[i] + from_black)
            })
            .collect();
        let mut radiosity = conjugate_gradients(
            &Zones {
                matrix: self,
                rho,
                reflects: &reflects,
            },
            &right,
            1e-12,
        );
        for i in (0..n).filter(|i| !reflects[*i]) {
            radiosity[i] = emitted[i];
        }
        radiosity
    }
}

/// diag(A/ρ) - S over the rows that reflect.
struct Zones<'a> {
    matrix: &'a Matrix,
    rho: &'a [f64],
    reflects: &'a [bool],
}

impl Symmetric for Zones<'_> {
    fn diagonal(&self, i: usize) -> f64 {
        let area = self.matrix.rows[i].area;
        if self.reflects[i] {
            area / self.rho[i] - area * self.matrix.factor(i, i)
        } else {
            1.0
        }
    }

    fn times(&self, i: usize, x: &[f64]) -> f64 {
        if !self.reflects[i] {
            return x[i];
        }
        let seen = self
            .matrix
            .row(i)
            .iter()
            .zip(x)
            .zip(self.reflects)
            .filter(|(_, reflects)| **reflects);
        let received: f64 = seen.map(|((f, x), _)| f * x).sum();
        self.matrix.rows[i].area * (x[i] / self.rho[i] - received)
    }
}
