//! How accurate the presets are: solves scenes and compares the irradiance with tables of reference values.
//!
//! ```text
//! cargo run --release --example accuracy -- [SCENE POINTS.csv] [--preset P]... [--engine E] [--threads N] [--set OPTION=VALUE]...
//! ```
//!
//! Without a scene, all bundled ones are compared: Emission with its exact floor at least 10 cm from the lights, the others with
//! the path-traced tables in `tests/data`. POINTS.csv has the columns x,y,z,nx,ny,nz,E_r,E_g,E_b,se_r,se_g,se_b: places in scene units, irradiance and its standard
//! error, which is taken out of the errors in quadrature.
//! nRMS is the RMS error over the mean reference, rmsRel the RMS of the relative error, bias the mean error over the mean
//! reference; max is the largest relative error. Three channels are pooled.

#[path = "../tests/common/mod.rs"]
mod common;

use clap::Parser;
use common::reference::{self, Deviation, Known, Sample};
use radiosity::scene::Scene;
use radiosity::solver::{Changes, Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, solve};
use std::error::Error;
use std::path::PathBuf;

#[derive(Parser)]
struct Request {
    /// SCENE and POINTS.csv, or neither
    files: Vec<PathBuf>,
    #[arg(long = "preset", value_parser = common::preset, default_values = ["draft", "standard"])]
    presets: Vec<Preset>,
    #[arg(long, default_value = "auto")]
    engine: EngineChoice,
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// An option of the solve as in report.json, and its value in JSON
    #[arg(long, value_name = "OPTION=VALUE", value_parser = setting)]
    set: Vec<Setting>,
}

/// Name and value of an option.
type Setting = (String, serde_json::Value);

fn main() -> Result<(), Box<dyn Error>> {
    let request = Request::parse();
    println!(
        "| scene | preset, engine | elements | vertices | Mrays | seconds | nRMS % | rmsRel % | bias % | max % | estimated nRMS % |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for (scene, samples) in tasks(&request)? {
        compare(&scene, &samples, &request)?;
    }
    Ok(())
}

fn compare(scene: &Scene, samples: &[Sample], request: &Request) -> Result<(), Box<dyn Error>> {
    let changes: Changes = request.set.iter().cloned().collect();
    for preset in &request.presets {
        let options = preset.options().with(&changes)?;
        let settings = Settings {
            options,
            engine: request.engine,
            threads: request.threads,
            ..Settings::default()
        };
        let solution = solve(scene, &settings, &mut Silent)?;
        let deviation = Deviation::of(&solution, samples);
        let report = &solution.report;
        if deviation.missed > 0 {
            eprintln!(
                "{}: {} points lie on no surface",
                scene.name, deviation.missed
            );
        }
        println!(
            "| {} | {} {} | {} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {:+.2} | {:.2} | {:.2} |",
            scene.name,
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
            100.0 * report.audit.map_or(f64::NAN, |audit| audit.n_rms),
        );
    }
    Ok(())
}

fn tasks(request: &Request) -> Result<Vec<Known>, Box<dyn Error>> {
    match &request.files[..] {
        [scene, points] => Ok(vec![(Scene::load(scene)?, reference::read(points)?)]),
        [] => Ok(reference::bundled()),
        _ => Err("expected SCENE POINTS.csv, or neither".into()),
    }
}

/// NAME=VALUE, the value in JSON; parts of `limits` by their own names.
fn setting(text: &str) -> Result<Setting, String> {
    let (name, value) = text.split_once('=').ok_or("expected OPTION=VALUE")?;
    let value = serde_json::from_str(value).map_err(|e| e.to_string())?;
    Ok((name.to_owned(), value))
}
