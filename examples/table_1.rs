//! The paper's Table 1, and ours beside it: solves the five scenes and the Cornell box, and prints `docs/table-1.md`'s table.
//!
//! ```text
//! cargo run --release --example table_1 -- [draft|standard|accurate]
//! ```
//!
//! Seconds are those of the wall clock from the mesh to the solution, with all threads.

#[path = "../tests/common/mod.rs"]
mod common;

use radiosity::scene::Scene;
use radiosity::solver::Silent;
use radiosity::{Settings, solve};
use std::error::Error;

/// Scene, and what Lee and Chuang print of it: shots, depth, shots with meshing, elements, seconds on a Pentium 4 of 3.2 GHz.
const SCENES: [(&str, Option<[f64; 5]>); 6] = [
    ("emission", Some([120.0, 10.0, 120.0, 44171.0, 140.37])),
    ("shadow", Some([3.0, 10.0, 1.0, 32983.0, 126.53])),
    ("huge", Some([5.0, 13.0, 3.0, 34790.0, 12.18])),
    ("secondary", Some([5.0, 10.0, 2.0, 58325.0, 237.53])),
    ("geometry", Some([2.0, 10.0, 1.0, 16386.0, 20.11])),
    ("cornell-box", None),
];

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1);
    let preset = common::preset(name.as_deref().unwrap_or("standard"))?;
    println!(
        "| scene | | input patches | shots | quadtree depth | shots with meshing | elements | seconds | estimated nRMS |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|");
    for (name, paper) in SCENES {
        let scene = Scene::load(&common::scene_folder(name))?;
        let settings = Settings {
            options: preset.options(),
            ..Settings::default()
        };
        let report = solve(&scene, &settings, &mut Silent)?.report;
        if let Some([shots, depth, meshing, elements, seconds]) = paper {
            println!(
                "| {} | paper | {} | {shots} | {depth} | {meshing} | {elements} | {seconds:.2} | |",
                scene.name, report.input_patches,
            );
        }
        println!(
            "| {} | ours | {} | {} | {} | {} | {} | {:.2} | {:.2} % |",
            scene.name,
            report.input_patches,
            report.shots,
            report.max_depth,
            report.meshing_shots,
            report.elements,
            report.seconds.build + report.seconds.solve,
            100.0 * report.audit.map_or(0.0, |audit| audit.n_rms),
        );
    }
    Ok(())
}
