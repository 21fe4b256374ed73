//! How far a solve has come: with the mesh and its light, all that it takes to go on as if it had never been interrupted.

use super::arrived::Arrived;
use super::audit::Span;
use super::escape::Lost;
use super::feelers::Feeler;
use super::light::{Light, Sign};
use super::observer::Phase;
use super::shoot::Shooter;
use super::source::{self, source_from};
use super::tiling;
use super::wave::Wave;
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use serde::{Deserialize, Serialize};

/// How far a solve has come, besides the mesh and the light on it.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Course {
    /// Shots that are complete.
    pub shots: u64,
    /// Shots that tested the mesh.
    pub meshing_shots: u64,
    /// Occlusion rays traced.
    pub rays: u64,
    /// Why the mesh is not refined any further, if a limit ended it.
    pub meshing_ended: Option<MeshingEnd>,
    pub(super) lost: Lost,
    /// From the first bounce to the gathering, unless there was other light before.
    pub(super) direct: Option<Direct>,
    /// See [`Audit::sent_sum`](super::Audit::sent_sum).
    pub(super) sent_sum: Option<Span>,
    pub(super) stage: Stage,
}

/// The limit that ended refinement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MeshingEnd {
    /// [`Options::max_elements`](super::Options::max_elements).
    MaxElements,
    /// [`Options::memory_limit`](super::Options::memory_limit).
    MemoryLimit,
}

/// What is to be done next.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) enum Stage {
    /// A shot.
    #[default]
    Shooting,
    /// A pass of refinement after a shot.
    Refining(Shot),
    /// The light of one more patch, gathered on the finished mesh.
    Gathering(Gathering),
    /// Nothing.
    Finished,
    /// The next vertices that a wave arrives at.
    Waving(Wave),
    /// A pass of refinement after all light was gathered as clusters.
    Settling(Shot),
    /// A shot, after a wave that arrived at neighbourhoods.
    Bounced(Bounce),
}

/// The light of the emitters alone, kept while what is reflected goes from wave to wave: it need not be gathered once more.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Direct {
    /// By vertex.
    pub irradiance: Vec<Spectrum>,
    /// What of it left the scene.
    pub lost: Lost,
}

/// A wave that has arrived at neighbourhoods.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Bounce {
    /// What was unshot before it.
    pub unshot: Power,
    /// By what it was multiplied in the bounce before it, if there was one.
    pub ratio: Option<Spectrum>,
}

/// A shot that has arrived at the vertices there were, while the mesh is refined for it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Shot {
    /// The patch, or [`ALL`].
    pub shooter: u32,
    pub sign: Sign,
    /// As a fraction of the emitted power.
    pub power: f64,
    /// Unshot radiosity by cell, or by tile, as it was before the shot.
    pub cells: Vec<Spectrum>,
    /// Elements to be tested.
    pub candidates: Vec<u32>,
    pub feelers: Vec<Feeler>,
    /// What the shot gave to each vertex so far.
    pub arrived: Arrived,
    /// What of it leaves the scene; found when it is asked for, unless there was time while it arrived.
    #[serde(skip)]
    pub lost: Option<Lost>,
    /// Made of `cells` when it is asked for.
    #[serde(skip)]
    pub made: Option<Shooter>,
}

/// All patches, as clusters.
pub(super) const ALL: u32 = u32::MAX;

impl Shot {
    /// The patch as a source.
    pub fn source(&self, mesh: &Mesh) -> Shooter {
        Shooter::Patch(source_from(mesh, self.shooter as usize, &self.cells))
    }
}

/// All light gathered once more at every vertex, so far.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Gathering {
    /// The first patch whose light is not in yet.
    pub next: u32,
    /// By how much the light is multiplied for what is unshot.
    pub ambient: Spectrum,
    pub irradiance: Vec<Spectrum>,
    pub lost: Lost,
    /// What arrived and what escaped over what was sent, and what was sent, of each strong patch.
    pub sums: Vec<(f64, f64)>,
    /// The light that is gathered; made when it is asked for.
    #[serde(skip)]
    pub whole: Option<Light>,
}

impl Course {
    /// What is done next, for who watches.
    pub(super) fn phase(&self, mesh: &Mesh) -> Phase {
        match &self.stage {
            Stage::Shooting | Stage::Bounced(_) => Phase::Shooting,
            Stage::Waving(wave) => wave.phase(mesh),
            Stage::Refining(_) | Stage::Settling(_) => Phase::Refining,
            Stage::Gathering(so_far) => Phase::Gathering {
                done: so_far.next,
                of: mesh.patches.len() as u32,
            },
            Stage::Finished => Phase::Estimating,
        }
    }

    /// Whether nothing is left to be done.
    pub fn is_finished(&self) -> bool {
        matches!(self.stage, Stage::Finished)
    }

    /// Goes on with shooting: the options have become stricter, or the emitters are others.
    pub fn reopen(&mut self) {
        // A shot counts as shot from its beginning, and is refined for to its end. A wave does when it has arrived everywhere, and
        // sets out anew with what is unshot by then.
        if !matches!(self.stage, Stage::Refining(_)) {
            self.stage = Stage::Shooting;
        }
        self.meshing_ended = None;
        self.direct = None;
    }

    /// Nothing is shot any more, and nothing lost: all emitters went out, and the light with them. What it took stays counted.
    pub fn go_dark(&mut self) {
        let Self {
            shots,
            meshing_shots,
            rays,
            ..
        } = *self;
        *self = Self {
            shots,
            meshing_shots,
            rays,
            ..Self::default()
        };
    }

    /// Checks a course that was read against the mesh that it belongs to. The error says what does not fit.
    pub fn check(&self, mesh: &Mesh) -> Result<(), String> {
        let (patches, elements) = (mesh.patches.len() as u32, mesh.elements.len() as u32);
        let fits = match &self.stage {
            Stage::Shooting | Stage::Bounced(_) | Stage::Finished => true,
            Stage::Refining(shot) | Stage::Settling(shot) => {
                let fits = match shot.shooter {
                    ALL => tiling::fits(mesh, &shot.cells),
                    patch => patch < patches && source::fits(mesh, patch as usize, &shot.cells),
                };
                fits && shot.candidates.iter().all(|e| *e < elements)
                    && shot.feelers.iter().all(|f| f.patch < patches)
                    && shot.arrived.len() == mesh.vertices.len()
            }
            Stage::Waving(wave) => {
                tiling::fits(mesh, &wave.cells)
                    && wave.arrived.len() == mesh.vertices.len()
                    && wave.next < patches
            }
            Stage::Gathering(of) => of.irradiance.len() == mesh.vertices.len(),
        };
        let is_known = |direct: &Direct| direct.irradiance.len() == mesh.vertices.len();
        if fits && self.direct.as_ref().is_none_or(is_known) {
            Ok(())
        } else {
            Err("a state of the solve that does not fit the mesh".into())
        }
    }
}
