//! Whole matrices: seconds and errors on the closed Cornell box, cut finer and finer.
//!
//! `cargo bench --bench form_factor_matrix` prints, for each number of rows and each tolerance, the median seconds of three runs on
//! all threads, the largest and mean error of a row (L2, relative) against a run to a tenth of the least tolerance, the largest
//! error that was estimated, and how the pairs were worked out. Arguments are largest areas in m², for other sizes: `-- 0.001`;
//! `--quick` leaves the comparison out, `--growth` goes on to 20,000 rows without it.

use glam::DVec3;
use radiosity::matrix::{Enclosure, Matrix, Options};
use radiosity::scene::{Corners, NamedScene, Scene, Sides, Surface};
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 3;

/// Largest areas (m²) that give 168, 908 and 3,837 rows or nearly so.
const AREAS: [f64; 3] = [0.0165, 0.00252, 0.00058];

/// Largest areas for growth.
const FINER: [f64; 2] = [0.00021, 0.000105];

const TOLERANCES: [f64; 3] = [1e-3, 3e-4, 1e-4];

fn main() {
    let scene = closed_cornell_box();
    println!(
        "  rows  tolerance  seconds  error: max   mean      estimate  unhindered        cut  limited  sampled"
    );
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |flag: &str| arguments.iter().any(|a| a == flag);
    let asked: Vec<f64> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    for area in if asked.is_empty() { &AREAS[..] } else { &asked } {
        measure(&scene, *area, !given("--quick"));
    }
    if given("--growth") {
        for area in FINER {
            measure(&scene, area, false);
        }
    }
}

fn measure(scene: &NamedScene, max_area: f64, compare: bool) {
    let made = |tolerance: f64| {
        let options = Options {
            max_area: Some(max_area),
            tolerance,
            ..Options::standard()
        };
        Enclosure::new(scene, &options)
            .expect("the box is a scene")
            .matrix()
    };
    let reference = compare.then(|| made(TOLERANCES[TOLERANCES.len() - 1] / 10.0));
    for tolerance in TOLERANCES {
        let mut seconds = Vec::new();
        let mut last = None;
        for _ in 0..if compare { ROUNDS } else { 1 } {
            let started = Instant::now();
            last = Some(made(tolerance));
            seconds.push(started.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        let matrix = last.expect("there is a round");
        print(
            tolerance,
            seconds[seconds.len() / 2],
            &matrix,
            reference.as_ref(),
        );
    }
}

fn print(tolerance: f64, seconds: f64, matrix: &Matrix, reference: Option<&Matrix>) {
    let (worst, mean) = reference.map_or((f64::NAN, f64::NAN), |it| errors(matrix, it));
    let sees = |i: &usize| length(matrix.row(*i)) > 0.0;
    let relative = (0..matrix.len())
        .filter(sees)
        .map(|i| matrix.certificate.row_errors[i] / length(matrix.row(i)));
    let pairs = matrix.certificate.pairs;
    println!(
        "{:6}  {tolerance:9.0e}  {seconds:7.3}  {worst:.2e}  {mean:.2e}  {:.2e}  {:10}  {:9}  {:7}  {:7}",
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
    let first = scene.vertices.len() as u32;
    scene
        .vertices
        .extend(front.map(|[x, y]| DVec3::new(x, y, 0.0)));
    scene.surfaces.push(Surface {
        corners: Corners::Quad([first, first + 1, first + 2, first + 3]),
        material: 0,
        polygon: scene.input_polygons as u32,
        sides: Sides::Front,
    });
    scene.input_polygons += 1;
    scene.into()
}
