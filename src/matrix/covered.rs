//! Pieces of surfaces that nothing can reach: below what stands on them, or within a solid. They do not radiate, so they count neither
//! as area nor as open.
//!
//! A piece is buried where it looks into a convex body whose inside does not radiate, as a floor below a box does, with or without a
//! bottom; or, for solids of any shape, where every ray that leaves it ends on a side that does not radiate. The bottom itself faces the void
//! below the floor; it is covered where the piece in whose plane it lies, back to back, is buried. Surfaces have been split where others
//! meet them, so a piece is covered as a whole or not at all.
//!
//! Rays alone would not do: where one box stands on another, they meet the back of the one and the front of the other at once.

use super::convex::Convex;
use super::facet::Facet;
use super::gauss::each_node;
use super::occluder::Occluder;
use crate::geometry::{cosine_direction, jitter, lift, polygon};
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
            solids: self.solids(),
            extent: self.extent,
        };
        let numbers: Vec<u32> = (0..facets.len() as u32).collect();
        let look = |number: &u32| scout.look(&facets[*number as usize], *number);
        let sees: Vec<Sees> = numbers.par_iter().map(look).collect();
        let of_backs = facets
            .iter()
            .zip(&sees)
            .filter(|(_, sees)| **sees == Sees::Backs);
        let buried: Vec<&Facet> = of_backs.map(|(facet, _)| facet).collect();
        let is_covered = |(facet, sees): (&Facet, &Sees)| match sees {
            Sees::Light => false,
            Sees::Backs => true,
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
    fn solids(&self) -> Vec<&Occluder> {
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
    solids: Vec<&'a Occluder>,
    extent: f64,
}

impl Scout<'_> {
    fn look(&self, facet: &Facet, number: u32) -> Sees {
        let outside = lift(facet.centroid, facet.normal, self.extent);
        if self.solids.iter().any(|body| body.contains(outside)) {
            return Sees::Backs;
        }
        let mut places = Vec::new();
        for tile in facet.shape.tiles() {
            each_node(&tile, 2, |place, _| places.push(place));
        }
        let (mut sees, mut first) = (Sees::Backs, 0);
        let (mut rays, mut hits) = (Vec::new(), Vec::new());
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
            for (ray, hit) in rays.iter().zip(&hits) {
                match hit {
                    None => sees = Sees::Void,
                    Some(hit) if self.radiates(hit, ray) => return Sees::Light,
                    Some(_) => {}
                }
            }
            if sees == Sees::Void && first >= ROUNDS[0] + ROUNDS[1] {
                break;
            }
        }
        sees
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
