//! Rows whose sums tell that an entry is off by more than was asked for and estimated are worked out once more, with care.
//!
//! No row sums up to more than 1. Nor does one to less in a closed scene; whether a scene is closed, the other rows tell.

use super::certificate::{CLOSED, exceeds};
use super::enclosure::Enclosure;
use super::work::Work;

/// So many rows, and one of so many, are worked out again at most, those that are off most: where more are off, it is not by accident,
/// and the time is bounded.
const MOST_ROWS: usize = 8;
const ONE_OF: usize = 64;

/// Sum of a row less 1, and the estimate of the row's error.
#[derive(Debug, Clone, Copy)]
struct Off {
    by: f64,
    error: f64,
}

impl Enclosure {
    /// Replaces what is off in `works`, which begin on the diagonal.
    pub(super) fn work_again(&self, works: &mut [Work]) {
        let rows = suspects(&self.off(works), self.tolerance);
        for (row, work) in rows.iter().zip(self.work_with_care(&rows)) {
            replace(works, *row, &work);
        }
    }

    /// By how much the sums are off; rows without area by nothing.
    fn off(&self, works: &[Work]) -> Vec<Off> {
        let count = works.len();
        let (mut sums, mut entries, mut squares) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        for (row, work) in works.iter().enumerate() {
            for (column, amount) in (row..).zip(&work.amounts) {
                for it in both(row, column) {
                    sums[it] += amount;
                    entries[it] += amount * amount;
                }
            }
            for (column, error) in &work.errors {
                for it in both(row, *column as usize) {
                    squares[it] += error * error;
                }
            }
        }
        let off = |row: usize| {
            let area = self.rows.areas[row];
            if area <= 0.0 {
                return Off {
                    by: 0.0,
                    error: 0.0,
                };
            }
            let square = squares[row] + entries[row] * self.accuracy(row).powi(2);
            Off {
                by: sums[row] / area - 1.0,
                error: square.sqrt() / area,
            }
        };
        (0..count).map(off).collect()
    }
}

/// The row of an entry, and the column if that is another.
fn both(row: usize, column: usize) -> impl Iterator<Item = usize> {
    std::iter::once(row).chain((column != row).then_some(column))
}

/// Rows that sum up to too much, and to too little if no row says that the scene is open; in order.
fn suspects(off: &[Off], tolerance: f64) -> Vec<usize> {
    let is_open = |it: &Off| exceeds(-it.by - CLOSED, it.error, 0.0);
    let is_open = off.iter().any(is_open);
    let is_suspect = |it: &Off| {
        let by = if is_open { it.by } else { it.by.abs() };
        exceeds(by, it.error, tolerance)
    };
    let mut rows: Vec<usize> = (0..off.len())
        .filter(|row| is_suspect(&off[*row]))
        .collect();
    let size = |row: &usize| off[*row].by.abs() / off[*row].error;
    rows.sort_by(|a, b| size(b).total_cmp(&size(a)));
    rows.truncate(MOST_ROWS + off.len() / ONE_OF);
    rows.sort_unstable();
    rows
}

/// Puts a whole row in the place of what `works` hold of it.
fn replace(works: &mut [Work], row: usize, whole: &Work) {
    for (column, amount) in whole.amounts.iter().enumerate() {
        let (first, second) = (row.min(column), row.max(column));
        works[first].amounts[second - first] = *amount;
    }
    let is_kept = |of: usize, column: u32| of != row && column as usize != row;
    for (of, work) in works[..=row].iter_mut().enumerate() {
        work.errors.retain(|(column, _)| is_kept(of, *column));
        work.limited.retain(|column| is_kept(of, *column));
    }
    let place = |column: u32| match (column as usize) < row {
        true => (column as usize, row as u32),
        false => (row, column),
    };
    for (column, error) in &whole.errors {
        let (first, second) = place(*column);
        works[first].errors.push((second, *error));
    }
    for column in &whole.limited {
        let (first, second) = place(*column);
        works[first].limited.push(second);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::certificate::Tally;

    fn off(list: &[f64]) -> Vec<Off> {
        let of = |by: &f64| Off {
            by: *by,
            error: 1e-5,
        };
        list.iter().map(of).collect()
    }

    #[test]
    fn too_much_is_suspicious_always_and_too_little_where_nothing_is_open() {
        assert_eq!(suspects(&off(&[0.0, 2e-3, -2e-5, -5e-4]), 1e-4), [1, 3]);
        assert_eq!(suspects(&off(&[-0.3, 2e-3, -2e-5, -5e-4]), 1e-4), [1]);
        assert_eq!(suspects(&off(&[-0.3, 1e-5, 0.0]), 1e-4), [0; 0]);
        assert_eq!(suspects(&off(&[9e-5, -9e-5]), 1e-4), [0; 0], "as asked");
    }

    #[test]
    fn a_few_rows_are_worked_out_again_at_most_and_the_worst() {
        let mut list = vec![1e-3; 100];
        list[70] = 2e-3;
        let rows = suspects(&off(&list), 1e-4);
        assert_eq!(rows.len(), 9);
        assert!(rows.contains(&70));
    }

    #[test]
    fn a_row_takes_its_place_on_both_sides_of_the_diagonal() {
        let work = |first: usize, amounts: &[f64], errors: &[(u32, f64)], limited: &[u32]| Work {
            first,
            amounts: amounts.to_vec(),
            errors: errors.to_vec(),
            limited: limited.to_vec(),
            tally: Tally::default(),
        };
        let mut works = [
            work(0, &[0.0, 1.0, 2.0], &[(1, 0.1), (2, 0.2)], &[1]),
            work(1, &[3.0, 4.0], &[(2, 0.3)], &[]),
            work(2, &[5.0], &[], &[]),
        ];
        let whole = work(0, &[6.0, 7.0, 8.0], &[(0, 0.4), (2, 0.5)], &[2]);
        replace(&mut works, 1, &whole);
        assert_eq!(works[0].amounts, [0.0, 6.0, 2.0]);
        assert_eq!(works[1].amounts, [7.0, 8.0]);
        assert_eq!(works[0].errors, [(2, 0.2), (1, 0.4)]);
        assert_eq!(works[1].errors, [(2, 0.5)]);
        assert!(works[0].limited.is_empty());
        assert_eq!(works[1].limited, [2]);
    }
}
