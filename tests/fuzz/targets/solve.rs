//! Any small scene can be meshed, shot into and written.
#![no_main]

mod files;

use libfuzzer_sys::fuzz_target;
use radiosity::mesh::MeshLimits;
use radiosity::scene::Scene;
use radiosity::solver::{Options, Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Run, Settings};

fuzz_target!(|data: &[u8]| {
    let Ok(scene) = Scene::load(&files::scene_of(data)) else {
        return;
    };
    if scene.surfaces.len() > 40 {
        return;
    }
    let options = Preset::Draft.options();
    let settings = Settings {
        options: Options {
            limits: MeshLimits {
                max_depth: 2,
                ..options.limits
            },
            max_shots: Some(3),
            max_elements: Some(500),
            audit_points: 8,
            ..options
        },
        engine: EngineChoice::Obvhs,
        threads: 1,
        ..Settings::default()
    };
    let mut run = Run::new(scene, settings).expect("a scene that was read can be solved");
    run.go(&mut Silent).expect("can be solved");
    let solution = run.finish();
    for light in &solution.light.irradiance {
        assert!(light.is_finite(), "{light}");
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    solution.write(&mut bytes).expect("memory can be written to");
    radiosity::solution::Solution::decode(bytes.get_ref()).expect("was just written");
    let _ = solution.lit_mesh();
});
