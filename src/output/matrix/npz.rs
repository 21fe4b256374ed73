//! Arrays for NumPy: an uncompressed zip of `.npy` files.

use super::{Feed, MatrixTable};
use crate::matrix::Certificate;
use crate::output::{WriteError, write_atomically};
use std::borrow::Cow;
use std::io::{self, Seek, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Writes the arrays `F` (n x n, float64, F[i, j] from i to j), `area` and `covered` (m²), `label`, `back`, `row_sum`, `row_error` (n each) and `limited`
/// (pairs of row and column, from 0). `numpy.load` reads them. In labels with more than 1024 characters `…` stands for what is in the middle.
///
/// # Errors
/// When the file cannot be written, or `feed` fails.
pub fn write_npz(
    path: &Path,
    table: &MatrixTable<'_>,
    feed: impl Feed,
) -> Result<Certificate, WriteError> {
    write_atomically(path, |out| {
        let mut zip = ZipWriter::new(out);
        let filled = fill(&mut zip, table, feed);
        if filled.is_err() {
            // Dropped, it would try to finish the archive, and complain that it cannot.
            std::mem::forget(zip);
        } else {
            zip.finish().map_err(io::Error::other)?;
        }
        filled
    })
}

fn fill<W: Write + Seek>(
    zip: &mut ZipWriter<W>,
    table: &MatrixTable<'_>,
    feed: impl Feed,
) -> io::Result<Certificate> {
    let n = table.rows.len();
    begin(zip, "F", "<f8", &[n, n])?;
    let known = feed(&mut |row| floats(zip, row.values))?;
    let areas: Vec<f64> = table.rows.iter().map(|row| row.area).collect();
    let covered: Vec<f64> = table.rows.iter().map(|row| row.covered).collect();
    for (name, values) in [
        ("area", &areas),
        ("covered", &covered),
        ("row_sum", &known.row_sums),
        ("row_error", &known.row_errors),
    ] {
        begin(zip, name, "<f8", &[n])?;
        floats(zip, values)?;
    }
    begin(zip, "back", "|b1", &[n])?;
    let backs: Vec<u8> = table.rows.iter().map(|row| u8::from(row.back)).collect();
    zip.write_all(&backs)?;
    labels(zip, table)?;
    begin(zip, "limited", "<u4", &[known.limited.len(), 2])?;
    for number in known.limited.as_flattened() {
        zip.write_all(&number.to_le_bytes())?;
    }
    Ok(known)
}

/// Opens the file of an array and writes its head: format 1.0, padded so that the data begin at a multiple of 64.
fn begin<W: Write + Seek>(
    zip: &mut ZipWriter<W>,
    name: &str,
    kind: &str,
    shape: &[usize],
) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .large_file(true);
    zip.start_file(format!("{name}.npy"), options)
        .map_err(io::Error::other)?;
    let shape: String = shape.iter().map(|size| format!("{size}, ")).collect();
    let mut head = format!(
        "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}",
        shape.trim_end()
    );
    let before = b"\x93NUMPY\x01\x00".len() + 2;
    let padding = 63 - (before + head.len()) % 64;
    head.extend(std::iter::repeat_n(' ', padding));
    head.push('\n');
    zip.write_all(b"\x93NUMPY\x01\x00")?;
    zip.write_all(&(head.len() as u16).to_le_bytes())?;
    zip.write_all(head.as_bytes())
}

fn floats(out: &mut impl Write, values: &[f64]) -> io::Result<()> {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    out.write_all(&bytes)
}

/// The most characters of a label: NumPy keeps as many for each as the longest has.
const LONGEST: usize = 1024;

/// What is kept of the end of a longer one: the number of a part, which tells it from others, stands there.
const END: usize = 64;

/// NumPy's fixed-width text: four bytes a character.
fn labels<W: Write + Seek>(zip: &mut ZipWriter<W>, table: &MatrixTable<'_>) -> io::Result<()> {
    let labels = || table.rows.iter().map(|row| shortened(&row.label));
    let width = labels().map(|label| label.chars().count()).max();
    let width = width.unwrap_or(0).max(1);
    begin(zip, "label", &format!("<U{width}"), &[table.rows.len()])?;
    for label in labels() {
        let codes = label.chars().map(u32::from).chain(std::iter::repeat(0));
        for code in codes.take(width) {
            zip.write_all(&code.to_le_bytes())?;
        }
    }
    Ok(())
}

/// A label with at most [`LONGEST`] characters.
fn shortened(label: &str) -> Cow<'_, str> {
    let count = label.chars().count();
    if count <= LONGEST {
        return label.into();
    }
    let beginning = label.chars().take(LONGEST - END - 1);
    let end = label.chars().skip(count - END);
    beginning.chain(['…']).chain(end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_cut_in_the_middle_if_it_is_very_long() {
        let long = format!("{}/17", "é".repeat(LONGEST - 3));
        assert_eq!(shortened(&long), long);
        let longer = format!("{}/17", "é".repeat(200_000));
        let cut = shortened(&longer);
        assert_eq!(cut.chars().count(), LONGEST);
        assert!(cut.starts_with("éé") && cut.contains("é…é") && cut.ends_with("é/17"));
    }
}
