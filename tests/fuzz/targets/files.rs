//! Fuzz input as the files of a scene.

use radiosity::scene::{NamedScene, Scene};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use tempfile::TempDir;

/// A folder in memory, where there is one: a file takes microseconds there.
pub static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let memory = Path::new("/dev/shm");
    let made = if memory.is_dir() {
        tempfile::tempdir_in(memory)
    } else {
        tempfile::tempdir()
    };
    made.expect("a temporary folder can be made")
});

/// Writes the OBJ, MTL and scene files that NUL separates; the path of the scene.
#[allow(dead_code)]
pub fn scene_of(data: &[u8]) -> PathBuf {
    let folder = FOLDER.path();
    let mut parts = data.splitn(3, |byte| *byte == 0);
    for name in ["s.obj", "s.mtl", "scene.toml"] {
        let text = parts.next().unwrap_or_default();
        fs::write(folder.join(name), text).expect("can be written");
    }
    if data.iter().filter(|byte| **byte == 0).count() < 2 {
        return folder.join("s.obj");
    }
    folder.to_path_buf()
}

/// Reads a file with geometry.
#[allow(dead_code)]
pub fn read_geometry(name: &str, data: &[u8]) {
    let path = FOLDER.path().join(name);
    fs::write(&path, data).expect("can be written");
    read(&path);
}

/// Reads a scene: a sound one, or an error.
#[allow(dead_code)]
pub fn read(path: &Path) {
    if let Ok(scene) = Scene::load(path) {
        scene.check().expect("a scene that was read is sound");
        let _ = scene.summary();
    }
    let _ = NamedScene::load(path);
}
