//! Whole solves: seconds, rays and rays per second on both engines, and their ratio; then what a second thread saves.
//!
//! `cargo bench --bench solve` runs each scene three times on each engine and five times on one and on two threads, interleaved, and
//! prints medians. What two processors of a machine share, two solves on one thread each share too: what is saved when these go at once
//! is the most that a second thread can save there.

mod hall;
mod median;

use median::median;
use radiosity::scene::Scene;
use radiosity::solution::Solution;
use radiosity::solver::{Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, solve};
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 3;

/// Of one and two threads.
const TURNS: usize = 5;

/// Triangles of the hall.
const HALL: usize = 8_000;

fn main() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    println!("scene          preset     engine   seconds  Mrays  Mrays/s  of embree");
    for name in ["cornell-box", "shadow", "geometry"] {
        let scene = Scene::load(&scenes.join(name)).expect("the scenes of this repository load");
        for preset in [Preset::Draft, Preset::Standard] {
            compare(name, &scene, preset);
        }
    }
    println!(
        "\nscene          preset     vertices  one thread s  two threads s  ratio  two solves at once s  ratio"
    );
    for name in ["cornell-box", "shadow", "geometry"] {
        let scene = Scene::load(&scenes.join(name)).expect("the scenes of this repository load");
        scale(name, &scene, Preset::Standard);
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("hall.obj");
    hall::write(&file, HALL);
    scale(
        "hall",
        &Scene::load(&file).expect("halls load"),
        Preset::Draft,
    );
}

/// The same solve on one and on two threads, and two of them at once on one thread each.
fn scale(name: &str, scene: &Scene, preset: Preset) {
    let solved = |threads| {
        timed(scene, preset, EngineChoice::Auto, threads).expect("one engine is always there")
    };
    let mut times = [const { Vec::new() }; 3];
    let mut vertices = 0;
    for _ in 0..TURNS {
        for (threads, times) in (1..=2).zip(&mut times) {
            let (seconds, solution) = solved(threads);
            times.push(seconds);
            vertices = solution.report.vertices;
        }
        let started = Instant::now();
        std::thread::scope(|scope| {
            scope.spawn(|| solved(1));
            scope.spawn(|| solved(1));
        });
        times[2].push(started.elapsed().as_secs_f64());
    }
    let [one, two, at_once] = times.map(median);
    println!(
        "{name:14} {preset:<10?} {vertices:8}  {one:12.2}  {two:13.2}  {:5.2}  {at_once:20.2}  {:5.2}",
        one / two,
        2.0 * one / at_once
    );
}

/// Seconds of one solve, if the engine was built in.
fn timed(
    scene: &Scene,
    preset: Preset,
    engine: EngineChoice,
    threads: usize,
) -> Option<(f64, Solution)> {
    let settings = Settings {
        options: preset.options(),
        engine,
        threads,
        ..Settings::default()
    };
    let started = Instant::now();
    let solution = solve(scene, &settings, &mut Silent).ok()?;
    Some((started.elapsed().as_secs_f64(), solution))
}

fn compare(name: &str, scene: &Scene, preset: Preset) {
    let engines = [EngineChoice::Embree, EngineChoice::Obvhs];
    let mut times = [const { Vec::new() }; 2];
    let mut rays = [0; 2];
    for _ in 0..ROUNDS {
        for (i, engine) in engines.into_iter().enumerate() {
            if let Some((seconds, solution)) = timed(scene, preset, engine, 0) {
                times[i].push(seconds);
                rays[i] = solution.report.rays;
            }
        }
    }
    let medians = times.map(median);
    for (i, engine) in engines.iter().enumerate() {
        let seconds = medians[i];
        if seconds.is_nan() {
            println!("{name:14} {preset:<10?} {engine:8} not built in");
            continue;
        }
        let mega = rays[i] as f64 / 1e6;
        let ratio = seconds / medians[0];
        println!(
            "{name:14} {preset:<10?} {engine:8} {seconds:7.2} {mega:6.2} {:8.2}  {ratio:9.2}",
            mega / seconds
        );
    }
}
