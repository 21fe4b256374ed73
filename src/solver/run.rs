//! The loop: select, shoot, refine, account, stop.

use super::audit::Audit;
use super::behind::Surfaces;
use super::burial::buried;
use super::course::{Bounce, Course, Stage};
use super::ledger::Ledger;
use super::light::Light;
use super::neighbourhoods::Neighbourhoods;
use super::observer::{Control, Observer, Progress};
use super::options::Options;
use super::outcome::{Outcome, StopReason};
use super::parts::{Laps, Parts};
use super::shoot::Shooter;
use super::sums::in_order;
use super::tiling::Tiling;
use super::volley::{Giver, side_by_side, strongest};
use super::wave::EARLY;
use crate::mesh::Mesh;
use crate::radiometry::Power;
use crate::scene::Scene;
use crate::visibility::{Triangles, Visibility};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// A solve in progress.
pub struct Solver<'a> {
    pub(super) mesh: Mesh,
    pub(super) light: Light,
    pub(super) course: Course,
    pub(super) visibility: &'a dyn Visibility,
    pub(super) options: Options,
    pub(super) behind: Surfaces<'a>,
    /// The tiles of a scene of many patches, while they do not shoot.
    pub(super) tiling: Option<Tiling>,
    /// … and while they do, or have done so for the last time.
    pub(super) radiated: Option<Shooter>,
    /// Where reflected light arrives in such a scene; known once the mesh is.
    pub(super) neighbourhoods: Option<Neighbourhoods>,
    /// Area of one square of the frame's unit, m².
    pub(super) square_metres: f64,
    pub(super) reference: f64,
    /// What all patches emit, W times the square of the frame's scale.
    emitted: Power,
    /// What was unshot, by sign, when that was last counted.
    unshot: Option<[Power; 2]>,
    /// What the solve took before it was taken up again.
    spent: Duration,
    started: Instant,
    laps: Laps,
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
        scene: &'a Scene,
        mut mesh: Mesh,
        visibility: &'a dyn Visibility,
        options: Options,
    ) -> Self {
        mesh.weld_if(options.clusters(&mesh));
        let behind = Surfaces::new(scene, &mesh);
        mesh.finish_topology(0, &buried(&mesh, visibility, &behind, 0));
        let light = Light::new(&mesh);
        let state = (mesh, light, Course::default());
        Self::resume(scene, state, visibility, options, Duration::ZERO)
    }

    /// Takes up a solve of `scene` where an [`Outcome`] has left it; `spent` is what counts against the time limit already.
    pub fn resume(
        scene: &'a Scene,
        (mut mesh, light, course): (Mesh, Light, Course),
        visibility: &'a dyn Visibility,
        options: Options,
        spent: Duration,
    ) -> Self {
        mesh.weld_if(options.clusters(&mesh));
        let of_patch = |number: usize| {
            let patch = mesh.patches.at(number);
            let brightest = f64::from(patch.exitance.max_element()) * patch.area;
            (
                patch.area,
                brightest,
                patch.exitance.as_dvec3() * patch.area,
            )
        };
        let (mut area, mut brightest, mut emitted) = (0.0, 0.0, Power::ZERO);
        in_order(mesh.patches.len(), of_patch, |of| {
            area += of.0;
            brightest += of.1;
            emitted += of.2;
        });
        Self {
            behind: Surfaces::new(scene, &mesh),
            tiling: None,
            radiated: None,
            neighbourhoods: None,
            square_metres: (scene.metres_per_unit / mesh.frame.scale()).powi(2),
            emitted,
            reference: if area > 0.0 { brightest / area } else { 0.0 },
            mesh,
            light,
            course,
            visibility,
            options,
            unshot: None,
            spent,
            started: Instant::now(),
            laps: Laps::new(),
        }
    }

    /// Goes on until there is a reason to stop; keeps `observer` informed.
    pub fn run(mut self, observer: &mut dyn Observer) -> Outcome {
        let stop_reason = self.advance(observer);
        let audit = match stop_reason {
            StopReason::NoEmitter | StopReason::Interrupted => None,
            _ => self.audit(),
        };
        self.laps.lap(|parts| &mut parts.estimating);
        self.outcome(stop_reason, audit)
    }

    /// Leaves the solve as it is.
    pub fn leave(self) -> Outcome {
        self.outcome(StopReason::Interrupted, None)
    }

    fn outcome(mut self, stop_reason: StopReason, audit: Option<Audit>) -> Outcome {
        let mut lost = self.course.lost;
        lost += self.escaping();
        let ledger = Ledger::balance(&self.mesh, &self.light, &lost, self.square_metres);
        Outcome {
            elapsed: self.elapsed(),
            parts: self.laps.parts,
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
            let unshot = self.count_unshot();
            if observer.progress(&self.progress(unshot)) == Control::Stop {
                return StopReason::Interrupted;
            }
            let elapsed = self.elapsed();
            if self.options.time_limit.is_some_and(|most| elapsed >= most) {
                return StopReason::TimeLimit;
            }
            self.laps.lap(|parts| &mut parts.selecting);
            let part = part(&self.course.stage);
            match std::mem::take(&mut self.course.stage) {
                Stage::Shooting => {
                    if let Some(reason) = self.shoot(unshot, None) {
                        return reason;
                    }
                }
                Stage::Bounced(bounce) => {
                    if let Some(reason) = self.shoot(unshot, Some(bounce)) {
                        self.course.stage = Stage::Bounced(bounce);
                        return reason;
                    }
                }
                Stage::Waving(wave) => self.wave(wave),
                Stage::Refining(shot) => self.refine(shot),
                Stage::Settling(shot) => self.settle(shot),
                Stage::Gathering(so_far) => self.gather(so_far),
                Stage::Finished => {
                    self.course.stage = Stage::Finished;
                    return StopReason::Converged;
                }
            }
            self.laps.lap(part);
        }
    }

    /// One shot, the gathering if enough of what is `unshot`, by sign, has been shot, or a reason to do neither; after a `bounce` the
    /// gathering may begin earlier.
    fn shoot(&mut self, unshot: [Power; 2], bounce: Option<Bounce>) -> Option<StopReason> {
        let emitted = self.emitted().element_sum();
        let early = match bounce {
            Some(_) if self.options.regather && self.is_clustered() => EARLY,
            _ => 1.0,
        };
        let all: Power = unshot.iter().sum();
        if all.element_sum() <= early * self.options.tolerance * emitted {
            match (self.options.regather, self.is_clustered()) {
                (false, _) => self.course.stage = Stage::Finished,
                (true, false) => self.course.stage = Stage::Gathering(self.gathering()),
                (true, true) => self.begin_gathering(bounce),
            }
            return None;
        }
        let shots = self.course.shots;
        if self.options.max_shots.is_some_and(|most| shots >= most) {
            return Some(StopReason::MaxShots);
        }
        if self.is_clustered() {
            self.begin_wave(unshot, bounce);
            return None;
        }
        let left = self.options.max_shots.map_or(u64::MAX, |most| most - shots);
        let most = usize::try_from(left).unwrap_or(usize::MAX);
        let givers = strongest(&self.unshot_powers(), most.min(side_by_side(&self.mesh)));
        let untested = self.untested(&givers);
        self.laps.lap(|parts| &mut parts.selecting);
        if untested == 0 {
            let Giver { patch, sign, power } = givers[0];
            self.shoot_from(patch, sign, power / emitted);
        } else {
            self.volley(&givers[..untested]);
        }
        None
    }

    /// Whether a shot of such a fraction of the emitted power tests the mesh.
    pub(super) fn meshes(&self, power: f64) -> bool {
        power >= self.options.meshing_power && self.course.meshing_ended.is_none()
    }

    /// By patch, first the positive, then the negative.
    pub(super) fn unshot_powers(&self) -> Vec<Power> {
        let of_patch = |patch| self.light.unshot_by_sign(&self.mesh, patch);
        let patches = (0..self.mesh.patches.len()).into_par_iter();
        patches.with_min_len(32).flat_map_iter(of_patch).collect()
    }

    /// What all patches have unshot: the positive, and the negative.
    pub(super) fn unshot_by_sign(&self) -> [Power; 2] {
        let mut unshot = [Power::ZERO; 2];
        let of_patch = |patch| self.light.unshot_by_sign(&self.mesh, patch);
        in_order(self.mesh.patches.len(), of_patch, |[positive, negative]| {
            unshot[0] += positive;
            unshot[1] += negative;
        });
        unshot
    }

    /// What all patches have unshot, the negative subtracted.
    pub(super) fn unshot(&self) -> Power {
        let [positive, negative] = self.unshot_by_sign();
        positive - negative
    }

    pub(super) fn emitted(&self) -> Power {
        self.emitted
    }

    /// What is unshot, by sign.
    fn count_unshot(&mut self) -> [Power; 2] {
        // Until a wave, or all light, has arrived everywhere, the light is what it was.
        let stays = matches!(self.course.stage, Stage::Waving(_) | Stage::Gathering(_));
        let known = self.unshot.filter(|_| stays);
        let unshot = known.unwrap_or_else(|| self.unshot_by_sign());
        self.unshot = Some(unshot);
        unshot
    }

    fn progress(&self, unshot: [Power; 2]) -> Progress {
        Progress {
            phase: self.course.phase(&self.mesh),
            shots: self.course.shots,
            meshing_shots: self.course.meshing_shots,
            elements: self.mesh.leaf_count(),
            vertices: self.mesh.vertices.len(),
            rays: self.course.rays,
            emitted: self.emitted() * self.square_metres,
            unshot: unshot.iter().sum::<Power>() * self.square_metres,
            elapsed: self.elapsed(),
        }
    }

    fn elapsed(&self) -> Duration {
        self.spent + self.started.elapsed()
    }
}

/// What a stage counts as.
fn part(stage: &Stage) -> fn(&mut Parts) -> &mut f64 {
    match stage {
        Stage::Refining(_) | Stage::Settling(_) => |parts| &mut parts.refining,
        Stage::Gathering(_) => |parts| &mut parts.gathering,
        Stage::Waving(wave) if wave.is_whole() => |parts| &mut parts.gathering,
        Stage::Waving(_) | Stage::Shooting | Stage::Bounced(_) | Stage::Finished => {
            |parts| &mut parts.shooting
        }
    }
}
