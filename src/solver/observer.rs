//! How a solve is watched and stopped.

use crate::radiometry::Power;
use std::time::Duration;

/// What a solve is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Shots.
    Shooting,
    /// Splitting elements after a shot.
    Refining,
    /// All light once more: that of one patch after the other or, from clusters, that of all at one patch after the other.
    Gathering {
        /// Patches whose light is in or, from clusters, that have it.
        done: u32,
        /// Patches in all.
        of: u32,
    },
    /// Nothing but the estimate of the error.
    Estimating,
}

/// Where a solve is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// What it is at.
    pub phase: Phase,
    /// Shots that are complete.
    pub shots: u64,
    /// Shots that tested the mesh.
    pub meshing_shots: u64,
    /// Leaves of the mesh.
    pub elements: usize,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Occlusion rays traced.
    pub rays: u64,
    /// Emitted power, W, per channel.
    pub emitted: Power,
    /// Power that is still unshot, W, per channel.
    pub unshot: Power,
    /// Since the start.
    pub elapsed: Duration,
}

/// What was found when the error was estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Shots that were complete.
    pub shots: u64,
    /// Since the start, the estimate's own time included.
    pub elapsed: Duration,
    /// Estimated RMS error of the irradiance over its mean.
    pub n_rms: f64,
}

/// What an observer wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Finish what is begun, keep the solution so far.
    Stop,
}

/// Hears of a solve after each batch of work: within a shot after every pass of refinement, and after the shot.
pub trait Observer: Send {
    /// Called between batches, from the thread that solves.
    fn progress(&mut self, progress: &Progress) -> Control;

    /// Called after each estimate of the error: once at the end of a solve, and of each round on the way to a target.
    fn estimated(&mut self, _estimate: &Estimate) {}
}

/// An observer that lets the solve run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {
    fn progress(&mut self, _: &Progress) -> Control {
        Control::Continue
    }
}
