//! What scenes load as, what is refused, and how that is said.

mod bundled;
mod formats;
mod gltf;
mod gltf_emission;
mod gltf_lights;
mod gltf_materials;
mod gltf_refused;
mod gltf_sides;
mod mutations;
mod ply;
mod refused;
mod refused_settings;
mod sides;
mod splits;

use radiosity::scene::{Scene, SceneError};
use std::path::Path;

/// A folder of files that is removed at the end of its test.
struct Files(tempfile::TempDir);

impl Files {
    fn new<T: AsRef<[u8]>>(files: &[(&str, T)]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        for (name, content) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("is in the folder")).expect("can be made");
            std::fs::write(path, content.as_ref()).expect("can be written");
        }
        Files(folder)
    }

    fn load(&self, name: &str) -> Result<Scene, SceneError> {
        Scene::load(&self.0.path().join(name))
    }

    /// What a message says, with the folder's own path left out.
    fn plain(&self, message: &str) -> String {
        let folder = self.0.path().display().to_string();
        message
            .replace(&format!("{folder}/"), "")
            .replace(&folder, "FOLDER")
    }

    /// The message with which `name` is refused.
    fn refusal(&self, name: &str) -> String {
        match self.load(name) {
            Ok(_) => panic!("{name} was accepted"),
            Err(error) => self.plain(&error.to_string()),
        }
    }

    /// A scene and its warnings.
    fn accepted(&self, name: &str) -> (Scene, Vec<String>) {
        let scene = self.load(name).unwrap_or_else(|error| panic!("{error}"));
        let warnings = scene
            .warnings
            .iter()
            .map(|warning| self.plain(warning))
            .collect();
        (scene, warnings)
    }
}

/// Loads one OBJ file.
fn obj(text: &str) -> (Scene, Vec<String>) {
    Files::new(&[("it.obj", text)]).accepted("it.obj")
}

/// A scene of the project.
fn bundled(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    Scene::load(&path).unwrap_or_else(|error| panic!("{error}"))
}
