//! Whole matrices: time, memory and errors on the closed Cornell box, cut finer and finer.
//!
//! `cargo bench --bench form_factor_matrix` prints, for each number of rows and each tolerance, the medians over three runs on all threads of the
//! seconds that passed and of the processor's seconds in all threads, the largest and mean error of a row (L2, relative) against a run to a tenth
//! of the least tolerance, the largest error that was estimated, and how the pairs were worked out. Arguments are largest areas in m², for other
//! sizes: `-- 0.001`; `--quick` leaves the comparison out.
//!
//! `-- --growth` hands out the rows of boxes of up to 20,000 rows one after the other, keeps none, and prints time and the process's largest
//! resident memory so far; `-- --streamed` does so with the 40,000 of a closed room, where each pair is worked out twice so that memory does
//! not grow with the square. Processor time and memory are read from `/proc`; elsewhere they are not known.

mod median;

use glam::DVec3;
use median::median;
use radiosity::matrix::{Enclosure, Matrix, Options};
use radiosity::scene::{Corners, NamedScene, Scene, Sides, Surface};
use std::convert::Infallible;
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 3;

/// Largest areas (m²) that give 168, 908 and 3,837 rows or nearly so.
const AREAS: [f64; 3] = [0.0165, 0.002522, 0.00058];

/// Largest areas for growth: up to just below 20,000 rows.
const FINER: [f64; 5] = [0.0165, 0.002522, 0.00058, 0.0002101, 0.0001132];

/// The largest area of the parts of a room of 1 m, for 40,560 of them.
const STREAMED: f64 = 1.0 / 82.0 / 82.0;

const TOLERANCES: [f64; 4] = [1e-3, 4e-4, 2e-4, 1e-4];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |flag: &str| arguments.iter().any(|a| a == flag);
    if given("--growth") || given("--streamed") {
        return grow(given("--streamed"));
    }
    println!(
        "  rows  tolerance  seconds  processor  error: max   mean      estimate  unhindered        cut  limited  sampled"
    );
    let scene = closed_cornell_box();
    let asked: Vec<f64> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    for area in if asked.is_empty() { &AREAS[..] } else { &asked } {
        measure(&scene, *area, !given("--quick"));
    }
}

fn enclosure(scene: &NamedScene, max_area: f64, tolerance: f64) -> Enclosure {
    let options = Options {
        max_area: Some(max_area),
        tolerance,
        ..Options::standard()
    };
    Enclosure::new(scene, &options).expect("is a scene")
}

fn measure(scene: &NamedScene, max_area: f64, compare: bool) {
    let made = |tolerance: f64| enclosure(scene, max_area, tolerance).matrix();
    let reference = compare.then(|| made(TOLERANCES[TOLERANCES.len() - 1] / 10.0));
    for tolerance in TOLERANCES {
        let mut times = [Vec::new(), Vec::new()];
        let mut last = None;
        for _ in 0..ROUNDS {
            let (clock, before) = (Instant::now(), processor_seconds());
            last = Some(made(tolerance));
            times[0].push(clock.elapsed().as_secs_f64());
            times[1].push(processor_seconds() - before);
        }
        let matrix = last.expect("there is a round");
        print(tolerance, times.map(median), &matrix, reference.as_ref());
    }
}

/// Time and memory of ever more rows, at the tolerance that gives a tenth of a per cent.
fn grow(streamed: bool) {
    println!("  rows  seconds  processor  peak MiB  row sums");
    let (scene, areas) = match streamed {
        true => (room(), &[STREAMED][..]),
        false => (closed_cornell_box(), &FINER[..]),
    };
    for area in areas {
        let (clock, before) = (Instant::now(), processor_seconds());
        let enclosure = enclosure(&scene, *area, TOLERANCES[1]);
        let certificate = enclosure.each_row(|_| Ok::<(), Infallible>(()));
        let certificate = certificate.unwrap_or_else(|never| match never {});
        let (low, high) = certificate.sum_range();
        println!(
            "{:6}  {:7.2}  {:9.2}  {:8.0}  {low:.5} to {high:.5}",
            enclosure.rows().len(),
            clock.elapsed().as_secs_f64(),
            processor_seconds() - before,
            peak_mebibytes(),
        );
    }
}

/// Seconds that the threads of this process have spent, in the kernel too.
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name, which may hold anything, in brackets: 11 fields, then ticks of 1/100 s in user and kernel mode.
    let fields: Vec<&str> = stat
        .rsplit(')')
        .next()
        .unwrap_or("")
        .split_whitespace()
        .collect();
    let ticks = |k: usize| fields.get(k).and_then(|field| field.parse::<f64>().ok());
    ticks(11)
        .zip(ticks(12))
        .map_or(f64::NAN, |(user, kernel)| 0.01 * (user + kernel))
}

/// The most memory that this process has had resident.
fn peak_mebibytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kibibytes.map_or(f64::NAN, |kibibytes| kibibytes / 1024.0)
}

fn print(
    tolerance: f64,
    [seconds, processor]: [f64; 2],
    matrix: &Matrix,
    reference: Option<&Matrix>,
) {
    let (worst, mean) = reference.map_or((f64::NAN, f64::NAN), |it| errors(matrix, it));
    let sees = |i: &usize| length(matrix.row(*i)) > 0.0;
    let relative = (0..matrix.len())
        .filter(sees)
        .map(|i| matrix.certificate.row_errors[i] / length(matrix.row(i)));
    let pairs = matrix.certificate.pairs;
    println!(
        "{:6}  {tolerance:9.0e}  {seconds:7.3}  {processor:9.2}  {worst:.2e}  {mean:.2e}  {:.2e}  {:10}  {:9}  {:7}  {:7}",
        matrix.len(),
        relative.fold(0.0, f64::max),
        pairs.unhindered,
        pairs.cut,
        pairs.limited,
        pairs.sampled,
    );
}

/// Largest and mean error of a row, relative to its length.
fn errors(matrix: &Matrix, reference: &Matrix) -> (f64, f64) {
    let error = |i: usize| {
        let differences: Vec<f64> = matrix
            .row(i)
            .iter()
            .zip(reference.row(i))
            .map(|(a, b)| a - b)
            .collect();
        length(&differences) / length(reference.row(i))
    };
    // A patch below a box sees nothing.
    let sees = |i: &usize| length(reference.row(*i)) > 0.0;
    let all: Vec<f64> = (0..matrix.len()).filter(sees).map(error).collect();
    (
        all.iter().copied().fold(0.0, f64::max),
        all.iter().sum::<f64>() / all.len() as f64,
    )
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The Cornell box of this repository with its front closed.
fn closed_cornell_box() -> NamedScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box");
    let mut scene = Scene::load(&path).expect("the scenes of this repository load");
    let front = [[0.0, 0.0], [552.8, 0.0], [556.0, 548.8], [0.0, 548.8]];
    add_quad(&mut scene, front.map(|[x, y]| DVec3::new(x, y, 0.0)));
    scene.into()
}

/// An empty room of 1 m.
fn room() -> NamedScene {
    let mut scene = closed_cornell_box().scene;
    scene.vertices.clear();
    scene.surfaces.clear();
    (scene.metres_per_unit, scene.input_polygons) = (1.0, 0);
    for axis in 0..3 {
        for far in [0.0, 1.0] {
            let at = |u: f64, v: f64| {
                let mut point = DVec3::splat(far);
                (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (u, v);
                point
            };
            let mut corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
            if far > 0.0 {
                corners.reverse();
            }
            add_quad(&mut scene, corners);
        }
    }
    scene.into()
}

fn add_quad(scene: &mut Scene, corners: [DVec3; 4]) {
    let first = scene.vertices.len() as u32;
    scene.vertices.extend(corners);
    scene.surfaces.push(Surface {
        corners: Corners::Quad([first, first + 1, first + 2, first + 3]),
        material: 0,
        polygon: scene.input_polygons as u32,
        sides: Sides::Front,
    });
    scene.input_polygons += 1;
}
