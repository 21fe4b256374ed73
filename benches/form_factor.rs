//! What a form factor costs: Eq. (1), Eq. (2), Eq. (2) clipped to the horizon, and Eq. (2) as the textbook writes it,
//! with one `atan2` an edge. Prints nanoseconds each and how they compare.
//!
//! `cargo bench --bench form_factor`

mod pairs;

use glam::DVec3;
use pairs::{Pair, across, clipped, pairs};
use radiosity::form_factor::{point_to_disk, point_to_polygon};
use radiosity::geometry::polygon;
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Rounds in which every kernel has its turn: what disturbs the machine disturbs all of them.
const ROUNDS: usize = 401;
/// How long a turn lasts, about: shorter than what the system hands to another program.
const TURN: Duration = Duration::from_micros(500);

/// A name and a sum over all pairs.
type Kernel = (&'static str, fn(&[Pair]) -> f64);

/// The first is what the others are compared with.
const KERNELS: [Kernel; 6] = [
    ("Eq. (2), atan2 an edge", |pairs| {
        sum(pairs, |p| textbook(DVec3::Z, &p.corners))
    }),
    ("Eq. (2)", |pairs| {
        sum(pairs, |p| point_to_polygon(DVec3::Z, &p.corners))
    }),
    ("Eq. (2), clipped, above the horizon", |pairs| {
        sum(pairs, |p| clipped(DVec3::Z, p))
    }),
    ("Eq. (2), clipped, across the horizon", |pairs| {
        sum(pairs, |p| clipped(across(p), p))
    }),
    ("Eq. (2), atan2 an edge, across the horizon", |pairs| {
        sum(pairs, |p| textbook_clipped(across(p), p))
    }),
    ("Eq. (1)", |pairs| {
        sum(pairs, |p| point_to_disk(DVec3::Z, p.to, p.normal, p.area))
    }),
];

fn main() {
    let pairs = pairs();
    check(&pairs);
    let mut times = [const { Vec::new() }; KERNELS.len()];
    let repeats = KERNELS.map(|(_, kernel)| repeats_in_a_turn(kernel, &pairs));
    for _ in 0..ROUNDS {
        for (kernel, (times, repeats)) in KERNELS.iter().zip(times.iter_mut().zip(repeats)) {
            times.push(nanoseconds(kernel.1, &pairs, repeats));
        }
    }
    println!(
        "{:<44}{:>8}{:>8}{:>8}",
        "median of interleaved rounds", "ns", "spread", "speed"
    );
    let baseline = quantile(&mut times[0], 0.5);
    for ((name, _), times) in KERNELS.iter().zip(times.iter_mut()) {
        let median = quantile(times, 0.5);
        let spread = 50.0 * (quantile(times, 0.75) - quantile(times, 0.25)) / median;
        println!(
            "{name:<44}{median:>8.1}{spread:>7.1}%{:>7.1}x",
            baseline / median
        );
    }
}

#[inline(always)]
fn sum(pairs: &[Pair], form_factor: impl Fn(&Pair) -> f64) -> f64 {
    pairs.iter().map(form_factor).sum()
}

/// Eq. (2) with the angle from `atan2` and the direction from a division, edge by edge.
fn textbook(normal: DVec3, corners: &[DVec3]) -> f64 {
    let edge = |i: usize| {
        let (from, to) = (corners[i], corners[(i + 1) % corners.len()]);
        let cross = from.cross(to);
        normal.dot(cross) / cross.length() * cross.length().atan2(from.dot(to))
    };
    -(0..corners.len()).map(edge).sum::<f64>() / (2.0 * PI)
}

fn textbook_clipped(normal: DVec3, pair: &Pair) -> f64 {
    textbook(
        normal,
        polygon::clip(&pair.corners, |corner| normal.dot(corner)).corners(),
    )
}

/// The kernels compute the same, or comparing them means nothing.
fn check(pairs: &[Pair]) {
    for p in pairs {
        let difference = point_to_polygon(DVec3::Z, &p.corners) - textbook(DVec3::Z, &p.corners);
        let across_difference = clipped(across(p), p) - textbook_clipped(across(p), p);
        assert!(difference.abs().max(across_difference.abs()) < 1e-10);
        assert!(
            clipped(across(p), p) > 0.0,
            "something is left above the horizon"
        );
    }
}

fn repeats_in_a_turn(kernel: fn(&[Pair]) -> f64, pairs: &[Pair]) -> u32 {
    let (start, mut repeats) = (Instant::now(), 0);
    while start.elapsed() < TURN {
        black_box(kernel(black_box(pairs)));
        repeats += 1;
    }
    repeats
}

/// Time of one form factor.
fn nanoseconds(kernel: fn(&[Pair]) -> f64, pairs: &[Pair], repeats: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..repeats {
        black_box(kernel(black_box(pairs)));
    }
    start.elapsed().as_secs_f64() * 1e9 / (f64::from(repeats) * pairs.len() as f64)
}

fn quantile(times: &mut [f64], share: f64) -> f64 {
    times.sort_by(f64::total_cmp);
    times[(share * (times.len() - 1) as f64) as usize]
}
