//! Cells that a patch is cut into, in its coordinates.

use crate::form_factor::{Division, SourceShape};
use crate::geometry::polygon::vector_area;
use crate::mesh::Patch;

/// A triangle or parallelogram of coordinates on a patch; a triangle repeats its first corner.
pub(super) type Quad = [[f64; 2]; 4];

/// The cells of a level below `whole`, each by its three or four corners.
pub(super) fn cells_at(whole: Quad, division: Division, levels: u32) -> Vec<Quad> {
    let mut cells = vec![whole];
    for level in 0..levels {
        let split = |cell: &Quad| division.children(level, *cell, half, |[a, _, c, _]| half(a, c));
        cells = cells.iter().flat_map(split).collect();
    }
    cells
}

/// The cells of a quad in columns and rows.
pub(super) fn cells_in(columns: u32, rows: u32) -> Vec<Quad> {
    let part = |number: u32, of: u32| f64::from(number) / f64::from(of);
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    cells
        .map(|(column, row)| {
            let [from, to] = [column, column + 1].map(|number| part(number, columns));
            let [low, high] = [row, row + 1].map(|number| part(number, rows));
            [[from, low], [to, low], [to, high], [from, high]]
        })
        .collect()
}

/// All of a patch.
pub(super) fn root(triangle: bool) -> Quad {
    if triangle {
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]
    } else {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    }
}

fn half(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]
}

/// The four quarters of a cell, in the order of the pyramid.
pub(super) fn parts(cell: &Quad, triangle: bool) -> [Quad; 4] {
    let shape = match triangle {
        true => SourceShape::Triangle,
        false => SourceShape::Quad,
    };
    shape.children(*cell, half, |[a, _, c, _]| half(a, c))
}

/// The areas of cells of a patch. On triangles and parallelograms they are as large as in the coordinates.
pub(super) fn areas(of: &Patch, cells: &[Quad]) -> Vec<f64> {
    if let [a, b, c, d] = *of.corners()
        && (a + c).distance(b + d) > 1e-9 * a.distance(c)
    {
        let corners = |cell: &Quad| cell.map(|[u, v]| of.position_at(u, v));
        return cells
            .iter()
            .map(|cell| vector_area(&corners(cell)).length())
            .collect();
    }
    let whole = root(of.is_triangle());
    let share = |cell: &Quad| area_in_coordinates(cell) / area_in_coordinates(&whole);
    cells.iter().map(|cell| of.area * share(cell)).collect()
}

fn area_in_coordinates(&[a, b, c, d]: &Quad) -> f64 {
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let way = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
    0.5 * cross(way(a, c), way(b, d)).abs()
}
