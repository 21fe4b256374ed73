//! Surfaces that lie over one another in one plane and radiate to the same side: light would arrive twice.

use super::convex::Convex;
use crate::geometry::bounds;
use crate::geometry::polygon::vector_area;
use crate::scene::{NamedScene, Sides};
use glam::DVec3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Overlaps below this share of the smaller surface are rounding.
const SHARE: f64 = 1e-5;

/// Pairs that are named; the others are counted.
const NAMED: usize = 5;

/// One warning for each of the first pairs that overlap, and one for the number of all others.
pub(super) fn overlaps(named: &NamedScene, positions: &[DVec3], extent: f64) -> Vec<String> {
    let surfaces = &named.scene.surfaces;
    let corners = |k: usize| -> Vec<DVec3> {
        surfaces[k]
            .corners
            .indices()
            .iter()
            .map(|v| positions[*v as usize])
            .collect()
    };
    let boxes = (0..surfaces.len()).map(|k| {
        let (low, high) = bounds(corners(k));
        GeomWithData::new(Rectangle::from_corners(low.to_array(), high.to_array()), k)
    });
    let tree = RTree::bulk_load(boxes.collect());
    let mut pairs = Vec::new();
    for k in 0..surfaces.len() {
        let list = corners(k);
        let (low, high) = bounds(list.iter().copied());
        let near = tree
            .locate_in_envelope_intersecting(AABB::from_corners(low.to_array(), high.to_array()));
        let mut others: Vec<usize> = near
            .map(|found| found.data)
            .filter(|other| *other > k)
            .collect();
        others.sort_unstable();
        pairs.extend(others.into_iter().filter_map(|other| {
            let facing = overlap(&list, &corners(other), extent)?;
            let both = [k, other].map(|k| surfaces[k].sides == Sides::Both);
            (facing == Facing::Alike || both != [false; 2]).then_some((k, other, facing))
        }));
    }
    let place = |k: usize| named.names.place(surfaces[k].polygon);
    let mut warnings: Vec<String> = pairs
        .iter()
        .take(NAMED)
        .map(|(a, b, facing)| {
            let twice = match facing {
                Facing::Alike => "facing the same way: row sums there exceed 1",
                Facing::Apart => {
                    "the back of one as the front of the other: row sums exceed 1 where both are seen"
                }
            };
            format!("{}: overlaps {} in one plane, {twice}", place(*b), place(*a))
        })
        .collect();
    if pairs.len() > NAMED {
        warnings.push(format!(
            "{} more pairs of surfaces overlap in one plane",
            pairs.len() - NAMED
        ));
    }
    warnings
}

/// How the fronts of two surfaces in one plane face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Facing {
    Alike,
    Apart,
}

/// How two convex polygons face that have more than a rounding error of area in common.
fn overlap(a: &[DVec3], b: &[DVec3], extent: f64) -> Option<Facing> {
    let (va, vb) = (vector_area(a), vector_area(b));
    let (area_a, area_b) = (va.length(), vb.length());
    let cosine = va.dot(vb) / (area_a * area_b);
    if cosine.abs() < 0.999_999 {
        return None;
    }
    let normal = va / area_a;
    if b.iter()
        .any(|p| normal.dot(*p - a[0]).abs() > 1e-6 * extent)
    {
        return None;
    }
    let mut common = Convex::new(b);
    for (i, p) in a.iter().enumerate() {
        let inwards = normal.cross(a[(i + 1) % a.len()] - *p);
        common = common.divide(|q| inwards.dot(q - *p), 0.0).above;
        if common.is_empty() {
            return None;
        }
    }
    let facing = match cosine > 0.0 {
        true => Facing::Alike,
        false => Facing::Apart,
    };
    (vector_area(common.corners()).length() > SHARE * area_a.min(area_b)).then_some(facing)
}
