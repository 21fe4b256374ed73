//! A scene made ready, and its matrix row by row.

use super::certificate::Certificate;
use super::covered::Covers;
use super::divide::check_count;
use super::facet::Facet;
use super::rows::{Row, Rows};
use super::space::{Budget, Space, occluders, row_lengths, triangles};
use super::work::Pairs;
use super::{MatrixError, Options};
use crate::scene::NamedScene;
use crate::threads::pool;
use crate::visibility::{EngineInfo, build};
use rayon::ThreadPool;

/// Up to this many rows the exchanges of all pairs are kept (1.5 GiB) and each is worked out once; beyond it twice, so that memory
/// grows with the number of rows and not with its square.
const MOST_KEPT: usize = 20_000;

/// Rows worked out together beyond that, for each thread.
const BLOCK: usize = 16;

/// A scene made ready for its matrix.
#[derive(Debug)]
pub struct Enclosure {
    pub(super) rows: Rows,
    pub(super) space: Space,
    pub(super) pool: ThreadPool,
    keep: bool,
    /// Whether surfaces overlap, so that row sums exceed 1 with reason.
    overlaps: bool,
    pub(super) tolerance: f64,
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
    /// Estimate of the error of the row: the root of the sum of the squares of the entries' errors; or by how much the sum exceeds 1,
    /// where that is more than such errors come to.
    pub error: f64,
    /// Columns whose entries are less accurate than asked because the limit of refinement came first.
    pub limited: &'a [u32],
}

impl Enclosure {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// When the scene or an option makes no sense, no surface radiates, there are more than 200,000 of them, or the visibility engine cannot be built.
    pub fn new(named: &NamedScene, options: &Options) -> Result<Self, MatrixError> {
        options.check()?;
        named.scene.check().map_err(MatrixError::Scene)?;
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
        let overlaps = super::overlap::overlaps(named, &positions, extent);
        let is_overlapping = !overlaps.is_empty();
        warnings.extend(overlaps);
        if rows.unsplit > 0 {
            warnings.push(format!(
                "{} surfaces not split where others meet them: entries there converge slowly",
                rows.unsplit
            ));
        }
        let facets = std::mem::take(&mut rows.facets);
        let lengths = pool.install(|| row_lengths(&facets, &rows.of_row));
        let count = facets.len();
        let numbered = lengths.iter().zip(&rows.areas).zip(&rows.of_row);
        let budgets = numbered.flat_map(|((length, area), facets)| {
            let pairs = facets.len() * count;
            let budget = Budget::new(options.tolerance, *area, *length, pairs);
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
            overlaps: is_overlapping,
            tolerance: options.tolerance,
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
        let mut works = self.work(0..count, Pairs::Once);
        if !self.overlaps {
            self.work_again(&mut works);
        }
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
        let error = certificate.add(row, sum, error, limited);
        sink(&FormFactors {
            index: row,
            values,
            sum,
            error,
            limited,
        })
    }

    /// The relative error that unhindered entries of a row may have.
    pub(super) fn accuracy(&self, row: usize) -> f64 {
        let first = self.rows.of_row[row].clone().next();
        first.map_or(0.0, |facet| self.space.budgets[facet as usize].accuracy)
    }
}
