//! What a solve answers, against closed forms, invariants and an independent path tracer.

#[path = "../common/mod.rs"]
mod common;

mod bright;
mod canopy;
mod clusters;
mod conforming;
mod contact;
mod corner;
mod ducts;
mod energy;
mod estimate;
mod exact_floor;
mod files;
mod furnace;
mod integral;
mod path_traced;
mod places;
mod relight;
mod resume;
mod small_objects;
mod stopping;
mod suspended;
mod threads;
mod variants;

use common::sessions::{bits, file};
use common::{ENGINE, scene_folder};
use radiosity::scene::Scene;
use radiosity::solution::Solution;
use radiosity::solver::{Options, Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, solve};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

/// The engines that are there: obvhs always, Embree if it was built in.
fn engines() -> Vec<EngineChoice> {
    if cfg!(embree) {
        vec![EngineChoice::Embree, EngineChoice::Obvhs]
    } else {
        vec![EngineChoice::Obvhs]
    }
}

/// A scene of the project.
fn bundled(name: &str) -> Scene {
    Scene::load(&scene_folder(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene of the project solved by a preset, once for all tests.
fn by_preset(name: &'static str, preset: Preset) -> Arc<Solution> {
    type Place = Arc<OnceLock<Arc<Solution>>>;
    static SOLVED: Mutex<BTreeMap<(&str, String), Place>> = Mutex::new(BTreeMap::new());
    let key = (name, format!("{preset:?}"));
    let place = Place::clone(
        SOLVED
            .lock()
            .expect("no test panics in here")
            .entry(key)
            .or_default(),
    );
    let solution = place.get_or_init(|| Arc::new(solved(&bundled(name), preset.options())));
    Arc::clone(solution)
}

/// Solves with the given options on [`ENGINE`], with the threads that the machine gives.
fn solved(scene: &Scene, options: Options) -> Solution {
    solved_by(scene, options, ENGINE, 0)
}

fn solved_by(scene: &Scene, options: Options, engine: EngineChoice, threads: usize) -> Solution {
    let settings = Settings {
        options,
        engine,
        threads,
        ..Settings::default()
    };
    solve(scene, &settings, &mut Silent).unwrap_or_else(|error| panic!("{error}"))
}

fn draft() -> Options {
    Preset::Draft.options()
}
