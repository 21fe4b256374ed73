//! A scene made ready, and its matrix row by row.

use super::certificate::{Certificate, Tally};
use super::covered::Covers;
use super::divide::check_count;
use super::facet::Facet;
use super::pair::{Exchange, Kind, Worker};
use super::rows::{Row, Rows};
use super::space::{Budget, Space, occluders, row_lengths, triangles};
use super::{MatrixError, Options};
use crate::scene::NamedScene;
use crate::threads::pool;
use crate::visibility::{EngineInfo, build};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::ops::Range;

/// Up to this many rows the exchanges of all pairs are kept (1.5 GiB) and each is worked out once; beyond it twice, so that memory
/// grows with the number of rows and not with its square.
const MOST_KEPT: usize = 20_000;

/// Rows worked out together beyond that, for each thread.
const BLOCK: usize = 16;

/// A scene made ready for its matrix.
#[derive(Debug)]
pub struct Enclosure {
    rows: Rows,
    space: Space,
    pool: ThreadPool,
    keep: bool,
    warnings: Vec<String>,
}

/// A row of the matrix.
#[derive(Debug, Clone, Copy)]
pub struct FormFactors<'a> {
    /// Its number, from 0.
    pub index: usize,
    /// F_ij for all columns j: the share of the diffuse flux that leaves i and arrives at j without being reflected.
    pub values: &'a [f64],
    /// Σ_j F_ij: 1 in a closed scene; what is missing escapes.
    pub sum: f64,
    /// Estimate of the error of the row: the root of the sum of the squares of the entries' errors.
    pub error: f64,
    /// Columns whose entries are less accurate than asked because the limit of refinement came first.
    pub limited: &'a [u32],
}

/// Whether a pair is worked out with the first of its rows only, or with both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pairs {
    Once,
    Twice,
}

/// What has been worked out of a row.
struct Work {
    /// The first column.
    first: usize,
    /// A_i F_ij from there on, in frame units squared.
    amounts: Vec<f64>,
    /// Errors of those that were partly hidden, by column.
    errors: Vec<(u32, f64)>,
    limited: Vec<u32>,
    tally: Tally,
}

impl Enclosure {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// When no surface radiates, there are more than 200,000 of them, an option cannot be met, or the visibility engine cannot be built.
    pub fn new(named: &NamedScene, options: &Options) -> Result<Self, MatrixError> {
        options.check()?;
        let pool = pool(options.threads)?;
        let scene = &named.scene;
        check_count(scene, options.max_area)?;
        let frame = scene.frame();
        let positions = scene.positions_in(&frame);
        let visibility = build(
            options.engine,
            &triangles(scene, &positions),
            pool.current_num_threads(),
        )?;
        let extent = frame.extent();
        let occluders = occluders(scene, &positions, extent);
        let covers = Covers {
            scene,
            positions: &positions,
            occluders: &occluders,
            visibility: visibility.as_ref(),
            extent,
        };
        let cover = |facets: &[Facet]| covers.covered(facets);
        let mut rows = pool.install(|| Rows::new(named, &frame, options, cover));
        if rows.list.is_empty() {
            return Err(MatrixError::NothingRadiates);
        }
        let mut warnings = scene.warnings.clone();
        warnings.extend(super::overlap::overlaps(named, &positions, extent));
        if rows.unsplit > 0 {
            warnings.push(format!(
                "{} surfaces not split where others meet them: entries there converge slowly",
                rows.unsplit
            ));
        }
        let facets = std::mem::take(&mut rows.facets);
        let lengths = pool.install(|| row_lengths(&facets, &rows.of_row));
        let count = rows.list.len();
        let numbered = lengths.iter().zip(&rows.areas).zip(&rows.of_row);
        let budgets = numbered.flat_map(|((length, area), facets)| {
            let budget = Budget::new(options.tolerance, *area, *length, count);
            std::iter::repeat_n(budget, facets.len())
        });
        let budgets = budgets.collect();
        let space = Space::new(facets, occluders, extent, budgets, visibility);
        let keep = rows.list.len() <= MOST_KEPT;
        Ok(Self {
            rows,
            space,
            pool,
            keep,
            warnings,
        })
    }

    /// What the rows and columns stand for.
    pub fn rows(&self) -> &[Row] {
        &self.rows.list
    }

    /// What the reader found suspicious, and surfaces that overlap.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Who traces rays where there is too much to cut out.
    pub fn engine(&self) -> EngineInfo {
        self.space.visibility.info()
    }

    /// Has every pair worked out when either of its rows comes up rather than once, as beyond 20,000 rows; for tests.
    #[doc(hidden)]
    pub fn without_keeping(mut self) -> Self {
        self.keep = false;
        self
    }

    /// Hands the rows to `sink` in order; the same bits for any number of threads.
    ///
    /// # Errors
    /// The first error of the sink.
    pub fn each_row<E>(
        &self,
        sink: impl FnMut(&FormFactors<'_>) -> Result<(), E>,
    ) -> Result<Certificate, E> {
        if self.keep {
            self.kept_rows(sink)
        } else {
            self.streamed_rows(sink)
        }
    }

    fn kept_rows<E>(
        &self,
        mut sink: impl FnMut(&FormFactors<'_>) -> Result<(), E>,
    ) -> Result<Certificate, E> {
        let count = self.rows.list.len();
        let works = self.work(0..count, Pairs::Once);
        let mut squares = vec![0.0; count];
        let mut limited = vec![Vec::new(); count];
        for (row, work) in works.iter().enumerate() {
            for (column, error) in &work.errors {
                squares[row] += error * error;
                if *column as usize != row {
                    squares[*column as usize] += error * error;
                }
            }
            for column in &work.limited {
                limited[row].push(*column);
                if *column as usize != row {
                    limited[*column as usize].push(row as u32);
                }
            }
        }
        let mut certificate = Certificate::new(self);
        let mut values = vec![0.0; count];
        for row in 0..count {
            for (column, work) in works[..row].iter().enumerate() {
                values[column] = work.amounts[row - column];
            }
            values[row..].copy_from_slice(&works[row].amounts);
            limited[row].sort_unstable();
            self.emit(
                row,
                &mut values,
                squares[row],
                &limited[row],
                &mut certificate,
                &mut sink,
            )?;
        }
        works
            .iter()
            .for_each(|work| certificate.pairs += work.tally);
        Ok(certificate)
    }

    fn streamed_rows<E>(
        &self,
        mut sink: impl FnMut(&FormFactors<'_>) -> Result<(), E>,
    ) -> Result<Certificate, E> {
        let count = self.rows.list.len();
        let mut certificate = Certificate::new(self);
        let block = BLOCK * self.pool.current_num_threads();
        for begin in (0..count).step_by(block) {
            for (row, work) in
                (begin..).zip(self.work(begin..(begin + block).min(count), Pairs::Twice))
            {
                let squares = work.errors.iter().map(|(_, e)| e * e).sum();
                let (mut values, mut limited) = (work.amounts, work.limited);
                limited.sort_unstable();
                limited.dedup();
                self.emit(
                    row,
                    &mut values,
                    squares,
                    &limited,
                    &mut certificate,
                    &mut sink,
                )?;
                certificate.pairs += work.tally;
            }
        }
        Ok(certificate)
    }

    /// Turns the exchanges of a row into form factors and hands them on.
    fn emit<E>(
        &self,
        row: usize,
        values: &mut [f64],
        squares: f64,
        limited: &[u32],
        certificate: &mut Certificate,
        sink: &mut impl FnMut(&FormFactors<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let area = self.rows.areas[row];
        values
            .iter_mut()
            .for_each(|value| *value /= area.max(f64::MIN_POSITIVE));
        let sum = values.iter().sum();
        let accuracy = self.accuracy(row);
        let quadrature: f64 = values.iter().map(|v| v * v).sum::<f64>() * accuracy.powi(2);
        let error = match area > 0.0 {
            true => (squares / (area * area) + quadrature).sqrt(),
            false => 0.0,
        };
        certificate.add(row, sum, error, limited);
        sink(&FormFactors {
            index: row,
            values,
            sum,
            error,
            limited,
        })
    }

    /// Works rows out in parallel.
    fn work(&self, rows: Range<usize>, pairs: Pairs) -> Vec<Work> {
        let start = || Worker::new(&self.space);
        self.pool.install(|| {
            rows.into_par_iter()
                // Rows are worth a millisecond and more, the first far more than the last.
                .with_max_len(1)
                .map_init(start, |worker, row| self.work_row(worker, row, pairs))
                .collect()
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

    /// The relative error that unhindered entries of a row may have.
    fn accuracy(&self, row: usize) -> f64 {
        let first = self.rows.of_row[row].clone().next();
        first.map_or(0.0, |facet| self.space.budgets[facet as usize].accuracy)
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
