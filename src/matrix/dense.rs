//! A whole matrix in memory.

use super::certificate::Certificate;
use super::enclosure::{Enclosure, FormFactors};
use super::rows::Row;
use std::convert::Infallible;

/// All form factors of an enclosure: 8 n² bytes.
#[derive(Debug, Clone)]
pub struct Matrix {
    /// What rows and columns stand for.
    pub rows: Vec<Row>,
    /// Row sums, errors and limits of the matrix as computed, before any was enforced.
    pub certificate: Certificate,
    /// F_ij, row by row.
    pub(super) values: Vec<f64>,
}

impl Enclosure {
    /// The whole matrix.
    pub fn matrix(&self) -> Matrix {
        let count = self.rows().len();
        let mut values = Vec::with_capacity(count * count);
        let collected = self.each_row(|row: &FormFactors<'_>| {
            values.extend_from_slice(row.values);
            Ok::<(), Infallible>(())
        });
        let certificate = collected.unwrap_or_else(|never| match never {});
        Matrix {
            rows: self.rows().to_vec(),
            certificate,
            values,
        }
    }
}

impl Matrix {
    /// Number of rows, and of columns.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// F_ij for all j.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, i: usize) -> &[f64] {
        let n = self.len();
        &self.values[i * n..(i + 1) * n]
    }

    /// F_ij.
    ///
    /// # Panics
    /// If there is no such row or column.
    pub fn factor(&self, i: usize, j: usize) -> f64 {
        self.row(i)[j]
    }

    /// Number of the row with a label.
    pub fn index(&self, label: &str) -> Option<usize> {
        self.rows.iter().position(|row| row.label == label)
    }

    /// Hands the rows on as [`Enclosure::each_row`] does, with the errors of the certificate.
    ///
    /// # Errors
    /// The first error of the sink.
    pub fn each_row<E>(
        &self,
        mut sink: impl FnMut(&FormFactors<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut limited = self.certificate.limited.as_slice();
        for index in 0..self.len() {
            let (here, rest) =
                limited.split_at(limited.partition_point(|[row, _]| *row as usize == index));
            limited = rest;
            let columns: Vec<u32> = here.iter().map(|[_, column]| *column).collect();
            let values = self.row(index);
            let (sum, error) = (values.iter().sum(), self.certificate.row_errors[index]);
            sink(&FormFactors {
                index,
                values,
                sum,
                error,
                limited: &columns,
            })?;
        }
        Ok(())
    }
}
