//! What a solve says of itself: `report.json`.

use crate::radiometry::Power;
use crate::solver::{Audit, Changes, Ledger, MeshingEnd, Options, Parts, StopReason};
use serde::{Deserialize, Serialize, Serializer};
use std::path::PathBuf;

/// The facts of a solve; serialised as `report.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Name of the scene.
    pub scene: String,
    /// Where the command read it, from the root on: what refers to it may be run elsewhere. What of it is not Unicode is stored as U+FFFD.
    #[serde(default, serialize_with = "as_text")]
    pub scene_file: Option<PathBuf>,
    /// Who traced the rays.
    pub engine: EngineReport,
    /// Threads used.
    pub threads: usize,
    /// Polygons as read, before any splitting, initial subdivision or second side.
    pub input_patches: usize,
    /// Patches: radiating sides of the surfaces after splitting.
    pub patches: usize,
    /// Shots in all.
    pub shots: u64,
    /// Shots after which the mesh was tested: the paper's early iterations.
    pub meshing_shots: u64,
    /// The limit that ended refinement, if one did.
    #[serde(default)]
    pub meshing_ended: Option<MeshingEnd>,
    /// Deepest level of a quadtree.
    pub max_depth: u32,
    /// Leaves of the quadtrees.
    pub elements: usize,
    /// Their corners and centres.
    pub vertices: usize,
    /// Vertices found inside a solid.
    pub buried_vertices: usize,
    /// Occlusion rays.
    pub rays: u64,
    /// Wall-clock time.
    pub seconds: Seconds,
    /// The most memory that the process has held, bytes, where the system tells.
    #[serde(default)]
    pub peak_memory: Option<u64>,
    /// Why the solve ended.
    pub stop_reason: StopReason,
    /// The irradiance that relative thresholds are multiples of, W/m².
    pub reference_irradiance: f64,
    /// Power in W, channels summed.
    pub power: PowerReport<f64>,
    /// Power in W, by channel.
    pub power_rgb: PowerReport<[f64; 3]>,
    /// The estimated error, and sums that should be 1.
    pub audit: Option<Audit>,
    /// The error that was to be reached, if one was.
    pub target: Option<TargetReport>,
    /// Every option in force.
    pub options: Options,
    /// What changed when the solve was taken up again, and after how many shots; if anything did, the options alone do not give this
    /// solution.
    #[serde(default)]
    pub resumed_with: Vec<String>,
    /// What was suspicious in the input, could not be meshed as it should, or ended the solve early; and where much of the light was lost.
    pub warnings: Vec<String>,
}

/// A path as text: JSON has no other strings, and no name may keep a solve from being stored.
fn as_text<S: Serializer>(path: &Option<PathBuf>, serializer: S) -> Result<S::Ok, S::Error> {
    path.as_ref()
        .map(|path| path.to_string_lossy())
        .serialize(serializer)
}

impl Report {
    /// Why the solve ended, in words.
    pub fn ended(&self) -> &'static str {
        match self.stop_reason {
            StopReason::Converged => "converged",
            StopReason::MaxShots => "stopped at the largest number of shots",
            StopReason::TimeLimit => "stopped at the time limit",
            StopReason::Interrupted => "interrupted",
            StopReason::NoEmitter => "nothing emits",
        }
    }
}

/// What became of `--target-error`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TargetReport {
    /// The estimated nRMS error that was asked for.
    pub n_rms: f64,
    /// Whether the estimate is below it.
    pub reached: bool,
    /// Solves that it took; the report is of the last.
    pub rounds: usize,
    /// Where its options lie between the presets: 0 is draft, 1 standard, 2 accurate.
    #[serde(default)]
    pub strictness: f64,
    /// Whether the mesh was begun with other options: if it does not do, that is no reason for stricter ones.
    #[serde(default)]
    pub inherited: bool,
    /// Options that were not for the target to choose.
    #[serde(default)]
    pub fixed: Changes,
}

/// Who traced the rays.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct EngineReport {
    /// `embree` or `obvhs` (or `brute_force`).
    pub name: String,
    /// Version of the library.
    pub version: String,
    /// Instruction set.
    pub isa: String,
    /// Rays traced together.
    pub packet_width: u32,
}

/// Wall-clock seconds of each part.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Seconds {
    /// Reading the scene.
    pub load: f64,
    /// Building mesh and visibility engine.
    pub build: f64,
    /// The engine's part of it.
    #[serde(default)]
    pub engine: f64,
    /// From the first shot to the estimate of the error.
    pub solve: f64,
    /// Where that went.
    #[serde(default)]
    pub parts: Parts,
    /// Writing results; in a stored solution, what was written before it.
    pub write: f64,
}

/// Where the power went: emitted = absorbed + escaped + unshot + residual.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(bound(deserialize = "T: Deserialize<'de> + Default"))]
pub struct PowerReport<T> {
    /// Given by all emitters.
    pub emitted: T,
    /// Kept by the surfaces.
    pub absorbed: T,
    /// Gone to the open or onto sides that do not radiate, measured by rays of its own.
    pub escaped: T,
    /// The part of it that ended on sides that do not radiate: on the wrong side, if they were to be lit.
    #[serde(default)]
    pub onto_backs: T,
    /// Not yet shot.
    pub unshot: T,
    /// What the other terms leave over: discretisation, and the sampling of `escaped`.
    pub residual: T,
}

impl<T> PowerReport<T> {
    /// The ledger, each entry made by `of`.
    pub fn new(ledger: &Ledger, of: impl Fn(Power) -> T) -> Self {
        Self {
            emitted: of(ledger.emitted),
            absorbed: of(ledger.absorbed),
            escaped: of(ledger.escaped),
            onto_backs: of(ledger.onto_backs),
            unshot: of(ledger.unshot),
            residual: of(ledger.residual()),
        }
    }
}
