//! Materials: a colour of base and emission each, one more for every mean colour that textures give to polygons.

use super::file::File;
use super::texture::{Corner, Texture};
use super::{accessor, warn, watts};
use crate::radiometry::{linear, srgb};
use crate::scene::mtl::{DEFAULT_NAME, Entry, Library, Stated};
use crate::scene::settings::SidesRule;
use crate::scene::warnings::Tally;
use ::gltf::material::AlphaMode;
use ::gltf::texture::Info;
use ::gltf::{Material, Primitive, Semantic};
use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;
use std::path::Path;

/// A material of the file (none for that of primitives without one) with the means of its two textures: as sRGB, and as the bits of numbers.
type Key = (Option<usize>, [u8; 3], [u32; 3]);

/// The materials that are used.
pub(super) struct Palette<'a> {
    file: &'a File<'a>,
    entries: Vec<Entry>,
    known: FxHashMap<Key, u32>,
    textures: FxHashMap<usize, Option<Texture>>,
    default: Option<usize>,
    transparent: usize,
    unreadable: Vec<String>,
}

impl<'a> Palette<'a> {
    pub fn new(file: &'a File<'a>) -> Self {
        Self {
            file,
            entries: Vec::new(),
            known: FxHashMap::default(),
            textures: FxHashMap::default(),
            default: None,
            transparent: 0,
            unreadable: Vec::new(),
        }
    }

    /// The coordinates of a primitive's vertices in the textures of its material; empty if it has no textures.
    pub fn coordinates(&self, primitive: &Primitive) -> Result<Vec<[DVec2; 2]>, String> {
        let infos = textures(&primitive.material());
        let mut all: Vec<[DVec2; 2]> = Vec::new();
        for (which, info) in infos.iter().enumerate() {
            let Some(info) = info else { continue };
            let transform = info.texture_transform();
            let set = transform.as_ref().and_then(|t| t.tex_coord());
            let set = Semantic::TexCoords(set.unwrap_or(info.tex_coord()));
            let Some(accessor) = primitive.get(&set) else {
                continue;
            };
            let coordinates = accessor::vectors::<2>(self.file, &accessor)?;
            all.resize(all.len().max(coordinates.len()), Default::default());
            for (place, at) in all.iter_mut().zip(coordinates) {
                let at = DVec2::from(at);
                place[which] = transform.as_ref().map_or(at, |t| transformed(at, t));
            }
        }
        Ok(all)
    }

    /// The number of a material for a polygon of these triangles.
    pub fn material(&mut self, material: Material, triangles: &[[Corner; 3]]) -> u32 {
        let [base, emission] = textures(&material).map(|info| info.map(|info| info.texture()));
        let base = base.and_then(|texture| self.texture(&texture));
        let base = base.map_or(DVec3::ONE, |texture| texture.mean(triangles, 0));
        let emission = emission.filter(|_| material.emissive_factor() != [0.0; 3]);
        let emission = emission.and_then(|texture| self.texture(&texture));
        let emission = emission.map_or(DVec3::ONE, |texture| texture.whole_mean(triangles, 1));
        let key = (material.index(), code(base), rounded(emission));
        let number = match self.known.get(&key) {
            Some(known) => *known,
            None => self.define(&material, key),
        };
        let tally = &mut self.entries[number as usize].polygons;
        tally.add(0);
        number
    }

    fn texture(&mut self, texture: &::gltf::Texture) -> Option<&Texture> {
        let (file, unreadable) = (self.file, &mut self.unreadable);
        let decoded = self.textures.entry(texture.index()).or_insert_with(|| {
            Texture::of(file, texture)
                .map_err(|reason| unreadable.push(reason))
                .ok()
        });
        decoded.as_ref()
    }

    fn define(&mut self, material: &Material, key: Key) -> u32 {
        let number = self.entries.len() as u32;
        self.known.insert(key, number);
        let Some(index) = material.index() else {
            self.default = Some(number as usize);
            self.entries.push(entry(DEFAULT_NAME.into(), None, None));
            return number;
        };
        let new = !self
            .known
            .keys()
            .any(|other| *other != key && other.0 == key.0);
        let transparent = material.alpha_mode() != AlphaMode::Opaque;
        self.transparent += usize::from(new && transparent);
        let base = colour(key.1);
        let emission = DVec3::from(key.2.map(|bits| f64::from(f32::from_bits(bits))));
        let [r, g, b, _] = match material.pbr_specular_glossiness() {
            Some(specular) => specular.diffuse_factor(),
            None => material.pbr_metallic_roughness().base_color_factor(),
        };
        let strength = f64::from(material.emissive_strength().unwrap_or(1.0));
        let emissive = DVec3::from(material.emissive_factor().map(f64::from)) * strength;
        let reflectance = self.stated(DVec3::from([r, g, b].map(f64::from)) * base);
        let radiance = self.stated(watts(emissive * emission));
        self.entries.push(Entry {
            sides: Some(match material.double_sided() {
                true => SidesRule::Both,
                false => SidesRule::Front,
            }),
            defined: true,
            ..entry(name(material, index), Some(reflectance), Some(radiance))
        });
        number
    }

    /// A black material that emits.
    pub fn light(&mut self, name: String, radiance: DVec3) -> u32 {
        let [black, radiance] = [DVec3::ZERO, radiance].map(|channels| self.stated(channels));
        self.entries.push(Entry {
            sides: Some(SidesRule::Front),
            defined: true,
            ..entry(name, Some(black), Some(radiance))
        });
        self.entries.len() as u32 - 1
    }

    fn stated(&self, channels: DVec3) -> Stated {
        Stated {
            channels,
            file: self.file.path.to_path_buf(),
            line: None,
        }
    }

    pub fn report(&self, path: &Path, warnings: &mut Vec<String>) {
        let what = "transparent materials treated as opaque";
        warn(warnings, path, self.transparent, what);
        if let Some(first) = self.unreadable.first() {
            let what = format!("textures ignored, as they cannot be read ({first})");
            warn(warnings, path, self.unreadable.len(), &what);
        }
    }

    pub fn finish(self) -> Library {
        let all = self.file.document.materials();
        let names = all.filter_map(|material| Some(name(&material, material.index()?)));
        let unused = names
            .filter(|name| !self.entries.iter().any(|entry| entry.name == *name))
            .collect();
        let mut library = Library::new(self.entries, self.default);
        library.unused = unused;
        library
    }
}

fn entry(name: String, reflectance: Option<Stated>, emitted_radiance: Option<Stated>) -> Entry {
    Entry {
        name,
        reflectance,
        emitted_radiance,
        polygons: Tally::default(),
        defined: false,
        sides: None,
    }
}

fn name(material: &Material, index: usize) -> String {
    let number = || format!("material {}", index + 1);
    material.name().map_or_else(number, str::to_owned)
}

/// The textures of base colour and emission. A material that has both ways to say what is reflected means the specular one, and the other
/// is for programs that do not know it.
fn textures<'a>(material: &Material<'a>) -> [Option<Info<'a>>; 2] {
    let base = match material.pbr_specular_glossiness() {
        Some(specular) => specular.diffuse_texture(),
        None => material.pbr_metallic_roughness().base_color_texture(),
    };
    [base, material.emissive_texture()]
}

/// `KHR_texture_transform`: scaled, then turned, then moved. Counter-clockwise is seen in the texture, where v points down: from +u to -v.
/// The matrix that the extension prints turns the other way, which is an error that no viewer follows (KhronosGroup/glTF, issue 1563).
fn transformed(at: DVec2, transform: &::gltf::texture::TextureTransform) -> DVec2 {
    let [offset, scale] = [transform.offset(), transform.scale()];
    let [offset, scale] = [offset, scale].map(|v| DVec2::from(v.map(f64::from)));
    let (sin, cos) = f64::from(transform.rotation()).sin_cos();
    let scaled = at * scale;
    let turned = DVec2::new(
        cos * scaled.x + sin * scaled.y,
        cos * scaled.y - sin * scaled.x,
    );
    turned + offset
}

/// A mean as 8-bit sRGB: as fine as the texture, and polygons that look alike share a material.
fn code(mean: DVec3) -> [u8; 3] {
    mean.to_array()
        .map(|c| (255.0 * srgb(c as f32)).round() as u8)
}

/// A mean to a two-thousandth of itself: what emits may be a few texels of many, times any strength, so no step is small enough for all.
fn rounded(mean: DVec3) -> [u32; 3] {
    const DROPPED: u32 = f32::MANTISSA_DIGITS - 1 - 10;
    let half = 1 << (DROPPED - 1);
    mean.to_array()
        .map(|c| ((c as f32).to_bits() + half) >> DROPPED << DROPPED)
}

fn colour(code: [u8; 3]) -> DVec3 {
    DVec3::from(code.map(|c| f64::from(linear(f32::from(c) / 255.0))))
}
