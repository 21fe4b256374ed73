//! The memory of the process.

use crate::scene::{Scene, SceneError};
use std::path::Path;
use std::{panic, thread};

/// A scene of more surfaces, or a mesh of more patches, is large …
const MANY: usize = 30_000;

/// … and its lists of so many bytes or more are given back to the system when they are freed. With the heap's own rule, which keeps them,
/// a hall of a million triangles holds a sixth more. Small scenes are left alone: `staircase2` takes 3 % longer with this one.
const LARGE: u32 = 4 << 20;

/// Reads a scene and leaves no more memory behind than it needs. For programs that have the process to themselves.
pub fn load_scene(file: &Path) -> Result<Scene, SceneError> {
    // A heap of its own, which goes when the thread ends: the thousands of small lists of a file leave a tenth of all memory full of holes.
    let read = thread::scope(|threads| threads.spawn(|| Scene::load(file)).join());
    let scene = read.unwrap_or_else(|panicked| panic::resume_unwind(panicked))?;
    hold_less(scene.surfaces.len());
    Ok(scene)
}

/// Lets a solve with so many patches, or surfaces, hold no more memory than it needs.
pub(super) fn hold_less(patches: usize) {
    if patches > MANY {
        heap::give_back_blocks_of(LARGE);
    }
}

/// The most memory that the process has held so far, bytes; where Linux tells.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes << 10)
}
