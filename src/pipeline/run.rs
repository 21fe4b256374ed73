//! A solve that can be left and taken up again.

use super::report::{blank, take_in};
use super::warnings::{forget_the_end, warn_at_end};
use super::{Settings, SolveError};
use crate::mesh::{Mesh, Patch};
use crate::radiometry::{Spectrum, exitance_from_radiance};
use crate::scene::{Scene, Surface};
use crate::solution::{Continuation, Report, Solution};
use crate::solver::{
    Estimate, Light, Observer, Options, Outcome, Solver, StopReason, memory_for, occluders,
};
use crate::threads::pool;
use crate::visibility::{Clocked, EngineChoice, Visibility, VisibilityError, build_within};
use crate::words::counted;
use rayon::ThreadPool;
use std::fmt;
use std::time::{Duration, Instant};

/// A solve in progress, or one that has ended. An observer that stops it does not end it: [`Run::go`] goes on where it was, in this
/// process or, from the solution's file, in another, and comes to the same bits.
pub struct Run {
    /// There, but while the solver works on it.
    solution: Option<Solution>,
    /// The result of the round before, while a stricter one is under way.
    complete: Option<Solution>,
    visibility: Box<dyn Visibility>,
    pool: ThreadPool,
    time_limit: Option<Duration>,
    /// What counts against the time limit.
    spent: Duration,
    /// Memory that is not for the solve, bytes.
    reserved: u64,
}

impl fmt::Debug for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut run = f.debug_struct("Run");
        run.field("engine", &self.visibility.info());
        run.field("spent", &self.spent).finish_non_exhaustive()
    }
}

impl Run {
    /// Meshes the scene and builds the engine; nothing is shot yet.
    ///
    /// # Errors
    /// Those of [`solve`](super::solve).
    pub fn new(scene: Scene, settings: Settings) -> Result<Self, SolveError> {
        let started = Instant::now();
        scene.check().map_err(SolveError::Scene)?;
        let target = settings.target.as_ref().map(|target| target.report());
        let options = match &target {
            Some(target) => target.options()?,
            None => settings.options.clone(),
        };
        options.check().map_err(SolveError::Option)?;
        let pool = pool(settings.threads)?;
        let threads = pool.current_num_threads();
        let mesh = pool.install(|| Mesh::new(&scene, options.limits));
        let (visibility, engine) = engine(&scene, &mesh, (settings.engine, threads), &options)?;
        check_memory(&mesh, visibility.as_ref(), &options, 0)?;
        let time_limit = options.time_limit;
        let mut report = blank(&scene, &mesh, visibility.as_ref(), options, threads);
        report.target = target;
        let mut run = Self::idle(visibility, pool, time_limit);
        run.begin(scene, mesh, report);
        let seconds = &mut run.report_mut().seconds;
        seconds.engine = engine;
        seconds.build = started.elapsed().as_secs_f64();
        Ok(run)
    }

    /// Takes up a solve from its solution, with settings that may have become stricter; without a target it has none from now on.
    pub fn resume(mut solution: Solution, settings: Settings) -> Result<Self, SolveError> {
        let started = Instant::now();
        let Some(continuation) = &mut solution.continuation else {
            return Err(SolveError::NotKept);
        };
        let report = &mut solution.report;
        forget_the_end(report);
        let mut options = settings.options;
        let known = report.target.take();
        if let Some(target) = &settings.target {
            let mut fresh = target.report();
            fresh.inherited = true;
            let same =
                known.filter(|known| known.n_rms == fresh.n_rms && known.fixed == fresh.fixed);
            let target = same.unwrap_or(fresh);
            options = target.options()?;
            report.target = Some(target);
        }
        options.check().map_err(SolveError::Option)?;
        if differs(&options, &report.options) {
            continuation.course.reopen();
            note(report, "other options");
        }
        let pool = pool(settings.threads)?;
        let threads = pool.current_num_threads();
        let choice = (settings.engine, threads);
        let (visibility, seconds) = engine(&continuation.scene, &solution.mesh, choice, &options)?;
        report.seconds.engine += seconds;
        let time_limit = options.time_limit;
        let now = blank(
            &continuation.scene,
            &solution.mesh,
            visibility.as_ref(),
            options,
            threads,
        );
        if report.engine != now.engine {
            note(report, "another engine");
        }
        (report.engine, report.threads) = (now.engine, now.threads);
        report.options = now.options;
        report.seconds.build += started.elapsed().as_secs_f64();
        Ok(Self {
            solution: Some(solution),
            ..Self::idle(visibility, pool, time_limit)
        })
    }

    /// Takes the result of the round before the one that is taken up, if `earlier` is that: until this one is complete, it is what
    /// [`Run::finish`] gives.
    pub fn fall_back_on(&mut self, mut earlier: Solution) {
        let is_complete = |of: &Solution| {
            let kept = of.continuation.as_ref();
            kept.is_some_and(|kept| kept.course.is_finished())
        };
        let now = self.solution();
        let is_next = now.report.target.is_some() && now.report.target == earlier.report.target;
        if is_next && is_complete(&earlier) && !is_complete(now) {
            forget_the_end(&mut earlier.report);
            self.complete = Some(earlier);
        }
    }

    /// Has nothing to solve yet.
    fn idle(
        visibility: Box<dyn Visibility>,
        pool: ThreadPool,
        time_limit: Option<Duration>,
    ) -> Self {
        Self {
            solution: None,
            complete: None,
            visibility,
            pool,
            time_limit,
            spent: Duration::ZERO,
            reserved: 0,
        }
    }

    /// Keeps so many bytes of the memory limit for pictures.
    ///
    /// # Errors
    /// When there is not room for them and the coarsest mesh. One that has been refined stays as it is.
    pub fn reserve(&mut self, pictures: u64) -> Result<(), SolveError> {
        let solution = self.solution();
        let options = &solution.report.options;
        if solution.report.shots == 0 {
            check_memory(&solution.mesh, self.visibility.as_ref(), options, pictures)?;
        }
        self.reserved = pictures;
        Ok(())
    }

    /// Goes on until there is a reason to stop.
    pub fn go(&mut self, observer: &mut dyn Observer) -> Result<StopReason, SolveError> {
        loop {
            let reason = self.advance(observer);
            if reason != StopReason::Converged || !self.needs_another_round() {
                return Ok(reason);
            }
            self.next_round()?;
        }
    }

    /// The solution so far.
    pub fn solution(&self) -> &Solution {
        self.solution.as_ref().expect(KEPT)
    }

    /// The report, for what the caller knows: files, times.
    pub fn report_mut(&mut self) -> &mut Report {
        &mut self.solution.as_mut().expect(KEPT).report
    }

    /// The state of a round that has not ended and that [`Run::finish`] drops for the result of the one before.
    pub fn set_aside(&self) -> Option<&Solution> {
        let last = self.solution();
        let ended = last.report.stop_reason == StopReason::Converged;
        (self.complete.is_some() && !ended).then_some(last)
    }

    /// The solution. Of several rounds on the way to a target, the last that is complete.
    pub fn finish(self) -> Solution {
        let last = self.solution.expect(KEPT);
        let mut solution = match self.complete {
            Some(mut complete) if last.report.stop_reason != StopReason::Converged => {
                complete.report.stop_reason = last.report.stop_reason;
                complete
            }
            _ => last,
        };
        warn_at_end(&mut solution.report, &solution.mesh);
        solution
    }

    /// Replaces what the surfaces emit by what they emit in `scene`, which must be the same in all else. What is more or less
    /// than before is shot as positive or negative light.
    pub fn relight(&mut self, scene: Scene) -> Result<(), SolveError> {
        let solution = self.solution.as_mut().expect(KEPT);
        let Some(known) = &mut solution.continuation else {
            return Err(SolveError::NotKept);
        };
        scene.check().map_err(SolveError::Scene)?;
        known
            .scene
            .differs_but_in_emission(&scene)
            .map_err(SolveError::OtherScene)?;
        check_emitters(&scene, &solution.mesh)?;
        let exitance = |patch: &Patch| {
            let surface = &scene.surfaces[patch.surface as usize];
            let material = &scene.materials[surface.material as usize];
            if patch.back {
                patch.exitance
            } else {
                exitance_from_radiance(material.emitted_radiance)
            }
        };
        let unshot = solution.light.exitance_unshot.iter_mut();
        for (unshot, patch) in unshot.zip(solution.mesh.patches.iter()) {
            *unshot += exitance(&patch) - patch.exitance;
        }
        let patches = &mut solution.mesh.patches;
        patches.relight(exitance);
        if patches.iter().all(|p| p.exitance == Spectrum::ZERO) {
            solution.light = Light::new(&solution.mesh);
            known.course.go_dark();
        } else {
            known.course.reopen();
        }
        if known.scene.materials != scene.materials {
            note(&mut solution.report, "other emitters");
        }
        known.scene = scene;
        Ok(())
    }

    /// Puts a solve with nothing shot in place.
    fn begin(&mut self, scene: Scene, mesh: Mesh, report: Report) {
        let options = report.options.clone();
        let visibility = self.visibility.as_ref();
        let outcome = self
            .pool
            .install(|| Solver::new(&scene, mesh, visibility, options).leave());
        self.keep(scene, report, outcome);
    }

    fn keep(&mut self, scene: Scene, mut report: Report, outcome: Outcome) {
        let (mesh, light, course) = take_in(&mut report, outcome);
        self.solution = Some(Solution {
            report,
            cameras: scene.cameras.clone(),
            metres_per_unit: scene.metres_per_unit,
            mesh,
            light,
            continuation: Some(Continuation { scene, course }),
        });
    }

    fn advance(&mut self, observer: &mut dyn Observer) -> StopReason {
        let started = Instant::now();
        let solution = self.solution.take().expect(KEPT);
        let Continuation { scene, course } = solution.continuation.expect(KEPT);
        let mut report = solution.report;
        let mut options = report.options.clone();
        options.time_limit = self.time_limit;
        let for_the_solve = |limit: u64| limit.saturating_sub(self.reserved);
        options.memory_limit = options.memory_limit.map(for_the_solve);
        let state = (solution.mesh, solution.light, course);
        let clocked = Clocked::new(self.visibility.as_ref());
        let spent = self.spent;
        let mut outcome = self
            .pool
            .install(|| Solver::resume(&scene, state, &clocked, options, spent).run(observer));
        outcome.parts.rays = clocked.spent().as_secs_f64();
        self.spent = outcome.elapsed;
        if let Some(audit) = outcome.audit {
            observer.estimated(&Estimate {
                shots: outcome.course.shots,
                elapsed: outcome.elapsed,
                n_rms: audit.n_rms,
            });
        }
        report.seconds.solve += started.elapsed().as_secs_f64();
        let reason = outcome.stop_reason;
        self.keep(scene, report, outcome);
        reason
    }

    fn needs_another_round(&mut self) -> bool {
        let report = &mut self.solution.as_mut().expect(KEPT).report;
        let estimate = report.audit.map_or(0.0, |audit| audit.n_rms);
        let target = report.target.as_mut();
        target.is_some_and(|target| target.needs_another(estimate))
    }

    /// Begins anew with the options of the next round.
    fn next_round(&mut self) -> Result<(), SolveError> {
        let complete = self.solution();
        let scene = complete.continuation.as_ref().expect(KEPT).scene.clone();
        let mut report = complete.report.clone();
        if let Some(target) = &report.target {
            report.options = target.options()?;
        }
        let limits = report.options.limits;
        let mesh = self.pool.install(|| Mesh::new(&scene, limits));
        self.complete = self.solution.take();
        self.begin(scene, mesh, report);
        Ok(())
    }
}

/// The engine of a choice, for so many threads, with what of a scene can be in the way of light, and the seconds that building it took.
fn engine(
    scene: &Scene,
    mesh: &Mesh,
    (choice, threads): (EngineChoice, usize),
    options: &Options,
) -> Result<(Box<dyn Visibility>, f64), VisibilityError> {
    let triangles = occluders(scene, mesh);
    let begun = Instant::now();
    let visibility = build_within(choice, &triangles, threads, options.memory_limit)?;
    Ok((visibility, begun.elapsed().as_secs_f64()))
}

/// Refuses a mesh that exceeds the limit as it is.
fn check_memory(
    mesh: &Mesh,
    visibility: &dyn Visibility,
    options: &Options,
    pictures: u64,
) -> Result<(), SolveError> {
    let Some(limit) = options.memory_limit else {
        return Ok(());
    };
    let needed = memory_for(mesh, options, visibility.info().bytes) + pictures;
    if needed <= limit {
        return Ok(());
    }
    Err(SolveError::TooLarge {
        elements: mesh.leaves().count(),
        pictures,
        needed,
        limit,
    })
}

/// Why there is always a solution, and one that can go on.
const KEPT: &str = "a run keeps its solution and what it takes to go on";

/// Refuses emitters that the mesh has no patches of: they did not emit when it was made, and lay in other surfaces.
fn check_emitters(scene: &Scene, mesh: &Mesh) -> Result<(), SolveError> {
    let emits = |surface: &Surface| scene.materials[surface.material as usize].emits();
    match mesh.missing(scene, emits) {
        0 => Ok(()),
        lost => Err(SolveError::OtherScene(format!(
            "{lost} of them lie in the plane of other surfaces and were left out when nothing shone there"
        ))),
    }
}

/// Notes what a solve goes on with, if it is not what it began with.
fn note(report: &mut Report, with: &str) {
    if report.shots > 0 {
        let after = counted(report.shots, "shot", "shots");
        report.resumed_with.push(format!("{with} after {after}"));
    }
}

/// Whether there may be something to do where all was done under options `before`.
fn differs(now: &Options, before: &Options) -> bool {
    let method = |of: &Options| Options {
        max_shots: None,
        time_limit: None,
        audit_points: 0,
        ..of.clone()
    };
    method(now) != method(before)
}
