//! `radiosity resume`.

use super::CliError;
use super::error::Code;
use super::flags::SolveFlags;
use super::memory::hold_less;
use super::progress::catch_interrupts;
use super::results::{CHECKPOINT, SOLUTION, folder_of, inputs, spare};
use super::say;
use super::session::Session;
use super::solve::{How, engine_of, prepare, warn_of_another_engine};
use crate::scene::Scene;
use crate::solution::Solution;
use crate::{Run, Settings, Target};
use clap::Args;
use std::path::{Path, PathBuf, absolute};
use std::time::Instant;

#[derive(Debug, Args)]
#[command(
    mut_arg("preset", |preset| preset.help(PRESET)),
    mut_arg("engine", |engine| engine.help(ENGINE)),
)]
pub(super) struct Arguments {
    /// Folder of a solve: goes on from its checkpoint if there is one, else from its solution; or one of these files
    folder: PathBuf,
    /// The scene with other emitters, and the same in all else: only the difference is shot
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Folder for the results [default: the same]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    how: How,
    #[command(flatten)]
    flags: SolveFlags,
}

/// What is taken where nothing is said, which is not what `solve` takes.
const PRESET: &str = "Start from draft, standard or accurate rather than from the solve's own options, or its target";
const ENGINE: &str =
    "Who traces the rays: auto, embree, obvhs or brute-force; if not given, who did so far";

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let started = Instant::now();
    let watching = arguments.how.begin()?;
    let file = latest(&arguments.folder)?;
    let solution = Solution::read(&file)?;
    hold_less(solution.mesh.patches.len());
    let scene = arguments.scene.as_deref().map(Scene::load).transpose()?;
    let output = arguments.output.clone();
    let output = &output.unwrap_or_else(|| folder_of(&arguments.folder));
    let scenes = solution.report.scene_file.iter().chain(&arguments.scene);
    let files: Vec<PathBuf> = scenes.flat_map(|file| inputs(file)).collect();
    spare(&files, output, &arguments.how, &solution.cameras)?;
    let settings = settings(&solution, arguments)?;
    prepare(output)?;
    catch_interrupts();
    let before = solution.report.clone();
    let mut run = Run::resume(solution, settings)?;
    if file.ends_with(CHECKPOINT) && scene.is_none() {
        // Where there is none, or none that can be read, there is nothing to lose.
        let earlier = Solution::read(&file.with_file_name(SOLUTION));
        let _ = earlier.map(|earlier| run.fall_back_on(earlier));
    }
    let known_warnings = run.solution().report.warnings.len();
    if let Some(scene) = scene {
        say::warnings(&scene.warnings);
        run.relight(scene)?;
        let file = arguments.scene.as_deref();
        run.report_mut().scene_file = file.and_then(|file| absolute(file).ok());
    }
    let now = run.report_mut();
    now.seconds.load += started.elapsed().as_secs_f64();
    if now.engine != before.engine {
        warn_of_another_engine(&before, now);
    }
    let session = Session {
        output,
        how: &arguments.how,
        started,
        known_warnings,
    };
    session.complete(run, watching)
}

/// The checkpoint of a folder, or the solution where there is none; a file is what it is.
fn latest(folder: &Path) -> Result<PathBuf, CliError> {
    if folder.is_file() {
        return Ok(folder.to_path_buf());
    }
    let found = [CHECKPOINT, SOLUTION].map(|name| folder.join(name));
    found.into_iter().find(|path| path.is_file()).ok_or_else(|| {
        CliError::Input(format!(
            "{} holds neither {CHECKPOINT} nor {SOLUTION}; expected the folder of a `radiosity solve`",
            folder.display()
        ))
    })
}

/// The solve's own settings, but for what the flags say.
fn settings(solution: &Solution, arguments: &Arguments) -> Result<Settings, CliError> {
    let (report, flags) = (&solution.report, &arguments.flags);
    // Who names a preset wants its thresholds, not those that are chosen for a target.
    let target = report.target.as_ref().filter(|_| !flags.names_preset());
    let known = target.map(|target| {
        let mut fixed = target.fixed.clone();
        fixed.extend(flags.changes()?);
        let n_rms = target.n_rms;
        Ok::<_, CliError>(Target { n_rms, fixed })
    });
    let engine = match arguments.how.engine {
        Some(engine) => engine,
        None => engine_of(report)?,
    };
    Ok(Settings {
        options: flags.over(report.options.clone())?,
        target: flags.with_estimate(flags.target()?.or(known.transpose()?))?,
        engine,
        threads: arguments.how.threads,
    })
}
