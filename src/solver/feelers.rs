//! Feelers for small occluders: points of the scene that lie behind a small surface as seen from the middle of the source.
//!
//! The three tests look at vertices, and the shadow of something smaller than an element may fall between them. So each
//! surface is projected from the source's centre onto what is behind it, the shot is evaluated there, and an element whose
//! interpolant does not know of it is split. A ray and an evaluation for each surface and shot: as much as another vertex
//! a surface.

use super::behind::Behind;
use super::escape::is_dark;
use super::light::Light;
use super::shoot::{Beam, Shooter, evaluate};
use crate::form_factor::{Receiver, Source};
use crate::geometry::polygon;
use crate::mesh::{Mesh, Patch};
use crate::radiometry::Spectrum;
use crate::visibility::{Ray, Visibility};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The most feelers along one surface.
const MOST: u32 = 16;

/// What a ray may pass on its way through solids: backs that do not radiate.
const PASSES: usize = 8;

/// A point in the middle of a shadow, or where one would be if nothing else were in the way.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Feeler {
    pub patch: u32,
    pub point: DVec3,
    /// Coordinates of the point on its patch.
    pub at: (f64, f64),
    /// How wide the surface is that casts the shadow, projected to the point.
    pub width: f64,
    /// What the shot gives there.
    pub irradiance: Spectrum,
}

/// The feelers of a source whose shadows are narrower than the elements that they fall on, and the number of rays that
/// their evaluation took.
pub(super) fn feelers(
    mesh: &Mesh,
    light: &Light,
    backing: &dyn Behind,
    beam: Beam,
    reached: &[bool],
) -> (Vec<Feeler>, u64) {
    let Shooter::Patch(source) = beam.shooter else {
        return (Vec::new(), 0);
    };
    let mut feelers = cast(mesh, source, beam.sampler.visibility, backing);
    feelers.retain(|f| {
        let leaf = mesh.leaf_at(f.patch, f.at.0, f.at.1);
        reached[f.patch as usize] && mesh.may_split(leaf) && f.width < mesh.longest_side(leaf)
    });
    let points: Vec<(Receiver, u32)> = (0u32..)
        .zip(&feelers)
        .map(|(number, feeler)| {
            let leaf = mesh.leaf_at(feeler.patch, feeler.at.0, feeler.at.1);
            let irradiance =
                mesh.interpolated(leaf, feeler.point, |v| light.irradiance[v as usize]);
            let receiver = Receiver {
                point: feeler.point,
                normal: mesh.patch(feeler.patch).normal,
                irradiance: irradiance.max_element(),
            };
            (receiver, !number)
        })
        .collect();
    let (gathers, rays) = evaluate(beam.sampler, beam.shooter, &points, |of| *of);
    for (feeler, gather) in feelers.iter_mut().zip(gathers) {
        feeler.irradiance = gather.irradiance * beam.sign.factor();
    }
    (feelers, rays)
}

/// A ray on its way from the surface that it feels for.
struct Probe {
    ray: Ray,
    direction: DVec3,
    /// From the source's centre to the start of the ray.
    travelled: f64,
    width: f64,
}

fn cast(
    mesh: &Mesh,
    source: &Source,
    visibility: &dyn Visibility,
    backing: &dyn Behind,
) -> Vec<Feeler> {
    let extent = mesh.frame.extent();
    let corners = source.corners();
    let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let mut probes = Vec::new();
    for patch in mesh.patches.iter().filter(|p| !p.back) {
        for place in places(&patch) {
            let way = place - centre;
            let distance = way.length();
            if source.normal().dot(way) <= 1e-4 * extent {
                continue;
            }
            let direction = way / distance;
            let start = distance + 2e-5 * extent;
            probes.push(Probe {
                ray: Ray {
                    origin: (centre + direction * start).as_vec3(),
                    direction: direction.as_vec3(),
                },
                direction,
                travelled: start,
                width: patch.area / polygon::diameter(patch.corners()) / distance,
            });
        }
    }
    let mut feelers = Vec::new();
    let mut hits = Vec::new();
    for _ in 0..PASSES {
        let rays: Vec<Ray> = probes.iter().map(|p| p.ray).collect();
        visibility.nearest(&rays, &mut hits);
        let mut through = Vec::new();
        for (mut probe, hit) in probes.into_iter().zip(&hits) {
            let Some(hit) = hit else { continue };
            let distance = probe.travelled + f64::from(hit.t);
            let point = centre + probe.direction * distance;
            if is_dark(hit, &probe.ray, backing) {
                probe.travelled = distance + 2e-5 * extent;
                probe.ray.origin = (centre + probe.direction * probe.travelled).as_vec3();
                through.push(probe);
            } else if let Some((patch, at)) =
                patch_at(mesh, (backing, hit.triangle), point, probe.direction)
            {
                feelers.push(Feeler {
                    patch,
                    point: mesh.patch(patch).position_at(at.0, at.1),
                    at,
                    width: probe.width * distance,
                    irradiance: Spectrum::ZERO,
                });
            }
        }
        probes = through;
    }
    feelers
}

/// Points along a patch, as many as it is longer than wide.
fn places(patch: &Patch) -> impl Iterator<Item = DVec3> + '_ {
    let third = 1.0 / 3.0;
    let (count, along_u) = match patch.corners() {
        [a, b, c, d] => {
            let (width, height) = (
                a.distance(*b) + c.distance(*d),
                b.distance(*c) + d.distance(*a),
            );
            let ratio = (width.max(height) / width.min(height)).round();
            (ratio.clamp(1.0, f64::from(MOST)) as u32, width > height)
        }
        _ => (1, true),
    };
    (0..count).map(move |i| {
        let along = (f64::from(i) + 0.5) / f64::from(count);
        match (patch.is_triangle(), along_u) {
            (true, _) => patch.position_at(third, third),
            (false, true) => patch.position_at(along, 0.5),
            (false, false) => patch.position_at(0.5, along),
        }
    })
}

/// The patch behind a triangle that has a point on the side which `direction` meets, and the coordinates there.
fn patch_at(
    mesh: &Mesh,
    (backing, triangle): (&dyn Behind, u32),
    point: DVec3,
    direction: DVec3,
) -> Option<(u32, (f64, f64))> {
    // Those of the region, or of the surface alone where that could not be tiled.
    let surface = backing.at(triangle, direction).surface;
    let surfaces = [backing.region(surface), surface].into_iter();
    let patches = surfaces.flat_map(|surface| mesh.patches.of_surface(surface));
    patches
        .filter(|(_, patch)| patch.normal.dot(direction) < 0.0)
        .find_map(|(number, patch)| {
            let (u, v) = patch.coordinates(point);
            let inside = |x: f64| (-1e-6..=1.0 + 1e-6).contains(&x);
            let covered = inside(u) && inside(v) && (!patch.is_triangle() || inside(u + v));
            covered.then_some((number, (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0))))
        })
}
