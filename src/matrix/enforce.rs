//! Row sums of exactly 1 by the least change: for closed enclosures whose balance must close.
//!
//! With S_ij = A_i F_ij, the symmetric S' is sought that minimises ½ Σ_ij (S'_ij - S_ij)² / S_ij under Σ_j S'_ij = A_i. Lagrange's
//! multipliers give S'_ij = S_ij (1 + λ_i + λ_j), where (diag(Σ_j S_ij) + S) λ = A - Σ_j S_ij. The method is Larsen & Howell's
//! (*Least-squares smoothing of direct-exchange areas in zonal analysis*, J. Heat Transfer 108, 1986), with weights 1/S_ij: what
//! is 0 stays 0, the relative change is the same for large and small entries, and reciprocity holds before and after.

use super::dense::Matrix;
use super::linear::{Symmetric, conjugate_gradients};
use serde::Serialize;

/// What was changed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Correction {
    /// Largest |F' - F|.
    pub largest: f64,
    /// Root of the mean of the squares of F' - F over all entries.
    pub rms: f64,
    /// Largest |Σ_j F_ij - 1| that is left.
    pub residual: f64,
}

/// Why nothing was changed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EnforceError {
    /// Light escapes, so row sums are less than 1 with reason.
    #[error(
        "the scene is open: the row sum of `{label}` is {sum:.6}; closure can be enforced in a closed scene only"
    )]
    Open {
        /// The row that is farthest from 1.
        label: String,
        /// Its sum.
        sum: f64,
    },
}

/// Row sums farther from 1 than this are no rounding: the scene is open.
const CLOSED: f64 = 0.02;

impl Matrix {
    /// Makes all row sums 1 and keeps reciprocity, by the least-squares correction that the source of this module states.
    ///
    /// # Errors
    /// When a row sum is farther from 1 than 0.02: the scene is open.
    pub fn enforce_closure(&mut self) -> Result<Correction, EnforceError> {
        let n = self.len();
        let sums: Vec<f64> = (0..n).map(|i| self.row(i).iter().sum()).collect();
        // Rows without exposed area have no balance.
        let is_exposed = |i: &usize| self.rows[*i].area > 0.0;
        let off = |i: &usize| (sums[*i] - 1.0).abs();
        if let Some(worst) = (0..n)
            .filter(is_exposed)
            .max_by(|a, b| off(a).total_cmp(&off(b)))
            && off(&worst) > CLOSED
        {
            return Err(EnforceError::Open {
                label: self.rows[worst].label.clone(),
                sum: sums[worst],
            });
        }
        let areas: Vec<f64> = self.rows.iter().map(|row| row.area).collect();
        let missing: Vec<f64> = (0..n).map(|i| areas[i] * (1.0 - sums[i])).collect();
        let exchange = Exchanges {
            matrix: self,
            areas: &areas,
            diagonal: sums.iter().zip(&areas).map(|(s, a)| s * a).collect(),
        };
        let multipliers = conjugate_gradients(&exchange, &missing, 1e-14);

        let (mut largest, mut squares): (f64, f64) = (0.0, 0.0);
        let mut residual: f64 = 0.0;
        for i in 0..n {
            let row = &mut self.values[i * n..(i + 1) * n];
            for (j, value) in row.iter_mut().enumerate() {
                let change = *value * (multipliers[i] + multipliers[j]);
                *value += change;
                largest = largest.max(change.abs());
                squares += change * change;
            }
            if areas[i] > 0.0 {
                residual = residual.max((row.iter().sum::<f64>() - 1.0).abs());
            }
        }
        Ok(Correction {
            largest,
            rms: (squares / (n * n) as f64).sqrt(),
            residual,
        })
    }

    /// Makes A_i F_ij = A_j F_ji by taking the mean of both, which is the least change of the exchanges. Here each pair is worked out as
    /// one number for both directions, so nothing but rounding changes.
    pub fn enforce_reciprocity(&mut self) -> Correction {
        let n = self.len();
        let (mut largest, mut squares): (f64, f64) = (0.0, 0.0);
        for i in 0..n {
            for j in i + 1..n {
                let (area_i, area_j) = (self.rows[i].area, self.rows[j].area);
                let mean =
                    0.5 * (area_i * self.values[i * n + j] + area_j * self.values[j * n + i]);
                for (at, area) in [(i * n + j, area_i), (j * n + i, area_j)] {
                    let value = if area > 0.0 { mean / area } else { 0.0 };
                    let change = (value - self.values[at]).abs();
                    self.values[at] = value;
                    largest = largest.max(change);
                    squares += change * change;
                }
            }
        }
        let sum = |i: usize| self.row(i).iter().sum::<f64>();
        let exposed = (0..n).filter(|i| self.rows[*i].area > 0.0);
        let residual = exposed.map(|i| (sum(i) - 1.0).abs()).fold(0.0, f64::max);
        Correction {
            largest,
            rms: (squares / ((n * n) as f64).max(1.0)).sqrt(),
            residual,
        }
    }
}

/// diag(Σ_j S_ij) + S.
struct Exchanges<'a> {
    matrix: &'a Matrix,
    areas: &'a [f64],
    diagonal: Vec<f64>,
}

impl Symmetric for Exchanges<'_> {
    fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i] + self.areas[i] * self.matrix.factor(i, i)
    }

    fn times(&self, i: usize, x: &[f64]) -> f64 {
        let off: f64 = self.matrix.row(i).iter().zip(x).map(|(f, x)| f * x).sum();
        self.diagonal[i] * x[i] + self.areas[i] * off
    }
}
