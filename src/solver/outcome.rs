//! What a solve leaves, and why it ended.

use super::audit::Audit;
use super::course::Course;
use super::ledger::Ledger;
use super::light::Light;
use super::parts::Parts;
use crate::mesh::Mesh;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Why a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StopReason {
    /// Unshot over emitted power fell below the tolerance.
    Converged,
    /// The largest number of shots was reached.
    MaxShots,
    /// Time was up.
    TimeLimit,
    /// The observer asked for it.
    Interrupted,
    /// No surface emits: there is nothing to shoot.
    NoEmitter,
}

/// What a solve leaves.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The refined mesh.
    pub mesh: Mesh,
    /// The light on it.
    pub light: Light,
    /// How far it has come; with mesh and light, what it takes to go on.
    pub course: Course,
    /// Where the power went.
    pub ledger: Ledger,
    /// The irradiance that relative thresholds are multiples of, W/m².
    pub reference_irradiance: f64,
    /// The estimated error, if it was looked for.
    pub audit: Option<Audit>,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Time that it took in all.
    pub elapsed: Duration,
    /// Where the time of this run went; its rays are the caller's to measure.
    pub parts: Parts,
}
