//! What several tests and examples share. Each uses a part of it.
#![allow(dead_code)]

pub mod closed_form;
pub mod reference;
pub mod shapes;

use std::path::{Path, PathBuf};

/// The folder of a scene of the project.
pub fn scene_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name)
}
