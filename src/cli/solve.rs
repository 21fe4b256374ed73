//! `radiosity solve`.

use super::CliError;
use super::error::Code;
use super::flags::SolveFlags;
use super::pictures::draw;
use super::progress::{Bar, catch_interrupts};
use crate::output::{SummaryRow, summary_table, write_atomically, write_ply};
use crate::radiometry::radiance_from_radiosity;
use crate::render::{RenderOptions, Tone};
use crate::scene::Scene;
use crate::solution::Solution;
use crate::solver::StopReason;
use crate::visibility::EngineChoice;
use crate::{Settings, solve, solve_to_error};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The solution file that the other commands read.
pub(super) const SOLUTION: &str = "solution.rad";

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A folder with a scene.toml, a .toml, or an .obj
    scene: PathBuf,
    /// Folder for the results; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Who traces the rays: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    engine: EngineChoice,
    /// Threads; 0 for as many as the machine has
    #[arg(long, default_value_t = 0, value_name = "N")]
    threads: usize,
    /// Leave the pictures out
    #[arg(long)]
    no_pictures: bool,
    #[command(flatten)]
    flags: SolveFlags,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let started = Instant::now();
    let scene = Scene::load(&arguments.scene)?;
    let load = started.elapsed().as_secs_f64();
    warn(&scene);
    prepare(&arguments.output)?;
    catch_interrupts();
    let settings = Settings {
        options: arguments.flags.options(),
        engine: arguments.engine,
        threads: arguments.threads,
    };
    let mut bar = Bar::new(settings.options.tolerance);
    let flags = &arguments.flags;
    let mut solution = match flags.target_error {
        None => solve(&scene, &settings, &mut bar)?,
        Some(target) => {
            let adjust = |options| flags.over(options);
            solve_to_error(&scene, &settings, target, &adjust, &mut bar)?
        }
    };
    bar.clear();
    for warning in &solution.report.warnings[scene.warnings.len()..] {
        eprintln!("warning: {warning}");
    }
    if let Some(target) = solution.report.target.filter(|t| !t.reached) {
        eprintln!(
            "warning: the error of {}% was not reached in {} solves",
            100.0 * target.n_rms,
            target.rounds
        );
    }
    solution.report.seconds.load = load;
    write(&mut solution, arguments)?;
    print!("{}", summary(&solution, started.elapsed().as_secs_f64()));
    match solution.report.stop_reason {
        StopReason::Interrupted => Ok(Code::Interrupted),
        _ => Ok(Code::Success),
    }
}

fn warn(scene: &Scene) {
    for warning in &scene.warnings {
        eprintln!("warning: {warning}");
    }
    if !scene.materials.iter().any(|m| m.emits()) {
        eprintln!("warning: no surface emits light; everything will be black");
    }
}

/// Makes the folder and finds out before the solve whether it can be written to.
fn prepare(folder: &Path) -> Result<(), CliError> {
    let refuse = |error: std::io::Error| {
        CliError::System(format!("cannot write to {}: {error}", folder.display()))
    };
    std::fs::create_dir_all(folder).map_err(refuse)?;
    let probe = folder.join(".radiosity-writable");
    std::fs::write(&probe, []).map_err(refuse)?;
    std::fs::remove_file(&probe).map_err(refuse)
}

fn write(solution: &mut Solution, arguments: &Arguments) -> Result<(), CliError> {
    let started = Instant::now();
    let folder = &arguments.output;
    write_atomically(&folder.join(SOLUTION), |out| solution.write(out))?;
    let lit = solution.lit_mesh();
    let tone = Tone::for_mesh(&lit);
    let errors = solution.triangle_errors(&lit);
    write_ply(&folder.join("solution.ply"), &lit, errors.as_deref(), |v| {
        tone.colour(radiance_from_radiosity(v.radiosity))
    })?;
    if !arguments.no_pictures {
        for (number, camera) in solution.cameras.iter().enumerate() {
            // The first camera's pictures lie in the folder itself, those of others in a folder of their name.
            let into = if number == 0 {
                folder.clone()
            } else {
                folder.join(&camera.name)
            };
            draw(
                &lit,
                camera,
                &RenderOptions::standard(),
                arguments.engine,
                arguments.threads,
                &into,
            )?;
        }
    }
    solution.report.seconds.write = started.elapsed().as_secs_f64();
    let report =
        serde_json::to_vec_pretty(&solution.report).map_err(|e| CliError::System(e.to_string()))?;
    write_atomically(&folder.join("report.json"), |out| out.write_all(&report))?;
    Ok(())
}

/// The paper's Table 1 for this solve, and what the table leaves out.
fn summary(solution: &Solution, seconds: f64) -> String {
    let report = &solution.report;
    let row = SummaryRow {
        scene: report.scene.clone(),
        input_patches: report.input_patches,
        shots: report.shots as usize,
        quadtree_depth: report.max_depth,
        meshing_shots: report.meshing_shots as usize,
        elements: report.elements,
        seconds,
    };
    let power = &report.power;
    let percent = |part: f64| {
        if power.emitted > 0.0 {
            100.0 * part / power.emitted
        } else {
            0.0
        }
    };
    let why = match report.stop_reason {
        StopReason::Converged => "converged",
        StopReason::MaxShots => "stopped at the largest number of shots",
        StopReason::TimeLimit => "stopped at the time limit",
        StopReason::Interrupted => "interrupted",
        StopReason::NoEmitter => "nothing emits",
    };
    let estimate = report.audit.map_or(String::new(), |audit| {
        format!(
            "estimated error of the irradiance: {:.2}% nRMS, of it {:+.2}% bias, at {} points\n",
            100.0 * audit.n_rms,
            100.0 * audit.bias,
            audit.points
        )
    });
    format!(
        "{}{why}: {:.4} W emitted = {:.2}% absorbed + {:.2}% escaped + {:.2}% unshot + {:.2}% residual\n\
         {estimate}{} vertices, {:.2} million rays at {:.1} million/s by {} {} ({}, {} wide), {} threads\n",
        summary_table(&[row]),
        power.emitted,
        percent(power.absorbed),
        percent(power.escaped),
        percent(power.unshot),
        percent(power.residual),
        report.vertices,
        report.rays as f64 / 1e6,
        report.rays as f64 / 1e6 / report.seconds.solve.max(1e-9),
        report.engine.name,
        report.engine.version,
        report.engine.isa,
        report.engine.packet_width,
        report.threads,
    )
}
