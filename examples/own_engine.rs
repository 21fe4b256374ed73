//! A visibility engine of one's own behind the solver: here one that counts the segments before brute force answers them.
//!
//! ```text
//! cargo run --release --example own_engine
//! ```

use radiosity::mesh::Mesh;
use radiosity::scene::Scene;
use radiosity::solver::{Preset, Silent, Solver, occluders};
use radiosity::visibility::{BruteForce, EngineInfo, Fans, Hit, Ray, Visibility};
use std::error::Error;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Answers as brute force does, and counts. Shared between threads, hence the atomic numbers.
struct Counting {
    inner: BruteForce,
    segments: AtomicUsize,
    rays: AtomicUsize,
}

impl Visibility for Counting {
    fn info(&self) -> EngineInfo {
        self.inner.info()
    }

    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>) {
        self.segments.fetch_add(fans.segments(), Ordering::Relaxed);
        self.inner.occluded(fans, masks);
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        self.rays.fetch_add(rays.len(), Ordering::Relaxed);
        self.inner.nearest(rays, hits);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::load(Path::new("scenes/geometry"))?;
    let options = Preset::Draft.options();
    let mesh = Mesh::new(&scene, options.limits);
    let engine = Counting {
        inner: BruteForce::new(&occluders(&scene, &mesh))?,
        segments: AtomicUsize::new(0),
        rays: AtomicUsize::new(0),
    };
    let outcome = Solver::new(&scene, mesh, &engine, options).run(&mut Silent);
    println!(
        "{} shots, {} segments tested for occlusion, {} rays for what is nearest",
        outcome.course.shots,
        engine.segments.load(Ordering::Relaxed),
        engine.rays.load(Ordering::Relaxed)
    );
    Ok(())
}
