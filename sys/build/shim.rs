//! Step 4: compile the C shim against the installed header.

use crate::{Missing, locate::Embree};

/// Compiles and links the shim; its static assertions check what the Rust side takes for granted.
pub fn compile(embree: &Embree) -> Result<(), Missing> {
    cc::Build::new()
        .file("shim/shim.c")
        .include(&embree.include_dir)
        .define("EMBREE_MAJOR", embree.major.to_string().as_str())
        .warnings(true)
        .cargo_warnings(false)
        .try_compile("embree4_shim")
        .map_err(|error| Missing::NotInstalled(format!("the C shim does not compile ({error})")))
}
