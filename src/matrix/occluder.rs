//! What may come between two facets: a flat convex surface, or a convex body whose faces are several, and its shadow from a point.
//!
//! Both are a common part of half-spaces: a surface has two faces back to back, a body one for each of its own. From a point that lies
//! outside, the silhouette is the edges between a face that is seen and one that is not; all that lies within its planes and is not
//! on the near side of the faces is hidden.

use super::facet::Facet;
use super::silhouette::{Edge, Face, Plane, Planes, Sides};
use crate::geometry::bounds;
use glam::DVec3;
use std::ops::Range;

/// A convex body, or a flat convex surface, that blocks light from all sides.
#[derive(Debug, Clone)]
pub(super) struct Occluder {
    pub corners: Vec<DVec3>,
    faces: Vec<Face>,
    edges: Vec<Edge>,
    pub low: DVec3,
    pub high: DVec3,
    /// A sphere around it.
    centre: DVec3,
    radius: f64,
    /// The surfaces of a body by their numbers, for what is not outside of it.
    pub members: Range<u32>,
    /// Whether it is one of the faces of a body.
    pub is_face: bool,
}

/// An occluder that may come between a facet and others, by its number, with the sides of its faces on which the facet lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    pub occluder: u32,
    pub sides: Sides,
}

/// An occluder that may come between a pair, by its number, the planes of its shadows that matter there, and on which sides the two
/// facets lie.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between {
    pub occluder: u32,
    pub planes: Planes,
    pub sides: [Sides; 2],
}

impl Occluder {
    /// Most faces of a body.
    pub const MOST_FACES: usize = 64;

    /// A flat surface; `None` where there is no area. `reach` is the distance up to which surfaces touch.
    pub fn new(corners: Vec<DVec3>, reach: f64) -> Option<Self> {
        let front = Face::new(&corners, reach)?;
        let sides = (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]]);
        let edges = sides.map(|side| Edge::new(side, 0, 1)).collect();
        Some(Self::made_of(
            corners,
            vec![front, front.reversed()],
            edges,
            0..0,
        ))
    }

    /// A body with at most [`Self::MOST_FACES`] faces.
    pub fn made_of(
        corners: Vec<DVec3>,
        faces: Vec<Face>,
        edges: Vec<Edge>,
        members: Range<u32>,
    ) -> Self {
        let (low, high) = bounds(corners.iter().copied());
        let centre = (low + high) * 0.5;
        let distances = corners.iter().map(|c| c.distance(centre));
        Self {
            centre,
            radius: distances.fold(0.0, f64::max),
            corners,
            faces,
            edges,
            low,
            high,
            members,
            is_face: false,
        }
    }

    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    pub fn is_body(&self) -> bool {
        !self.members.is_empty()
    }

    /// The planes of faces that run through a facet.
    pub fn face_planes<'a>(&'a self, facet: &'a Facet) -> impl Iterator<Item = Plane> + 'a {
        let count = if self.is_body() { self.faces.len() } else { 1 };
        self.faces[..count].iter().filter_map(|face| {
            let (low, high) = facet.range_over(face.normal, face.offset);
            (low < -face.thickness && high > face.thickness).then_some(Plane {
                normal: face.normal,
                offset: face.offset,
                reach: face.thickness,
            })
        })
    }

    /// Lets points up to this far from the plane lie on the surface.
    pub fn thicken(&mut self, thickness: f64) {
        for face in &mut self.faces {
            face.thickness = face.thickness.max(thickness);
        }
    }

    /// The face of a surface.
    pub fn front(&self) -> Face {
        self.faces[0]
    }

    /// Whether it keeps clear of everything within `width` of the line between two points.
    pub fn is_beside(&self, [a, b]: [DVec3; 2], width: f64) -> bool {
        let (along, from) = (b - a, self.centre - a);
        let place = from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        let aside = (from - along * place.clamp(0.0, 1.0)).length_squared();
        aside >= (self.radius + width).powi(2)
    }

    /// Whether a point lies behind a surface.
    pub fn is_seen_from_behind(&self, point: DVec3) -> bool {
        !self.is_body() && self.faces[0].height(point) <= 0.0
    }

    /// Where a facet lies.
    pub fn sides(&self, facet: &Facet) -> Sides {
        self.sides_by(|face| facet.range_over(face.normal, face.offset))
    }

    /// Where a box lies.
    pub fn sides_of_box(&self, low: DVec3, high: DVec3) -> Sides {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        self.sides_by(|face| {
            let (at, spread) = (face.height(middle), face.normal.abs().dot(half));
            (at - spread, at + spread)
        })
    }

    fn sides_by(&self, range: impl Fn(&Face) -> (f64, f64)) -> Sides {
        let mut sides = Sides::default();
        // The faces of a surface mirror one another.
        if !self.is_body() {
            let (low, high) = range(&self.faces[0]);
            let front = u64::from(low >= -self.faces[0].thickness);
            let back = u64::from(high <= self.faces[0].thickness);
            sides.front = front | back << 1;
            sides.back = back | front << 1;
            return sides;
        }
        for (bit, face) in self.faces.iter().enumerate() {
            let (low, high) = range(face);
            sides.front |= u64::from(low >= -face.thickness) << bit;
            sides.back |= u64::from(high <= face.thickness) << bit;
        }
        sides
    }

    /// Whether no line that leaves a facet on these sides begins within the body: the facet lies in front of some face, and not in its
    /// plane, looking in.
    pub fn is_outside(&self, facet: &Facet, sides: Sides) -> bool {
        let looks_in = |bit: usize| {
            sides.back >> bit & 1 != 0 && facet.normal.dot(self.faces[bit].normal) < 0.0
        };
        let mut fronts = (0..self.faces.len()).filter(|bit| sides.front >> bit & 1 != 0);
        fronts.any(|bit| !looks_in(bit))
    }

    /// Whether a point lies within a body.
    pub fn contains(&self, point: DVec3) -> bool {
        let mut faces = self.faces.iter();
        faces.all(|face| face.height(point) < -face.thickness)
    }

    /// Whether a facet lies in a face of a body and looks outwards.
    pub fn has_on_its_skin(&self, facet: &Facet) -> bool {
        let is_within = |face: &Face| face.height(facet.centroid) <= face.thickness;
        let sides = self.sides(facet);
        let outwards = |(bit, face): (usize, &Face)| {
            sides.front & sides.back & 1 << bit != 0 && face.normal.dot(facet.normal) > 0.0
        };
        self.faces.iter().all(is_within) && self.faces.iter().enumerate().any(outwards)
    }

    /// Whether some of it reaches in front of a facet's plane.
    pub fn rises_over(&self, facet: &Facet) -> bool {
        let thickness = self.faces[0].thickness;
        self.corners.iter().any(|c| facet.height(*c) > thickness)
    }

    /// Whether points keep clear of a surface's plane, all on one side.
    pub fn is_clear_of(&self, points: &[DVec3]) -> bool {
        let front = &self.faces[0];
        let mut heights = points.iter().map(|p| front.height(*p));
        let clear = |h: f64| h > front.thickness;
        heights.clone().all(clear) || heights.all(|h| clear(-h))
    }

    /// Hands out the half-spaces, those of `wanted`, whose common part is all that it hides from `eye` of something on the given `sides`,
    /// until `take` returns false. Returns whether it hides anything: of what it hides altogether, no half-space may be wanted.
    pub fn shadow(
        &self,
        eye: DVec3,
        wanted: Planes,
        there: Sides,
        extent: f64,
        mut take: impl FnMut(Plane) -> bool,
    ) -> bool {
        let mut seen = 0_u64;
        for (bit, face) in self.faces.iter().enumerate() {
            seen |= u64::from(face.height(eye) > face.thickness) << bit;
        }
        if seen == 0 || seen & there.front != 0 {
            return false;
        }
        if wanted.has_own() && !self.is_body() {
            let behind = &self.faces[usize::from(seen == 1)];
            let own = Plane {
                normal: behind.normal,
                offset: behind.offset + behind.thickness,
                reach: ROUNDING * extent,
            };
            if !take(own) {
                return true;
            }
        }
        for (k, edge) in self.edges.iter().enumerate() {
            let turn = edge.turn_from(seen);
            if turn == 0.0 || !wanted.has(k) {
                continue;
            }
            let normal = (edge.along.cross(eye) + edge.moment) * -turn;
            let plane = Plane {
                normal,
                offset: normal.dot(eye),
                reach: ROUNDING * extent * extent * edge.length,
            };
            if !take(plane) {
                return true;
            }
        }
        true
    }
}

/// Heights below this, in units of the scene's extent, are rounding.
const ROUNDING: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shadow_is_what_lies_behind() {
        let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        let corners = square.map(|[u, v]| DVec3::new(u, v, 1.0)).to_vec();
        for turned in [corners.clone(), corners.into_iter().rev().collect()] {
            let occluder = Occluder::new(turned, 1e-6).expect("has an area");
            let mut planes = Vec::new();
            occluder.shadow(DVec3::ZERO, Planes::ALL, Sides::default(), 4.0, |plane| {
                planes.push(plane);
                true
            });
            let hidden = |p: DVec3| planes.iter().all(|plane| plane.height(p) > 0.0);
            assert_eq!(planes.len(), 5);
            assert!(hidden(DVec3::new(0.9, -0.9, 2.0)));
            assert!(!hidden(DVec3::new(1.1, 0.0, 2.0)));
            assert!(!hidden(DVec3::new(0.1, 0.0, 0.9)));
        }
    }
}
