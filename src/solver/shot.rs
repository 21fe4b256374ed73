//! One shot: it arrives at the vertices, the mesh is refined for it pass by pass, what it loses is measured.

use super::arrived::Arrived;
use super::course::{ALL, Shot, Stage};
use super::descent::Descent;
use super::escape::{Lost, Part, draw, escaped, rays_for};
use super::feelers::feelers;
use super::light::Sign;
use super::refine::Refinement;
use super::run::Solver;
use super::shoot::{Beam, Shooter, faces};
use super::source::{cells_of, source_from};
use crate::form_factor::{Cell, Sampler, Source};
use crate::radiometry::{Power, Spectrum};
use glam::DVec3;
use rayon::prelude::*;

impl<'a> Solver<'a> {
    /// Adds the contribution of one patch to all vertices that there are; the mesh is to be refined for it.
    pub(super) fn shoot_from(&mut self, shooter: usize, sign: Sign, power: f64) {
        let sampler = self.sampler();
        let from = (shooter, sign);
        let thresholds = &sampler.thresholds;
        let cells = cells_of(&self.mesh, &self.light, from, &self.options, thresholds);
        let source = source_from(&self.mesh, shooter, &cells);
        let reached = self.reached(&source);
        let shooting = Shooter::Patch(source);
        let beam = Beam {
            sampler: &sampler,
            shooter: &shooting,
            sign,
        };
        self.light.take(&self.mesh, shooter, sign);
        // One has work where the other waits.
        let ((arrived, rays), lost) = rayon::join(
            || self.arrivals(beam, shooter, &reached),
            || self.escape_of_shot(shooter, (power, sign), &shooting),
        );
        self.course.rays += rays;
        self.light.receive(arrived.irradiance.par_iter().copied());
        let elements = self.mesh.leaves();
        let patch_of = |e: u32| self.mesh.element(e).patch as usize;
        let candidates = elements.filter(|e| reached[patch_of(*e)]).collect();
        let (feelers, rays) = feelers(&self.mesh, &self.light, &self.behind, beam, &reached);
        self.course.rays += rays;
        self.course.stage = Stage::Refining(Shot {
            shooter: shooter as u32,
            sign,
            power,
            cells,
            candidates,
            feelers,
            arrived,
            lost: Some(lost),
            made: Some(shooting),
        });
    }

    /// One pass of refinement for what a shot gave.
    pub(super) fn refine(&mut self, mut shot: Shot) {
        let shooter = self.made(&mut shot, false);
        let sampler = self.sampler();
        self.pass(&mut shot, &sampler, &shooter);
        let is_done = shot.candidates.is_empty();
        shot.made = Some(shooter);
        if is_done {
            self.course.meshing_shots += 1;
            self.end_shot(shot);
        } else {
            self.course.stage = Stage::Refining(shot);
        }
    }

    /// Tests the candidates and splits those that fail; what that makes are the next ones. At a limit there are none.
    pub(super) fn pass(&mut self, shot: &mut Shot, sampler: &Sampler, shooter: &Shooter) {
        if let Some(end) = self.meshing_end() {
            self.course.meshing_ended = Some(end);
            shot.candidates.clear();
        }
        if shot.candidates.is_empty() {
            return;
        }
        let mut refinement = Refinement {
            beam: Beam {
                sampler,
                shooter,
                sign: shot.sign,
            },
            room: self.room(),
            mesh: &mut self.mesh,
            light: &mut self.light,
            arrived: &mut shot.arrived,
            options: &self.options,
            backing: &self.behind,
            feelers: &shot.feelers,
            rays: 0,
        };
        shot.candidates = refinement.pass(&shot.candidates);
        self.course.rays += refinement.rays;
    }

    /// What shoots; made anew from what is kept of it, if need be.
    pub(super) fn made(&mut self, shot: &mut Shot, settled: bool) -> Shooter {
        match (shot.made.take(), shot.shooter) {
            (Some(made), _) => made,
            (None, ALL) => self.radiating(&shot.cells, settled),
            (None, _) => shot.source(&self.mesh),
        }
    }

    pub(super) fn end_shot(&mut self, mut shot: Shot) {
        if let Some(shooter) = shot.made.take() {
            let lost = self.escape_of(&shot, &shooter);
            self.course.lost += lost;
            if let Shooter::Patch(source) = &shooter {
                self.close(&shot, source, &lost);
            }
            self.keep_tiling(shooter);
        }
        self.course.shots += 1;
    }

    /// What has arrived of a shot is brought to what was sent and not lost.
    fn close(&mut self, shot: &Shot, source: &Source, lost: &Lost) {
        let cells = source.finest().map(|(_, power)| power.as_dvec3());
        let sent = cells.sum::<Power>();
        let arrived = &shot.arrived.irradiance;
        let passage = self.passage((sent, shot.power, shot.sign), lost, arrived);
        if let Some(closing) = self.closing_of_shot(shot.shooter as usize, &passage) {
            let more = closing - Spectrum::ONE;
            self.light.receive(arrived.par_iter().map(|e| *e * more));
        }
    }

    /// What escapes of the shot that is under way.
    pub(super) fn escaping(&mut self) -> Lost {
        let mut shot = match std::mem::take(&mut self.course.stage) {
            Stage::Refining(shot) => shot,
            other => {
                self.course.stage = other;
                return Lost::default();
            }
        };
        let shooter = self.made(&mut shot, false);
        let lost = self.escape_of(&shot, &shooter);
        shot.made = Some(shooter);
        self.course.stage = Stage::Refining(shot);
        lost
    }

    /// … which is the same before and after the mesh is refined for it: the shooter does not light itself.
    fn escape_of(&self, shot: &Shot, source: &Shooter) -> Lost {
        let of = (shot.power, shot.sign);
        let found = || self.escape_of_shot(shot.shooter as usize, of, source);
        shot.lost.unwrap_or_else(found)
    }

    fn escape_of_shot(&self, shooter: usize, (power, sign): (f64, Sign), source: &Shooter) -> Lost {
        let seed = self.course.shots as u32;
        self.escape(shooter, source, power, seed) * f64::from(sign.factor())
    }

    pub(super) fn sampler(&self) -> Sampler<'a> {
        Sampler {
            visibility: self.visibility,
            extent: self.mesh.frame.extent(),
            formula: self.options.formula(),
            thresholds: self.options.source_thresholds(self.reference),
        }
    }

    /// The patches that can see any of the source, planes alone considered.
    pub(super) fn reached(&self, source: &Source) -> Vec<bool> {
        let extent = self.mesh.frame.extent();
        let patches = self.mesh.patches.iter();
        patches.map(|p| faces(&p, source, extent)).collect()
    }

    /// What a beam from a patch gives to each vertex of the patches that it reaches, and with how many rays: what an emitter sends is
    /// evaluated at all of them, anything else as far down as it is rough.
    pub(super) fn arrivals(&self, beam: Beam, shooter: usize, reached: &[bool]) -> (Arrived, u64) {
        let mesh = &self.mesh;
        let is_reached = |e: &u32| reached[mesh.elements.patch_of(*e) as usize];
        let elements: Vec<u32> = if mesh.patches.at(shooter).exitance != Spectrum::ZERO {
            mesh.leaves().filter(is_reached).collect()
        } else {
            let roots = mesh.patches.iter().flat_map(|p| p.roots.clone());
            roots.filter(is_reached).collect()
        };
        let mut arrived = Arrived::nothing(mesh);
        let mut descent = Descent::new(mesh, &self.light, beam, &self.options, &mut arrived);
        descent.descend(elements);
        let rays = descent.rays;
        arrived.continue_to_buried(mesh, 0);
        (arrived, rays)
    }

    /// What of a source's power, a fraction `power` of the emitted, leaves the scene.
    pub(super) fn escape(&self, shooter: usize, source: &Shooter, power: f64, seed: u32) -> Lost {
        let rays = rays_for(power) as usize;
        // An emitter emits wherever it is.
        let emits = |patch: usize| self.mesh.patches.at(patch).exitance != Spectrum::ZERO;
        let extent = self.mesh.frame.extent();
        match source {
            Shooter::Patch(source) => {
                let part = |(cell, power): (&Cell, Spectrum)| {
                    let cell = *cell;
                    Part {
                        patch: shooter as u32,
                        normal: source.normal(),
                        power,
                        at: move |s, t| cell.at(s, t),
                    }
                };
                let draws = draw(source.finest().map(part), rays, seed);
                let mut vertices = self.mesh.vertices_of(shooter as u32);
                let is_whole = !vertices.any(|v| self.mesh.buried[v as usize]) || emits(shooter);
                let is_open = |_, point| is_whole || self.is_open(shooter, point);
                escaped(draws, self.visibility, &self.behind, is_open, extent)
            }
            Shooter::All { tiling, .. } => {
                let draws = draw(tiling.parts(), rays, seed);
                let is_whole = self.patches_without_buried();
                let is_open = |patch: u32, point| {
                    let number = patch as usize;
                    is_whole[number] || emits(number) || self.is_open(number, point)
                };
                escaped(draws, self.visibility, &self.behind, is_open, extent)
            }
        }
    }

    /// Of each patch, whether all its vertices are open.
    fn patches_without_buried(&self) -> Vec<bool> {
        let mut is_whole = vec![true; self.mesh.patches.len()];
        let buried = self.mesh.buried.iter().zip(self.mesh.vertices.patches());
        for (_, patch) in buried.filter(|(is_buried, _)| **is_buried) {
            is_whole[patch as usize] = false;
        }
        is_whole
    }

    /// Whether the nearest vertex to a point of a patch is open.
    fn is_open(&self, patch: usize, point: DVec3) -> bool {
        let (u, v) = self.mesh.patches.at(patch).coordinates(point);
        let weighted = self
            .mesh
            .interpolate(self.mesh.leaf_at(patch as u32, u, v), point);
        let nearest = weighted.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        nearest.is_none_or(|(vertex, _)| !self.mesh.buried[*vertex as usize])
    }
}
