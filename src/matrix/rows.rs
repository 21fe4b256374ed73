//! What the rows of a matrix stand for: sides of surfaces, one by one or in groups.

use super::convex::Convex;
use super::divide::divided;
use super::facet::Facet;
use super::{By, Options};
use crate::geometry::Frame;
use crate::mesh::{Regions, split_at_contacts};
use crate::radiometry::{Power, exitance_from_radiance};
use crate::scene::{NamedScene, Names, Scene, Sides, Surface};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// A row, and a column, of a matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Unique within the matrix: the name of the group or material, with the number of the polygon in it where there are several,
    /// `/` and the number of the part where it is divided, and ` back` for the back of a two-sided surface. `'` follows where the file has that
    /// name for something else.
    pub label: String,
    /// Area of its radiating sides, m², less what is covered.
    pub area: f64,
    /// Area, m², that nothing can reach: below what stands on it, or within a solid. It does not radiate.
    pub covered: f64,
    /// Whether it is the back.
    pub back: bool,
    /// Reflectance ρ, the mean over its area.
    pub reflectance: Power,
    /// Exitance M, W/m², the mean over its area; 0 for a back.
    pub exitance: Power,
}

impl Row {
    /// The share of its surfaces that is covered.
    pub fn covered_share(&self) -> f64 {
        self.covered / (self.area + self.covered).max(f64::MIN_POSITIVE)
    }
}

/// Rows with their facets.
#[derive(Debug)]
pub(super) struct Rows {
    pub list: Vec<Row>,
    /// Flat pieces in the frame, row after row.
    pub facets: Vec<Facet>,
    /// Area of each row in the frame.
    pub areas: Vec<f64>,
    /// The facets of each row.
    pub of_row: Vec<Range<u32>>,
    /// Surfaces that could not be split where others meet them.
    pub unsplit: usize,
}

/// What belongs into one row: a name, and which part of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Key {
    Part { polygon: u32, part: u32 },
    Group(u32),
    Material(u32),
}

impl Rows {
    /// `covered` tells for facets whether nothing can reach them.
    pub fn new(
        named: &NamedScene,
        frame: &Frame,
        options: &Options,
        covered: impl FnOnce(&[Facet]) -> Vec<bool>,
    ) -> Self {
        let NamedScene { scene, names } = named;
        let parts = options
            .max_area
            .map(|area| divided(scene, area / scene.metres_per_unit.powi(2)));
        let cells = parts.as_ref().unwrap_or(scene);
        let keys = keys(cells, names, options);
        let pieces = split_at_contacts(cells, frame, &Regions::default(), 0.0);

        // Rows in the order of their first surfaces, the back after the front.
        let mut numbers: FxHashMap<(Key, bool), u32> = FxHashMap::default();
        let mut drafts: Vec<Draft> = Vec::new();
        for (surface, key) in cells.surfaces.iter().zip(&keys) {
            let backs: &[bool] = if surface.sides == Sides::Both {
                &[false, true]
            } else {
                &[false]
            };
            for back in backs {
                numbers.entry((*key, *back)).or_insert_with(|| {
                    drafts.push(Draft::new(*key, *back));
                    drafts.len() as u32 - 1
                });
            }
        }
        let (mut facets, mut from) = (Vec::new(), Vec::new());
        for piece in &pieces.list {
            let surface = &cells.surfaces[piece.surface as usize];
            for back in [false, true] {
                let Some(row) = numbers.get(&(keys[piece.surface as usize], back)) else {
                    continue;
                };
                if back && surface.sides != Sides::Both {
                    continue;
                }
                let mut corners = piece.corners().to_vec();
                if back {
                    corners.reverse();
                }
                if let Some(facet) = Facet::new(Convex::new(&corners)) {
                    facets.push(facet);
                    from.push((*row, surface));
                }
            }
        }
        let covered = covered(&facets);
        let mut of_facet: Vec<(u32, Facet)> = Vec::new();
        for ((facet, (row, surface)), is_covered) in facets.into_iter().zip(from).zip(covered) {
            drafts[row as usize].add(&facet, surface, scene, is_covered);
            if !is_covered {
                of_facet.push((row, facet));
            }
        }
        // Stable: within a row facets keep the order of the surfaces.
        of_facet.sort_by_key(|(row, _)| *row);
        let labels = labels(&drafts, scene, names, options);
        let unit = (scene.metres_per_unit / frame.scale()).powi(2);
        let mut begin = 0;
        let of_row = drafts.iter().map(|draft| {
            let range = begin..begin + draft.facets;
            begin = range.end;
            range
        });
        Self {
            of_row: of_row.collect(),
            areas: drafts.iter().map(|draft| draft.exposed.area).collect(),
            list: drafts
                .iter()
                .zip(labels)
                .map(|(draft, label)| draft.finish(label, unit))
                .collect(),
            facets: of_facet.into_iter().map(|(_, facet)| facet).collect(),
            unsplit: pieces.unsplit,
        }
    }
}

/// The key of every cell.
fn keys(cells: &Scene, names: &Names, options: &Options) -> Vec<Key> {
    // What a texture colours differently is one material all the same.
    let mut first_of_name: FxHashMap<&str, u32> = FxHashMap::default();
    let named: Vec<u32> = (0..)
        .zip(&cells.materials)
        .map(|(number, material)| *first_of_name.entry(&material.name).or_insert(number))
        .collect();
    let mut last = None;
    let mut part = 0;
    let key = |surface: &Surface| {
        part = match last {
            Some(polygon) if polygon == surface.polygon && options.max_area.is_some() => part + 1,
            _ => 0,
        };
        last = Some(surface.polygon);
        match (options.by, names.group_of.get(surface.polygon as usize)) {
            (By::Material, _) => Key::Material(named[surface.material as usize]),
            (By::Group, Some(Some(group))) => Key::Group(*group),
            (By::Group, _) => Key::Part {
                polygon: surface.polygon,
                part: 0,
            },
            (By::Surface, _) => Key::Part {
                polygon: surface.polygon,
                part,
            },
        }
    };
    cells.surfaces.iter().map(key).collect()
}

/// A row while its facets come together.
struct Draft {
    key: Key,
    back: bool,
    /// How many of them are exposed.
    facets: u32,
    exposed: Sum,
    covered: Sum,
}

/// Area in the frame, and what it reflects and emits.
#[derive(Default)]
struct Sum {
    area: f64,
    reflected: Power,
    emitted: Power,
}

impl Draft {
    fn new(key: Key, back: bool) -> Self {
        Self {
            key,
            back,
            facets: 0,
            exposed: Sum::default(),
            covered: Sum::default(),
        }
    }

    fn add(&mut self, facet: &Facet, surface: &Surface, scene: &Scene, is_covered: bool) {
        let material = &scene.materials[surface.material as usize];
        self.facets += u32::from(!is_covered);
        let sum = match is_covered {
            true => &mut self.covered,
            false => &mut self.exposed,
        };
        sum.area += facet.area;
        sum.reflected += material.reflectance.as_dvec3() * facet.area;
        if !self.back {
            sum.emitted +=
                exitance_from_radiance(material.emitted_radiance).as_dvec3() * facet.area;
        }
    }

    fn finish(&self, label: String, unit: f64) -> Row {
        // What is covered altogether keeps its material.
        let sum = match self.exposed.area > 0.0 {
            true => &self.exposed,
            false => &self.covered,
        };
        let area = sum.area.max(f64::MIN_POSITIVE);
        Row {
            label,
            area: self.exposed.area * unit,
            covered: self.covered.area * unit,
            back: self.back,
            reflectance: sum.reflected / area,
            exitance: sum.emitted / area,
        }
    }
}

fn labels(drafts: &[Draft], scene: &Scene, names: &Names, options: &Options) -> Vec<String> {
    // A polygon alone in its group goes by the group's name.
    let mut members: FxHashMap<u32, u32> = FxHashMap::default();
    let in_group: Vec<u32> = names
        .group_of
        .iter()
        .map(|group| {
            let count = members.entry(group.unwrap_or(u32::MAX)).or_insert(0);
            *count += 1;
            *count
        })
        .collect();
    let mut parts: FxHashMap<u32, u32> = FxHashMap::default();
    for draft in drafts {
        if let Key::Part { polygon, part } = draft.key {
            let count = parts.entry(polygon).or_insert(0);
            *count = (*count).max(part + 1);
        }
    }
    let mut taken: FxHashSet<String> = FxHashSet::default();
    let label = |draft: &Draft| {
        let mut label = match draft.key {
            Key::Material(material) => scene.materials[material as usize].name.clone(),
            Key::Group(group) => names.groups[group as usize].clone(),
            Key::Part { polygon, part } => {
                let mut label = match names.group(polygon) {
                    None => (polygon + 1).to_string(),
                    Some(group) => {
                        let number = names.group_of[polygon as usize].unwrap_or(u32::MAX);
                        match members[&number] {
                            1 => group.to_owned(),
                            _ => format!("{group}:{}", in_group[polygon as usize]),
                        }
                    }
                };
                if options.max_area.is_some() && parts[&polygon] > 1 {
                    label += &format!("/{}", part + 1);
                }
                label
            }
        };
        if draft.back {
            label += " back";
        }
        // A name in the file may be what another row is called here.
        while !taken.insert(label.clone()) {
            label.push('\'');
        }
        label
    };
    drafts.iter().map(label).collect()
}
