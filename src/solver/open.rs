//! The light of a solved mesh at points that lie on no surface: a plane of work, a meter on a stand.

use super::audit::FINER;
use super::behind::Backing;
use super::escape::is_dark;
use super::light::{Light, Sign};
use super::options::Options;
use super::shoot::{Shooter, evaluate};
use super::source::{cells_of, source_from};
use super::tiling::Tiling;
use crate::form_factor::{Formula, Receiver, Sampler};
use crate::geometry::{cosine_direction, jitter};
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use crate::scene::Sides;
use crate::visibility::{Ray, Triangles, Visibility};
use glam::DVec3;
use rustc_hash::FxHashSet;

/// Rays that tell the inside of a solid from the open, and a room from what is outside of it.
const RAYS: u32 = 32;

/// A solved mesh to be measured: what occludes, and what radiates.
pub struct OpenLight<'a> {
    mesh: &'a Mesh,
    /// All light, to be gathered.
    whole: Light,
    options: &'a Options,
    /// The irradiance that thresholds are multiples of, W/m².
    reference: f64,
    backing: Vec<Backing>,
    /// All patches together, if they are many.
    clusters: Option<Shooter>,
}

impl<'a> OpenLight<'a> {
    /// Prepares the measurement of a mesh with `light` on it, solved with `options`; `reference` as in the report of the solve.
    pub fn new(mesh: &'a Mesh, light: &Light, options: &'a Options, reference: f64) -> Self {
        let whole = Light {
            irradiance: Vec::new(),
            unshot: light.irradiance.clone(),
            ..Light::new(mesh)
        };
        let two_sided: FxHashSet<u32> = mesh
            .patches
            .iter()
            .filter(|p| p.back)
            .map(|p| p.surface)
            .collect();
        let fronts = mesh.patches.iter().filter(|p| !p.back);
        let backing = fronts.flat_map(|patch| {
            let backing = Backing {
                normal: patch.normal,
                sides: match two_sided.contains(&patch.surface) {
                    true => Sides::Both,
                    false => Sides::Front,
                },
                surface: patch.surface,
            };
            std::iter::repeat_n(backing, patch.corners().len() - 2)
        });
        let shooter = || {
            let scale = options.source_thresholds(reference).scale;
            Tiling::even(mesh, &whole, (options, scale)).radiating(mesh, &whole)
        };
        let clusters = options.clusters(mesh).then(shooter);
        Self {
            clusters,
            mesh,
            whole,
            options,
            reference,
            backing: backing.collect(),
        }
    }

    /// The triangles that a visibility engine has to answer for, in the frame of the mesh: every piece of surface once.
    pub fn occluders(&self) -> Triangles {
        let mut triangles = Triangles::default();
        for patch in self.mesh.patches.iter().filter(|p| !p.back) {
            let first = triangles.vertices.len() as u32;
            let corners = patch.corners();
            triangles
                .vertices
                .extend(corners.iter().map(|c| c.as_vec3()));
            let last = first + corners.len() as u32;
            let fan = (first + 1..last - 1).map(|corner| [first, corner, corner + 1]);
            triangles.indices.extend(fan);
        }
        triangles
    }

    /// Irradiance, W/m², at points and unit normals in the frame of the mesh, from all that the mesh emits and reflects, with
    /// sources sampled as finely as for the estimate of errors. `None` where all that is seen is the inside of a solid, and where nothing
    /// arrives as nothing that could radiate is seen in any direction: outside of all rooms.
    /// `visibility` answers for [`Self::occluders`].
    pub fn irradiance(
        &self,
        visibility: &dyn Visibility,
        places: &[(DVec3, DVec3)],
    ) -> Vec<Option<Spectrum>> {
        let outside: Vec<u32> = (0..places.len() as u32)
            .filter(|number| self.is_outside(visibility, places[*number as usize], *number))
            .collect();
        let receivers = |known: &[Spectrum]| -> Vec<(Receiver, u32)> {
            let receiver = |(number, known): (&u32, &Spectrum)| {
                let (point, normal) = places[*number as usize];
                let irradiance = known.max_element();
                let receiver = Receiver {
                    point,
                    normal,
                    irradiance,
                };
                (receiver, *number)
            };
            outside.iter().zip(known).map(receiver).collect()
        };
        // What a first look finds is what the thresholds of the second follow.
        let guess = vec![Spectrum::splat(self.reference as f32); outside.len()];
        let first = self.gather(visibility, 1.0, &receivers(&guess));
        let second = self.gather(visibility, FINER, &receivers(&first));
        let mut found = vec![None; places.len()];
        for (number, irradiance) in outside.iter().zip(second) {
            let place = places[*number as usize];
            let is_within =
                irradiance != Spectrum::ZERO || self.sees_any(visibility, place, *number);
            found[*number as usize] = is_within.then_some(irradiance);
        }
        found
    }

    fn gather(
        &self,
        visibility: &dyn Visibility,
        finer: f64,
        receivers: &[(Receiver, u32)],
    ) -> Vec<Spectrum> {
        let sampler = Sampler {
            visibility,
            extent: self.mesh.frame.extent(),
            formula: Formula::Polygon,
            thresholds: self.options.source_thresholds(self.reference).scaled(finer),
        };
        if let Some(all) = &self.clusters {
            let (gathers, _) = evaluate(&sampler, all, receivers, |of| *of);
            return gathers.iter().map(|g| g.irradiance).collect();
        }
        let mut sums = vec![Power::ZERO; receivers.len()];
        for patch in 0..self.mesh.patches.len() {
            if self.whole.unshot_power(self.mesh, patch, Sign::Positive) == Power::ZERO {
                continue;
            }
            let shooter = (patch, Sign::Positive);
            let cells = cells_of(
                self.mesh,
                &self.whole,
                shooter,
                self.options,
                &sampler.thresholds,
            );
            let source = source_from(self.mesh, patch, &cells);
            let (gathers, _) = evaluate(&sampler, &Shooter::Patch(source), receivers, |of| *of);
            for (sum, gather) in sums.iter_mut().zip(gathers) {
                *sum += gather.irradiance.as_dvec3();
            }
        }
        sums.iter().map(|sum| sum.as_vec3()).collect()
    }

    /// Whether some ray of the hemisphere reaches the open, or a side that radiates.
    fn is_outside(&self, visibility: &dyn Visibility, place: (DVec3, DVec3), number: u32) -> bool {
        let ends = self.ends(visibility, place, number);
        !ends.iter().all(|end| *end == End::Dark)
    }

    /// Whether some ray, in whatever direction, reaches a side that radiates.
    fn sees_any(
        &self,
        visibility: &dyn Visibility,
        (point, normal): (DVec3, DVec3),
        number: u32,
    ) -> bool {
        let around = [normal, -normal].map(|normal| self.ends(visibility, (point, normal), number));
        around.as_flattened().contains(&End::Radiating)
    }

    /// Where rays of the hemisphere end.
    fn ends(
        &self,
        visibility: &dyn Visibility,
        (point, normal): (DVec3, DVec3),
        number: u32,
    ) -> [End; RAYS as usize] {
        let rays: [Ray; RAYS as usize] = std::array::from_fn(|ray| {
            let [s, t] = jitter(number, ray as u32 ^ 0x6f70_656e);
            let share = (ray as f64 + s) / f64::from(RAYS);
            Ray {
                origin: point.as_vec3(),
                direction: cosine_direction(normal, [share, t]).as_vec3(),
            }
        });
        let mut hits = Vec::new();
        visibility.nearest(&rays, &mut hits);
        std::array::from_fn(|ray| match &hits[ray] {
            None => End::Open,
            Some(hit) if is_dark(hit, &rays[ray], &self.backing) => End::Dark,
            Some(_) => End::Radiating,
        })
    }
}

/// Where a ray ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Open,
    /// On a side that does not radiate.
    Dark,
    Radiating,
}
