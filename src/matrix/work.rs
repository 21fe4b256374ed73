//! What rows exchange with all others, facet by facet, in parallel.

use super::certificate::Tally;
use super::enclosure::Enclosure;
use super::pair::{Exchange, Kind, Worker};
use super::space::Space;
use rayon::prelude::*;
use std::ops::Range;

/// Whether a pair is worked out with the first of its rows only, or with both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pairs {
    Once,
    Twice,
}

/// What has been worked out of a row.
pub(super) struct Work {
    /// The first column.
    pub first: usize,
    /// A_i F_ij from there on, in frame units squared.
    pub amounts: Vec<f64>,
    /// Errors of those that were partly hidden, by column.
    pub errors: Vec<(u32, f64)>,
    pub limited: Vec<u32>,
    pub tally: Tally,
}

impl Enclosure {
    /// Works rows out in parallel.
    pub(super) fn work(&self, rows: Range<usize>, pairs: Pairs) -> Vec<Work> {
        let start = || Worker::new(&self.space);
        self.pool.install(|| {
            rows.into_par_iter()
                // Rows are worth a millisecond and more, the first far more than the last.
                .with_max_len(1)
                .map_init(start, |worker, row| self.work_row(worker, row, pairs))
                .collect()
        })
    }

    /// Works a few rows out with care, whole.
    pub(super) fn work_with_care(&self, rows: &[usize]) -> Vec<Work> {
        let start = || Worker::new(&self.space).with_care();
        let work = |worker: &mut Worker<'_>, row: &usize| self.work_row(worker, *row, Pairs::Twice);
        self.pool.install(|| {
            let rows = rows.par_iter().with_max_len(1);
            rows.map_init(start, work).collect()
        })
    }

    fn work_row(&self, worker: &mut Worker<'_>, row: usize, pairs: Pairs) -> Work {
        let count = self.rows.list.len();
        let once = pairs == Pairs::Once;
        let first = if once { row } else { 0 };
        let mut work = Work {
            first,
            amounts: vec![0.0; count - first],
            errors: Vec::new(),
            limited: Vec::new(),
            tally: Tally::default(),
        };
        for i in self.rows.of_row[row].clone() {
            let from = if once { i + 1 } else { 0 };
            let Space {
                facets,
                tree,
                occluders,
                ..
            } = &self.space;
            tree.each_partner(&facets[i as usize], occluders, from, &mut |j, near| {
                let column = self.row_of(j);
                let within = column == row;
                // A pair within the row has one error, which counts for both of its directions: it is met from its first facet only.
                if j == i || (within && j < i) {
                    return;
                }
                let rays_before = worker.rays;
                let exchange = worker.exchange(i, j, near);
                if i < j {
                    work.tally.count(exchange.kind);
                    work.tally.rays += worker.rays - rays_before;
                }
                work.add(column, exchange, within);
            });
        }
        work.limited.sort_unstable();
        work.limited.dedup();
        work
    }

    /// The row that a facet belongs to.
    fn row_of(&self, facet: u32) -> usize {
        self.rows.of_row.partition_point(|range| range.end <= facet)
    }
}

impl Work {
    fn add(&mut self, column: usize, exchange: Exchange, twice: bool) {
        let times = if twice { 2.0 } else { 1.0 };
        self.amounts[column - self.first] += times * exchange.amount;
        if !matches!(exchange.kind, Kind::Nothing | Kind::Unhindered) {
            self.errors.push((column as u32, times * exchange.error));
        }
        if exchange.kind == Kind::Limited {
            self.limited.push(column as u32);
        }
    }
}
