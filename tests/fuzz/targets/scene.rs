//! Any files are a scene or an error.
#![no_main]

mod files;

use libfuzzer_sys::fuzz_target;
use radiosity::scene::{NamedScene, Scene};

fuzz_target!(|data: &[u8]| {
    let path = files::scene_of(data);
    if let Ok(scene) = Scene::load(&path) {
        scene.check().expect("a scene that was read is sound");
        let _ = scene.summary();
    }
    let _ = NamedScene::load(&path);
});
