//! Surfaces divided to a largest area.

use super::MatrixError;
use crate::geometry::polygon;
use crate::scene::{Corners, Scene, Surface};
use glam::DVec3;

/// Parts that one surface may be divided into.
const MOST_PARTS: f64 = 1e6;

/// Most pieces of surfaces, of which all pairs are worked out.
const MOST_PIECES: u64 = 200_000;

/// Refuses what would take days: too many surfaces, or parts of no more than `max_area` (m²).
pub(super) fn check_count(scene: &Scene, max_area: Option<f64>) -> Result<(), MatrixError> {
    let unit = scene.metres_per_unit.powi(2);
    let (limit, hint) = match max_area {
        Some(area) => (area / unit, ": ask for a larger max-area"),
        None => (f64::INFINITY, ""),
    };
    let parts = |surface: &Surface| (area(scene, surface) / limit).clamp(1.0, MOST_PARTS) as u64;
    let pieces = scene.surfaces.iter().map(parts).sum();
    match pieces <= MOST_PIECES {
        true => Ok(()),
        false => Err(MatrixError::TooLarge {
            pieces,
            most: MOST_PIECES,
            hint,
        }),
    }
}

fn area(scene: &Scene, surface: &Surface) -> f64 {
    let corners = surface.corners.indices().iter();
    let corners: Vec<DVec3> = corners.map(|v| scene.vertices[*v as usize]).collect();
    polygon::vector_area(&corners).length()
}

/// Divides quads into grids and triangles into similar triangles, row by row from the first corner, until no part is larger than
/// `max_area` (scene units squared).
pub(super) fn divided(scene: &Scene, max_area: f64) -> Scene {
    let mut parts = Scene {
        surfaces: Vec::new(),
        ..scene.clone()
    };
    for surface in &scene.surfaces {
        let corners = surface.corners.indices().iter();
        let corners: Vec<DVec3> = corners.map(|v| scene.vertices[*v as usize]).collect();
        let pieces = (polygon::vector_area(&corners).length() / max_area).clamp(1.0, MOST_PARTS);
        match *corners {
            [a, b, c] => triangle(&mut parts, surface, [a, b, c], pieces),
            [a, b, c, d] => quad(&mut parts, surface, [a, b, c, d], pieces),
            _ => {}
        }
    }
    parts
}

/// Rounds up, but not for what rounding added.
fn at_least(count: f64) -> u32 {
    (count - 1e-9).ceil().max(1.0) as u32
}

fn quad(scene: &mut Scene, surface: &Surface, [a, b, c, d]: [DVec3; 4], pieces: f64) {
    if pieces <= 1.0 {
        scene.surfaces.push(*surface);
        return;
    }
    let width = 0.5 * (a.distance(b) + c.distance(d));
    let height = 0.5 * (b.distance(c) + d.distance(a));
    // The grid with the fewest cells whose cells are the squarest.
    let columns = (pieces * width / height).sqrt().round().max(1.0);
    let (columns, rows) = (columns as u32, at_least(pieces / columns));
    let first = scene.vertices.len() as u32;
    for row in 0..=rows {
        let v = f64::from(row) / f64::from(rows);
        for column in 0..=columns {
            let u = f64::from(column) / f64::from(columns);
            scene.vertices.push(a.lerp(b, u).lerp(d.lerp(c, u), v));
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let k = first + row * (columns + 1) + column;
            let corners = Corners::Quad([k, k + 1, k + columns + 2, k + columns + 1]);
            scene.surfaces.push(Surface {
                corners,
                ..*surface
            });
        }
    }
}

fn triangle(scene: &mut Scene, surface: &Surface, [a, b, c]: [DVec3; 3], pieces: f64) {
    if pieces <= 1.0 {
        scene.surfaces.push(*surface);
        return;
    }
    let steps = at_least(pieces.sqrt());
    let mut vertex = |u: u32, v: u32| {
        let [u, v] = [u, v].map(|x| f64::from(x) / f64::from(steps));
        scene.vertices.push(a + (b - a) * u + (c - a) * v);
        scene.vertices.len() as u32 - 1
    };
    // Vertices row by row; a row has one less than that before it.
    let rows: Vec<Vec<u32>> = (0..=steps)
        .map(|v| (0..=steps - v).map(|u| vertex(u, v)).collect())
        .collect();
    for pair in rows.windows(2) {
        let (lower, upper) = (&pair[0], &pair[1]);
        for u in 0..upper.len() {
            let upright = [lower[u], lower[u + 1], upper[u]];
            scene.surfaces.push(Surface {
                corners: Corners::Triangle(upright),
                ..*surface
            });
            if let Some(next) = upper.get(u + 1) {
                let inverted = [lower[u + 1], *next, upper[u]];
                scene.surfaces.push(Surface {
                    corners: Corners::Triangle(inverted),
                    ..*surface
                });
            }
        }
    }
}
