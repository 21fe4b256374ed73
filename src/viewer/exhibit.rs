//! What is looked at: a lit mesh, the names of its surfaces, and how bright it is.

use crate::radiometry::{Spectrum, photometric};
use crate::scene::{Camera, Names};
use crate::solution::{LitMesh, LitTriangle, LitVertex, Solution};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// The scales of false colours end where this share of the area is below: a lamp's own glare would leave the rest in the dark.
const BELOW: f64 = 0.99;

/// A lit mesh with what a viewer needs to know of it.
#[derive(Debug, Clone)]
pub struct Exhibit {
    /// The light.
    pub lit: LitMesh,
    /// What the surfaces are called.
    pub labels: Labels,
    /// Lumens per watt.
    pub efficacy: f64,
    /// Illuminance that nearly all of the area is below, lx.
    pub(super) illuminance: f64,
    /// Radiosity, mean of the channels, that nearly all of the area is below, lamps left out, W/m².
    pub(super) radiosity: f64,
}

/// What the surfaces of a solution are called.
#[derive(Debug, Clone, Default)]
pub struct Labels {
    /// What is known of each polygon from its file.
    pub names: Names,
    materials: FxHashMap<u32, String>,
    known: bool,
}

impl Labels {
    /// The names of a solution's materials, and those of its polygons where they are known.
    pub fn of(solution: &Solution, names: Names) -> Self {
        let surfaces = solution.continuation.iter().flat_map(|known| {
            let name = |material: u32| known.scene.materials[material as usize].name.clone();
            let surfaces = known.scene.surfaces.iter();
            surfaces.map(move |surface| (surface.polygon, name(surface.material)))
        });
        Self {
            materials: surfaces.collect(),
            names,
            known: true,
        }
    }

    /// What a polygon is called: its group and its material as far as they are known, and its place in the file or its number.
    /// Empty where polygons are not known.
    pub(super) fn polygon(&self, polygon: u32) -> String {
        if !self.known {
            return String::new();
        }
        let group = self.names.group(polygon).into_iter();
        let material = self.materials.get(&polygon).map(String::as_str);
        let mut parts: Vec<&str> = group.chain(material).collect();
        let place = self.names.place(polygon);
        parts.push(&place);
        parts.join(", ")
    }
}

impl Exhibit {
    /// Gets a lit mesh ready to be looked at; `efficacy` is in lumens per watt.
    pub fn new(lit: LitMesh, labels: Labels, efficacy: f64) -> Self {
        let illuminance = level(&lit, |vertex| {
            Some(photometric(vertex.irradiance, efficacy))
        });
        let reflected = |vertex: &LitVertex| {
            let emits = vertex.radiosity.cmpgt(vertex.irradiance).any();
            (!emits).then(|| mean(vertex.radiosity))
        };
        Self {
            illuminance,
            radiosity: level(&lit, reflected),
            lit,
            labels,
            efficacy,
        }
    }

    /// The longest side of the box around everything, in scene units; 1 if there is nothing.
    pub fn extent(&self) -> f64 {
        let (low, high) = bounds(&self.lit);
        let extent = (high - low).max_element();
        if extent.is_finite() && extent > 0.0 {
            extent
        } else {
            1.0
        }
    }

    /// A camera that sees everything, for files that have none.
    pub fn camera(&self) -> Camera {
        let (low, high) = bounds(&self.lit);
        let (middle, size) = match low.is_finite() && high.is_finite() {
            true => ((low + high) / 2.0, (high - low).length().max(1e-9)),
            false => (DVec3::ZERO, 1.0),
        };
        Camera {
            name: "all".into(),
            eye: middle + DVec3::new(0.6, 0.5, 1.0).normalize() * 1.3 * size,
            look_at: middle,
            up: DVec3::Y,
            horizontal_fov: 45.0,
            width: 1024,
            height: 768,
            exposure: None,
        }
    }
}

fn bounds(lit: &LitMesh) -> (DVec3, DVec3) {
    let all = lit.positions.iter();
    all.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(*p), high.max(*p))
    })
}

fn mean(spectrum: Spectrum) -> f64 {
    f64::from(spectrum.element_sum()) / 3.0
}

/// The value that [`BELOW`] of the area is below, of what has one.
fn level(lit: &LitMesh, value: impl Fn(&LitVertex) -> Option<f64>) -> f64 {
    let of_triangle = |triangle: &LitTriangle| {
        let corners = triangle.vertices.map(|v| &lit.vertices[v as usize]);
        let [a, b, c] = corners.map(|corner| lit.positions[corner.position as usize]);
        let sum: Option<f64> = corners.iter().map(|corner| value(corner)).sum();
        Some((sum? / 3.0, (b - a).cross(c - a).length()))
    };
    let mut values: Vec<(f64, f64)> = lit.triangles.iter().filter_map(of_triangle).collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = values.iter().map(|(_, area)| area).sum();
    let mut passed = 0.0;
    let reached = values.iter().find(|(_, area)| {
        passed += area;
        passed >= BELOW * whole
    });
    reached.map_or(0.0, |(value, _)| *value)
}
