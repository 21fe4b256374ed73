//! Random scenes on every engine: rooms with boxes, sheets and lamps of any size, at any place, turned any way.
//!
//! ```sh
//! cargo run --release --example soak -- [--scenes N] [--seed S] [--preset P]
//! cargo run --release --example soak -- --repeat RUNS
//! ```
//!
//! Of each scene: nothing panics; the ledger closes; the engines agree; a solve in sessions, with a file between them and
//! another number of threads, ends with the same bits; and with all surfaces alike and nothing open, everything shines with
//! B = M / (1 - ρ). Prints what was found, with the seed of the worst scene, and fails if anything is beyond its bound.
//!
//! With `--repeat` the bundled scenes are solved again and again on 1, 2, 7 and 64 threads; every run of an engine must end with the
//! same bits.

#[path = "../tests/common/mod.rs"]
mod common;

use clap::Parser;
use common::sessions::{Batches, bits, file};
use common::shapes::{add_cuboid, add_quad, empty};
use fastrand::Rng;
use glam::{DQuat, DVec3, EulerRot, Vec3};
use radiosity::scene::{Material, Scene, Sides};
use radiosity::solution::{Prober, Solution};
use radiosity::solver::{Options, Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Run, Settings, solve};
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

#[derive(Parser)]
struct Request {
    /// Number of scenes
    #[arg(long, default_value_t = 100)]
    scenes: u64,
    /// Seed of the first scene; the others follow
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[arg(long, value_parser = common::preset, default_value = "draft")]
    preset: Preset,
    /// Solve the bundled scenes this often instead
    #[arg(long, value_name = "RUNS")]
    repeat: Option<usize>,
}

/// The largest of what was found, with its bound.
struct Worst {
    what: &'static str,
    bound: f64,
    found: f64,
    seed: u64,
    sum: f64,
    count: u32,
}

impl Worst {
    fn new(what: &'static str, bound: f64) -> Self {
        Self {
            what,
            bound,
            found: 0.0,
            seed: 0,
            sum: 0.0,
            count: 0,
        }
    }

    fn take(&mut self, seed: u64, value: f64) {
        self.sum += value;
        self.count += 1;
        if value > self.found || value.is_nan() {
            (self.found, self.seed) = (value, seed);
        }
    }

    fn is_kept(&self) -> bool {
        self.found <= self.bound
    }
}

fn main() -> ExitCode {
    let request = Request::parse();
    if let Some(runs) = request.repeat {
        return repeat(runs, request.preset);
    }
    let mut worst = [
        Worst::new("residual of the ledger over the emitted power", 0.10),
        Worst::new("nRMS difference between Embree and obvhs", 0.05),
        Worst::new("largest error in a furnace", 0.15),
    ];
    let mut failures = 0;
    for seed in request.seed..request.seed + request.scenes {
        let checked = catch_unwind(AssertUnwindSafe(|| check(seed, request.preset, &mut worst)));
        let failure = match checked {
            Ok(Ok(())) => continue,
            Ok(Err(failure)) => failure,
            Err(_) => "panicked".to_owned(),
        };
        println!("seed {seed}: {failure}");
        failures += 1;
    }
    println!(
        "| {} scenes from seed {} | mean | worst | seed | bound |",
        request.scenes, request.seed
    );
    println!("|---|--:|--:|--:|--:|");
    for of in &worst {
        let mean = of.sum / f64::from(of.count.max(1));
        let Worst {
            what,
            found,
            seed,
            bound,
            ..
        } = of;
        println!("| {what} | {mean:.5} | {found:.5} | {seed} | {bound} |");
    }
    let kept = worst.iter().all(Worst::is_kept);
    println!("{failures} failures");
    if kept && failures == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn repeat(runs: usize, preset: Preset) -> ExitCode {
    let mut differing = 0;
    for name in [
        "cornell-box",
        "shadow",
        "secondary",
        "emission",
        "geometry",
        "huge",
    ] {
        let scene = Scene::load(&common::scene_folder(name)).unwrap_or_else(|e| panic!("{e}"));
        for engine in [EngineChoice::Embree, EngineChoice::Obvhs] {
            let solved = |run: usize| {
                let settings = Settings {
                    options: preset.options(),
                    engine,
                    threads: [1, 2, 7, 64][run % 4],
                    ..Settings::default()
                };
                solve(&scene, &settings, &mut Silent).map(threadless)
            };
            let Ok(first) = solved(0) else {
                println!("{name}: no {engine} here");
                continue;
            };
            let others = (1..runs).filter(|run| solved(*run).ok().as_ref() != Some(&first));
            let others = others.count();
            println!("{name} by {engine}: {runs} runs, {others} with other bits");
            differing += others;
        }
    }
    if differing == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn check(seed: u64, preset: Preset, worst: &mut [Worst; 3]) -> Result<(), String> {
    let mut rng = Rng::with_seed(seed);
    let scene = room(&mut rng);
    let options = Options {
        max_shots: Some(60),
        audit_points: 32,
        ..preset.options()
    };
    let with = |engine, threads| Settings {
        options: options.clone(),
        engine,
        threads,
        ..Settings::default()
    };
    let solved =
        |settings: &Settings| solve(&scene, settings, &mut Silent).map_err(|e| e.to_string());
    let known = solved(&with(EngineChoice::Obvhs, 2))?;
    let power = known.report.power;
    worst[0].take(seed, (power.residual / power.emitted).abs());

    let resumed = in_sessions(&scene, &with(EngineChoice::Obvhs, 1), rng.usize(1..40))?;
    if threadless(resumed) != threadless(known.clone()) {
        return Err("in sessions it ends with other bits".into());
    }
    if let Ok(other) = solved(&with(EngineChoice::Embree, 0)) {
        worst[1].take(seed, difference(&known, &other));
    }

    let furnace = furnace(&mut rng);
    let settings = with(common::ENGINE, 0);
    let alike = solve(&furnace, &settings, &mut Silent).map_err(|e| e.to_string())?;
    worst[2].take(seed, furnace_error(&alike));
    Ok(())
}

/// A room with boxes, sheets and lamps; or three walls and a floor of one.
fn room(rng: &mut Rng) -> Scene {
    let mut scene = empty();
    let size = DVec3::new(1.0, 1.0, 1.0) + vector(rng) * 4.0;
    let wall = material(&mut scene, rng, 0.0);
    add_cuboid(&mut scene, wall, [DVec3::ZERO, size], true);
    if rng.u8(0..4) == 0 {
        scene.surfaces.remove(rng.usize(0..6));
    }
    for _ in 0..rng.u8(0..5) {
        let of = material(&mut scene, rng, 0.0);
        let first = scene.vertices.len();
        let half = vector(rng) * 0.25 * size.min_element() + 0.02;
        add_cuboid(&mut scene, of, [-half, half], false);
        let place = vector(rng) * size;
        // On the floor, or anywhere and any way, through walls and one another.
        let (turn, place) = if rng.bool() {
            let about = DQuat::from_rotation_y(rng.f64() * TAU);
            (about, DVec3::new(place.x, half.y, place.z))
        } else {
            (rotation(rng), place)
        };
        move_from(&mut scene, first, |p| turn * p + place);
    }
    for _ in 0..rng.u8(0..3) {
        let of = material(&mut scene, rng, 0.0);
        quad(&mut scene, of, rng, size);
        if let Some(last) = scene.surfaces.last_mut() {
            last.sides = Sides::Both;
        }
    }
    for _ in 0..rng.u8(1..4) {
        let radiance = 10f32.powf(rng.f32() * 4.0 - 2.0);
        let of = material(&mut scene, rng, radiance);
        quad(&mut scene, of, rng, size);
    }
    place_anywhere(&mut scene, rng);
    scene
}

/// A closed room in which all surfaces emit and reflect alike, with boxes that touch nothing:
/// what stands on a floor is dark below.
fn furnace(rng: &mut Rng) -> Scene {
    let mut scene = empty();
    let grey = common::shapes::add_grey(&mut scene, 0.5, 1.0);
    let size = DVec3::splat(1.0) + vector(rng) * 2.0;
    add_cuboid(&mut scene, grey, [DVec3::ZERO, size], true);
    let count = rng.u8(0..4);
    for slot in 0..count {
        let first = scene.vertices.len();
        let width = size.x / f64::from(count);
        let half = (vector(rng) * 0.2 + 0.05) * DVec3::new(width, size.y, size.z);
        add_cuboid(&mut scene, grey, [-half, half], false);
        let turn = DQuat::from_rotation_y(rng.f64() * TAU);
        let across = half.x.hypot(half.z);
        let lift = (0.05 + 0.3 * rng.f64()) * size.y;
        let z = across + rng.f64() * (size.z - 2.0 * across).max(0.0);
        let place = DVec3::new((f64::from(slot) + 0.5) * width, half.y + lift, z);
        if across < 0.5 * width.min(size.z) {
            move_from(&mut scene, first, |p| turn * p + place);
        } else {
            move_from(&mut scene, first, |p| p * 0.3 + place);
        }
    }
    place_anywhere(&mut scene, rng);
    scene
}

fn vector(rng: &mut Rng) -> DVec3 {
    DVec3::new(rng.f64(), rng.f64(), rng.f64())
}

fn rotation(rng: &mut Rng) -> DQuat {
    let [a, b, c] = (vector(rng) * TAU).to_array();
    DQuat::from_euler(EulerRot::XYZ, a, b, c)
}

fn material(scene: &mut Scene, rng: &mut Rng, radiance: f32) -> u32 {
    let colour = vector(rng).as_vec3();
    scene.materials.push(Material {
        name: format!("m{}", scene.materials.len()),
        reflectance: colour * 0.9,
        emitted_radiance: (Vec3::ONE - 0.5 * colour) * radiance,
    });
    scene.materials.len() as u32 - 1
}

/// A parallelogram anywhere in a room.
fn quad(scene: &mut Scene, material: u32, rng: &mut Rng, size: DVec3) {
    let turn = rotation(rng);
    let [width, height] = [0.05 + 0.3 * rng.f64(), 0.05 + 0.3 * rng.f64()];
    let (u, v) = (turn * DVec3::X * width, turn * DVec3::Y * height);
    let corner = (vector(rng) * 0.6 + 0.2) * size;
    add_quad(
        scene,
        material,
        [corner, corner + u, corner + u + v, corner + v],
    );
}

fn move_from(scene: &mut Scene, first: usize, place: impl Fn(DVec3) -> DVec3) {
    for vertex in &mut scene.vertices[first..] {
        *vertex = place(*vertex);
    }
}

/// Any size from millimetres to kilometres, turned any way, up to a thousand extents from the origin.
fn place_anywhere(scene: &mut Scene, rng: &mut Rng) {
    let scale = 10f64.powf(rng.f64() * 6.0 - 3.0);
    let turn = rotation(rng);
    let away = (vector(rng) - 0.5) * 10f64.powf(rng.f64() * 4.0 - 1.0);
    move_from(scene, 0, |p| (turn * p + away) * scale);
}

/// Three sessions, with a file between them.
fn in_sessions(scene: &Scene, how: &Settings, batches: usize) -> Result<Solution, String> {
    let text = |error: radiosity::SolveError| error.to_string();
    let mut run = Run::new(scene.clone(), how.clone()).map_err(text)?;
    for _ in 0..2 {
        run.go(&mut Batches(batches)).map_err(text)?;
        let left = Solution::decode(&file(&run.finish()))?;
        run = Run::resume(left, how.clone()).map_err(text)?;
    }
    run.go(&mut Silent).map_err(text)?;
    Ok(run.finish())
}

/// The bits, but for the number of threads.
fn threadless(mut solution: Solution) -> Vec<u8> {
    solution.report.threads = 0;
    bits(solution)
}

/// nRMS difference of the irradiance at the middles of the elements, by area.
fn difference(of: &Solution, other: &Solution) -> f64 {
    let prober = Prober::new(other);
    let (mut square, mut sum, mut area) = (0.0, 0.0, 0.0);
    for leaf in of.mesh.leaves() {
        let element = &of.mesh.element(leaf);
        if of.mesh.buried[element.centre as usize] {
            continue;
        }
        let here = of.light.irradiance[element.centre as usize].as_dvec3();
        let point = of.mesh.frame.leave(of.mesh.position(element.centre));
        let normal = of.mesh.patch(element.patch).normal;
        let Some(there) = prober.probe(point, normal) else {
            continue;
        };
        let weight = of.mesh.full_weight(element.centre);
        square += (here - there.irradiance.as_dvec3()).length_squared() / 3.0 * weight;
        sum += here.element_sum() / 3.0 * weight;
        area += weight;
    }
    // Where no light gets out of the lamps, both are dark.
    if square == 0.0 {
        return 0.0;
    }
    (square / area).sqrt() / (sum / area)
}

/// The largest relative error of B = 2 at a vertex that is not buried.
fn furnace_error(solution: &Solution) -> f64 {
    let vertices = solution.light.irradiance.iter().zip(&solution.mesh.buried);
    let open = vertices.filter(|(_, buried)| !**buried);
    let errors = open.map(|(e, _)| (1.0 + 0.5 * f64::from(e.x)) / 2.0 - 1.0);
    errors.map(f64::abs).fold(0.0, f64::max)
}
