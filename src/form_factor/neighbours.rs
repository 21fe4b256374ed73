//! Which cells of a source lie beside which.

use super::cell::SourceShape;
use super::division::Division;
use super::source::{CELLS, DEEPEST, level_start};
use std::collections::HashMap;
use std::sync::OnceLock;

/// Cells beside a cell; itself in place of those that are not there.
pub(super) type Neighbours = [u16; 4];

impl Division {
    /// The cells of the same level across each side of each cell.
    pub(super) fn neighbours(self) -> &'static [Neighbours] {
        let table = match self.shape {
            SourceShape::Triangle => &TRIANGLE,
            SourceShape::Quad => &QUAD[usize::from(self.upwards)][self.sliced as usize],
        };
        table.get_or_init(|| neighbour_table(self))
    }
}

type Table = OnceLock<Vec<Neighbours>>;

static TRIANGLE: Table = Table::new();
/// By the way slices go and by the levels of them.
static QUAD: [[Table; DEEPEST as usize + 1]; 2] =
    [const { [const { Table::new() }; DEEPEST as usize + 1] }; 2];

/// Finds who shares a side with whom by subdividing a lattice of integers.
fn neighbour_table(division: Division) -> Vec<Neighbours> {
    // Slices are a quarter as long each time.
    const N: i32 = 1 << (2 * DEEPEST + 1);
    let shape = division.shape;
    let mut corners = vec![match shape {
        SourceShape::Triangle => [[0, 0], [N, 0], [0, N], [0, 0]],
        SourceShape::Quad => [[0, 0], [N, 0], [N, N], [0, N]],
    }];
    let half = |a: [i32; 2], b: [i32; 2]| [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    for level in 0..DEEPEST {
        for parent in level_start(level)..level_start(level + 1) {
            let centre = |[a, _, c, _]: [[i32; 2]; 4]| half(a, c);
            corners.extend(division.children(level, corners[parent], half, centre));
        }
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
        let strip = |sliced, upwards| Division {
            shape: SourceShape::Quad,
            sliced,
            upwards,
        };
        for (division, inner_sides) in [
            (strip(0, false), 2 * (2 * 32 * 31)),
            (strip(2, false), 2 * (127 * 8 + 128 * 7)),
            (strip(2, true), 2 * (127 * 8 + 128 * 7)),
            (strip(DEEPEST, true), 2 * 1023),
            (Division::even(SourceShape::Triangle), 3 * 1024 - 3 * 32),
        ] {
            let table = neighbour_table(division);
            let last = &table[level_start(DEEPEST)..];
            let others = |(cell, row): (usize, &Neighbours)| {
                row.iter()
                    .filter(|n| usize::from(**n) != level_start(DEEPEST) + cell)
                    .count()
            };
            let linked: usize = last.iter().enumerate().map(others).sum();
            assert_eq!(linked, inner_sides, "{division:?}");
            for (i, row) in table.iter().enumerate() {
                for other in row {
                    assert!(table[usize::from(*other)].contains(&(i as u16)));
                }
            }
        }
    }
}
