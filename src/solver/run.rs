//! The loop: select, shoot, refine, account, stop.

use super::audit::Span;
use super::burial::buried;
use super::escape::{Backing, escaped};
use super::feelers::feelers;
use super::ledger::Ledger;
use super::observer::{Control, Observer, Progress};
use super::options::Options;
use super::outcome::{Outcome, StopReason};
use super::refine::Refinement;
use super::shoot::{faces, shoot_at};
use super::source::source_of;
use super::state::Light;
use crate::form_factor::{Gather, Sampler, Source, SourceThresholds, ToleranceScale};
use crate::geometry::polygon::vector_area;
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use crate::scene::Scene;
use crate::visibility::{Triangles, Visibility};
use glam::DVec3;
use rayon::prelude::*;
use std::time::Instant;

/// A solve in progress.
pub struct Solver<'a> {
    pub(super) mesh: Mesh,
    pub(super) light: Light,
    pub(super) visibility: &'a dyn Visibility,
    pub(super) options: Options,
    pub(super) backing: Vec<Backing>,
    /// Area of one square of the frame's unit, m².
    pub(super) square_metres: f64,
    pub(super) reference: f64,
    pub(super) escaped: Power,
    pub(super) shots: u64,
    pub(super) meshing_shots: u64,
    pub(super) rays: u64,
    pub(super) sent_sum: Option<Span>,
    pub(super) started: Instant,
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
        mesh.finish_topology(0, &buried(&mesh, visibility, &backing, 0));
        mesh.integrate();
        let light = Light::new(&mesh);
        let area: f64 = mesh.patches.iter().map(|p| p.area).sum();
        let emitted: f64 = mesh
            .patches
            .iter()
            .map(|p| f64::from(p.exitance.max_element()) * p.area)
            .sum();
        let square_metres = (scene.metres_per_unit / mesh.frame.scale()).powi(2);
        let reference = if area > 0.0 { emitted / area } else { 0.0 };
        Self {
            light,
            visibility,
            options,
            backing,
            square_metres,
            reference,
            escaped: Power::ZERO,
            shots: 0,
            meshing_shots: 0,
            rays: 0,
            sent_sum: None,
            started: Instant::now(),
            mesh,
        }
    }

    /// Shoots until a reason to stop; keeps `observer` informed.
    pub fn run(mut self, observer: &mut dyn Observer) -> Outcome {
        let mut stop_reason = self.shoot_until_stop(observer);
        if stop_reason == StopReason::Converged
            && self.options.regather
            && self.regather(observer) == Control::Stop
        {
            stop_reason = StopReason::Interrupted;
        }
        let audit = match stop_reason {
            StopReason::NoEmitter | StopReason::Interrupted => None,
            _ => self.audit(),
        };
        let ledger = Ledger::balance(&self.mesh, &self.light, self.escaped, self.square_metres);
        Outcome {
            mesh: self.mesh,
            light: self.light,
            ledger,
            reference_irradiance: self.reference,
            shots: self.shots,
            meshing_shots: self.meshing_shots,
            rays: self.rays,
            audit,
            stop_reason,
        }
    }

    fn shoot_until_stop(&mut self, observer: &mut dyn Observer) -> StopReason {
        let emitted = self.emitted();
        if emitted.element_sum() <= 0.0 {
            return StopReason::NoEmitter;
        }
        loop {
            let powers = self.unshot_powers();
            let unshot: Power = powers.iter().sum();
            if observer.progress(&self.progress(unshot)) == Control::Stop {
                return StopReason::Interrupted;
            }
            if unshot.element_sum() <= self.options.tolerance * emitted.element_sum() {
                return StopReason::Converged;
            }
            if self
                .options
                .max_shots
                .is_some_and(|most| self.shots >= most)
            {
                return StopReason::MaxShots;
            }
            if self
                .options
                .time_limit
                .is_some_and(|limit| self.started.elapsed() >= limit)
            {
                return StopReason::TimeLimit;
            }
            let shooter = select(&powers);
            let power = powers[shooter].element_sum() / emitted.element_sum();
            if self.shoot(shooter, power, observer) == Control::Stop {
                return StopReason::Interrupted;
            }
        }
    }

    /// Adds the contribution of one patch everywhere, and refines where it falls.
    fn shoot(&mut self, shooter: usize, power: f64, observer: &mut dyn Observer) -> Control {
        let sampler = self.sampler();
        let source = source_of(
            &self.mesh,
            &self.light,
            shooter,
            &self.options,
            &sampler.thresholds,
        );
        self.light.take(&self.mesh, shooter);
        let reached = self.reached(&source);
        let mut arrived = self.arrivals(&sampler, &source, &reached);
        for (vertex, gather) in arrived.iter().enumerate() {
            self.light.irradiance[vertex] += gather.irradiance;
            self.light.unshot[vertex] += gather.irradiance;
        }
        let mut control = Control::Continue;
        if power >= self.options.meshing_power {
            control = self.refine(&sampler, &source, &reached, &mut arrived, observer);
            self.meshing_shots += 1;
        }
        self.escaped += self.escape(shooter, &source, power, self.shots as u32);
        self.shots += 1;
        control
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

    /// What a source gives to each vertex of the patches that it reaches.
    pub(super) fn arrivals(
        &mut self,
        sampler: &Sampler,
        source: &Source,
        reached: &[bool],
    ) -> Vec<Gather> {
        let patches = self.mesh.patches.iter().zip(reached);
        let vertices: Vec<u32> = patches
            .filter(|(_, reached)| **reached)
            .flat_map(|(patch, _)| patch.vertices.iter().copied())
            .filter(|v| !self.mesh.buried[*v as usize])
            .collect();
        let mut arrived = vec![Gather::default(); self.mesh.vertices.len()];
        self.rays += shoot_at(
            &self.mesh,
            &self.light,
            sampler,
            source,
            &vertices,
            &mut arrived,
        );
        let mut irradiance: Vec<Spectrum> = arrived.iter().map(|g| g.irradiance).collect();
        self.mesh.continue_to_buried(&mut irradiance, 0);
        for (gather, received) in arrived.iter_mut().zip(irradiance) {
            gather.irradiance = received;
        }
        arrived
    }

    /// What of a source's power, a fraction `power` of the emitted, leaves the scene.
    pub(super) fn escape(&self, shooter: usize, source: &Source, power: f64, seed: u32) -> Power {
        // The square root shares the rays so that each shot adds its part to the error of the whole.
        let rays = (16384.0 * power.sqrt()).clamp(256.0, 16384.0) as usize;
        let is_open = |point| self.is_open(shooter, point);
        escaped(
            source,
            self.visibility,
            &self.backing,
            is_open,
            self.mesh.frame.extent(),
            (rays, seed),
        )
    }

    fn refine(
        &mut self,
        sampler: &Sampler,
        source: &Source,
        reached: &[bool],
        arrived: &mut Vec<Gather>,
        observer: &mut dyn Observer,
    ) -> Control {
        let mut candidates: Vec<u32> = self
            .mesh
            .leaves()
            .filter(|e| reached[self.mesh.elements[*e as usize].patch as usize])
            .collect();
        let (feelers, rays) = feelers(
            &self.mesh,
            &self.light,
            &self.backing,
            (sampler, source),
            reached,
        );
        self.rays += rays;
        while !candidates.is_empty() {
            let mut refinement = Refinement {
                mesh: &mut self.mesh,
                light: &mut self.light,
                arrived,
                sampler,
                source,
                options: &self.options,
                backing: &self.backing,
                feelers: &feelers,
                rays: 0,
            };
            candidates = refinement.pass(&candidates);
            self.rays += refinement.rays;
            self.mesh.integrate();
            let unshot = self.unshot();
            if observer.progress(&self.progress(unshot)) == Control::Stop {
                return Control::Stop;
            }
        }
        Control::Continue
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

    fn unshot_powers(&self) -> Vec<Power> {
        (0..self.mesh.patches.len())
            .into_par_iter()
            .map(|p| self.light.unshot_power(&self.mesh, p))
            .collect()
    }

    /// What all patches have unshot.
    pub(super) fn unshot(&self) -> Power {
        self.unshot_powers().iter().sum()
    }

    /// The light with nothing shot yet.
    pub(super) fn whole(&self) -> Light {
        Light {
            unshot: self.light.irradiance.clone(),
            ..Light::new(&self.mesh)
        }
    }

    pub(super) fn emitted(&self) -> Power {
        self.mesh
            .patches
            .iter()
            .map(|p| p.exitance.as_dvec3() * p.area)
            .sum()
    }

    pub(super) fn progress(&self, unshot: Power) -> Progress {
        let inner = self.mesh.elements.iter().filter(|e| !e.is_leaf()).count();
        Progress {
            shots: self.shots,
            meshing_shots: self.meshing_shots,
            elements: self.mesh.elements.len() - inner,
            vertices: self.mesh.vertices.len(),
            rays: self.rays,
            emitted: self.emitted() * self.square_metres,
            unshot: unshot * self.square_metres,
            elapsed: self.started.elapsed(),
        }
    }
}

/// The patch with the most unshot power; the first of equals.
fn select(powers: &[Power]) -> usize {
    let mut best = 0;
    for (patch, power) in powers.iter().enumerate() {
        if power.element_sum() > powers[best].element_sum() {
            best = patch;
        }
    }
    best
}
