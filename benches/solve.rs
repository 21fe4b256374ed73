//! Whole solves: seconds, rays and rays per second on both engines, and their ratio.
//!
//! `cargo bench --bench solve` runs each scene three times on each engine, interleaved, and prints medians.

use radiosity::scene::Scene;
use radiosity::solver::{Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, solve};
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 3;

fn main() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    println!("scene          preset     engine   seconds  Mrays  Mrays/s  of embree");
    for name in ["cornell-box", "shadow", "geometry"] {
        let scene = Scene::load(&scenes.join(name)).expect("the scenes of this repository load");
        for preset in [Preset::Draft, Preset::Standard] {
            compare(name, &scene, preset);
        }
    }
}

fn compare(name: &str, scene: &Scene, preset: Preset) {
    let engines = [EngineChoice::Embree, EngineChoice::Obvhs];
    let mut times = [const { Vec::new() }; 2];
    let mut rays = [0; 2];
    for _ in 0..ROUNDS {
        for (i, engine) in engines.into_iter().enumerate() {
            let settings = Settings {
                options: preset.options(),
                engine,
                threads: 0,
                ..Settings::default()
            };
            let started = Instant::now();
            if let Ok(solution) = solve(scene, &settings, &mut Silent) {
                times[i].push(started.elapsed().as_secs_f64());
                rays[i] = solution.report.rays;
            }
        }
    }
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied()
    });
    for (i, engine) in engines.iter().enumerate() {
        let Some(seconds) = medians[i] else {
            println!("{name:14} {preset:<10?} {engine:8} not built in");
            continue;
        };
        let mega = rays[i] as f64 / 1e6;
        let ratio = medians[0].map_or(f64::NAN, |embree| seconds / embree);
        println!(
            "{name:14} {preset:<10?} {engine:8} {seconds:7.2} {mega:6.2} {:8.2}  {ratio:9.2}",
            mega / seconds
        );
    }
}
