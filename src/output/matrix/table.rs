//! A dense matrix as a table.

use super::{Feed, MatrixTable, number};
use crate::matrix::Certificate;
use crate::output::{WriteError, write_atomically};
use std::io::Write;
use std::path::Path;

/// Writes lines of comment (`#`), a header and one line a row: label, area in m² less what is covered, covered area, row sum, error
/// estimate of the row, number of its entries that are less accurate than asked, then F_i1 to F_in.
///
/// # Errors
/// When the file cannot be written, or `feed` fails.
pub fn write_matrix_csv(
    path: &Path,
    table: &MatrixTable<'_>,
    feed: impl Feed,
) -> Result<Certificate, WriteError> {
    write_atomically(path, |out| {
        for line in table.head() {
            writeln!(out, "# {line}")?;
        }
        writeln!(
            out,
            "# columns: label, exposed area (m^2), area that nothing can reach (m^2), sum of the row, estimated error of the row (L2), entries at the limit of refinement, F_i1 ... F_in"
        )?;
        write!(out, "label,area_m2,covered_m2,row_sum,row_error,limited")?;
        for row in table.rows {
            write!(out, ",{}", quoted(&format!("to {}", row.label)))?;
        }
        writeln!(out)?;
        feed(&mut |row| {
            let about = &table.rows[row.index];
            let [area, covered, sum, error] =
                [about.area, about.covered, row.sum, row.error].map(number);
            write!(
                out,
                "{},{area},{covered},{sum},{error},{}",
                quoted(&about.label),
                row.limited.len()
            )?;
            for value in row.values {
                write!(out, ",{}", number(*value))?;
            }
            writeln!(out)
        })
    })
}

/// A field as RFC 4180 has it.
fn quoted(field: &str) -> String {
    if field.contains(['"', ',', '\n', '\r', '#']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
