//! Where other surfaces meet the inside of a face: segments in its plane.

use super::face::Face;
use crate::scene::Corners;
use glam::{DVec2, DVec3};

/// A segment in the plane of a face.
pub(super) type Line = [DVec2; 2];

/// The segments in which other surfaces cross or touch a face, clipped to it; those along its border are left out.
pub(super) fn lines(
    face: &Face,
    others: impl Iterator<Item = Corners>,
    positions: &[DVec3],
) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut rims = Vec::new();
    for other in others {
        let vertices = other.indices();
        match meet(face, vertices, positions) {
            Meeting::Apart => {}
            Meeting::Along(line) => lines.push(line),
            Meeting::Over => rims.extend(rim(face, vertices, positions)),
        }
    }
    rims.sort_unstable();
    rims.dedup();
    // Where two surfaces in the plane continue one another, nothing changes across the side they share.
    let ends = rims
        .iter()
        .filter(|(a, b)| rims.binary_search(&(*b, *a)).is_err());
    lines.extend(ends.map(|(a, b)| [a, b].map(|v| face.flatten(positions[*v as usize]))));
    lines
        .iter()
        .filter_map(|line| inside(face, *line))
        .collect()
}

/// How a surface meets a face.
#[derive(Debug, PartialEq)]
enum Meeting {
    /// Not at all, in a point, or on the border only.
    Apart,
    /// On a line.
    Along(Line),
    /// It lies in the plane of the face, and over or under a part of it.
    Over,
}

fn meet(face: &Face, vertices: &[u32], positions: &[DVec3]) -> Meeting {
    let count = vertices.len();
    let mut heights = [0.0; 4];
    let mut flat = [DVec2::ZERO; 4];
    for (i, vertex) in vertices.iter().enumerate() {
        let corner = positions[*vertex as usize];
        heights[i] = face.height(corner);
        flat[i] = face.flatten(corner);
    }
    let (flat, heights) = (&flat[..count], &heights[..count]);
    let thickness = face.thickness;
    let (low, high) = heights
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(*x), h.max(*x))
        });
    if low > thickness || high < -thickness {
        return Meeting::Apart;
    }
    if face.beside(flat) {
        return Meeting::Apart;
    }
    if low >= -thickness && high <= thickness {
        return Meeting::Over;
    }
    cross_section(flat, heights, thickness).map_or(Meeting::Apart, Meeting::Along)
}

/// The segment in which a convex polygon meets a plane, from the feet of its corners in the plane and their heights.
fn cross_section(feet: &[DVec2], heights: &[f64], thickness: f64) -> Option<Line> {
    let on = |i: usize| heights[i].abs() <= thickness;
    let mut ends = [DVec2::ZERO; 8];
    let mut found = 0;
    for i in 0..feet.len() {
        let next = (i + 1) % feet.len();
        ends[found] = if on(i) {
            feet[i]
        } else if !on(next) && (heights[i] > 0.0) != (heights[next] > 0.0) {
            feet[i].lerp(feet[next], heights[i] / (heights[i] - heights[next]))
        } else {
            continue;
        };
        found += 1;
    }
    // There are two, but for polygons that barely rise from the plane: take what is farthest apart.
    let ends = &ends[..found];
    let pairs = ends
        .iter()
        .enumerate()
        .flat_map(|(i, a)| ends[i + 1..].iter().map(|b| [*a, *b]));
    pairs.max_by(|x, y| {
        x[0].distance_squared(x[1])
            .total_cmp(&y[0].distance_squared(y[1]))
    })
}

/// The sides of a surface that lies in the plane of a face, running counter-clockwise as seen by the face.
fn rim(face: &Face, vertices: &[u32], positions: &[DVec3]) -> impl Iterator<Item = (u32, u32)> {
    let flat = |i: usize| face.flatten(positions[vertices[i] as usize]);
    let turned = (flat(1) - flat(0)).perp_dot(flat(2) - flat(0)) < 0.0;
    (0..vertices.len()).map(move |i| {
        let (a, b) = (vertices[i], vertices[(i + 1) % vertices.len()]);
        if turned { (b, a) } else { (a, b) }
    })
}

/// What a segment has inside a face.
pub(super) fn inside(face: &Face, line: Line) -> Option<Line> {
    let line = face.clip(line)?;
    let short = line[0].distance(line[1]) <= face.reach;
    (!short && !face.beside(&line)).then_some(line)
}
