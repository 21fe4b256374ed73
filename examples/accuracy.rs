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

use common::reference::{self, Deviation, Known, Sample};
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
    presets: Vec<Preset>,
    engine: EngineChoice,
    threads: usize,
    set: Vec<(String, serde_json::Value)>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let request = request()?;
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
    for preset in &request.presets {
        let options = with(preset.options(), &request.set)?;
        let settings = Settings {
            options,
            engine: request.engine,
            threads: request.threads,
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
            "--preset" => request.presets.push(preset(&value()?)?),
            "--engine" => request.engine = value()?.parse()?,
            "--threads" => request.threads = value()?.parse()?,
            "--set" => request.set.push(setting(&value()?)?),
            flag if flag.starts_with("--") => return Err(format!("unknown option {flag}").into()),
            file => request.files.push(file.into()),
        }
    }
    if request.presets.is_empty() {
        request.presets = vec![Preset::Draft, Preset::Standard];
    }
    Ok(request)
}

/// NAME=VALUE, the value in JSON; parts of `limits` by their own names.
fn setting(text: &str) -> Result<(String, serde_json::Value), Box<dyn Error>> {
    let (name, value) = text.split_once('=').ok_or("--set needs OPTION=VALUE")?;
    Ok((name.to_owned(), serde_json::from_str(value)?))
}

fn with(options: Options, set: &[(String, serde_json::Value)]) -> Result<Options, Box<dyn Error>> {
    let mut json = serde_json::to_value(options)?;
    for (name, value) in set {
        let within = if json["limits"].get(name).is_some() {
            &mut json["limits"]
        } else {
            &mut json
        };
        *within
            .get_mut(name)
            .ok_or_else(|| format!("no option {name}"))? = value.clone();
    }
    Ok(serde_json::from_value(json)?)
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
