//! What is known about the accuracy of a matrix.

use super::enclosure::Enclosure;
use super::pair::Kind;
use super::rows::Row;
use serde::Serialize;
use std::ops::AddAssign;

/// A row sum may differ from 1 by this more than its error estimate, and the scene still counts as closed.
pub(super) const CLOSED: f64 = 1e-3;

/// Errors are estimates: what is off by no more than so many of them says nothing.
const FEW: f64 = 3.0;

/// Whether a row sum is off by more than was asked for and than the error of the row tells.
pub(super) fn exceeds(by: f64, error: f64, tolerance: f64) -> bool {
    by > tolerance.max(FEW * error)
}

/// How the pairs of flat pieces were worked out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Tally {
    /// Facing away from one another, or hidden by one surface: exactly 0.
    pub nothing: u64,
    /// Nothing between: analytic.
    pub unhindered: u64,
    /// Shadows cut out exactly, integrated over both sides.
    pub cut: u64,
    /// Rays traced, since too much lies between.
    pub sampled: u64,
    /// Less accurate than asked: the limit of refinement came first.
    pub limited: u64,
    /// Rays traced in all.
    pub rays: u64,
}

impl Tally {
    pub(super) fn count(&mut self, kind: Kind) {
        let slot = match kind {
            Kind::Nothing => &mut self.nothing,
            Kind::Unhindered => &mut self.unhindered,
            Kind::Cut => &mut self.cut,
            Kind::Sampled => &mut self.sampled,
            Kind::Limited => &mut self.limited,
        };
        *slot += 1;
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.nothing += other.nothing;
        self.unhindered += other.unhindered;
        self.cut += other.cut;
        self.sampled += other.sampled;
        self.limited += other.limited;
        self.rays += other.rays;
    }
}

/// Row sums, errors and limits of a matrix.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Certificate {
    /// Σ_j F_ij of each row: 1 in a closed scene, else less by the share that escapes; 0 where all of it is covered.
    pub row_sums: Vec<f64>,
    /// Estimated error of each row: the root of the sum of the squares of its entries' errors; for those in `exceeding` what their sum
    /// has above 1.
    pub row_errors: Vec<f64>,
    /// Rows whose sum exceeds 1 by more than the tolerance and than the errors that were estimated for their entries come to.
    pub exceeding: Vec<u32>,
    /// Entries (row, column; from 0) that are less accurate than asked.
    pub limited: Vec<[u32; 2]>,
    /// Share of the flux of all rows, in proportion to their area, that escapes.
    pub escaped: f64,
    /// For each row the share of its surfaces that nothing can reach, since something stands on it or it lies within a solid: it counts
    /// neither as area nor as open.
    pub covered: Vec<f64>,
    /// How the pairs were worked out.
    pub pairs: Tally,
    #[serde(skip)]
    weights: Vec<f64>,
    #[serde(skip)]
    is_closed: bool,
    #[serde(skip)]
    tolerance: f64,
}

impl Certificate {
    pub(super) fn new(enclosure: &Enclosure) -> Self {
        let areas: Vec<f64> = enclosure.rows().iter().map(|row| row.area).collect();
        let total: f64 = areas.iter().sum();
        Self {
            row_sums: Vec::with_capacity(areas.len()),
            row_errors: Vec::with_capacity(areas.len()),
            exceeding: Vec::new(),
            limited: Vec::new(),
            escaped: 0.0,
            covered: enclosure.rows().iter().map(Row::covered_share).collect(),
            pairs: Tally::default(),
            weights: areas
                .iter()
                .map(|area| area / total.max(f64::MIN_POSITIVE))
                .collect(),
            is_closed: true,
            tolerance: enclosure.tolerance,
        }
    }

    /// Adds a row with the error that was estimated; returns the one that is stated.
    pub(super) fn add(&mut self, row: usize, sum: f64, mut error: f64, limited: &[u32]) -> f64 {
        if self.covered[row] < 1.0 {
            self.is_closed &= (sum - 1.0).abs() <= CLOSED + FEW * error;
        }
        if exceeds(sum - 1.0, error, self.tolerance) {
            self.exceeding.push(row as u32);
            error = sum - 1.0;
        }
        self.row_sums.push(sum);
        self.row_errors.push(error);
        self.limited
            .extend(limited.iter().map(|column| [row as u32, *column]));
        self.escaped += self.weights[row] * (1.0 - sum);
        error
    }

    /// Rows with some area that is not covered, by number and sum.
    fn exposed(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rows = self.row_sums.iter().copied().enumerate();
        rows.filter(|(row, _)| self.covered[*row] < 1.0)
    }

    /// Whether every row sums up to 1, as far as the errors tell; rows that are covered altogether are left out.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Least and largest row sum of those that are not covered altogether.
    pub fn sum_range(&self) -> (f64, f64) {
        let range = |(low, high): (f64, f64), (_, sum): (usize, f64)| (sum.min(low), sum.max(high));
        self.exposed()
            .fold((f64::INFINITY, f64::NEG_INFINITY), range)
    }

    /// Rows that see no other, though nothing covers them: they face outwards, as a rule.
    pub fn blind_rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.exposed()
            .filter(|(_, sum)| *sum == 0.0)
            .map(|(row, _)| row)
    }

    /// Largest error of a row.
    pub fn largest_error(&self) -> f64 {
        self.row_errors.iter().copied().fold(0.0, f64::max)
    }
}
