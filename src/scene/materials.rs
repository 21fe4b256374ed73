//! From what the files say about materials to the scene's own: overrides applied, values judged.

use super::mtl::{Entry, Library, Stated};
use super::polygons::Polygons;
use super::settings::{Channels, MaterialSettings, Settings, SidesRule};
use super::text::{TextFile, quote};
use super::{Material, SceneError, limits};
use crate::radiometry::Spectrum;
use glam::DVec3;
use rustc_hash::FxHashSet;
use std::path::Path;
use toml::Spanned;

/// What a material reflects where no file says it.
const DEFAULT_REFLECTANCE: f32 = 0.5;

/// What a channel reflects where the files say that it reflects everything: light must die out.
const WHITEST: f32 = 0.999;

/// A channel up to here is meant to be 1: the file's number was rounded.
const ROUNDED_ONE: f32 = 1.0 + 1e-6;

/// The scene's materials, with the rule for the sides of their surfaces; both indexed as the library's.
pub(super) struct Materials {
    pub list: Vec<Material>,
    pub sides: Vec<SidesRule>,
    /// Emitters that the file calls double-sided.
    pub shining: Vec<u32>,
    /// Names of those that were to reflect everything.
    perfect: Vec<String>,
}

impl Materials {
    /// Whether a polygon gives light of its own.
    pub fn emit(&self, polygons: &Polygons, polygon: usize) -> bool {
        self.list[polygons.materials[polygon] as usize].emits()
    }
}

/// Judges every material of the library, as overridden by the settings (and the file they stand in).
pub(super) fn decide(
    library: &Library,
    settings: Option<(&TextFile, &Settings)>,
) -> Result<Materials, SceneError> {
    if let Some((file, settings)) = settings {
        refuse_unknown_names(file, settings, library)?;
    }
    let scene_rule = settings.and_then(|(_, s)| s.sides);
    let mut materials = Materials {
        list: Vec::new(),
        sides: Vec::new(),
        shining: Vec::new(),
        perfect: Vec::new(),
    };
    for (number, entry) in (0..).zip(&library.entries) {
        let over =
            settings.and_then(|(file, s)| Some((file, s.material.get(&entry.name)?.get_ref())));
        let rule = over.and_then(|(_, material)| material.sides);
        let (material, perfect) = material(entry, over)?;
        let name = quote(&material.name);
        // Materials that differ in the colour of a texture share a name.
        if perfect && !materials.perfect.contains(&name) {
            materials.perfect.push(name);
        }
        let rule = match rule.or(scene_rule) {
            None | Some(SidesRule::Auto) => entry.sides.unwrap_or(SidesRule::Auto),
            Some(rule) => rule,
        };
        let both = (entry.sides, rule) == (Some(SidesRule::Both), SidesRule::Both);
        if both && material.emits() {
            materials.shining.push(number);
        }
        materials.list.push(material);
        materials.sides.push(rule);
    }
    Ok(materials)
}

/// One material, as its MTL file and then the settings have it, and whether it was to reflect everything.
fn material(
    entry: &Entry,
    over: Option<(&TextFile, &MaterialSettings)>,
) -> Result<(Material, bool), SceneError> {
    let name = entry.name.clone();
    let mut reflectance = Spectrum::splat(DEFAULT_REFLECTANCE);
    if let Some(stated) = stated(&entry.reflectance, over, |m| m.reflectance.as_ref()) {
        // Judged as stored: a reflectance just below 1 must not become 1 by rounding.
        reflectance = stated.channels.as_vec3();
        let channels = reflectance.to_array();
        if !channels.iter().all(|c| (0.0..=ROUNDED_ONE).contains(c)) {
            let expected = "0 <= reflectance <= 1 in each channel";
            return Err(stated.refused("reflectance", &name, expected));
        }
    }
    let perfect = reflectance.max_element() >= 1.0;
    let reflectance = reflectance.map(|channel| if channel >= 1.0 { WHITEST } else { channel });
    let mut emitted_radiance = Spectrum::ZERO;
    if let Some(stated) = stated(&entry.emitted_radiance, over, |m| {
        m.emitted_radiance.as_ref()
    }) {
        emitted_radiance = stated.channels.as_vec3();
        let channels = emitted_radiance.to_array();
        if !channels
            .iter()
            .all(|c| (0.0..=limits::RADIANCE).contains(c))
        {
            let expected = "0 <= radiance <= 1e30 in each channel";
            return Err(stated.refused("emitted radiance", &name, expected));
        }
    }
    let material = Material {
        name,
        reflectance,
        emitted_radiance,
    };
    Ok((material, perfect))
}

impl Stated {
    fn refused(&self, quantity: &str, material: &str, expected: &str) -> SceneError {
        let DVec3 { x, y, z } = self.channels;
        let found = format!("the {quantity} ({x}, {y}, {z}) of {}", quote(material));
        SceneError::new(&self.file, self.line, found, expected)
    }
}

/// Warns of materials that had to be made up, wholly or in part.
pub(super) fn warn_of_defaults(
    file: &Path,
    library: &Library,
    settings: Option<&Settings>,
    warnings: &mut Vec<String>,
) {
    let overridden = |entry: &Entry| {
        settings
            .and_then(|s| s.material.get(&entry.name))
            .is_some_and(|m| m.get_ref().reflectance.is_some())
    };
    let grey: Vec<&Entry> = library
        .entries
        .iter()
        .filter(|e| e.reflectance.is_none() && !overridden(e))
        .collect();
    for entry in grey.iter().filter(|entry| !entry.defined) {
        let what = match Some(&entry.name) == library.default_name() {
            true => format!("without a material, given a grey of {DEFAULT_REFLECTANCE}"),
            false => {
                format!(
                    "of material {}, which no .mtl file defines, given a grey of {DEFAULT_REFLECTANCE}",
                    quote(&entry.name)
                )
            }
        };
        entry.polygons.report(warnings, file, "polygon", &what);
    }
    let names: Vec<String> = grey
        .iter()
        .filter(|e| e.defined)
        .map(|e| quote(&e.name))
        .collect();
    if !names.is_empty() {
        let (count, plural) = (names.len(), if names.len() == 1 { "" } else { "s" });
        let list = shortened(&names);
        let file = file.display();
        warnings.push(format!("{file}: {count} material{plural} without `Kd` given a grey of {DEFAULT_REFLECTANCE}: {list}"));
    }
}

/// Warns of materials that were to reflect everything.
pub(super) fn warn_of_perfect(file: &Path, materials: &Materials, warnings: &mut Vec<String>) {
    let names = &materials.perfect;
    if !names.is_empty() {
        let (count, plural) = (names.len(), if names.len() == 1 { "" } else { "s" });
        let (file, list) = (file.display(), shortened(names));
        warnings.push(format!(
            "{file}: {count} material{plural} with a reflectance of 1 given {WHITEST} in that channel: {list}"
        ));
    }
}

/// What the settings state, or else what the MTL file does.
fn stated(
    own: &Option<Stated>,
    over: Option<(&TextFile, &MaterialSettings)>,
    pick: impl Fn(&MaterialSettings) -> Option<&Spanned<Channels>>,
) -> Option<Stated> {
    let overriding = over.and_then(|(file, settings)| {
        let channels = pick(settings)?;
        Some(Stated {
            channels: DVec3::from_array(channels.get_ref().0),
            file: file.path.clone(),
            line: Some(file.line_at(channels.span().start)),
        })
    });
    overriding.or_else(|| own.clone())
}

fn refuse_unknown_names(
    file: &TextFile,
    settings: &Settings,
    library: &Library,
) -> Result<(), SceneError> {
    let used = library.entries.iter().map(|entry| &entry.name);
    let all = || used.clone().chain(&library.unused);
    let names: FxHashSet<&String> = all().collect();
    match (settings.material.iter()).find(|(name, _)| !names.contains(name)) {
        None => Ok(()),
        Some((name, table)) => {
            // Materials that differ in the colour of a texture share a name.
            let mut listed = FxHashSet::default();
            let names: Vec<String> = all()
                .filter(|name| listed.insert(*name))
                .map(|name| quote(name))
                .collect();
            let expected = match names.is_empty() {
                true => "no materials, as the geometry has none".to_owned(),
                false => format!("a material of the geometry: {}", shortened(&names)),
            };
            Err(file.error(
                file.line_at(table.span().start),
                format!("the material {}", quote(name)),
                expected,
            ))
        }
    }
}

/// The first few names of a list.
fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown = names[..names.len().min(SHOWN)].join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}
