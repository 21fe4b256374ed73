//! Matrices of form factors: CSV, NumPy's `.npz`, Matrix Market. Each takes the rows as they come and keeps none.

mod mtx;
mod npz;
mod table;

pub use mtx::{Dropped, write_matrix_market};
pub use npz::write_npz;
pub use table::write_matrix_csv;

use crate::matrix::{Certificate, FormFactors, Row};
use std::io;

/// What a file of a matrix says besides the entries.
#[derive(Debug, Clone, Copy)]
pub struct MatrixTable<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// What rows and columns stand for.
    pub rows: &'a [Row],
    /// Lines for the head of the file: how the matrix was made.
    pub notes: &'a [String],
}

/// Takes one row after the other.
pub type Sink<'a> = dyn FnMut(&FormFactors<'_>) -> io::Result<()> + 'a;

impl MatrixTable<'_> {
    /// What the entries are, for the head of text files.
    fn head(&self) -> Vec<String> {
        let quantity = [
            format!("radiosity {}: form factors of {}", env!("CARGO_PKG_VERSION"), self.scene),
            "F_ij, dimensionless: the share of the diffuse flux leaving i (row) that arrives at j (column); A_i F_ij = A_j F_ji".to_owned(),
        ];
        quantity
            .into_iter()
            .chain(self.notes.iter().cloned())
            .map(|line| line.replace(['\n', '\r'], " "))
            .collect()
    }
}

/// Hands all rows to a sink and says what is known about them.
pub trait Feed: FnOnce(&mut Sink<'_>) -> io::Result<Certificate> {}

impl<F: FnOnce(&mut Sink<'_>) -> io::Result<Certificate>> Feed for F {}

/// Nine significant digits; 0 as it is, since most entries of many matrices are.
fn number(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.8e}")
    }
}
