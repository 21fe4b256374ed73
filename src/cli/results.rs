//! The files of a folder of results: what they are called, and which are found there.

use super::CliError;
use super::meshes::MeshFormat;
use super::solve::How;
use crate::scene::{Camera, geometry_of};
use crate::solution::Solution;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The solution file that the other commands read.
pub(super) const SOLUTION: &str = "solution.rad";

/// The state of a run that has not ended; `radiosity resume` reads it.
pub(super) const CHECKPOINT: &str = "checkpoint.rad";

/// The report for programs, and for people.
pub(super) const REPORT: &str = "report.json";
pub(super) const PAGE: &str = "report.html";

/// The pictures of a camera.
pub(super) const PICTURES: [&str; 4] = ["shaded.exr", "shaded.png", "wireframe.png", "mesh.png"];

/// The lit mesh in a format.
pub(super) fn mesh_file(format: MeshFormat) -> String {
    format!("solution.{}", format.extension())
}

/// The first camera's pictures lie in the folder itself, those of others in a folder of their name.
pub(super) fn picture_folder(folder: &Path, number: usize, camera: &Camera) -> PathBuf {
    match number {
        0 => folder.to_path_buf(),
        _ => folder.join(&camera.name),
    }
}

/// The solution in a folder, or in a file.
pub(super) fn read_solution(path: &Path) -> Result<Solution, CliError> {
    if path.is_file() {
        return Ok(Solution::read(path)?);
    }
    let file = path.join(SOLUTION);
    if !file.exists() && path.join(CHECKPOINT).is_file() {
        return Err(CliError::Input(format!(
            "{} holds a {CHECKPOINT} and no {SOLUTION}: the solve has not ended; `radiosity resume` goes on with it",
            path.display()
        )));
    }
    Ok(Solution::read(&file)?)
}

/// The folder that a solution lies in, if its folder or its file is named.
pub(super) fn folder_of(solution: &Path) -> PathBuf {
    match solution.is_file() {
        true => solution.parent().unwrap_or(Path::new("")).to_path_buf(),
        false => solution.to_path_buf(),
    }
}

/// The files of a scene that could lie where a result goes: what was named, its geometry, and what a .gltf names. Of a scene that is
/// not there any more none can be lost.
pub(super) fn inputs(scene: &Path) -> Vec<PathBuf> {
    let geometry = geometry_of(scene).unwrap_or_else(|_| scene.to_path_buf());
    let mut inputs = vec![match scene.is_dir() {
        true => scene.join("scene.toml"),
        false => scene.to_path_buf(),
    }];
    let is_text = geometry
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("gltf"));
    let text = is_text.then(|| std::fs::read(&geometry).ok()).flatten();
    let named = text.and_then(|text| serde_json::from_slice::<Value>(&text).ok());
    let lists = ["images", "buffers"].map(|list| named.as_ref()?.get(list)?.as_array());
    let uris = lists.into_iter().flatten().flatten();
    let folder = geometry.parent().unwrap_or(Path::new(""));
    inputs.extend(uris.filter_map(|it| Some(folder.join(it.get("uri")?.as_str()?))));
    inputs.push(geometry);
    inputs
}

/// Refuses a folder in which a result would replace one of these files.
pub(super) fn spare(
    inputs: &[PathBuf],
    folder: &Path,
    how: &How,
    cameras: &[Camera],
) -> Result<(), CliError> {
    let inputs: Vec<PathBuf> = inputs.iter().flat_map(|it| it.canonicalize()).collect();
    let mut results: Vec<PathBuf> = [SOLUTION, CHECKPOINT, REPORT]
        .map(|name| folder.join(name))
        .to_vec();
    results.extend((!how.no_html).then(|| folder.join(PAGE)));
    results.extend(how.formats.0.iter().map(|f| folder.join(mesh_file(*f))));
    if !how.no_pictures {
        for (number, camera) in cameras.iter().enumerate() {
            let of_camera = picture_folder(folder, number, camera);
            results.extend(PICTURES.map(|name| of_camera.join(name)));
        }
    }
    let is_input = |it: &&PathBuf| it.canonicalize().is_ok_and(|it| inputs.contains(&it));
    match results.iter().find(is_input) {
        None => Ok(()),
        Some(lost) => Err(CliError::Usage(format!(
            "{} belongs to the scene, and a result of the same name would replace it: name another folder with -o",
            lost.display()
        ))),
    }
}
