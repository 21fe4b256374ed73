//! Surfaces divided to a largest area.

use super::MatrixError;
use crate::geometry::polygon;
use crate::scene::{Corners, Scene, Surface};
use glam::DVec3;

/// Parts that one surface may be divided into.
const MOST_PARTS: f64 = 1e6;

/// Most pieces of surfaces, of which all pairs are worked out.
const MOST_PIECES: u64 = 200_000;

/// Areas differ by this share from what they are meant to be, as files round their coordinates.
const ROUNDING: f64 = 1e-6;

/// Refuses what would take days: too many surfaces, or parts of no more than `max_area` (m²).
pub(super) fn check_count(scene: &Scene, max_area: Option<f64>) -> Result<(), MatrixError> {
    let unit = scene.metres_per_unit.powi(2);
    let (limit, hint) = match max_area {
        Some(area) => (area / unit, ": ask for a larger max-area"),
        None => (f64::INFINITY, ""),
    };
    let parts = |surface: &Surface| match *corners(scene, surface) {
        [a, b, c] => u64::from(steps([a, b, c], limit)).pow(2),
        [a, b, c, d] => {
            let [columns, rows] = grid([a, b, c, d], limit).map(u64::from);
            columns * rows
        }
        _ => 0,
    };
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

fn corners(scene: &Scene, surface: &Surface) -> Vec<DVec3> {
    let corners = surface.corners.indices().iter();
    corners.map(|v| scene.vertices[*v as usize]).collect()
}

/// Divides quads into grids and triangles into similar triangles, row by row from the first corner, until no part is larger than
/// `max_area` (scene units squared).
pub(super) fn divided(scene: &Scene, max_area: f64) -> Scene {
    let mut parts = Scene {
        surfaces: Vec::new(),
        ..scene.clone()
    };
    for surface in &scene.surfaces {
        match *corners(scene, surface) {
            [a, b, c] => triangle(&mut parts, surface, [a, b, c], max_area),
            [a, b, c, d] => quad(&mut parts, surface, [a, b, c, d], max_area),
            _ => {}
        }
    }
    parts
}

/// Rounds up, but not for what rounding added.
fn at_least(count: f64) -> u32 {
    (count * (1.0 - ROUNDING)).ceil().max(1.0) as u32
}

/// How many parts of no more than `max_area` make up an area.
fn pieces(area: f64, max_area: f64) -> f64 {
    (area / max_area).clamp(1.0, MOST_PARTS)
}

/// Columns and rows of a quad: cells about as wide as high, the largest no larger than `max_area`.
fn grid([a, b, c, d]: [DVec3; 4], max_area: f64) -> [u32; 2] {
    let width = 0.5 * (a.distance(b) + c.distance(d));
    let height = 0.5 * (b.distance(c) + d.distance(a));
    // What a cell at a corner would have were the quad a parallelogram with that corner: in between area changes linearly.
    let at_corners = [[d, a, b], [a, b, c], [c, d, a], [b, c, d]]
        .map(|[before, corner, after]| (after - corner).cross(before - corner).length());
    let mut pieces = pieces(polygon::vector_area(&[a, b, c, d]).length(), max_area);
    loop {
        // A quad longer than its parts together are wide is cut across only.
        let columns = (pieces * width / height).sqrt().round();
        let columns = columns.clamp(1.0, f64::from(at_least(pieces)));
        let grid = [columns as u32, at_least(pieces / columns)];
        let largest = largest_cell(at_corners, grid);
        if largest <= max_area * (1.0 + 2.0 * ROUNDING) || pieces >= MOST_PARTS {
            return grid;
        }
        let made = f64::from(grid[0]) * f64::from(grid[1]);
        pieces = (made * (largest / max_area).max(1.01)).min(MOST_PARTS);
    }
}

/// The area of the largest cell of a grid, which lies at a corner; the corners are those of the first row, then of the last.
fn largest_cell([first, first_end, last, last_end]: [f64; 4], grid: [u32; 2]) -> f64 {
    let [columns, rows] = grid.map(f64::from);
    let (u, v) = (0.5 / columns, 0.5 / rows);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let at = |u: f64, v: f64| mix(mix(first, first_end, u), mix(last, last_end, u), v);
    let cells = [
        at(u, v),
        at(1.0 - u, v),
        at(u, 1.0 - v),
        at(1.0 - u, 1.0 - v),
    ];
    cells.into_iter().fold(0.0, f64::max) / (columns * rows)
}

fn quad(scene: &mut Scene, surface: &Surface, [a, b, c, d]: [DVec3; 4], max_area: f64) {
    let [columns, rows] = grid([a, b, c, d], max_area);
    if columns * rows == 1 {
        scene.surfaces.push(*surface);
        return;
    }
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

/// Along each side of a triangle.
fn steps([a, b, c]: [DVec3; 3], max_area: f64) -> u32 {
    let area = 0.5 * (b - a).cross(c - a).length();
    at_least(pieces(area, max_area).sqrt())
}

fn triangle(scene: &mut Scene, surface: &Surface, [a, b, c]: [DVec3; 3], max_area: f64) {
    let steps = steps([a, b, c], max_area);
    if steps == 1 {
        scene.surfaces.push(*surface);
        return;
    }
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
