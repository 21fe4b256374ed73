//! A sparse matrix in Matrix Market's coordinate format.

use super::{Feed, MatrixTable, number};
use crate::matrix::Certificate;
use crate::output::{WriteError, write_atomically};
use serde::Serialize;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

/// What a cut-off left out.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Dropped {
    /// Entries below this were left out, besides those that are 0.
    pub cut_off: f64,
    /// How many other than 0.
    pub entries: u64,
    /// Their share of the flux that arrives anywhere: Σ A_i F_ij left out over Σ A_i F_ij.
    pub share: f64,
}

/// Width of a number in the head, which is written before the numbers are known and again in the same place.
const WIDTH: usize = 20;

/// Writes the entries that are not 0 and not below `cut_off`, numbered from 1, row by row; labels and areas as comments.
///
/// # Errors
/// When the file cannot be written, or `feed` fails.
pub fn write_matrix_market(
    path: &Path,
    table: &MatrixTable<'_>,
    cut_off: f64,
    feed: impl Feed,
) -> Result<(Certificate, Dropped), WriteError> {
    write_atomically(path, |out| {
        writeln!(out, "%%MatrixMarket matrix coordinate real general")?;
        for line in table.head() {
            writeln!(out, "% {line}")?;
        }
        writeln!(
            out,
            "% number, exposed area (m^2) and label of the rows and columns:"
        )?;
        for (place, row) in (1..).zip(table.rows) {
            let label = row.label.replace(['\n', '\r'], " ");
            writeln!(out, "% {place} {} {label}", number(row.area))?;
        }
        let counts_at = out.stream_position()?;
        write_counts(out, table.rows.len(), 0, &Dropped::default())?;
        let mut kept = 0u64;
        let mut dropped = Dropped {
            cut_off,
            ..Dropped::default()
        };
        let mut whole = 0.0;
        let certificate = feed(&mut |row| {
            let area = table.rows[row.index].area;
            for (column, value) in (1..).zip(row.values) {
                whole += area * value;
                if *value == 0.0 {
                    continue;
                }
                if *value < cut_off {
                    dropped.entries += 1;
                    dropped.share += area * value;
                } else {
                    kept += 1;
                    writeln!(out, "{} {column} {}", row.index + 1, number(*value))?;
                }
            }
            Ok(())
        })?;
        if whole > 0.0 {
            dropped.share /= whole;
        }
        out.seek(SeekFrom::Start(counts_at))?;
        write_counts(out, table.rows.len(), kept, &dropped)?;
        out.seek(SeekFrom::End(0))?;
        Ok((certificate, dropped))
    })
}

/// As long whatever the numbers are.
fn write_counts(
    out: &mut impl Write,
    rows: usize,
    kept: u64,
    dropped: &Dropped,
) -> std::io::Result<()> {
    writeln!(
        out,
        "% entries below {:WIDTH$.3e} left out: {:WIDTH$}, which carry {:WIDTH$.9e} of the flux that arrives",
        dropped.cut_off, dropped.entries, dropped.share
    )?;
    writeln!(out, "{rows:WIDTH$} {rows:WIDTH$} {kept:WIDTH$}")
}
