//! What an error costs: the command from loading to the written solution, for errors that are asked of it.
//!
//! `cargo bench --bench equal_error` solves the Cornell box to 1 % and to 3 % (`--target-error`) several times, the targets taking turns, and
//! prints the processor seconds of a run (all threads, user and system), the seconds on the wall, and the error against the
//! path-traced table of the tests. Processor seconds are Linux's, in hundredths; those of all runs of a kind are added up first.

#[path = "../tests/common/mod.rs"]
mod common;

use common::reference::{Deviation, table};
use common::scene_folder;
use radiosity::solution::Solution;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const ROUNDS: usize = 5;
const TARGETS: [&str; 2] = ["1%", "3%"];

/// What runs to one target took.
#[derive(Default)]
struct Cost {
    processor: f64,
    wall: Vec<f64>,
}

fn main() {
    let folder = tempfile::tempdir().expect("there is room for solutions");
    let of = |target: &str| folder.path().join(target.trim_end_matches('%'));
    let mut costs: [Cost; 2] = Default::default();
    for _ in 0..ROUNDS {
        for (cost, target) in costs.iter_mut().zip(TARGETS) {
            let (before, started) = (processor_seconds(), Instant::now());
            solve(target, &of(target));
            cost.wall.push(started.elapsed().as_secs_f64());
            cost.processor += processor_seconds() - before;
        }
    }
    let known = table("cornell_irradiance.csv");
    println!("target  processor s  wall s  nRMS %  bias %  estimated nRMS %  rounds");
    for (cost, target) in costs.iter_mut().zip(TARGETS) {
        let solution = Solution::read(&of(target).join("solution.rad")).expect("it was written");
        let found = Deviation::of(&solution, &known);
        cost.wall.sort_by(f64::total_cmp);
        let report = &solution.report;
        println!(
            "{target:6} {:12.2} {:7.2} {:7.2} {:+7.2} {:17.2} {:7}",
            cost.processor / ROUNDS as f64,
            cost.wall[ROUNDS / 2],
            100.0 * found.n_rms,
            100.0 * found.bias,
            100.0 * report.audit.map_or(f64::NAN, |audit| audit.n_rms),
            report.target.as_ref().map_or(0, |target| target.rounds),
        );
    }
}

/// The command, as somebody would call it.
fn solve(target: &str, output: &Path) {
    let done = Command::new(env!("CARGO_BIN_EXE_radiosity"))
        .arg("solve")
        .arg(scene_folder("cornell-box"))
        .args(["--target-error", target, "--no-pictures", "--quiet"])
        .args(["--formats", "none", "--no-html", "--output"])
        .arg(output)
        .status()
        .expect("the program can be run");
    assert!(done.success(), "the Cornell box is solved to {target}");
}

/// Of all children that have ended.
fn processor_seconds() -> f64 {
    const TICKS: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").expect("a Linux to ask");
    // After the name, which may have spaces in it: the state is the third field, the children's times are the 16th and 17th.
    let fields = stat.rsplit(')').next().unwrap_or_default();
    let fields = fields.split_whitespace().skip(13).take(2);
    fields.filter_map(|t| t.parse::<f64>().ok()).sum::<f64>() / TICKS
}
