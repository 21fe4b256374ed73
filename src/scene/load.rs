//! From a path to a [`Scene`]: finds the files, reads them in order and puts together what they say.

use super::geometry::{self, ENDINGS, Format, Reading};
use super::settings::{self, Settings, SidesRule, UpAxis};
use super::text::{TextFile, quote};
use super::warnings::Tally;
use super::{NamedScene, Names, Scene, SceneError, cameras, duplicates, materials, sides, split};
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

const SCENE_FILE: &str = "scene.toml";

impl Scene {
    /// Reads a scene.
    ///
    /// `path` is a folder with a `scene.toml`, a `.toml` file with the same keys, or a bare `.obj`, `.glb`, `.gltf` or
    /// `.ply` file, which is then in metres with y up. Polygons are split into triangles and convex planar quads; what cannot be used is
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
    /// the scene nor the material says `front` or `both`. Cameras serve nobody here; materials are not needed, and their files may be
    /// missing, with a warning.
    ///
    /// # Errors
    ///
    /// A [`SceneError`] names the file, the line, what is there and what should be.
    pub fn load(path: &Path) -> Result<NamedScene, SceneError> {
        load(path, SidesRule::Front)
    }

    /// Reads a scene as [`Scene::load`] does, with the names of its polygons.
    ///
    /// # Errors
    ///
    /// Those of [`Scene::load`].
    pub fn load_lit(path: &Path) -> Result<NamedScene, SceneError> {
        load(path, SidesRule::Auto)
    }
}

/// The file with the geometry of the scene at `path`, as far as that can be told without reading it.
pub(crate) fn geometry_of(path: &Path) -> Result<PathBuf, SceneError> {
    let toml = match path.is_dir() {
        true => path.join(SCENE_FILE),
        false => path.to_path_buf(),
    };
    if !has_extension(&toml, "toml") {
        return Ok(toml);
    }
    let file = TextFile::read(&toml, "a scene's .toml file")?;
    Ok(geometry_path(&file, &settings::read(&file)?)?.0)
}

/// Reads a scene in which `auto` sides come to `auto`.
fn load(path: &Path, auto: SidesRule) -> Result<NamedScene, SceneError> {
    if path.is_dir() {
        let scene = path.join(SCENE_FILE);
        if !scene.is_file() {
            let found = format!("a folder without {SCENE_FILE}");
            let expected = format!("a folder with one, a .toml, {ENDINGS} file");
            return Err(SceneError::new(path, None, found, expected));
        }
        return load_toml(&scene, auto);
    }
    let expected = format!("a folder with a {SCENE_FILE}, a .toml, {ENDINGS} file");
    if let Err(reason) = path.metadata() {
        let found = match reason.kind() {
            ErrorKind::NotFound => "no such file or folder".into(),
            _ => format!("what cannot be read ({reason})"),
        };
        return Err(SceneError::new(path, None, found, expected));
    }
    if has_extension(path, "toml") {
        return load_toml(path, auto);
    }
    match Format::of(path) {
        Some(format) => assemble(path, format, None, auto),
        None => Err(SceneError::new(
            path,
            None,
            "a file of another kind",
            expected,
        )),
    }
}

fn load_toml(path: &Path, auto: SidesRule) -> Result<NamedScene, SceneError> {
    let file = TextFile::read(path, "a scene's .toml file")?;
    let settings = settings::read(&file)?;
    let (geometry, format) = geometry_path(&file, &settings)?;
    assemble(&geometry, format, Some((&file, &settings)), auto)
}

/// The geometry file that the settings name: it exists, and below the folder of the settings.
fn geometry_path(file: &TextFile, settings: &Settings) -> Result<(PathBuf, Format), SceneError> {
    let Some(geometry) = &settings.geometry else {
        return Err(file.error(
            None,
            "no `geometry`",
            "`geometry = \"FILE\"`, an .obj, .glb, .gltf or .ply file",
        ));
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
    let format = Format::of(named)
        .ok_or_else(|| file.error(line, found(""), format!("an {ENDINGS} file")))?;
    let path = file.path.parent().unwrap_or(Path::new("")).join(named);
    if !path.is_file() {
        let expected = format!("a file at {}", path.display());
        return Err(file.error(line, found(", which does not exist"), expected));
    }
    Ok((path, format))
}

/// Whether a relative path never leaves the folder that it starts from.
pub(super) fn stays_below(path: &Path) -> bool {
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
    format: Format,
    settings: Option<(&TextFile, &Settings)>,
    auto: SidesRule,
) -> Result<NamedScene, SceneError> {
    let mut warnings = Vec::new();
    let mut reading = match settings {
        Some((file, settings)) => settings.reading(file)?,
        None => Reading::default(),
    };
    // As for form factors, which take names alone: see [`NamedScene::load`].
    reading.spares_materials = auto == SidesRule::Front;
    let mut geometry = geometry::read(path, format, reading, &mut warnings)?;
    let up = settings.and_then(|(_, s)| s.up).unwrap_or_default();
    if up == UpAxis::Z {
        geometry.turn_up(UpAxis::turned);
    }
    let library = &geometry.library;
    let mut materials = materials::decide(library, settings)?;
    materials::warn_of_defaults(path, library, settings.map(|(_, s)| s), &mut warnings);
    materials::warn_of_perfect(path, &materials, &mut warnings);
    sides::shine_from_both(&mut geometry, &mut materials);
    let polygons = &geometry.polygons;

    // Split what is not a triangle or a convex planar quad, and decide which sides radiate.
    let shines = |polygon: usize| materials.emit(polygons, polygon);
    let repeated = duplicates::find(polygons, shines);
    let mut surfaces = split::split(path, polygons, &repeated, &mut warnings);
    if surfaces.is_empty() {
        return Err(nothing_usable(path, polygons.len()));
    }
    let stated = |rule: &SidesRule| {
        if *rule == SidesRule::Auto {
            auto
        } else {
            *rule
        }
    };
    let rules: Vec<SidesRule> = materials.sides.iter().map(stated).collect();
    let mut inside_out = Tally::default();
    sides::decide(polygons, &repeated, &rules, shines, &mut surfaces)
        .into_iter()
        .for_each(|polygon| inside_out.add(polygons.line(polygon)));
    let what = "of closed solids that are inside out made two-sided";
    inside_out.report(&mut warnings, path, "polygon", what);

    let cameras = match settings {
        Some((file, settings)) => cameras::from_settings(file, settings, up)?,
        None => Vec::new(),
    };
    let name = settings.and_then(|(_, s)| s.name.clone());
    let names = Names {
        file: path.to_path_buf(),
        groups: geometry.groups,
        group_of: geometry.group_of,
        lines: geometry.polygons.lines.clone(),
    };
    let mut scene = Scene {
        name: name.unwrap_or_else(|| stem(path)),
        metres_per_unit: reading.metres_per_unit,
        input_polygons: geometry.polygons.len(),
        vertices: geometry.polygons.positions,
        surfaces,
        materials: materials.list,
        cameras,
        warnings,
    };
    if scene.cameras.is_empty() {
        scene.cameras = geometry.cameras;
    }
    if scene.cameras.is_empty() {
        scene.cameras.push(cameras::overview(scene.bounds()));
    }
    Ok(NamedScene { scene, names })
}

fn nothing_usable(path: &Path, polygons: usize) -> SceneError {
    let found = match polygons {
        0 => "no polygons".to_owned(),
        1 => "one polygon, which cannot be used".to_owned(),
        n => format!("{n} polygons, none of which can be used"),
    };
    SceneError::new(path, None, found, "at least one polygon with an area")
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}
