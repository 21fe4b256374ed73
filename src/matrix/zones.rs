//! Where the points of a facet see all of another past one occluder, some of it, and nothing: the lines along which what they see has
//! kinks, so that no slit between an edge and a shadow is missed.
//!
//! A convex occluder hides something from points within all planes that touch both it and what is looked at and part them (the
//! penumbra), and everything from those that all corners of what is looked at have in its shadow (the umbra). Both are convex. At the
//! plane of a face the outline of the occluder changes: over a facet just below its bottom, that is nearly a step.

use super::convex::{Convex, part_above};
use super::facet::Facet;
use super::occluder::{Between, Occluder};
use super::silhouette::{Edge, Plane};
use super::visible::{Cutter, Sight, split};
use glam::DVec3;

/// Occluders along the shadows of which a facet is divided, and parts that come of it, at most.
const MOST_DIVIDING: usize = 6;
const MOST_ZONES: usize = 32;

/// Points nearer to a plane than this, in units of the scene, lie on it.
const ON: f64 = 1e-9;

/// Parts of `outer`, from which `sight` is seen; one where nothing divides it.
pub(super) fn zones(cutter: &mut Cutter, outer: &Facet, sight: Sight<'_>) -> Vec<Convex> {
    let back = Sight {
        facet: outer,
        there: 1 - sight.there,
        ..sight
    };
    let inner = sight.facet.corners();
    let mut zones = vec![outer.shape];
    for between in sight.between.iter().take(MOST_DIVIDING) {
        let occluder = &sight.occluders[between.occluder as usize];
        let outlines = [
            penumbra(outer, inner, occluder, sight.extent),
            umbra(cutter, back, inner, between),
        ];
        let outlines = outlines.into_iter().flatten();
        let shadows = outlines.map(|it| around(&it, outer.normal, sight.extent));
        let faces = occluder.face_planes(outer).map(|plane| vec![plane]);
        for planes in shadows.chain(faces) {
            let mut parts = zones.clone();
            if split(&planes, &mut parts).is_err() || parts.len() > MOST_ZONES {
                return zones;
            }
            zones = parts;
        }
    }
    zones
}

/// The part of a facet from whose points some of what has the corners `inner` may be hidden.
fn penumbra(
    outer: &Facet,
    inner: &[DVec3],
    occluder: &Occluder,
    extent: f64,
) -> Option<Vec<DVec3>> {
    let mut left = (outer.corners().to_vec(), Vec::new());
    let mut part = |edge: &Edge, from: DVec3| {
        let normal = edge.along.cross(from) + edge.moment;
        let reach = ON * extent * extent * edge.length;
        if normal.length() <= reach {
            return;
        }
        let range = |points: &[DVec3]| {
            let heights = points.iter().map(|p| normal.dot(*p - from));
            heights.fold((0.0, 0.0), |(low, high): (f64, f64), h| {
                (low.min(h), high.max(h))
            })
        };
        let (hiding, seen) = (range(&occluder.corners), range(inner));
        let side = if hiding.1 <= reach && seen.0 >= -reach {
            -1.0
        } else if hiding.0 >= -reach && seen.1 <= reach {
            1.0
        } else {
            return;
        };
        part_above(&left.0, |p| side * normal.dot(p - from), reach, &mut left.1);
        std::mem::swap(&mut left.0, &mut left.1);
    };
    for edge in occluder.edges() {
        inner.iter().for_each(|corner| part(edge, *corner));
    }
    for (k, corner) in inner.iter().enumerate() {
        let edge = Edge::new([*corner, inner[(k + 1) % inner.len()]], 0, 0);
        { occluder.corners.iter() }.for_each(|corner| part(&edge, *corner));
    }
    Some(left.0).filter(|outline| outline.len() > 2)
}

/// The part of the facet of `sight` from whose points all of what has the corners `inner` is hidden.
fn umbra(
    cutter: &mut Cutter,
    sight: Sight<'_>,
    inner: &[DVec3],
    between: &Between,
) -> Option<Vec<DVec3>> {
    let planes = cutter.shadow_from_all(inner, sight, between)?;
    let mut left = (sight.facet.corners().to_vec(), Vec::new());
    for plane in planes {
        part_above(&left.0, |p| plane.height(p), plane.reach, &mut left.1);
        std::mem::swap(&mut left.0, &mut left.1);
    }
    Some(left.0).filter(|outline| outline.len() > 2)
}

/// The planes around a polygon, upright on it.
fn around(outline: &[DVec3], normal: DVec3, extent: f64) -> Vec<Plane> {
    let next = outline.iter().cycle().skip(1);
    let sides = outline.iter().zip(next).map(|(a, b)| (*a, *b - *a));
    let long = sides.filter(|(_, along)| along.length() > ON * extent);
    let plane = |(from, along): (DVec3, DVec3)| {
        let normal = normal.cross(along.normalize());
        Plane {
            normal,
            offset: normal.dot(from),
            reach: ON * extent,
        }
    };
    long.map(plane).collect()
}
