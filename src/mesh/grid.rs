//! The coarsest grid of a patch: its elements row by row, each with the vertices that none before it has, corners first. All of that
//! follows from the number of columns and rows, so nothing is kept of it.

use super::{Element, Lattice, NONE, UNIT};

/// How many elements the coarsest grid of a patch has each way: one for a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    pub is_triangle: bool,
    pub columns: u32,
    pub rows: u32,
}

/// Where a vertex of a grid is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// So many columns and rows from the first corner.
    Corner(u32, u32),
    /// In the middle of the element in this column and row.
    Centre(u32, u32),
}

use Place::{Centre, Corner};

/// Where the vertices of a quad and of a triangle are that are one element.
const SINGLE: [[Lattice; 5]; 2] = [
    [
        Lattice::new(0, 0),
        Lattice::new(UNIT, 0),
        Lattice::new(UNIT, UNIT),
        Lattice::new(0, UNIT),
        Lattice::new(UNIT / 2, UNIT / 2),
    ],
    [
        Lattice::new(0, 0),
        Lattice::new(UNIT, 0),
        Lattice::new(0, UNIT),
        Lattice::new(UNIT / 3, UNIT / 3),
        // It has no fifth.
        Lattice::new(UNIT, UNIT),
    ],
];

impl Grid {
    /// How many elements it has.
    pub const fn elements(&self) -> u32 {
        self.columns * self.rows
    }

    /// How many vertices it has.
    pub const fn vertices(&self) -> u32 {
        if self.is_triangle {
            4
        } else {
            (self.columns + 1) * (self.rows + 1) + self.elements()
        }
    }

    /// Whether it is one element, as nearly all grids of large scenes are.
    #[inline(always)]
    const fn is_single(&self) -> bool {
        self.columns | self.rows == 1
    }

    /// One of its elements, if the vertices of the grid are numbered from `first` on.
    #[inline(always)]
    pub fn element(&self, patch: u32, number: u32, first: u32) -> Element {
        let (corners, centre) = if self.is_triangle {
            ([first, first + 1, first + 2, NONE], first + 3)
        } else if self.is_single() {
            ([0, 1, 2, 3].map(|corner| first + corner), first + 4)
        } else {
            let (corners, centre) = self.vertices_of(number);
            (corners.map(|corner| first + corner), first + centre)
        };
        Element {
            patch,
            corners,
            centre,
            hanging: [NONE; 4],
            children: NONE,
            level: 0,
        }
    }

    /// Where one of its vertices is on the patch.
    #[inline(always)]
    pub fn lattice(&self, vertex: u32) -> Lattice {
        if self.is_single() {
            return SINGLE[usize::from(self.is_triangle)][vertex as usize];
        }
        self.lattice_among_many(vertex)
    }

    /// That on a quad with more than one element.
    fn lattice_among_many(&self, vertex: u32) -> Lattice {
        // Powers of two: shifts, not divisions.
        let [du, dv] = [self.columns, self.rows].map(|count| UNIT >> count.trailing_zeros());
        match self.place(vertex) {
            Corner(x, y) => Lattice::new(x * du, y * dv),
            Centre(x, y) => Lattice::new(x * du + du / 2, y * dv + dv / 2),
        }
    }

    /// The first element that has one of its vertices.
    #[inline(always)]
    pub fn maker(&self, vertex: u32) -> u32 {
        if self.is_single() {
            0
        } else {
            self.maker_among_many(vertex)
        }
    }

    /// That on a quad with more than one element.
    fn maker_among_many(&self, vertex: u32) -> u32 {
        let (x, y) = match self.place(vertex) {
            Corner(x, y) => (x.saturating_sub(1), y.saturating_sub(1)),
            Centre(x, y) => (x, y),
        };
        y * self.columns + x
    }

    /// The vertex at a lattice point, if it has one there.
    pub fn vertex_at(&self, at: Lattice) -> Option<u32> {
        if self.is_triangle {
            return (0..4).find(|vertex| self.lattice(*vertex) == at);
        }
        // In halves of an element.
        let [x, y] = [(at.u, self.columns), (at.v, self.rows)].map(|(along, count)| {
            let half = UNIT / count / 2;
            (along % half == 0).then_some(along / half)
        });
        let place = match (x?, y?) {
            (x, y) if x % 2 == 0 && y % 2 == 0 => Corner(x / 2, y / 2),
            (x, y) if x % 2 == 1 && y % 2 == 1 => Centre(x / 2, y / 2),
            _ => return None,
        };
        Some(self.number(place))
    }

    /// The corners and the centre of an element of a quad.
    fn vertices_of(&self, element: u32) -> ([u32; 4], u32) {
        let (x, y) = (element % self.columns, element / self.columns);
        let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
        let corners = corners.map(|(x, y)| self.number(Corner(x, y)));
        (corners, self.number(Centre(x, y)))
    }

    /// The number of a vertex of a quad: the first element brings five, the others of its row three each (two corners), the first of
    /// a later row three as well, and its others two.
    fn number(&self, place: Place) -> u32 {
        let row = |y: u32| 3 * self.columns + 2 + (y - 1) * (2 * self.columns + 1);
        match place {
            Corner(x @ 0..2, 0) => x,
            Corner(x @ 0..2, 1) => 3 - x,
            Corner(x, y @ 0..2) => 3 * x - 1 + y,
            Corner(x @ 0..2, y) => row(y - 1) + 1 - x,
            Corner(x, y) => row(y - 1) + 2 * x - 1,
            Centre(x, 0) => 3 * x + 4,
            Centre(x, y) => row(y) + 2 * x + 2,
        }
    }

    /// The place of a vertex of a quad, by its number.
    fn place(&self, vertex: u32) -> Place {
        match vertex {
            0 => return Corner(0, 0),
            1 => return Corner(1, 0),
            2 => return Corner(1, 1),
            3 => return Corner(0, 1),
            4 => return Centre(0, 0),
            _ => {}
        }
        let in_first_row = 3 * self.columns + 2;
        if vertex < in_first_row {
            let x = (vertex - 2) / 3;
            return match (vertex - 2) % 3 {
                0 => Corner(x + 1, 0),
                1 => Corner(x + 1, 1),
                _ => Centre(x, 0),
            };
        }
        let in_row = 2 * self.columns + 1;
        let y = 1 + (vertex - in_first_row) / in_row;
        match (vertex - in_first_row) % in_row {
            0 => Corner(1, y + 1),
            1 => Corner(0, y + 1),
            2 => Centre(0, y),
            later if later % 2 == 1 => Corner(later.div_ceil(2), y + 1),
            later => Centre(later / 2 - 1, y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::build::centre_of;

    /// Each element with the places of its vertices, as they are made one after the other.
    fn made(grid: Grid) -> (Vec<Element>, Vec<(Lattice, u32)>) {
        let (mut elements, mut vertices) = (Vec::new(), Vec::<(Lattice, u32)>::new());
        let (du, dv) = (UNIT / grid.columns, UNIT / grid.rows);
        for number in 0..grid.elements() {
            let (u, v) = (number % grid.columns * du, number / grid.columns * dv);
            let mut corners = vec![(u, v), (u + du, v), (u + du, v + dv), (u, v + dv)];
            if grid.is_triangle {
                corners.remove(2);
            }
            let mut corners: Vec<Lattice> = corners
                .into_iter()
                .map(|(u, v)| Lattice::new(u, v))
                .collect();
            corners.push(centre_of(&corners));
            let of = corners.into_iter().map(|at| {
                let known = vertices.iter().position(|(known, _)| *known == at);
                known.unwrap_or_else(|| {
                    vertices.push((at, number));
                    vertices.len() - 1
                }) as u32
            });
            let of: Vec<u32> = of.collect();
            let (centre, corners) = of.split_last().expect("has a centre");
            elements.push(Element {
                patch: 7,
                corners: [0, 1, 2, 3].map(|i| corners.get(i).copied().unwrap_or(NONE)),
                centre: *centre,
                hanging: [NONE; 4],
                children: NONE,
                level: 0,
            });
        }
        (elements, vertices)
    }

    #[test]
    fn it_is_what_is_made_element_by_element() {
        let quads = (0..5).flat_map(|a| (0..5).map(move |b| (false, 1 << a, 1 << b)));
        for (is_triangle, columns, rows) in quads.chain([(true, 1, 1)]) {
            let grid = Grid {
                is_triangle,
                columns,
                rows,
            };
            let (elements, vertices) = made(grid);
            assert_eq!(grid.vertices() as usize, vertices.len());
            for (number, element) in (0..).zip(elements) {
                assert_eq!(grid.element(7, number, 0), element, "{grid:?}, {number}");
            }
            for (number, (lattice, maker)) in (0..).zip(vertices) {
                assert_eq!(grid.lattice(number), lattice, "{grid:?}, {number}");
                assert_eq!(grid.maker(number), maker, "{grid:?}, {number}");
                assert_eq!(grid.vertex_at(lattice), Some(number), "{grid:?}, {number}");
                let beside = Lattice::new(lattice.u ^ 1, lattice.v);
                assert_eq!(grid.vertex_at(beside), None);
            }
            let middle = Lattice::new(UNIT / columns / 2, 0);
            assert_eq!(grid.vertex_at(middle), None);
        }
    }
}
