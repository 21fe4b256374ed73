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
use super::visible::{Cutter, Sight, TooIntricate, cut_out};
use glam::DVec3;

/// Occluders along the shadows of which a facet is divided, and parts that come of it, at most.
const MOST_DIVIDING: usize = 6;
const MOST_ZONES: usize = 32;

/// Points nearer to a plane than this, in units of the scene, lie on it.
const ON: f64 = 1e-9;

/// A part of a facet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zone {
    pub shape: Convex,
    /// Whether its points see all.
    pub is_clear: bool,
}

/// Parts of `outer`, from which `sight` is seen, without those in some umbra; one where nothing divides it.
pub(super) fn zones(cutter: &mut Cutter, outer: &Facet, sight: Sight<'_>) -> Vec<Zone> {
    let back = Sight {
        facet: outer,
        there: 1 - sight.there,
        ..sight
    };
    let inner = sight.facet.corners();
    let mut zones = vec![Zone {
        shape: outer.shape,
        is_clear: sight.between.len() <= MOST_DIVIDING,
    }];
    for between in sight.between.iter().take(MOST_DIVIDING) {
        let occluder = &sight.occluders[between.occluder as usize];
        let planes = |outline: Vec<DVec3>| around(&outline, outer.normal, sight.extent);
        let partly = penumbra(outer, inner, occluder, sight.extent).map(planes);
        let wholly = umbra(cutter, back, inner, between).map(planes);
        let faces = occluder.face_planes(outer).map(|plane| vec![plane]);
        let shadows = [(partly, Within::Penumbra), (wholly, Within::Umbra)];
        let shadows = shadows
            .into_iter()
            .filter_map(|(planes, within)| Some((planes?, within)));
        for (planes, within) in shadows.chain(faces.map(|planes| (planes, Within::Face))) {
            match divided(&zones, &planes, within) {
                Ok(parts) if parts.len() <= MOST_ZONES => zones = parts,
                _ => return unsure(zones),
            }
        }
    }
    zones
}

/// What lies within planes that divide zones.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Within {
    Penumbra,
    Umbra,
    Face,
}

/// Zones divided into what lies within all planes and what does not.
fn divided(zones: &[Zone], planes: &[Plane], within: Within) -> Result<Vec<Zone>, TooIntricate> {
    let (mut parts, mut outside) = (Vec::with_capacity(2 * zones.len()), Vec::new());
    for zone in zones {
        outside.clear();
        let Some(shape) = cut_out(zone.shape, planes, &mut outside)? else {
            parts.push(*zone);
            continue;
        };
        if within != Within::Umbra {
            let is_clear = zone.is_clear && within != Within::Penumbra;
            parts.push(Zone { shape, is_clear });
        }
        parts.extend(outside.iter().map(|shape| Zone {
            shape: *shape,
            ..*zone
        }));
    }
    Ok(parts)
}

/// Zones that not every occluder was asked about.
fn unsure(mut zones: Vec<Zone>) -> Vec<Zone> {
    zones.iter_mut().for_each(|zone| zone.is_clear = false);
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

#[cfg(test)]
mod tests {
    use super::super::silhouette::Planes;
    use super::*;
    use crate::geometry::polygon::vector_area;

    fn square(height: f64, half: f64) -> Vec<DVec3> {
        [[-half, -half], [half, -half], [half, half], [-half, half]]
            .map(|[x, y]| DVec3::new(x, y, height))
            .to_vec()
    }

    fn facet(corners: &[DVec3]) -> Facet {
        Facet::new(Convex::new(corners)).expect("has an area")
    }

    #[test]
    fn the_umbra_is_left_out_and_what_lies_beyond_the_penumbra_is_clear() {
        let outer = facet(&square(0.0, 2.0));
        let above = square(2.0, 0.4).into_iter().rev().collect::<Vec<_>>();
        let inner = facet(&above);
        for half in [0.5, 0.15] {
            let plate = Occluder::new(square(1.0, half), 1e-6).expect("has an area");
            let sides = [&outer, &inner].map(|it| plate.sides(it));
            let between = [Between {
                occluder: 0,
                planes: Planes::ALL,
                sides,
            }];
            let sight = Sight {
                facet: &inner,
                occluders: &[plate],
                between: &between,
                there: 1,
                extent: 4.0,
            };
            let zones = zones(&mut Cutter::default(), &outer, sight);
            let area = |is_clear: bool| -> f64 {
                let alike = zones.iter().filter(|zone| zone.is_clear == is_clear);
                alike
                    .map(|zone| vector_area(zone.shape.corners()).length())
                    .sum()
            };
            // Half-way up: what the plate's edge hides from the far edge of what is above, and from the near one.
            let penumbra = (2.0 * (2.0 * half + 0.4)).powi(2);
            let umbra = (2.0 * (2.0 * half - 0.4).max(0.0)).powi(2);
            assert!((area(true) - (16.0 - penumbra)).abs() < 1e-9, "{half}");
            assert!((area(false) - (penumbra - umbra)).abs() < 1e-9, "{half}");
        }
    }
}
