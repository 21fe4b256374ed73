//! Materials from the MTL files that an OBJ file names.
//!
//! As with polygons, a scan of our own checks the lines that matter and hands `tobj` the same materials in
//! their plainest form.

use super::SceneError;
use super::obj_guard::{CheckedObj, UsedMaterial, name_of, without_comment};
use super::settings::SidesRule;
use super::text::{TextFile, quote};
use super::warnings::Tally;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The materials of a scene's MTL files, then those that only the OBJ file names.
#[derive(Default)]
pub(super) struct Library {
    /// In order of definition; no two with the same name.
    pub entries: Vec<Entry>,
    /// The material of polygons that name none, if there are any such.
    pub default: Option<usize>,
    /// Names of materials that the file defines and nothing has, where these are not among the entries.
    pub unused: Vec<String>,
    tobj: Vec<tobj::Material>,
}

/// A material as its file has it.
pub(super) struct Entry {
    /// Its name.
    pub name: String,
    /// `Kd`, if the file has it.
    pub reflectance: Option<Stated>,
    /// `Ke`, if the file has it.
    pub emitted_radiance: Option<Stated>,
    /// The polygons that use it.
    pub polygons: Tally,
    /// Whether any file defines it.
    pub defined: bool,
    /// Which sides radiate, if the file says it.
    pub sides: Option<SidesRule>,
}

/// Three numbers, not yet judged, and where they stand.
#[derive(Debug, Clone)]
pub(super) struct Stated {
    pub channels: DVec3,
    pub file: PathBuf,
    pub line: Option<usize>,
}

/// The name under which polygons without a material find one, and can be given one in a `scene.toml`.
pub(super) const DEFAULT_NAME: &str = "default";

impl Library {
    /// A library of materials that do not come from MTL files.
    pub fn new(entries: Vec<Entry>, default: Option<usize>) -> Self {
        Self {
            entries,
            default,
            unused: Vec::new(),
            tobj: Vec::new(),
        }
    }

    /// The name of the material of polygons that name none.
    pub fn default_name(&self) -> Option<&String> {
        self.default.map(|index| &self.entries[index].name)
    }

    /// What `tobj` wants to know of materials when it reads polygons.
    pub fn for_tobj(&self) -> tobj::MTLLoadResult {
        let indices = self
            .tobj
            .iter()
            .enumerate()
            .map(|(i, m)| (m.name.clone(), i))
            .collect();
        Ok((self.tobj.clone(), indices))
    }
}

/// Reads every library that `obj` names, and adds the materials that it uses without a definition. A library may be missing if that is `spared`.
pub(super) fn read(
    file: &TextFile,
    obj: &CheckedObj,
    spared: bool,
    warnings: &mut Vec<String>,
) -> Result<Library, SceneError> {
    let mut scan = Scan::default();
    let mut seen = Vec::new();
    for (line, named) in &obj.libraries {
        let paths = match library_paths(file, *line, named) {
            Err(missing) if spared => {
                warnings.push(format!("{missing}; went on without it"));
                continue;
            }
            found => found?,
        };
        for path in paths {
            if !seen.contains(&path) {
                scan.file(&TextFile::read(&path, "an .mtl file")?, warnings)?;
                seen.push(path);
            }
        }
    }
    for UsedMaterial { name, polygons } in &obj.used_materials {
        let index = scan
            .index_of(name)
            .unwrap_or_else(|| scan.define(name, false));
        scan.entries[index].polygons = *polygons;
    }
    let mut default = None;
    if obj.without_material.count > 0 {
        let index = scan
            .index_of(DEFAULT_NAME)
            .unwrap_or_else(|| scan.define(DEFAULT_NAME, false));
        scan.entries[index].polygons = obj.without_material;
        default = Some(index);
    }
    let (entries, tobj) = scan.finish(file)?;
    Ok(Library {
        entries,
        default,
        unused: Vec::new(),
        tobj,
    })
}

/// The files that a `mtllib` means: one whose name may hold spaces, or several.
fn library_paths(file: &TextFile, line: usize, named: &str) -> Result<Vec<PathBuf>, SceneError> {
    let folder = file.path.parent().unwrap_or(Path::new(""));
    let find = |name: &str| {
        let here = [folder.join(name), folder.join(name.replace('\\', "/"))];
        here.into_iter().find(|path| path.is_file())
    };
    if let Some(path) = find(named) {
        return Ok(vec![path]);
    }
    let named = match without_comment(named, |word| word.starts_with('#')) {
        "" => named,
        name => name,
    };
    if let Some(path) = find(named) {
        return Ok(vec![path]);
    }
    let missing = |name: &str| {
        let expected = format!("an .mtl file of that name in {}", folder_name(folder));
        file.error(
            line,
            format!("`mtllib {name}`, a file that does not exist"),
            expected,
        )
    };
    match named
        .split_whitespace()
        .map(|name| find(name).ok_or_else(|| missing(name)))
        .collect()
    {
        Ok(paths) => Ok(paths),
        // Of a single name with spaces the whole is missing, not its first word.
        Err(_) if !named.split_whitespace().any(|name| find(name).is_some()) => Err(missing(named)),
        Err(error) => Err(error),
    }
}

fn folder_name(folder: &Path) -> String {
    match folder.as_os_str().is_empty() {
        true => "the current folder".to_owned(),
        false => folder.display().to_string(),
    }
}

/// The state of the scan: what is defined, and the plain text for `tobj`.
#[derive(Default)]
struct Scan {
    entries: Vec<Entry>,
    /// Where each name is in `entries`.
    index: FxHashMap<String, usize>,
    text: String,
}

impl Scan {
    fn index_of(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    fn define(&mut self, name: &str, defined: bool) -> usize {
        let entry = Entry {
            name: name.to_owned(),
            reflectance: None,
            emitted_radiance: None,
            polygons: Tally::default(),
            defined,
            sides: None,
        };
        self.index.insert(name.to_owned(), self.entries.len());
        self.entries.push(entry);
        let _ = writeln!(self.text, "newmtl {name}");
        self.entries.len() - 1
    }

    fn file(&mut self, file: &TextFile, warnings: &mut Vec<String>) -> Result<(), SceneError> {
        let mut current = Current::None;
        let (mut repeated, mut textures) = (Tally::default(), Tally::default());
        let (mut transparent, mut opacity) = (Tally::default(), Opacity::default());
        for (line, text) in file.lines() {
            let mut words = text
                .split_ascii_whitespace()
                .take_while(|word| !word.starts_with('#'));
            let Some(keyword) = words.next() else {
                continue;
            };
            match keyword {
                "newmtl" => match name_of(&text, keyword) {
                    "" => {
                        return Err(file.error(
                            line,
                            "`newmtl` without a name",
                            "the name of a material",
                        ));
                    }
                    name => {
                        std::mem::take(&mut opacity).count(&mut transparent);
                        current = match self.index_of(name) {
                            Some(_) => {
                                repeated.add(line);
                                Current::Skipped
                            }
                            None => Current::Entry(self.define(name, true)),
                        };
                    }
                },
                "Kd" | "Ke" => {
                    let channels = channels(words).map_err(|found| {
                        file.error(
                            line,
                            format!("`{keyword}` with {found}"),
                            format!("`{keyword} r g b`"),
                        )
                    })?;
                    let stated = Stated {
                        channels,
                        file: file.path.clone(),
                        line: Some(line),
                    };
                    self.state(current, keyword, stated)
                        .map_err(|found| file.error(line, found, "`newmtl NAME` first"))?;
                }
                "d" | "Tr" => opacity.state(keyword, words, line),
                _ if keyword.starts_with("map_K") || keyword == "map_d" => textures.add(line),
                _ => {}
            }
        }
        opacity.count(&mut transparent);
        repeated.report(
            warnings,
            &file.path,
            "material",
            "defined again: the first definition holds",
        );
        textures.report(
            warnings,
            &file.path,
            "texture",
            "ignored: a material has one colour",
        );
        transparent.report(
            warnings,
            &file.path,
            "transparent material",
            "treated as opaque",
        );
        Ok(())
    }

    fn state(&mut self, current: Current, keyword: &str, stated: Stated) -> Result<(), String> {
        let index = match current {
            Current::None => return Err(format!("`{keyword}` before any material")),
            Current::Skipped => return Ok(()),
            Current::Entry(index) => index,
        };
        let DVec3 { x, y, z } = stated.channels;
        let _ = writeln!(self.text, "{keyword} {x} {y} {z}");
        let entry = &mut self.entries[index];
        *if keyword == "Kd" {
            &mut entry.reflectance
        } else {
            &mut entry.emitted_radiance
        } = Some(stated);
        Ok(())
    }

    /// Lets `tobj` read the plain text; its values are the ones that count.
    fn finish(mut self, file: &TextFile) -> Result<(Vec<Entry>, Vec<tobj::Material>), SceneError> {
        let (tobj, _) = tobj::load_mtl_buf(&mut self.text.as_bytes()).map_err(|error| {
            file.error(
                None,
                format!("materials that cannot be read ({error})"),
                "MTL files",
            )
        })?;
        for (entry, read) in self.entries.iter_mut().zip(&tobj) {
            for (stated, value) in [
                (&mut entry.reflectance, read.diffuse),
                (&mut entry.emitted_radiance, read.emissive),
            ] {
                if let (Some(stated), Some(value)) = (stated, value) {
                    stated.channels = DVec3::from_array(value);
                }
            }
        }
        Ok((self.entries, tobj))
    }
}

/// The material that a line of an MTL file describes.
#[derive(Clone, Copy)]
enum Current {
    None,
    Skipped,
    Entry(usize),
}

/// What lets light through of a material, with the line: `d`, or else `Tr`, which is 1 less `d` and which some programs write beside it as the same.
#[derive(Default)]
struct Opacity {
    dissolve: Option<(f64, usize)>,
    transparency: Option<(f64, usize)>,
}

impl Opacity {
    fn state<'a>(&mut self, keyword: &str, words: impl Iterator<Item = &'a str>, line: usize) {
        let mut numbers = words.filter(|word| *word != "-halo").map(str::parse);
        let Some(Ok(number)) = numbers.next() else {
            return;
        };
        match keyword {
            "d" => self.dissolve = Some((number, line)),
            _ => self.transparency = Some((number, line)),
        }
    }

    fn count(self, transparent: &mut Tally) {
        let by_dissolve = self.dissolve.map(|(d, line)| (d < 1.0, line));
        let by_transparency = self.transparency.map(|(t, line)| (t > 0.0, line));
        if let Some((true, line)) = by_dissolve.or(by_transparency) {
            transparent.add(line);
        }
    }
}

/// Three numbers, or one that stands for three.
fn channels<'a>(words: impl Iterator<Item = &'a str>) -> Result<DVec3, String> {
    let mut values = Vec::new();
    for word in words {
        values.push(word.parse::<f64>().map_err(|_| quote(word))?);
    }
    match values[..] {
        [grey] => Ok(DVec3::splat(grey)),
        [r, g, b] => Ok(DVec3::new(r, g, b)),
        _ => Err(format!("{} numbers", values.len())),
    }
}
