//! From a path to a [`Scene`]: finds the files, reads them in order and puts together what they say.

use super::settings::{self, Settings, SidesRule};
use super::text::{TextFile, quote};
use super::{
    NamedScene, Names, Scene, SceneError, cameras, duplicates, materials, mtl, obj, obj_guard,
    sides, split,
};
use std::path::{Component, Path, PathBuf};

const SCENE_FILE: &str = "scene.toml";

impl Scene {
    /// Reads a scene.
    ///
    /// `path` is a folder with a `scene.toml`, a `.toml` file with the same keys, or a bare `.obj` file, which
    /// is then in metres. Polygons are split into triangles and convex planar quads; what cannot be used is
    /// left out with one of [`Scene::warnings`].
    ///
    /// # Errors
    ///
    /// A [`SceneError`] names the file, the line, what is there and what should be.
    pub fn load(path: &Path) -> Result<Scene, SceneError> {
        Ok(load(path, SidesRule::Auto)?.scene)
    }
}

impl NamedScene {
    /// Reads a scene as [`Scene::load`] does, with the names of its polygons; but surfaces radiate from the front alone where neither
    /// the scene nor the material says `front` or `both`. Cameras serve nobody here, materials are not needed.
    ///
    /// # Errors
    ///
    /// A [`SceneError`] names the file, the line, what is there and what should be.
    pub fn load(path: &Path) -> Result<NamedScene, SceneError> {
        load(path, SidesRule::Front)
    }
}

/// Reads a scene in which `auto` sides come to `auto`.
fn load(path: &Path, auto: SidesRule) -> Result<NamedScene, SceneError> {
    if path.is_dir() {
        let scene = path.join(SCENE_FILE);
        if !scene.is_file() {
            let found = format!("a folder without {SCENE_FILE}");
            return Err(SceneError::new(
                path,
                None,
                found,
                "a folder with one, a .toml or an .obj file",
            ));
        }
        return load_toml(&scene, auto);
    }
    if !path.exists() {
        let expected = format!("a folder with a {SCENE_FILE}, a .toml or an .obj file");
        return Err(SceneError::new(
            path,
            None,
            "no such file or folder",
            expected,
        ));
    }
    if has_extension(path, "toml") {
        load_toml(path, auto)
    } else if has_extension(path, "obj") {
        assemble(path, None, auto)
    } else {
        let expected = format!("a folder with a {SCENE_FILE}, a .toml or an .obj file");
        Err(SceneError::new(
            path,
            None,
            "a file of another kind",
            expected,
        ))
    }
}

fn load_toml(path: &Path, auto: SidesRule) -> Result<NamedScene, SceneError> {
    let file = TextFile::read(path, "a scene's .toml file")?;
    let settings = settings::read(&file)?;
    let geometry = geometry_path(&file, &settings)?;
    assemble(&geometry, Some((&file, &settings)), auto)
}

/// The OBJ file that the settings name: it exists, and below the folder of the settings.
fn geometry_path(file: &TextFile, settings: &Settings) -> Result<PathBuf, SceneError> {
    let Some(geometry) = &settings.geometry else {
        return Err(file.error(None, "no `geometry`", "`geometry = \"FILE.obj\"`"));
    };
    let named = Path::new(geometry.get_ref());
    let line = file.line_at(geometry.span().start);
    let found = |what: &str| format!("the geometry {}{what}", quote(geometry.get_ref()));
    if !stays_below(named) {
        return Err(file.error(
            line,
            found(""),
            "a relative path that stays in the scene's folder",
        ));
    }
    if !has_extension(named, "obj") {
        return Err(file.error(line, found(""), "an .obj file"));
    }
    let path = file.path.parent().unwrap_or(Path::new("")).join(named);
    if !path.is_file() {
        let expected = format!("a file at {}", path.display());
        return Err(file.error(line, found(", which does not exist"), expected));
    }
    Ok(path)
}

/// Whether a relative path never leaves the folder that it starts from.
fn stays_below(path: &Path) -> bool {
    let mut depth = 0i32;
    path.components().all(|component| {
        depth += match component {
            Component::Normal(_) => 1,
            Component::CurDir => 0,
            Component::ParentDir => -1,
            Component::RootDir | Component::Prefix(_) => return false,
        };
        depth >= 0
    })
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// Reads the geometry and joins it with the settings, if there are any.
fn assemble(
    path: &Path,
    settings: Option<(&TextFile, &Settings)>,
    auto: SidesRule,
) -> Result<NamedScene, SceneError> {
    // Check the OBJ file, read its materials, then its polygons.
    let mut warnings = Vec::new();
    let file = TextFile::read(path, "an .obj file")?;
    let mut checked = obj_guard::check(&file)?;
    let library = mtl::read(&file, &checked, &mut warnings)?;
    let materials = materials::decide(&library, settings)?;
    materials::warn_of_defaults(path, &library, settings.map(|(_, s)| s), &mut warnings);
    materials::warn_of_perfect(path, &materials, &mut warnings);
    checked
        .unknown
        .report(&mut warnings, path, "line", "of unknown kind skipped");
    let (groups, group_of) = (
        std::mem::take(&mut checked.groups),
        std::mem::take(&mut checked.polygon_groups),
    );
    let polygons = obj::read(&file, checked, &library)?;

    // Split what is not a triangle or a convex planar quad, and decide which sides radiate.
    let repeated = duplicates::find(&polygons);
    let mut surfaces = split::split(path, &polygons, &repeated, &mut warnings);
    if surfaces.is_empty() {
        let found = match polygons.len() {
            0 => "no polygons".to_owned(),
            1 => "one polygon, which cannot be used".to_owned(),
            n => format!("{n} polygons, none of which can be used"),
        };
        return Err(file.error(None, found, "at least one polygon with an area"));
    }
    let rules: Vec<SidesRule> = materials
        .sides
        .iter()
        .map(|rule| {
            if *rule == SidesRule::Auto {
                auto
            } else {
                *rule
            }
        })
        .collect();
    sides::decide(&polygons, &repeated, &rules, &mut surfaces);
    let names = Names {
        file: path.to_path_buf(),
        groups,
        group_of,
        lines: polygons.lines.clone(),
    };

    let (metres_per_unit, cameras) = match settings {
        Some((file, settings)) => (
            settings.metres_per_unit(file)?,
            cameras::from_settings(file, settings)?,
        ),
        None => (1.0, Vec::new()),
    };
    let name = settings.and_then(|(_, s)| s.name.clone());
    let mut scene = Scene {
        name: name.unwrap_or_else(|| {
            path.file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        }),
        metres_per_unit,
        input_polygons: polygons.len(),
        vertices: polygons.positions,
        surfaces,
        materials: materials.list,
        cameras,
        warnings,
    };
    if scene.cameras.is_empty() {
        scene.cameras.push(cameras::overview(scene.bounds()));
    }
    Ok(NamedScene { scene, names })
}
