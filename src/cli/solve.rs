//! `radiosity solve`.

use super::CliError;
use super::error::Code;
use super::flags::SolveFlags;
use super::memory::{load_scene, peak_memory};
use super::meshes::{Exporter, Formats};
use super::pictures::draw;
use super::progress::{Look, catch_interrupts, is_interrupted};
use super::results::{PAGE, REPORT, SOLUTION, inputs, mesh_file, picture_folder, spare};
use super::say;
use super::session::{Session, Watching};
use super::values::{interval, threads};
use crate::output::{
    History, Page, SummaryRow, remove_abandoned, summary_table, write_atomically, write_html,
};
use crate::radiometry::WHITE_EFFICACY;
use crate::render::Tone;
use crate::solution::{LitMesh, Report, Solution};
use crate::solver::StopReason;
use crate::visibility::EngineChoice;
use crate::words::counted;
use crate::{Run, Settings};
use clap::Args;
use rayon::prelude::*;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A folder with a scene.toml, a .toml, or an .obj, .glb, .gltf or .ply; with --from, the report's scene if left out
    #[arg(required_unless_present = "from")]
    scene: Option<PathBuf>,
    /// Take engine and options from the report.json of another solve, to repeat it
    #[arg(long, value_name = "REPORT", conflicts_with_all = ["preset", "target_error"])]
    from: Option<PathBuf>,
    /// Folder for the results; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    how: How,
    #[command(flatten)]
    flags: SolveFlags,
}

/// How a solve is done, whatever its options.
#[derive(Debug, Args)]
pub(super) struct How {
    /// Who traces the rays: auto (the default), embree, obvhs or brute-force
    #[arg(long, value_name = "ENGINE")]
    pub engine: Option<EngineChoice>,
    /// Threads; 0 for as many as the machine has
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    pub threads: usize,
    /// Leave the pictures out
    #[arg(long)]
    pub no_pictures: bool,
    /// Lit meshes to write beside the solution: any of glb, obj, ply and vtu, or none
    #[arg(long, value_name = "LIST", default_value = "ply,glb,vtu")]
    pub formats: Formats,
    /// Leave report.html out
    #[arg(long)]
    pub no_html: bool,
    /// How progress is shown
    #[arg(long, value_enum, value_name = "LOOK", default_value = "auto")]
    pub progress: Look,
    /// Show the solution in a window while it converges (feature `viewer`); closing it lets the solve go on, Ctrl-C ends it
    #[arg(long)]
    watch: bool,
    /// Say where the time went; report.json always does
    #[arg(long)]
    pub profile: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
    /// Save the state at the start and then at these intervals (60 s if no TIME is given), for `radiosity resume`
    #[arg(long, value_name = "TIME", value_parser = interval, num_args = 0..=1, default_missing_value = "60")]
    pub checkpoint: Option<Duration>,
}

impl How {
    /// Takes note of `--quiet`, and finds out whether there can be a window where one is asked for.
    pub(super) fn begin(&self) -> Result<Option<Watching>, CliError> {
        if self.quiet {
            say::be_quiet();
        }
        self.watch.then(Watching::new).transpose()
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let started = Instant::now();
    let watching = arguments.how.begin()?;
    let model = arguments.from.as_deref().map(read_report).transpose()?;
    let flags = &arguments.flags;
    let target = flags.target()?;
    let file = arguments.scene.as_ref();
    let file = file.or(model.as_ref().and_then(|m| m.scene_file.as_ref()));
    let file = file.ok_or_else(|| CliError::Input("the report names no scene; name one".into()))?;
    let scene = load_scene(file)?;
    let load = started.elapsed().as_secs_f64();
    say::warnings(&scene.warnings);
    let how = &arguments.how;
    spare(&inputs(file), &arguments.output, how, &scene.cameras)?;
    prepare(&arguments.output)?;
    catch_interrupts();
    let (options, engine) = match &model {
        Some(model) => (flags.over(model.options.clone())?, engine_of(model)?),
        None => (flags.options()?, EngineChoice::Auto),
    };
    let settings = Settings {
        options,
        target,
        engine: how.engine.unwrap_or(engine),
        threads: how.threads,
    };
    let known = scene.warnings.len();
    let mut run = Run::new(scene, settings)?;
    let report = run.report_mut();
    report.seconds.load = load;
    report.scene_file = std::path::absolute(file).ok();
    if let Some(model) = &model {
        warn_of_the_model(model, report);
    }
    let session = Session {
        output: &arguments.output,
        how,
        started,
        known_warnings: known,
    };
    session.complete(run, watching)
}

fn read_report(path: &Path) -> Result<Report, CliError> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|e| CliError::Input(format!("cannot read {name}: {e}")))?;
    serde_json::from_str(&text).map_err(|e| {
        CliError::Input(format!(
            "{name}: {e}; expected a report.json of `radiosity solve`"
        ))
    })
}

/// The engine that a report names.
pub(super) fn engine_of(report: &Report) -> Result<EngineChoice, CliError> {
    let name = report.engine.name.replace('_', "-");
    name.parse().map_err(|e| CliError::Input(format!("{e}")))
}

/// Says why this solve may not be that of its report.
fn warn_of_the_model(model: &Report, now: &Report) {
    let ended_by = match model.stop_reason {
        StopReason::TimeLimit => Some("the time limit"),
        StopReason::Interrupted => Some("an interruption"),
        _ => None,
    };
    if let Some(what) = ended_by {
        say::warning(&format!(
            "the solve of the report was ended by {what}: this one may go further"
        ));
    }
    if !model.resumed_with.is_empty() {
        say::warning(&format!(
            "the solve of the report was taken up again with {}: this one begins with what it ended with, and results will differ",
            model.resumed_with.join(", ")
        ));
    }
    if model.engine != now.engine {
        warn_of_another_engine(model, now);
    }
}

/// The bits depend on the engine's version and instruction set.
pub(super) fn warn_of_another_engine(then: &Report, now: &Report) {
    let name = |of: &Report| {
        format!(
            "{} {} ({})",
            of.engine.name, of.engine.version, of.engine.isa
        )
    };
    say::warning(&format!(
        "solved before by {}, now by {}: results may differ in their last digits",
        name(then),
        name(now)
    ));
}

/// Bytes that a folder must have room for before a solve begins.
const PROBE: usize = 1 << 20;

/// Makes the folder and finds out before the solve whether it can be written to.
pub(super) fn prepare(folder: &Path) -> Result<(), CliError> {
    let refuse = |error: std::io::Error| {
        CliError::System(format!("cannot write to {}: {error}", folder.display()))
    };
    std::fs::create_dir_all(folder).map_err(refuse)?;
    let probe = folder.join(".radiosity-writable");
    let written = std::fs::write(&probe, vec![0; PROBE]);
    // Of a full disk too, nothing may stay.
    let removed = std::fs::remove_file(&probe);
    written.and(removed).map_err(refuse)?;
    remove_abandoned(folder);
    Ok(())
}

/// Writes all results but the solution itself, with which writing `started`; of its triangles those that are asked for.
pub(super) fn write_beside(
    solution: &mut Solution,
    lit: Option<LitMesh>,
    (folder, started): (&Path, Instant),
    how: &How,
    history: &History,
) -> Result<(), CliError> {
    // First of all, so that it is there whatever may fail below; and once more when the time that writing took is known.
    write_report(&solution.report, folder)?;
    // Who interrupts the solve gets pictures of what there is; who interrupts these does not want them.
    let before = is_interrupted();
    let wanted = || before || !is_interrupted();
    let mut drawn = false;
    if let Some(lit) = lit {
        drawn = write_lit(solution, &lit, folder, how, &wanted)?;
    }
    solution.report.seconds.write = started.elapsed().as_secs_f64();
    solution.report.peak_memory = peak_memory();
    write_report(&solution.report, folder)?;
    if !how.no_html {
        write_page(solution, folder, how, history, drawn)?;
    }
    Ok(())
}

/// `report.json`.
fn write_report(report: &Report, folder: &Path) -> Result<(), CliError> {
    let text = serde_json::to_vec_pretty(report).map_err(|e| CliError::System(e.to_string()))?;
    write_atomically(&folder.join(REPORT), |out| out.write_all(&text))?;
    Ok(())
}

/// The meshes that were asked for, and the pictures while they are wanted; whether there are those of the first camera.
fn write_lit(
    solution: &Solution,
    lit: &LitMesh,
    folder: &Path,
    how: &How,
    wanted: &(dyn Fn() -> bool + Sync),
) -> Result<bool, CliError> {
    let exporter = Exporter {
        solution,
        lit,
        tone: Tone::for_mesh(lit),
        efficacy: WHITE_EFFICACY,
    };
    let formats = how.formats.0.par_iter().with_max_len(1);
    let written: Vec<_> = formats
        .map(|format| exporter.write(*format, &folder.join(mesh_file(*format))))
        .collect();
    // Of several that failed the first.
    written.into_iter().collect::<Result<(), _>>()?;
    if how.no_pictures {
        return Ok(false);
    }
    let engine = (how.engine.unwrap_or_default(), how.threads);
    for (number, camera) in solution.cameras.iter().enumerate() {
        let into = picture_folder(folder, number, camera);
        if !draw(lit, camera, engine, &into, wanted)? {
            return Ok(number > 0);
        }
    }
    Ok(true)
}

/// `report.html`, with the first camera's pictures if they were drawn.
fn write_page(
    solution: &Solution,
    folder: &Path,
    how: &How,
    history: &History,
    drawn: bool,
) -> Result<(), CliError> {
    let camera = solution.cameras.first().map_or("", |camera| &camera.name);
    let mut pictures = Vec::new();
    for (file, what) in [("shaded.png", "light"), ("mesh.png", "mesh")] {
        if drawn {
            let path = folder.join(file);
            let refused = |e| CliError::System(format!("cannot read {}: {e}", path.display()));
            let png = std::fs::read(&path).map_err(refused)?;
            pictures.push((format!("{camera}: {what}"), png));
        }
    }
    let mut files = vec![SOLUTION.to_owned(), REPORT.to_owned()];
    let meshes = how.formats.0.iter();
    files.extend(meshes.map(|format| mesh_file(*format)));
    let page = Page {
        report: &solution.report,
        history,
        pictures: &pictures,
        files: &files,
    };
    Ok(write_html(&folder.join(PAGE), &page)?)
}

/// The paper's Table 1 for this solve, and what the table leaves out.
pub(super) fn summary(solution: &Solution, seconds: f64) -> String {
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
            // To what is shown, and no zero that is negative.
            (1e4 * part / power.emitted).round() / 100.0 + 0.0
        } else {
            0.0
        }
    };
    let why = report.ended();
    let estimate = report.audit.map_or(String::new(), |audit| {
        format!(
            "estimated error of the irradiance: {:.2}% nRMS, of it {:+.2}% bias, at {}\n",
            100.0 * audit.n_rms,
            100.0 * audit.bias,
            counted(audit.points, "point", "points")
        )
    });
    format!(
        "{}{why}: {} emitted = {:.2}% absorbed + {:.2}% escaped + {:.2}% unshot + {:.2}% residual\n\
         {estimate}{}, {:.2} million rays at {:.1} million/s by {} {} ({}, {} wide), {}\n",
        summary_table(&[row]),
        say::watts(power.emitted),
        percent(power.absorbed),
        percent(power.escaped),
        percent(power.unshot),
        percent(power.residual),
        counted(report.vertices, "vertex", "vertices"),
        report.rays as f64 / 1e6,
        report.rays as f64 / 1e6 / report.seconds.solve.max(1e-9),
        report.engine.name,
        report.engine.version,
        report.engine.isa,
        report.engine.packet_width,
        counted(report.threads, "thread", "threads"),
    )
}
