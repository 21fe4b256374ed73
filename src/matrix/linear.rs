//! Symmetric positive definite systems by conjugate gradients, preconditioned with the diagonal.

use rayon::prelude::*;

/// A symmetric, positive (semi)definite matrix, row by row.
pub(super) trait Symmetric: Sync {
    fn diagonal(&self, i: usize) -> f64;

    /// Row i times x.
    fn times(&self, i: usize, x: &[f64]) -> f64;
}

/// Solves `matrix` · x = `right` until the residual has fallen to `tolerance` of the right side.
pub(super) fn conjugate_gradients(
    matrix: &impl Symmetric,
    right: &[f64],
    tolerance: f64,
) -> Vec<f64> {
    let n = right.len();
    let precondition = |r: &[f64]| -> Vec<f64> {
        (0..n)
            .map(|i| r[i] / matrix.diagonal(i).max(f64::MIN_POSITIVE))
            .collect()
    };
    let mut x = vec![0.0; n];
    let mut residual = right.to_vec();
    let mut z = precondition(&residual);
    let mut direction = z.clone();
    let mut product = dot(&residual, &z);
    let goal = tolerance * tolerance * product;
    // In exact arithmetic n steps are enough; rounding may ask for some more.
    for _ in 0..2 * n + 10 {
        if product <= goal || product == 0.0 {
            break;
        }
        let image: Vec<f64> = (0..n)
            .into_par_iter()
            .map(|i| matrix.times(i, &direction))
            .collect();
        let step = product / dot(&direction, &image);
        if !step.is_finite() {
            break;
        }
        for i in 0..n {
            x[i] += step * direction[i];
            residual[i] -= step * image[i];
        }
        z = precondition(&residual);
        let next = dot(&residual, &z);
        let share = next / product;
        for i in 0..n {
            direction[i] = z[i] + share * direction[i];
        }
        product = next;
    }
    x
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
