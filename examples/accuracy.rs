//! How accurate the presets are: solves a scene and compares the irradiance with a table of reference values.
//!
//! ```text
//! cargo run --release --example accuracy -- SCENE POINTS.csv [--preset P]... [--engine E] [--threads N] [--tolerance T]
//! cargo run --release --example accuracy -- --emission       [--preset P]... [--engine E] [--threads N] [--tolerance T]
//! ```
//!
//! POINTS.csv has the columns x,y,z,nx,ny,nz,E_r,E_g,E_b,se_r,se_g,se_b: places in scene units, irradiance and its standard
//! error, which is taken out of the errors in quadrature. `--emission` compares the scene Emission with its exact floor.
//! nRMS is the RMS error over the mean reference, rmsRel the RMS of the relative error, bias the mean error over the mean
//! reference; max is the largest relative error. Three channels are pooled.

#[path = "../tests/common/mod.rs"]
mod common;

use common::reference::{self, Deviation, Sample};
use radiosity::scene::Scene;
use radiosity::solver::{Options, Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, solve};
use std::error::Error;
use std::path::PathBuf;

/// What was asked for.
#[derive(Default)]
struct Request {
    files: Vec<PathBuf>,
    emission: bool,
    presets: Vec<Preset>,
    engine: EngineChoice,
    threads: usize,
    tolerance: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let request = request()?;
    let (scene, samples) = task(&request)?;
    println!("{} ({} points)", scene.name, samples.len());
    println!(
        "| preset | elements | vertices | Mrays | seconds | nRMS % | rmsRel % | bias % | max % | missed |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for preset in &request.presets {
        let options = preset.options();
        let options = Options {
            tolerance: request.tolerance.unwrap_or(options.tolerance),
            ..options
        };
        let settings = Settings {
            options,
            engine: request.engine,
            threads: request.threads,
        };
        let solution = solve(&scene, &settings, &mut Silent)?;
        let deviation = Deviation::of(&solution, &samples);
        let report = &solution.report;
        println!(
            "| {} {} | {} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {:+.2} | {:.2} | {} |",
            format!("{preset:?}").to_lowercase(),
            report.engine.name,
            report.elements,
            report.vertices,
            report.rays as f64 / 1e6,
            report.seconds.build + report.seconds.solve,
            100.0 * deviation.n_rms,
            100.0 * deviation.rms_rel,
            100.0 * deviation.bias,
            100.0 * deviation.max_rel,
            deviation.missed,
        );
    }
    Ok(())
}

fn task(request: &Request) -> Result<(Scene, Vec<Sample>), Box<dyn Error>> {
    match &request.files[..] {
        [] if request.emission => Ok((
            Scene::load(&common::scene_folder("emission"))?,
            common::closed_form::emission_floor(),
        )),
        [scene, points] if !request.emission => Ok((Scene::load(scene)?, reference::read(points)?)),
        _ => Err("expected SCENE POINTS.csv, or --emission".into()),
    }
}

fn request() -> Result<Request, Box<dyn Error>> {
    let mut request = Request::default();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || {
            arguments
                .next()
                .ok_or_else(|| format!("{argument} needs a value"))
        };
        match argument.as_str() {
            "--emission" => request.emission = true,
            "--preset" => request.presets.push(preset(&value()?)?),
            "--engine" => request.engine = value()?.parse()?,
            "--threads" => request.threads = value()?.parse()?,
            "--tolerance" => request.tolerance = Some(value()?.parse()?),
            flag if flag.starts_with("--") => return Err(format!("unknown option {flag}").into()),
            file => request.files.push(file.into()),
        }
    }
    if request.presets.is_empty() {
        request.presets = vec![Preset::Draft, Preset::Standard];
    }
    Ok(request)
}

fn preset(name: &str) -> Result<Preset, String> {
    match name {
        "draft" => Ok(Preset::Draft),
        "standard" => Ok(Preset::Standard),
        "accurate" => Ok(Preset::Accurate),
        _ => Err(format!(
            "unknown preset {name}; there are draft, standard and accurate"
        )),
    }
}
