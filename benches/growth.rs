//! How time and memory grow with a scene: halls of the same furniture, of ten thousand triangles to a million.
//!
//! `cargo bench --bench growth` solves each as a draft and prints where the time went, the exponent of the time from one size to the next,
//! and the memory that the process has held at most by vertex of the mesh. `cargo bench --bench growth -- 5000000` ends at that size.

mod hall;

use radiosity::cli::peak_memory;
use radiosity::scene::Scene;
use radiosity::solver::{Options, Preset, Silent};
use radiosity::{Run, Settings};
use std::time::Instant;

const SIZES: [usize; 4] = [10_000, 100_000, 1_000_000, 5_000_000];

fn main() {
    let most = std::env::args().skip(1).find_map(|a| a.parse().ok());
    let most: usize = most.unwrap_or(1_000_000);
    let folder = tempfile::tempdir().expect("there is room for a file");
    println!(
        "triangles  vertices   load  build  shoot refine gather  write off  total s  exponent  Mrays  unshot %  bytes a vertex"
    );
    let mut before: Option<(usize, f64)> = None;
    for size in SIZES.into_iter().filter(|size| *size <= most) {
        let file = folder.path().join("hall.obj");
        let triangles = hall::write(&file, size);
        let started = Instant::now();
        let scene = Scene::load(&file).expect("what was written can be read");
        let load = started.elapsed().as_secs_f64();
        let settings = Settings {
            options: Options {
                audit_points: 0,
                ..Preset::Draft.options()
            },
            ..Settings::default()
        };
        let mut run = Run::new(scene, settings).expect("the hall can be solved");
        run.go(&mut Silent).expect("it can be solved to the end");
        let solution = run.finish();
        let total = started.elapsed().as_secs_f64();
        let report = &solution.report;
        let parts = &report.seconds.parts;
        let memory = peak_memory().map_or(f64::NAN, |bytes| bytes as f64);
        let exponent = before.map_or(f64::NAN, |(n, t)| {
            (total / t).ln() / (triangles as f64 / n as f64).ln()
        });
        println!(
            "{triangles:9} {:9} {load:6.2} {:6.2} {:6.2} {:6.2} {:6.2} {:10.2} {total:8.2} {exponent:9.2} {:6.1} {:9.2} {:15.0}",
            report.vertices,
            report.seconds.build,
            parts.shooting + parts.selecting,
            parts.refining,
            parts.gathering,
            total - load - report.seconds.build - report.seconds.solve,
            report.rays as f64 / 1e6,
            100.0 * report.power.unshot.abs() / report.power.emitted,
            memory / report.vertices as f64,
        );
        before = Some((triangles, total));
    }
}
