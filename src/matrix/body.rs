//! Convex bodies among surfaces: a box hides what its silhouette hides, of which a point sees one outline rather than three faces.
//!
//! Faces that meet in convex edges belong together. Where all corners lie behind all of the faces, and edges that only one face has run
//! around one flat opening, if any, the faces bound a convex body; a line that comes in through the opening leaves through a face, so the
//! opening hides as much as the rest.

use super::occluder::Occluder;
use super::silhouette::{Edge, Face};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Fewer faces bound no body, even with an opening.
const FEWEST_FACES: usize = 3;

/// A corner that several faces share, up to rounding.
type Corner = [i64; 3];

/// Orders surfaces so that the faces of bodies come first, side by side, and appends the bodies. Corners nearer than `reach` are one.
pub(super) fn with_bodies(surfaces: Vec<Occluder>, reach: f64) -> Vec<Occluder> {
    let groups = groups(&surfaces, reach);
    let mut surfaces: Vec<Option<Occluder>> = surfaces.into_iter().map(Some).collect();
    let mut list = Vec::with_capacity(surfaces.len());
    let mut bodies = Vec::new();
    for group in groups {
        let first = list.len() as u32;
        let members = first..first + group.len() as u32;
        let mut faces: Vec<Occluder> = group.iter().filter_map(|k| surfaces[*k].take()).collect();
        if let Some(body) = body(&faces, members, reach) {
            faces.iter_mut().for_each(|face| face.is_face = true);
            list.extend(faces);
            bodies.push(body);
        } else {
            let back = group.into_iter().zip(faces);
            back.for_each(|(k, face)| surfaces[k] = Some(face));
        }
    }
    list.extend(surfaces.into_iter().flatten());
    list.extend(bodies);
    list
}

fn corner(point: DVec3, reach: f64) -> Corner {
    (point / reach).to_array().map(|x| x.round() as i64)
}

fn sides(face: &Occluder, reach: f64) -> impl Iterator<Item = [Corner; 2]> + '_ {
    let next = face.corners.iter().cycle().skip(1);
    (face.corners.iter().zip(next)).map(move |(a, b)| [corner(*a, reach), corner(*b, reach)])
}

/// Surfaces that hang together across convex edges, by their numbers.
fn groups(surfaces: &[Occluder], reach: f64) -> Vec<Vec<usize>> {
    let mut owner: FxHashMap<[Corner; 2], usize> = FxHashMap::default();
    for (k, surface) in surfaces.iter().enumerate() {
        owner.extend(sides(surface, reach).map(|side| (side, k)));
    }
    let mut is_taken = vec![false; surfaces.len()];
    let mut groups = Vec::new();
    for seed in 0..surfaces.len() {
        let (mut group, mut next) = (Vec::new(), vec![seed]);
        while let Some(k) = next.pop() {
            if std::mem::replace(&mut is_taken[k], true) {
                continue;
            }
            group.push(k);
            let partners = sides(&surfaces[k], reach).filter_map(|[a, b]| owner.get(&[b, a]));
            next.extend(partners.filter(|other| {
                !is_taken[**other] && is_convex(&surfaces[k], &surfaces[**other], reach)
            }));
        }
        if (FEWEST_FACES..Occluder::MOST_FACES).contains(&group.len()) {
            group.sort_unstable();
            groups.push(group);
        }
    }
    groups
}

/// Whether two faces lie behind one another's planes, and not in one.
fn is_convex(a: &Occluder, b: &Occluder, reach: f64) -> bool {
    let behind = |face: &Occluder, other: &Occluder| {
        let heights = other.corners.iter().map(|c| face.front().height(*c));
        let (low, high) = heights.fold((0.0, f64::NEG_INFINITY), |(l, h): (f64, f64), x| {
            (l.min(x), h.max(x))
        });
        high <= reach && low < -reach
    };
    behind(a, b) && behind(b, a)
}

/// The faces of what may be a body, by the sides that they own.
struct Skin {
    faces: Vec<Face>,
    /// Sides in the order of the faces.
    sides: Vec<([Corner; 2], usize)>,
    owner: FxHashMap<[Corner; 2], usize>,
    places: FxHashMap<Corner, DVec3>,
}

/// The body that faces bound; `members` are their numbers.
fn body(group: &[Occluder], members: Range<u32>, reach: f64) -> Option<Occluder> {
    let mut skin = Skin::new(group, reach)?;
    skin.close(group[0].front().thickness, reach)?;
    let mut corners: Vec<(Corner, DVec3)> = skin.places.iter().map(|(c, p)| (*c, *p)).collect();
    corners.sort_unstable_by_key(|(corner, _)| *corner);
    let corners: Vec<DVec3> = corners.into_iter().map(|(_, place)| place).collect();
    let is_behind = |face: &Face| corners.iter().all(|c| face.height(*c) <= reach);
    let edges = skin.edges()?;
    let is_convex = skin.faces.iter().all(is_behind);
    is_convex.then(|| Occluder::made_of(corners, skin.faces, edges, members))
}

impl Skin {
    /// `None` where two faces own one side.
    fn new(group: &[Occluder], reach: f64) -> Option<Self> {
        let mut skin = Self {
            faces: group.iter().map(Occluder::front).collect(),
            sides: Vec::new(),
            owner: FxHashMap::default(),
            places: FxHashMap::default(),
        };
        for (k, face) in group.iter().enumerate() {
            for (side, point) in sides(face, reach).zip(&face.corners) {
                skin.places.entry(side[0]).or_insert(*point);
                skin.add(side, k)?;
            }
        }
        Some(skin)
    }

    fn add(&mut self, side: [Corner; 2], face: usize) -> Option<()> {
        self.sides.push((side, face));
        self.owner.insert(side, face).is_none().then_some(())
    }

    /// Puts a face into the opening, if there is one; `None` where sides without a partner do not run around one flat opening.
    fn close(&mut self, thickness: f64, reach: f64) -> Option<()> {
        let is_open = |side: &[Corner; 2]| !self.owner.contains_key(&[side[1], side[0]]);
        let rim = self.sides.iter().map(|(side, _)| *side).filter(is_open);
        let next: FxHashMap<Corner, Corner> = rim.clone().map(|[a, b]| (b, a)).collect();
        let Some([first, _]) = rim.clone().next() else {
            return Some(());
        };
        let mut outline = vec![first];
        let mut last = *next.get(&first)?;
        while last != first && outline.len() <= next.len() {
            outline.push(last);
            last = *next.get(&last)?;
        }
        if outline.len() != rim.count() {
            return None;
        }
        let points: Vec<DVec3> = outline.iter().map(|c| self.places[c]).collect();
        let opening = Face::new(&points, thickness)?;
        for (k, corner) in outline.iter().enumerate() {
            self.add(
                [*corner, outline[(k + 1) % outline.len()]],
                self.faces.len(),
            )?;
        }
        self.faces.push(opening);
        (opening.warp(&points) <= reach).then_some(())
    }

    /// Every edge once; `None` where a side has no partner.
    fn edges(&self) -> Option<Vec<Edge>> {
        let mut edges = Vec::with_capacity(self.sides.len() / 2);
        for ([a, b], left) in &self.sides {
            let right = *self.owner.get(&[*b, *a])?;
            if *left < right {
                edges.push(Edge::new([self.places[a], self.places[b]], *left, right));
            }
        }
        Some(edges)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::vector_area;

    /// Faces of the unit cube, outwards, but for those whose numbers are left out.
    fn cube(without: &[usize]) -> Vec<Occluder> {
        let at = |k: usize| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2 & 1) as f64);
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let kept = (0..6).filter(|k| !without.contains(k));
        kept.map(|k| Occluder::new(faces[k].map(at).to_vec(), 1e-7).expect("has an area"))
            .collect()
    }

    fn bodies(surfaces: Vec<Occluder>) -> usize {
        let list = with_bodies(surfaces, 1e-6);
        list.iter().filter(|it| it.is_body()).count()
    }

    #[test]
    fn boxes_are_bodies_with_a_lid_or_without() {
        assert!(vector_area(&cube(&[])[0].corners).z < 0.0);
        for without in [&[][..], &[0], &[5]] {
            let list = with_bodies(cube(without), 1e-6);
            let body = list.last().expect("has parts");
            assert!(body.is_body());
            assert_eq!(body.edges().len(), 12);
            assert_eq!(list.len(), 7 - without.len());
            assert_eq!(body.members.len(), 6 - without.len());
        }
    }

    #[test]
    fn what_is_open_twice_or_seen_from_inside_is_none() {
        assert_eq!(bodies(cube(&[0, 1])), 0, "a tube");
        assert_eq!(bodies(cube(&[0, 2])), 0, "an opening around a corner");
        assert_eq!(bodies(cube(&[0, 2, 4])), 0, "three sides of a corner");
        let mut room = cube(&[]);
        for face in &mut room {
            let corners = face.corners.iter().rev().copied().collect();
            *face = Occluder::new(corners, 1e-7).expect("has an area");
        }
        assert_eq!(bodies(room), 0, "a room");
    }
}
