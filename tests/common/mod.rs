//! What several tests and examples share. Each uses a part of it.
#![allow(dead_code)]

pub mod closed_form;
pub mod reference;
pub mod sessions;
pub mod shapes;

use radiosity::solver::Preset;
use radiosity::visibility::EngineChoice;
use std::path::{Path, PathBuf};

/// The engine of tests about something else: Embree if it was built in, so that both have gone through them all after a build with it
/// and one without.
pub const ENGINE: EngineChoice = if cfg!(embree) {
    EngineChoice::Embree
} else {
    EngineChoice::Obvhs
};

/// The folder of a scene of the project.
pub fn scene_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name)
}

/// A preset by its name.
pub fn preset(name: &str) -> Result<Preset, String> {
    serde_json::from_value(name.into()).map_err(|e| e.to_string())
}
