//! Pieces of surfaces that nothing can reach: below what stands on them, or within a solid. They do not radiate, so they count neither
//! as area nor as open.
//!
//! A piece is buried where it looks into a convex body whose inside does not radiate, as a floor below a box does, with or without a
//! bottom, unless it is hollow there; or, for solids of any shape, where every ray that leaves it ends on a side that does not radiate, or some do and it lies in the solid
//! ([`super::solid`]): what reaches into the solid, and the floor below it, see fronts of one another there. The bottom itself faces the void
//! below the floor; it is covered where the piece in whose plane it lies, back to back, is buried. Surfaces have been split where others
//! meet them, so a piece is covered as a whole or not at all.
//!
//! Rays alone would not do: where one box stands on another, they meet the back of the one and the front of the other at once.

use super::convex::Convex;
use super::facet::Facet;
use super::gauss::each_node;
use super::occluder::Occluder;
use super::solid::Solids;
use crate::geometry::{bounds, cosine_direction, jitter, lift, polygon};
use crate::scene::{Scene, Sides, Surface};
use crate::visibility::{Hit, Ray, Visibility};
use glam::DVec3;
use rayon::prelude::*;

/// Rays in rounds, each only where all before it ended on sides that do not radiate; what sees more than some thousandths of something
/// else is found out.
const ROUNDS: [u32; 3] = [8, 56, 960];

/// Facets in one plane miss it by up to this fraction of the scene's extent.
const FLAT: f64 = 1e-6;

/// What is known of the rays that leave a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sees {
    /// Something that radiates.
    Light,
    /// All end on sides that do not radiate.
    Backs,
    /// The inside of a solid that something else reaches into.
    Solid(u32),
    /// Some leave the scene, and none ends on what radiates.
    Void,
}

/// What may cover facets: a scene with its vertices in a frame of the given extent, the occluders made of it, and the visibility of its
/// triangles, surface by surface.
#[derive(Clone, Copy)]
pub(super) struct Covers<'a> {
    pub scene: &'a Scene,
    pub positions: &'a [DVec3],
    pub occluders: &'a [Occluder],
    pub visibility: &'a dyn Visibility,
    pub extent: f64,
}

impl Covers<'_> {
    /// For every facet whether nothing can reach it.
    pub fn covered(&self, facets: &[Facet]) -> Vec<bool> {
        let scout = Scout {
            visibility: self.visibility,
            sides: self.sides(),
            bodies: self.bodies(),
            solids: Solids::new(self.scene, self.positions),
            extent: self.extent,
        };
        let numbers: Vec<u32> = (0..facets.len() as u32).collect();
        let look = |number: &u32| scout.look(&facets[*number as usize], *number);
        let mut sees: Vec<Sees> = numbers.par_iter().map(look).collect();
        scout.look_into_solids(facets, &mut sees);
        let is_buried = |sees: &Sees| matches!(sees, Sees::Backs | Sees::Solid(_));
        let of_buried = facets.iter().zip(&sees).filter(|(_, sees)| is_buried(sees));
        let buried: Vec<&Facet> = of_buried.map(|(facet, _)| facet).collect();
        let is_covered = |(facet, sees): (&Facet, &Sees)| match sees {
            Sees::Light => false,
            Sees::Backs | Sees::Solid(_) => true,
            Sees::Void => buried
                .iter()
                .any(|it| lies_on(facet, it, FLAT * self.extent)),
        };
        facets.par_iter().zip(&sees).map(is_covered).collect()
    }

    fn corners(&self, surface: &Surface) -> Vec<DVec3> {
        let corners = surface.corners.indices().iter();
        corners.map(|v| self.positions[*v as usize]).collect()
    }

    /// Normal of the front and radiating sides for every triangle.
    fn sides(&self) -> Vec<(DVec3, Sides)> {
        let of_surface = |surface: &Surface| {
            let about = (polygon::vector_area(&self.corners(surface)), surface.sides);
            std::iter::repeat_n(about, surface.corners.triangles().count())
        };
        self.scene.surfaces.iter().flat_map(of_surface).collect()
    }

    /// The convex bodies no face of which radiates inwards.
    fn bodies(&self) -> Vec<&Occluder> {
        let two_sided = self
            .scene
            .surfaces
            .iter()
            .filter(|s| s.sides == Sides::Both);
        let two_sided: Vec<Facet> = two_sided
            .filter_map(|surface| Facet::new(Convex::new(&self.corners(surface))))
            .collect();
        let bodies = self.occluders.iter().filter(|it| it.is_body());
        bodies
            .filter(|body| !two_sided.iter().any(|facet| body.has_on_its_skin(facet)))
            .collect()
    }
}

/// Looks out from facets.
struct Scout<'a> {
    visibility: &'a dyn Visibility,
    sides: Vec<(DVec3, Sides)>,
    bodies: Vec<&'a Occluder>,
    solids: Solids,
    extent: f64,
}

impl Scout<'_> {
    fn look(&self, facet: &Facet, number: u32) -> Sees {
        let outside = self.outside(facet);
        let is_buried = |body: &&Occluder| {
            let around = || bounds(body.corners.iter().copied()).into();
            body.contains(outside) && !self.solids.is_hollow(around(), outside)
        };
        if self.bodies.iter().any(is_buried) {
            return Sees::Backs;
        }
        let mut places = Vec::new();
        for tile in facet.shape.tiles() {
            each_node(&tile, 2, |place, _| places.push(place));
        }
        let (mut sees, mut first) = (Sees::Backs, 0);
        let (mut rays, mut hits, mut solids) = (Vec::new(), Vec::new(), Vec::new());
        for count in ROUNDS {
            rays.clear();
            rays.extend((first..first + count).map(|k| {
                let place = places[k as usize % places.len()];
                Ray {
                    origin: lift(place, facet.normal, self.extent).as_vec3(),
                    direction: cosine_direction(facet.normal, jitter(number, k)).as_vec3(),
                }
            }));
            first += count;
            self.visibility.nearest(&rays, &mut hits);
            let mut is_lit = false;
            for (ray, hit) in rays.iter().zip(&hits) {
                match hit {
                    None => sees = Sees::Void,
                    Some(hit) if self.radiates(hit, ray) => is_lit = true,
                    Some(hit) => solids.extend(self.solids.of_triangle(hit.triangle)),
                }
            }
            if is_lit {
                solids.sort_unstable();
                solids.dedup();
                let mut solids = solids.into_iter();
                let holding = solids.find(|solid| self.solids.hold(*solid, outside));
                return holding.map_or(Sees::Light, Sees::Solid);
            }
            if sees == Sees::Void && first >= ROUNDS[0] + ROUNDS[1] {
                break;
            }
        }
        sees
    }

    /// Looks once more, in the solids that were found to hold something, at all that sees light: between things that reach into a solid,
    /// the first rays may have ended on these alone.
    fn look_into_solids(&self, facets: &[Facet], sees: &mut [Sees]) {
        let mut solids: Vec<u32> = sees
            .iter()
            .filter_map(|sees| match sees {
                Sees::Solid(solid) => Some(*solid),
                _ => None,
            })
            .collect();
        solids.sort_unstable();
        solids.dedup();
        facets.par_iter().zip(sees).for_each(|(facet, sees)| {
            if *sees == Sees::Light {
                let mut solids = solids.iter();
                let holding = solids.find(|it| self.solids.hold(**it, self.outside(facet)));
                *sees = holding.map_or(Sees::Light, |solid| Sees::Solid(*solid));
            }
        });
    }

    /// A point just above the middle of a facet.
    fn outside(&self, facet: &Facet) -> DVec3 {
        lift(facet.centroid, facet.normal, self.extent)
    }

    fn radiates(&self, hit: &Hit, ray: &Ray) -> bool {
        let (normal, sides) = self.sides[hit.triangle as usize];
        sides == Sides::Both || normal.dot(ray.direction.as_dvec3()) < 0.0
    }
}

/// Whether a facet lies in the plane of another, back to back with it, its middle within the other.
fn lies_on(facet: &Facet, other: &Facet, reach: f64) -> bool {
    let middle = facet.centroid;
    if facet.normal.dot(other.normal) > -0.999
        || middle.distance(other.centroid) > other.radius
        || facet
            .corners()
            .iter()
            .any(|c| other.height(*c).abs() > reach)
    {
        return false;
    }
    let corners = other.corners();
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .all(|(a, b)| other.normal.cross(*b - *a).dot(middle - *a) >= 0.0)
}
