//! The loop: select, shoot, refine, account, stop.

use super::audit::Audit;
use super::burial::buried;
use super::course::{Course, Shot, Stage};
use super::escape::{Backing, Lost, escaped};
use super::feelers::feelers;
use super::ledger::Ledger;
use super::light::{Light, Sign};
use super::observer::{Control, Observer, Progress};
use super::options::Options;
use super::outcome::{Outcome, StopReason};
use super::refine::Refinement;
use super::shoot::{Beam, faces, shoot_at};
use super::source::cells_of;
use crate::form_factor::{Gather, Sampler, Source, SourceThresholds, ToleranceScale};
use crate::geometry::polygon::vector_area;
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use crate::scene::Scene;
use crate::visibility::{Triangles, Visibility};
use glam::DVec3;
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// A solve in progress.
pub struct Solver<'a> {
    pub(super) mesh: Mesh,
    pub(super) light: Light,
    pub(super) course: Course,
    pub(super) visibility: &'a dyn Visibility,
    pub(super) options: Options,
    pub(super) backing: Vec<Backing>,
    /// Area of one square of the frame's unit, m².
    pub(super) square_metres: f64,
    pub(super) reference: f64,
    /// What the solve took before it was taken up again.
    spent: Duration,
    started: Instant,
}

/// The triangles of a scene for a visibility engine, in the frame of `mesh`: in the order of the surfaces, two for each quad.
pub fn occluders(scene: &Scene, mesh: &Mesh) -> Triangles {
    let positions = scene.positions_in(&mesh.frame);
    let surfaces = scene.surfaces.iter();
    Triangles {
        vertices: positions.iter().map(|p| p.as_vec3()).collect(),
        indices: surfaces.flat_map(|s| s.corners.triangles()).collect(),
    }
}

impl<'a> Solver<'a> {
    /// Prepares a solve of `scene` on its coarsest `mesh`; `visibility` answers for the scene's [`occluders`].
    pub fn new(
        scene: &Scene,
        mut mesh: Mesh,
        visibility: &'a dyn Visibility,
        options: Options,
    ) -> Self {
        let backing = backing(scene, &mesh);
        mesh.finish_topology(0, &buried(&mesh, visibility, &backing, 0));
        mesh.integrate();
        let light = Light::new(&mesh);
        let state = (mesh, light, Course::default());
        Self::resume(scene, state, visibility, options, Duration::ZERO)
    }

    /// Takes up a solve of `scene` where an [`Outcome`] has left it; `spent` is what counts against the time limit already.
    pub fn resume(
        scene: &Scene,
        (mesh, light, course): (Mesh, Light, Course),
        visibility: &'a dyn Visibility,
        options: Options,
        spent: Duration,
    ) -> Self {
        let area: f64 = mesh.patches.iter().map(|p| p.area).sum();
        let emitted: f64 = mesh
            .patches
            .iter()
            .map(|p| f64::from(p.exitance.max_element()) * p.area)
            .sum();
        Self {
            backing: backing(scene, &mesh),
            square_metres: (scene.metres_per_unit / mesh.frame.scale()).powi(2),
            reference: if area > 0.0 { emitted / area } else { 0.0 },
            mesh,
            light,
            course,
            visibility,
            options,
            spent,
            started: Instant::now(),
        }
    }

    /// Goes on until there is a reason to stop; keeps `observer` informed.
    pub fn run(mut self, observer: &mut dyn Observer) -> Outcome {
        let stop_reason = self.advance(observer);
        let audit = match stop_reason {
            StopReason::NoEmitter | StopReason::Interrupted => None,
            _ => self.audit(),
        };
        self.outcome(stop_reason, audit)
    }

    /// Leaves the solve as it is.
    pub fn leave(self) -> Outcome {
        self.outcome(StopReason::Interrupted, None)
    }

    fn outcome(self, stop_reason: StopReason, audit: Option<Audit>) -> Outcome {
        let mut lost = self.course.lost;
        lost += self.escaping();
        let ledger = Ledger::balance(&self.mesh, &self.light, &lost, self.square_metres);
        Outcome {
            elapsed: self.elapsed(),
            mesh: self.mesh,
            light: self.light,
            course: self.course,
            ledger,
            reference_irradiance: self.reference,
            audit,
            stop_reason,
        }
    }

    /// One batch of work after the other. Between them the state is whole: what goes on from it ends with the same bits.
    fn advance(&mut self, observer: &mut dyn Observer) -> StopReason {
        if self.emitted().element_sum() <= 0.0 {
            return StopReason::NoEmitter;
        }
        loop {
            if observer.progress(&self.progress()) == Control::Stop {
                return StopReason::Interrupted;
            }
            match std::mem::take(&mut self.course.stage) {
                Stage::Shooting => {
                    if let Some(reason) = self.shoot() {
                        return reason;
                    }
                }
                Stage::Refining(shot) => self.refine(shot),
                Stage::Gathering(so_far) => self.gather(so_far),
                Stage::Finished => {
                    self.course.stage = Stage::Finished;
                    return StopReason::Converged;
                }
            }
        }
    }

    /// One shot, the gathering if enough has been shot, or a reason to do neither.
    fn shoot(&mut self) -> Option<StopReason> {
        let powers = self.unshot_powers();
        let emitted = self.emitted().element_sum();
        let unshot: Power = powers.iter().sum();
        if unshot.element_sum() <= self.options.tolerance * emitted {
            self.course.stage = if self.options.regather {
                Stage::Gathering(self.gathering())
            } else {
                Stage::Finished
            };
            return None;
        }
        let shots = self.course.shots;
        if self.options.max_shots.is_some_and(|most| shots >= most) {
            return Some(StopReason::MaxShots);
        }
        let elapsed = self.elapsed();
        if self.options.time_limit.is_some_and(|most| elapsed >= most) {
            return Some(StopReason::TimeLimit);
        }
        let strongest = select(&powers);
        let power = powers[strongest].element_sum() / emitted;
        self.shoot_from(strongest / 2, Sign::ALL[strongest % 2], power);
        None
    }

    /// Adds the contribution of one patch to all vertices that there are.
    fn shoot_from(&mut self, shooter: usize, sign: Sign, power: f64) {
        let sampler = self.sampler();
        let from = (shooter, sign);
        let thresholds = &sampler.thresholds;
        let mut shot = Shot {
            shooter: shooter as u32,
            sign,
            power,
            cells: cells_of(&self.mesh, &self.light, from, &self.options, thresholds),
            candidates: Vec::new(),
            feelers: Vec::new(),
            arrived: Vec::new(),
            source: None,
        };
        let source = shot.source(&self.mesh);
        let beam = Beam {
            sampler: &sampler,
            source: &source,
            sign,
        };
        self.light.take(&self.mesh, shooter, sign);
        let reached = self.reached(&source);
        shot.arrived = self.arrivals(beam, &reached);
        for (vertex, gather) in shot.arrived.iter().enumerate() {
            self.light.irradiance[vertex] += gather.irradiance;
            self.light.unshot[vertex] += gather.irradiance;
        }
        let meshes = power >= self.options.meshing_power && self.course.meshing_ended.is_none();
        if meshes {
            let elements = self.mesh.leaves();
            let patch_of = |e: u32| self.mesh.elements[e as usize].patch as usize;
            shot.candidates = elements.filter(|e| reached[patch_of(*e)]).collect();
            let (found, rays) = feelers(&self.mesh, &self.light, &self.backing, beam, &reached);
            self.course.rays += rays;
            shot.feelers = found;
            shot.source = Some(source);
            self.course.stage = Stage::Refining(shot);
        } else {
            self.end_shot(&shot, &source);
        }
    }

    /// One pass of refinement.
    fn refine(&mut self, mut shot: Shot) {
        let source = shot.source(&self.mesh);
        if let Some(end) = self.meshing_end() {
            self.course.meshing_ended = Some(end);
            shot.candidates.clear();
        }
        if shot.candidates.is_empty() {
            self.course.meshing_shots += 1;
            return self.end_shot(&shot, &source);
        }
        let sampler = self.sampler();
        let mut refinement = Refinement {
            beam: Beam {
                sampler: &sampler,
                source: &source,
                sign: shot.sign,
            },
            room: self.room(),
            mesh: &mut self.mesh,
            light: &mut self.light,
            arrived: &mut shot.arrived,
            options: &self.options,
            backing: &self.backing,
            feelers: &shot.feelers,
            rays: 0,
        };
        shot.candidates = refinement.pass(&shot.candidates);
        self.course.rays += refinement.rays;
        self.mesh.integrate();
        shot.source = Some(source);
        self.course.stage = Stage::Refining(shot);
    }

    fn end_shot(&mut self, shot: &Shot, source: &Source) {
        self.course.lost += self.escape_of(shot, source);
        self.course.shots += 1;
    }

    /// What escapes of the shot that is under way.
    fn escaping(&self) -> Lost {
        match &self.course.stage {
            Stage::Refining(shot) => {
                let source = shot.clone().source(&self.mesh);
                self.escape_of(shot, &source)
            }
            _ => Lost::default(),
        }
    }

    fn escape_of(&self, shot: &Shot, source: &Source) -> Lost {
        let seed = self.course.shots as u32;
        let lost = self.escape(shot.shooter as usize, source, shot.power, seed);
        lost * f64::from(shot.sign.factor())
    }

    pub(super) fn sampler(&self) -> Sampler<'a> {
        Sampler {
            visibility: self.visibility,
            extent: self.mesh.frame.extent(),
            formula: self.options.formula(),
            thresholds: self.source_thresholds(),
        }
    }

    /// The patches that can see any of the source, planes alone considered.
    pub(super) fn reached(&self, source: &Source) -> Vec<bool> {
        let extent = self.mesh.frame.extent();
        let patches = self.mesh.patches.iter();
        patches.map(|p| faces(p, source, extent)).collect()
    }

    /// What a beam gives to each vertex of the patches that it reaches.
    pub(super) fn arrivals(&mut self, beam: Beam, reached: &[bool]) -> Vec<Gather> {
        let patches = self.mesh.patches.iter().zip(reached);
        let vertices: Vec<u32> = patches
            .filter(|(_, reached)| **reached)
            .flat_map(|(patch, _)| patch.vertices.iter().copied())
            .filter(|v| !self.mesh.buried[*v as usize])
            .collect();
        let mut arrived = vec![Gather::default(); self.mesh.vertices.len()];
        self.course.rays += shoot_at(&self.mesh, &self.light, beam, &vertices, &mut arrived);
        let mut irradiance: Vec<Spectrum> = arrived.iter().map(|g| g.irradiance).collect();
        self.mesh.continue_to_buried(&mut irradiance, 0);
        for (gather, received) in arrived.iter_mut().zip(irradiance) {
            gather.irradiance = received;
        }
        arrived
    }

    /// What of a source's power, a fraction `power` of the emitted, leaves the scene.
    pub(super) fn escape(&self, shooter: usize, source: &Source, power: f64, seed: u32) -> Lost {
        // The square root shares the rays so that each shot adds its part to the error of the whole.
        let rays = (16384.0 * power.sqrt()).clamp(256.0, 16384.0) as usize;
        // An emitter emits wherever it is.
        let emits = self.mesh.patches[shooter].exitance != Spectrum::ZERO;
        let is_open = |point| emits || self.is_open(shooter, point);
        escaped(
            source,
            self.visibility,
            &self.backing,
            is_open,
            self.mesh.frame.extent(),
            (rays, seed),
        )
    }

    /// Whether the nearest vertex to a point of a patch is open.
    fn is_open(&self, patch: usize, point: DVec3) -> bool {
        let (u, v) = self.mesh.patches[patch].coordinates(point);
        let weighted = self
            .mesh
            .interpolate(self.mesh.leaf_at(patch as u32, u, v), point);
        let nearest = weighted.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        nearest.is_none_or(|(vertex, _)| !self.mesh.buried[*vertex as usize])
    }

    fn source_thresholds(&self) -> SourceThresholds {
        SourceThresholds {
            difference: self.options.epsilon_fd,
            estimate: self.options.epsilon_fe,
            raw: self.options.raw_form_factors,
            scale: ToleranceScale {
                reference: self.reference,
                local_share: self.options.local_share,
            },
        }
    }

    /// By patch, first the positive, then the negative.
    fn unshot_powers(&self) -> Vec<Power> {
        let power = |of: usize| {
            let (patch, sign) = (of / 2, Sign::ALL[of % 2]);
            self.light.unshot_power(&self.mesh, patch, sign)
        };
        let count = 2 * self.mesh.patches.len();
        (0..count).into_par_iter().map(power).collect()
    }

    /// What all patches have unshot, the negative subtracted.
    pub(super) fn unshot(&self) -> Power {
        let powers = self.unshot_powers();
        let sum = |sign: usize| powers.iter().skip(sign).step_by(2).sum::<Power>();
        sum(0) - sum(1)
    }

    pub(super) fn emitted(&self) -> Power {
        self.mesh
            .patches
            .iter()
            .map(|p| p.exitance.as_dvec3() * p.area)
            .sum()
    }

    fn progress(&self) -> Progress {
        let inner = self.mesh.elements.iter().filter(|e| !e.is_leaf()).count();
        let unshot: Power = self.unshot_powers().iter().sum();
        Progress {
            shots: self.course.shots,
            meshing_shots: self.course.meshing_shots,
            elements: self.mesh.elements.len() - inner,
            vertices: self.mesh.vertices.len(),
            rays: self.course.rays,
            emitted: self.emitted() * self.square_metres,
            unshot: unshot * self.square_metres,
            elapsed: self.elapsed(),
        }
    }

    fn elapsed(&self) -> Duration {
        self.spent + self.started.elapsed()
    }
}

/// What stands behind each triangle of the scene's [`occluders`].
fn backing(scene: &Scene, mesh: &Mesh) -> Vec<Backing> {
    let mut backing = Vec::new();
    for (number, surface) in (0..).zip(&scene.surfaces) {
        let at = |v: &u32| mesh.frame.enter(scene.vertices[*v as usize]);
        let corners: Vec<DVec3> = surface.corners.indices().iter().map(at).collect();
        let side = Backing {
            normal: vector_area(&corners).normalize_or(DVec3::Z),
            sides: surface.sides,
            surface: number,
        };
        backing.extend(std::iter::repeat_n(side, corners.len() - 2));
    }
    backing
}

/// The largest power; the first of equals.
fn select(powers: &[Power]) -> usize {
    let mut best = 0;
    for (patch, power) in powers.iter().enumerate() {
        if power.element_sum() > powers[best].element_sum() {
            best = patch;
        }
    }
    best
}
