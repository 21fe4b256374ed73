//! How time and memory grow with a scene: halls of the same furniture, of ten thousand triangles to a million.
//!
//! `cargo bench --bench growth` solves each as a draft and prints where the time went, the exponent of the time from one size to the next,
//! the most memory that was held, and how much of it there is for each vertex of the mesh, without what a process holds that has only
//! been started. `cargo bench --bench growth -- 5000000` ends at that size. Each size has a process of its own: what one leaves in
//! the heap is not counted for the next.

mod hall;

use radiosity::cli::{load_scene, peak_memory};
use radiosity::solver::{Options, Preset, Silent};
use radiosity::{Run, Settings};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

const SIZES: [usize; 4] = [10_000, 100_000, 1_000_000, 5_000_000];

/// The column of the seconds in all.
const TOTAL: usize = 8;

/// Before the file of a hall, its triangles, and the triangles and seconds of the one before it.
const ONE: &str = "--one";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [first, file, numbers @ ..] = &arguments[..]
        && first == ONE
    {
        let numbers = numbers.iter().map(|n| n.parse().expect("a number"));
        return solve(Path::new(file), &numbers.collect::<Vec<f64>>());
    }
    let most = arguments.iter().find_map(|argument| argument.parse().ok());
    let most: usize = most.unwrap_or(1_000_000);
    let folder = tempfile::tempdir().expect("there is room for a file");
    let file = folder.path().join("hall.obj");
    println!(
        "triangles  vertices   load  build  shoot refine gather    off  total s  exponent  Mrays  unshot %      MB  bytes a vertex"
    );
    let mut before = [f64::NAN; 2];
    for size in SIZES.into_iter().filter(|size| *size <= most) {
        let triangles = hall::write(&file, size) as f64;
        let itself = std::env::current_exe().expect("it is somewhere");
        let numbers = [triangles, before[0], before[1]].map(|n| n.to_string());
        let solved = Command::new(itself)
            .arg(ONE)
            .arg(&file)
            .args(numbers)
            .stderr(Stdio::inherit())
            .output()
            .expect("it can be started once more");
        assert!(solved.status.success(), "{size} triangles cannot be solved");
        let line = String::from_utf8(solved.stdout).expect("it writes numbers");
        print!("{line}");
        let total = line.split_whitespace().nth(TOTAL).expect("is there");
        before = [triangles, total.parse().expect("a number")];
    }
}

/// Solves a hall and prints its line.
fn solve(file: &Path, numbers: &[f64]) {
    let &[triangles, triangles_before, seconds_before] = numbers else {
        panic!("three numbers are passed on");
    };
    let memory = || peak_memory().map_or(f64::NAN, |bytes| bytes as f64);
    let started_with = memory();
    let started = Instant::now();
    let scene = load_scene(file).expect("what was written can be read");
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
    println!(
        "{triangles:9} {:9} {load:6.2} {:6.2} {:6.2} {:6.2} {:6.2} {:6.2} {total:8.2} {:9.2} {:6.1} {:9.2} {:7.1} {:15.0}",
        report.vertices,
        report.seconds.build,
        parts.shooting + parts.selecting,
        parts.refining,
        parts.gathering,
        total - load - report.seconds.build - report.seconds.solve,
        (total / seconds_before).ln() / (triangles / triangles_before).ln(),
        report.rays as f64 / 1e6,
        100.0 * report.power.unshot.abs() / report.power.emitted,
        memory() / 1e6,
        (memory() - started_with) / report.vertices as f64,
    );
}
