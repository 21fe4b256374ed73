//! Polygons as files have them become triangles and convex planar quads.

use super::polygon::{doubled_area_vector, has_no_area, is_planar, is_strictly_convex};
use super::polygons::Polygons;
use super::triangulate::{self, minimum_angle};
use super::warnings::Tally;
use super::{Corners, Sides, Surface};
use glam::DVec3;
use std::path::Path;

/// A triangle or quad by its corners' places in the polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Piece {
    Triangle([usize; 3]),
    Quad([usize; 4]),
}

/// Why a polygon has no pieces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unusable {
    /// Its corners lie on a line, or nearly.
    NoArea,
    /// Its boundary crosses itself, so that it has no inside.
    CrossesItself,
}

/// Splits all polygons but the repeated ones. All surfaces are one-sided for now.
pub(super) fn split(
    file: &Path,
    polygons: &Polygons,
    repeated: &[bool],
    warnings: &mut Vec<String>,
) -> Vec<Surface> {
    let mut surfaces = Vec::with_capacity(polygons.len());
    let mut tallies = [Tally::default(); 4];
    let [repetitions, repeated_corners, without_area, crossing] = &mut tallies;
    let mut corners: Vec<u32> = Vec::new();
    let mut positions: Vec<DVec3> = Vec::new();
    for (polygon, repeated) in repeated.iter().enumerate() {
        let line = polygons.line(polygon);
        if *repeated {
            repetitions.add(line);
            continue;
        }
        corners.clear();
        corners.extend_from_slice(polygons.corners(polygon));
        let has_repeated_corner = remove_repeated_corners(&mut corners);
        positions.clear();
        positions.extend(
            corners
                .iter()
                .map(|corner| polygons.positions[*corner as usize]),
        );
        match pieces(&positions) {
            Ok(pieces) => {
                if has_repeated_corner {
                    repeated_corners.add(line);
                }
                surfaces.extend(pieces.iter().map(|piece| Surface {
                    corners: piece.corners(&corners),
                    material: polygons.materials[polygon],
                    polygon: polygon as u32,
                    sides: Sides::Front,
                }));
            }
            Err(Unusable::NoArea) => without_area.add(line),
            Err(Unusable::CrossesItself) => crossing.add(line),
        }
    }
    repeated_corners.report(
        warnings,
        file,
        "polygon",
        "with a corner twice in a row, taken as once",
    );
    repetitions.report(warnings, file, "repeated polygon", "left out");
    without_area.report(warnings, file, "polygon", "without area left out");
    crossing.report(
        warnings,
        file,
        "polygon",
        "whose boundary crosses itself left out: light passes there",
    );
    surfaces
}

/// Removes all corners that equal the one before; tells whether there were any.
fn remove_repeated_corners(corners: &mut Vec<u32>) -> bool {
    let before = corners.len();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners.len() != before
}

impl Piece {
    fn corners(&self, polygon: &[u32]) -> Corners {
        match self {
            Piece::Triangle(places) => Corners::Triangle(places.map(|place| polygon[place])),
            Piece::Quad(places) => Corners::Quad(places.map(|place| polygon[place])),
        }
    }
}

/// The pieces of one polygon, oriented as it is.
pub(super) fn pieces(corners: &[DVec3]) -> Result<Vec<Piece>, Unusable> {
    if corners.len() < 3 {
        return Err(Unusable::NoArea);
    }
    if has_no_area(corners) {
        // Two lobes of opposite orientation cancel.
        let fan =
            (2..corners.len()).any(|i| !has_no_area(&[corners[0], corners[i - 1], corners[i]]));
        return Err(if fan {
            Unusable::CrossesItself
        } else {
            Unusable::NoArea
        });
    }
    match corners {
        [_, _, _] => Ok(vec![Piece::Triangle([0, 1, 2])]),
        [_, _, _, _] if is_planar(corners) && is_strictly_convex(corners) => {
            Ok(vec![Piece::Quad([0, 1, 2, 3])])
        }
        [a, b, c, d] => halves([*a, *b, *c, *d]).ok_or(Unusable::CrossesItself),
        _ => {
            let triangles = triangulate::triangulate(corners).ok_or(Unusable::CrossesItself)?;
            Ok(triangulate::merge_into_quads(corners, &triangles))
        }
    }
}

/// A quad that is not planar or not convex, as two triangles.
///
/// A concave quad has one diagonal inside. Of two possible ones that is taken which makes the better
/// triangles, by their smallest angle: the crease of a bent quad may run along either.
fn halves(quad: [DVec3; 4]) -> Option<Vec<Piece>> {
    let normal = doubled_area_vector(&quad);
    let diagonals = [[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]]];
    let quality = |halves: &[[usize; 3]; 2]| {
        let angles = halves.map(|half| {
            let triangle = half.map(|place| quad[place]);
            let faces_front = doubled_area_vector(&triangle).dot(normal) > 0.0;
            (faces_front && !has_no_area(&triangle)).then(|| minimum_angle(triangle))
        });
        Some(f64::min(angles[0]?, angles[1]?))
    };
    let (_, best) = diagonals
        .iter()
        .filter_map(|halves| Some((quality(halves)?, halves)))
        .reduce(|best, other| if other.0 > best.0 { other } else { best })?;
    Some(best.map(Piece::Triangle).to_vec())
}
