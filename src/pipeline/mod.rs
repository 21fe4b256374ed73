//! From a scene to its solution: mesh, visibility, solve, report. [`solve`] does it in one call, a [`Run`] in as many as one likes.
//!
//! Imports `radiometry`, `scene`, `threads`, `visibility`, `mesh`, `solver`, `solution` and `words`.

mod measure;
mod report;
mod run;
mod target;
mod warnings;

pub use measure::irradiance_at;
pub use run::Run;
pub use target::Target;

use crate::scene::Scene;
use crate::solution::Solution;
use crate::solver::{Observer, Options};
use crate::threads::ThreadsError;
use crate::visibility::{EngineChoice, VisibilityError};
use crate::words::size;
use thiserror::Error;

/// How a scene is solved.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Settings {
    /// Thresholds and limits; with a target, what it does not fix comes from there.
    pub options: Options,
    /// The error to be reached, in place of thresholds.
    pub target: Option<Target>,
    /// Who traces the rays.
    pub engine: EngineChoice,
    /// Threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// Why a scene could not be solved.
#[derive(Debug, Error)]
pub enum SolveError {
    /// The visibility engine could not be built.
    #[error(transparent)]
    Visibility(#[from] VisibilityError),
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The solution is of an older format, which did not keep what it takes to go on.
    #[error("this solution was written by an earlier version and cannot be continued, only shown")]
    NotKept,
    /// The scene is not the one that was solved, but for what its surfaces emit.
    #[error("a solve can go on with other emitters, not with another scene: {0}")]
    OtherScene(String),
    /// Already the coarsest mesh, with what is to be drawn of it, exceeds the memory limit.
    #[error(
        "{elements} elements before any refinement{} need about {}, where {} may be used (--memory-limit)",
        drawn(*.pictures, *.limit),
        size(*.needed, *.limit),
        size(*.limit, *.limit)
    )]
    TooLarge {
        /// Leaves of the coarsest mesh.
        elements: usize,
        /// The part of the pictures, bytes.
        pictures: u64,
        /// What the run would take, bytes.
        needed: u64,
        /// What it may take, bytes.
        limit: u64,
    },
    /// An option that a target fixes is none.
    #[error("{0}")]
    Option(String),
}

fn drawn(pictures: u64, limit: u64) -> String {
    match pictures {
        0 => String::new(),
        _ => format!(" and a picture of {}", size(pictures, limit)),
    }
}

/// Solves `scene`; `observer` hears of the progress and may stop it. The same settings on the same instruction set give the same
/// solution, bit for bit, for any number of threads.
pub fn solve(
    scene: &Scene,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Solution, SolveError> {
    let mut run = Run::new(scene.clone(), settings.clone())?;
    run.go(observer)?;
    Ok(run.finish())
}
