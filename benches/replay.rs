//! How near a solve is to the speed of its rays: the occlusion rays of a solve, all that there are, once more through Embree's own calls
//! and through both engines.
//!
//! `cargo bench --bench replay` solves on one thread with each engine, interleaved with the rays of the solve alone, and prints medians:
//! the rays in packets that are ready (Embree's own calls, the widest), then as the solver asks, fan by fan. The last columns are the
//! solve by the engine of `--engine auto` in units of the first of these, and the rates of obvhs in units of Embree's: the rule of `auto` follows them.

#[cfg(embree)]
mod raw;

mod hall;
mod median;

use median::median;
use radiosity::mesh::Mesh;
use radiosity::scene::Scene;
use radiosity::solver::{Options, Preset, Silent, Solver, occluders};
use radiosity::visibility::{
    EngineChoice, EngineInfo, Fans, Hit, Obvhs, Ray, Triangles, Visibility, build,
};
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

const ROUNDS: usize = 3;

/// Rays that are kept: of a longer solve every other question, or fewer still, in the order in which they were asked.
const MOST: usize = 16_000_000;

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("one thread").install(run);
}

fn run() {
    println!(
        "                        triangles   Mrays  by fan   solve s   ready s  embree s   obvhs s  solve/ready  obvhs/embree"
    );
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for name in ["cornell-box", "shadow", "geometry"] {
        let scene = Scene::load(&scenes.join(name)).expect("the scenes of this repository load");
        for preset in [Preset::Draft, Preset::Standard] {
            replay(&format!("{name}, {preset:?}"), &scene, preset);
        }
    }
    let folder = tempfile::tempdir().expect("there is room for a file");
    let file = folder.path().join("hall.obj");
    for size in [10_000, 30_000, 100_000] {
        hall::write(&file, size);
        let scene = Scene::load(&file).expect("what was written can be read");
        replay("hall, Draft", &scene, Preset::Draft);
    }
}

fn replay(name: &str, scene: &Scene, preset: Preset) {
    let options = Options {
        audit_points: 0,
        ..preset.options()
    };
    let triangles = occluders(scene, &Mesh::new(scene, options.limits));
    let solved_with = |engine: &dyn Visibility| {
        let started = Instant::now();
        let mesh = Mesh::new(scene, options.limits);
        Solver::new(scene, mesh, engine, options.clone()).run(&mut Silent);
        started.elapsed().as_secs_f64()
    };
    let built = |choice| build(choice, &triangles, 1);
    let auto = built(EngineChoice::Auto).expect("it always is there");
    let recorder = Recorder {
        inner: &*auto,
        asked: Mutex::default(),
    };
    solved_with(&recorder);
    let asked = recorder.asked.into_inner().expect("nobody has panicked");
    let all: usize = asked.iter().map(Fans::segments).sum();
    let step = all.div_ceil(MOST);
    let asked: Vec<Fans> = asked.into_iter().step_by(step).collect();
    let segments: usize = asked.iter().map(Fans::segments).sum();
    let fans: usize = asked.iter().map(Fans::len).sum();
    // What a part of the rays takes, as if it were all of them.
    let scale = all as f64 / segments as f64;

    let mut ready = ready(&triangles, &asked);
    let embree = built(EngineChoice::Embree).ok();
    let obvhs = Obvhs::new(&triangles).expect("it takes these triangles");
    let mut seconds = [const { Vec::new() }; 4];
    for _ in 0..ROUNDS {
        seconds[0].push(solved_with(&*auto));
        seconds[1].push(scale * timed(&mut *ready));
        if let Some(embree) = &embree {
            seconds[2].push(scale * timed(|| ask(&**embree, &asked)));
        }
        seconds[3].push(scale * timed(|| ask(&obvhs, &asked)));
    }
    let [solve, ready, embree, obvhs] = seconds.map(median);
    println!(
        "{name:22} {:10} {:7.2} {:7.1} {solve:9.2} {ready:9.3} {embree:9.3} {obvhs:9.3} {:12.2} {:13.2}",
        triangles.indices.len(),
        all as f64 / 1e6,
        segments as f64 / fans as f64,
        solve / ready,
        embree / obvhs
    );
}

/// Answers as another engine does, and keeps the questions.
struct Recorder<'a> {
    inner: &'a dyn Visibility,
    asked: Mutex<Vec<Fans>>,
}

impl Visibility for Recorder<'_> {
    fn info(&self) -> EngineInfo {
        self.inner.info()
    }

    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>) {
        let mut asked = self.asked.lock().expect("nobody has panicked");
        asked.push(fans.clone());
        self.inner.occluded(fans, masks);
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        self.inner.nearest(rays, hits);
    }
}

fn ask(engine: &dyn Visibility, asked: &[Fans]) {
    let mut masks = Vec::new();
    for fans in asked {
        engine.occluded(fans, &mut masks);
    }
}

/// Embree's own calls on packets that are ready; without Embree nothing.
fn ready(triangles: &Triangles, asked: &[Fans]) -> Box<dyn FnMut()> {
    #[cfg(embree)]
    {
        let widest = radiosity::visibility::Isa::widest();
        let (_, mut answer) = raw::contender(widest, triangles, asked);
        Box::new(move || {
            std::hint::black_box(answer());
        })
    }
    #[cfg(not(embree))]
    {
        let _ = (triangles, asked);
        Box::new(|| {})
    }
}

fn timed(mut work: impl FnMut()) -> f64 {
    let started = Instant::now();
    work();
    started.elapsed().as_secs_f64()
}
