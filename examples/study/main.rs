//! The paper's claims, measured: prints the tables of `docs/study.md` and draws its figures into `docs/study/`.
//!
//! ```text
//! cargo run --release --example study
//! ```
//!
//! nRMS is the RMS error of the irradiance over its mean, against the exact floor of Emission (10 cm and more from the lights)
//! and the path-traced tables of the other scenes; seconds are of the wall clock, from the scene in memory to the solution.

#[path = "../../tests/common/mod.rs"]
mod common;
mod figure;

use common::reference::{self, Deviation, Known, Sample};
use figure::{Curve, Panel, draw};
use radiosity::mesh::MeshLimits;
use radiosity::solver::{FormFactorRule, Options, Preset, Shooting, Silent};
use radiosity::{Settings, solve};
use std::error::Error;

/// One solve of a scene.
struct Run {
    elements: usize,
    seconds: f64,
    deviation: Deviation,
}

fn run((scene, samples): &Known, options: &Options) -> Result<Run, Box<dyn Error>> {
    let settings = Settings {
        options: Options {
            audit_points: 0,
            ..options.clone()
        },
        ..Settings::default()
    };
    let solution = solve(scene, &settings, &mut Silent)?;
    Ok(Run {
        elements: solution.report.elements,
        seconds: solution.report.seconds.build + solution.report.seconds.solve,
        deviation: Deviation::of(&solution, samples),
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let scenes = reference::bundled();
    meshing(&scenes)?;
    formulas(&scenes)?;
    shooting(&scenes)?;
    time(&scenes)
}

/// From the draft to the standard preset.
const STRICTNESS: [f64; 4] = [0.0, 0.33, 0.67, 1.0];

/// How elements come to be, and the options for it at a strictness.
type Strategy = (&'static str, fn(f64) -> Options);

const STRATEGIES: [Strategy; 6] = [
    ("all three tests", Options::at),
    ("without nodal difference", |s| Options {
        epsilon_d: f64::INFINITY,
        ..Options::at(s)
    }),
    ("without residual", |s| Options {
        epsilon_r: f64::INFINITY,
        ..Options::at(s)
    }),
    ("without visibility index", |s| Options {
        epsilon_v: f64::INFINITY,
        ..Options::at(s)
    }),
    ("same tolerance at all sizes", |s| Options {
        size_exponent: 0.0,
        ..Options::at(s)
    }),
    ("uniform", |s| Options {
        meshing_power: f64::INFINITY,
        limits: MeshLimits {
            initial_size: 0.1 * 0.15f64.powf(s),
            ..Options::at(s).limits
        },
        ..Options::at(s)
    }),
];

/// Error against elements.
fn meshing(scenes: &[Known]) -> Result<(), Box<dyn Error>> {
    println!("| scene | meshing | elements: nRMS % |\n|---|---|---|");
    let mut panels = Vec::new();
    for known in scenes {
        let mut panel = Panel::new(&known.0.name);
        for (name, options) in STRATEGIES {
            let mut curve = Curve::new(name);
            let mut cells = Vec::new();
            for strictness in STRICTNESS {
                let run = run(known, &options(strictness))?;
                let percent = 100.0 * run.deviation.n_rms;
                cells.push(format!("{}: {percent:.2}", run.elements));
                curve.points.push((run.elements as f64, percent));
            }
            println!("| {} | {name} | {} |", known.0.name, cells.join(", "));
            panel.curves.push(curve);
        }
        panels.push(panel);
    }
    draw("docs/study/meshing.svg", "elements", &panels)
}

/// Within half a metre of Emission's lights, which stand on the floor at x = ±2 from z = -0.5 to 0.5.
fn is_near(sample: &Sample) -> bool {
    let across = 2.0 - sample.point.x.abs();
    across.hypot((sample.point.z.abs() - 0.5).max(0.0)) < 0.5
}

/// Eq. (1), Eq. (2) and the choice between them.
fn formulas(scenes: &[Known]) -> Result<(), Box<dyn Error>> {
    const FORMULAS: [(&str, FormFactorRule); 3] = [
        ("hybrid", FormFactorRule::Hybrid),
        ("disk, Eq. (1)", FormFactorRule::Disk),
        ("polygon, Eq. (2)", FormFactorRule::Polygon),
    ];
    println!("\n| scene | formula | nRMS % | bias % | seconds |\n|---|---|--:|--:|--:|");
    let (emission, floor) = &scenes[0];
    let (near, far): (Vec<Sample>, Vec<Sample>) = floor.iter().copied().partition(is_near);
    let mut parts = vec![
        (
            "Emission, 10 to 50 cm from the lights",
            (emission.clone(), near),
        ),
        ("Emission, beyond", (emission.clone(), far)),
    ];
    parts.extend(scenes[1..].iter().map(|k| (k.0.name.as_str(), k.clone())));
    for (name, known) in &parts {
        for (formula, form_factor) in FORMULAS {
            let options = Options {
                form_factor,
                ..Preset::Standard.options()
            };
            let Run {
                seconds, deviation, ..
            } = run(known, &options)?;
            println!(
                "| {name} | {formula} | {:.2} | {:+.2} | {seconds:.2} |",
                100.0 * deviation.n_rms,
                100.0 * deviation.bias,
            );
        }
    }
    Ok(())
}

/// What a patch shoots: what lies on it, or its mean as in the paper.
fn shooting(scenes: &[Known]) -> Result<(), Box<dyn Error>> {
    println!("\n| scene | interpolated: nRMS %, bias % | mean: nRMS %, bias % |\n|---|--:|--:|");
    for known in scenes {
        let mut cells = Vec::new();
        for shooting in [Shooting::Interpolated, Shooting::Mean] {
            let options = Options {
                shooting,
                ..Preset::Standard.options()
            };
            let Deviation { n_rms, bias, .. } = run(known, &options)?.deviation;
            cells.push(format!("{:.2}, {:+.2}", 100.0 * n_rms, 100.0 * bias));
        }
        println!("| {} | {} |", known.0.name, cells.join(" | "));
    }
    Ok(())
}

/// Error against time, from the draft to beyond standard.
fn time(scenes: &[Known]) -> Result<(), Box<dyn Error>> {
    println!("\n| scene | seconds: nRMS % |\n|---|---|");
    let mut panel = Panel::new("draft (left) to half way from standard to accurate (right)");
    for known in scenes {
        let mut curve = Curve::new(&known.0.name);
        let mut cells = Vec::new();
        for strictness in [0.0, 0.5, 1.0, 1.5] {
            let run = run(known, &Options::at(strictness))?;
            let percent = 100.0 * run.deviation.n_rms;
            cells.push(format!("{:.2}: {percent:.2}", run.seconds));
            curve.points.push((run.seconds, percent));
        }
        println!("| {} | {} |", known.0.name, cells.join(", "));
        panel.curves.push(curve);
    }
    draw("docs/study/time.svg", "seconds", &[panel])
}
