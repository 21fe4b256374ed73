//! Which cells of a source lie beside which.

use super::cell::SourceShape;
use super::source::{CELLS, DEEPEST, level_start};
use std::collections::HashMap;
use std::sync::LazyLock;

/// Cells beside a cell; itself in place of those that are not there.
pub(super) type Neighbours = [u16; 4];

impl SourceShape {
    /// The cells of the same level across each side of each cell.
    pub(super) fn neighbours(self) -> &'static [Neighbours] {
        match self {
            SourceShape::Triangle => &TRIANGLE_NEIGHBOURS,
            SourceShape::Quad => &QUAD_NEIGHBOURS,
        }
    }
}

static TRIANGLE_NEIGHBOURS: LazyLock<Vec<Neighbours>> =
    LazyLock::new(|| neighbour_table(SourceShape::Triangle));
static QUAD_NEIGHBOURS: LazyLock<Vec<Neighbours>> =
    LazyLock::new(|| neighbour_table(SourceShape::Quad));

/// Finds who shares a side with whom by subdividing a lattice of integers.
fn neighbour_table(shape: SourceShape) -> Vec<Neighbours> {
    const N: i32 = 1 << (DEEPEST + 1);
    let mut corners = vec![match shape {
        SourceShape::Triangle => [[0, 0], [N, 0], [0, N], [0, 0]],
        SourceShape::Quad => [[0, 0], [N, 0], [N, N], [0, N]],
    }];
    let half = |a: [i32; 2], b: [i32; 2]| [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    for parent in 0..level_start(DEEPEST) {
        corners.extend(shape.children(corners[parent], half, |[a, _, c, _]| half(a, c)));
    }
    let mut table: Vec<Neighbours> = (0..CELLS as u16).map(|cell| [cell; 4]).collect();
    for level in 0..=DEEPEST {
        let mut open: HashMap<([i32; 2], [i32; 2]), (usize, usize)> = HashMap::new();
        for cell in level_start(level)..level_start(level + 1) {
            for side in 0..shape.corners() {
                let (a, b) = (
                    corners[cell][side],
                    corners[cell][(side + 1) % shape.corners()],
                );
                if let Some((other, other_side)) = open.insert((a.min(b), a.max(b)), (cell, side)) {
                    table[cell][side] = other as u16;
                    table[other][other_side] = cell as u16;
                }
            }
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_share_a_side() {
        for (shape, inner_sides) in [
            (SourceShape::Quad, 2 * (2 * 32 * 31)),
            (SourceShape::Triangle, 3 * 1024 - 3 * 32),
        ] {
            let table = neighbour_table(shape);
            let last = &table[level_start(DEEPEST)..];
            let others = |(cell, row): (usize, &Neighbours)| {
                row.iter()
                    .filter(|n| usize::from(**n) != level_start(DEEPEST) + cell)
                    .count()
            };
            let linked: usize = last.iter().enumerate().map(others).sum();
            assert_eq!(linked, inner_sides, "{shape:?}");
            for (i, row) in table.iter().enumerate() {
                for other in row {
                    assert!(table[usize::from(*other)].contains(&(i as u16)));
                }
            }
        }
    }
}
