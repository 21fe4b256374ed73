//! A shooting patch as a pyramid of cells, each split into four.

use crate::geometry::polygon;
use crate::radiometry::Spectrum;
use glam::DVec3;
use std::collections::HashMap;
use std::sync::LazyLock;

/// Cells are numbered level by level; cell `c` has the children `4c + 1 … 4c + 4`.
pub(super) type CellIndex = u32;

/// The deepest level a source can have: 1024 cells there, 1365 in all.
pub const DEEPEST: u32 = 5;

/// The two shapes that shoot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SourceShape {
    /// Three corners; split at the midpoints into three corner triangles and the middle one.
    Triangle,
    /// Four corners; split at the midpoints and the mean of the corners.
    Quad,
}

/// A cell of the source.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    corners: [DVec3; 4],
    shape: SourceShape,
    /// Centre of mass: where Eq. (1) is evaluated.
    pub(super) centroid: DVec3,
    pub(super) area: f64,
    /// The longest distance between two corners.
    pub(super) diameter: f64,
    /// The longest distance from the centroid to a corner.
    pub(super) radius: f64,
    /// Mean unshot radiosity.
    pub(super) radiosity: Spectrum,
    /// Largest difference, in any channel, between a child's radiosity and the cell's.
    pub(super) variation: f32,
}

impl Cell {
    pub(super) fn new(corners: [DVec3; 4], shape: SourceShape) -> Self {
        let count = shape.corners();
        let used = &corners[..count];
        let centroid = polygon::centroid(used);
        let radius = used
            .iter()
            .map(|c| c.distance_squared(centroid))
            .fold(0.0, f64::max)
            .sqrt();
        Self {
            corners,
            shape,
            centroid,
            area: polygon::vector_area(used).length(),
            diameter: polygon::diameter(used),
            radius,
            radiosity: Spectrum::ZERO,
            variation: 0.0,
        }
    }

    /// All four stored corners; a triangle repeats its first.
    pub(super) fn corners(&self) -> [DVec3; 4] {
        self.corners
    }

    /// Three or four.
    pub(super) fn corner_count(&self) -> usize {
        self.shape.corners()
    }

    /// The three or four corners.
    pub(super) fn outline(&self) -> &[DVec3] {
        &self.corners[..self.corner_count()]
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The point at (s, t) of the unit square, mapped onto the cell evenly in area for triangles and parallelograms.
    pub fn at(&self, s: f64, t: f64) -> DVec3 {
        let [a, b, c, d] = self.corners;
        match self.shape {
            SourceShape::Quad => a.lerp(b, s).lerp(d.lerp(c, s), t),
            SourceShape::Triangle => {
                let (s, t) = if s + t > 1.0 {
                    (1.0 - s, 1.0 - t)
                } else {
                    (s, t)
                };
                a + (b - a) * s + (c - a) * t
            }
        }
    }

    fn children(&self) -> [[DVec3; 4]; 4] {
        self.shape.children(
            self.corners,
            |a, b| (a + b) * 0.5,
            |[a, b, c, d]| (a + b + c + d) * 0.25,
        )
    }
}

impl SourceShape {
    /// Three or four.
    pub const fn corners(self) -> usize {
        match self {
            SourceShape::Triangle => 3,
            SourceShape::Quad => 4,
        }
    }

    /// The corners of the four parts, in the order in which the mesh numbers the children of an element.
    fn children<P: Copy>(
        self,
        corners: [P; 4],
        midpoint: impl Fn(P, P) -> P,
        centre: impl Fn([P; 4]) -> P,
    ) -> [[P; 4]; 4] {
        let [a, b, c, d] = corners;
        match self {
            SourceShape::Quad => {
                let (ab, bc, cd, da) = (
                    midpoint(a, b),
                    midpoint(b, c),
                    midpoint(c, d),
                    midpoint(d, a),
                );
                let m = centre(corners);
                [
                    [a, ab, m, da],
                    [ab, b, bc, m],
                    [m, bc, c, cd],
                    [da, m, cd, d],
                ]
            }
            SourceShape::Triangle => {
                let (ab, bc, ca) = (midpoint(a, b), midpoint(b, c), midpoint(c, a));
                [
                    [a, ab, ca, a],
                    [ab, b, bc, ab],
                    [ca, bc, c, ca],
                    [bc, ca, ab, bc],
                ]
            }
        }
    }
}

/// A shooting patch: the pyramid of its cells with the radiosity that each has to give.
#[derive(Debug, Clone)]
pub struct Source {
    shape: SourceShape,
    normal: DVec3,
    levels: u32,
    cells: Vec<Cell>,
    /// Radiosity of the cells of the deepest level, close together in memory.
    finest: Vec<Spectrum>,
}

impl Source {
    /// The pyramid over a planar convex polygon of three or four corners, counter-clockwise seen from its radiating side.
    ///
    /// `finest` holds the mean unshot radiosity of each cell of the deepest level, `4^levels` of them in order; a coarser
    /// cell has the area-weighted mean of its children, so that the power is the same on every level.
    pub fn new(corners: &[DVec3], normal: DVec3, levels: u32, finest: &[Spectrum]) -> Self {
        assert!((1..=DEEPEST).contains(&levels) && finest.len() == 1 << (2 * levels));
        let shape = if corners.len() == 3 {
            SourceShape::Triangle
        } else {
            SourceShape::Quad
        };
        let root = [
            corners[0],
            corners[1],
            corners[2],
            *corners.get(3).unwrap_or(&corners[0]),
        ];
        let mut cells = vec![Cell::new(root, shape)];
        for parent in 0..level_start(levels) {
            for child in cells[parent].children() {
                cells.push(Cell::new(child, shape));
            }
        }
        for (cell, radiosity) in cells[level_start(levels)..].iter_mut().zip(finest) {
            cell.radiosity = *radiosity;
        }
        for parent in (0..level_start(levels)).rev() {
            let children = &cells[4 * parent + 1..4 * parent + 5];
            let area: f64 = children.iter().map(|c| c.area).sum();
            let power: Spectrum = children.iter().map(|c| c.radiosity * c.area as f32).sum();
            let mean = if area > 0.0 {
                power / area as f32
            } else {
                Spectrum::ZERO
            };
            let variation = children
                .iter()
                .map(|c| (c.radiosity - mean).abs().max_element())
                .fold(0.0, f32::max);
            cells[parent].radiosity = mean;
            cells[parent].variation = variation;
        }
        Self {
            shape,
            normal,
            levels,
            cells,
            finest: finest.to_vec(),
        }
    }

    /// Unit normal of the radiating side.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Area of the whole patch.
    pub fn area(&self) -> f64 {
        self.cells[0].area
    }

    /// The corners of the whole patch.
    pub fn corners(&self) -> &[DVec3] {
        &self.cells[0].corners[..self.shape.corners()]
    }

    /// The cells of the deepest level with their radiosity times area, for drawing points in proportion to it.
    pub fn finest(&self) -> impl ExactSizeIterator<Item = (&Cell, Spectrum)> + Clone {
        self.cells[level_start(self.levels)..]
            .iter()
            .map(|c| (c, c.radiosity * c.area as f32))
    }

    pub(super) fn cell(&self, index: CellIndex) -> &Cell {
        &self.cells[index as usize]
    }

    /// Radiosity at the point (s, t) of a cell, to the resolution of the deepest level.
    pub(super) fn radiosity_at(&self, mut index: CellIndex, s: f64, t: f64) -> Spectrum {
        let (mut s, mut t) = match self.shape {
            SourceShape::Triangle if s + t > 1.0 => (1.0 - s, 1.0 - t),
            _ => (s, t),
        };
        while self.has_children(index) {
            let (child, s2, t2) = match self.shape {
                SourceShape::Quad => {
                    let (right, upper) = (s >= 0.5, t >= 0.5);
                    let child = [[0, 3], [1, 2]][usize::from(right)][usize::from(upper)];
                    (
                        child,
                        2.0 * s - f64::from(right),
                        2.0 * t - f64::from(upper),
                    )
                }
                SourceShape::Triangle if s > 0.5 => (1, 2.0 * s - 1.0, 2.0 * t),
                SourceShape::Triangle if t > 0.5 => (2, 2.0 * s, 2.0 * t - 1.0),
                SourceShape::Triangle if s + t < 0.5 => (0, 2.0 * s, 2.0 * t),
                SourceShape::Triangle => (3, 1.0 - 2.0 * s, 1.0 - 2.0 * t),
            };
            (index, s, t) = (4 * index + 1 + child, s2, t2);
        }
        self.finest[index as usize - level_start(self.levels)]
    }

    /// Whether a cell can still be split.
    pub(super) fn has_children(&self, index: CellIndex) -> bool {
        (index as usize) < level_start(self.levels)
    }

    /// The cells of the same level across each side; `None` on the border.
    pub(super) fn neighbours(&self, index: CellIndex) -> &'static [Option<CellIndex>; 4] {
        let table = match self.shape {
            SourceShape::Triangle => &TRIANGLE_NEIGHBOURS,
            SourceShape::Quad => &QUAD_NEIGHBOURS,
        };
        &table[index as usize]
    }
}

/// The four children of a cell.
pub(super) fn children(cell: CellIndex) -> impl DoubleEndedIterator<Item = CellIndex> + Clone {
    4 * cell + 1..=4 * cell + 4
}

/// Number of the first cell of a level.
const fn level_start(level: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3
}

static TRIANGLE_NEIGHBOURS: LazyLock<Vec<[Option<CellIndex>; 4]>> =
    LazyLock::new(|| neighbour_table(SourceShape::Triangle));
static QUAD_NEIGHBOURS: LazyLock<Vec<[Option<CellIndex>; 4]>> =
    LazyLock::new(|| neighbour_table(SourceShape::Quad));

/// Finds who shares a side with whom by subdividing a lattice of integers.
fn neighbour_table(shape: SourceShape) -> Vec<[Option<CellIndex>; 4]> {
    const N: i32 = 1 << (DEEPEST + 1);
    let mut corners = vec![match shape {
        SourceShape::Triangle => [[0, 0], [N, 0], [0, N], [0, 0]],
        SourceShape::Quad => [[0, 0], [N, 0], [N, N], [0, N]],
    }];
    let half = |a: [i32; 2], b: [i32; 2]| [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    for parent in 0..level_start(DEEPEST) {
        corners.extend(shape.children(corners[parent], half, |[a, _, c, _]| half(a, c)));
    }
    let mut table = vec![[None; 4]; corners.len()];
    for level in 0..=DEEPEST {
        let mut open: HashMap<([i32; 2], [i32; 2]), (usize, usize)> = HashMap::new();
        for cell in level_start(level)..level_start(level + 1) {
            for side in 0..shape.corners() {
                let (a, b) = (
                    corners[cell][side],
                    corners[cell][(side + 1) % shape.corners()],
                );
                if let Some((other, other_side)) = open.insert((a.min(b), a.max(b)), (cell, side)) {
                    table[cell][side] = Some(other as CellIndex);
                    table[other][other_side] = Some(cell as CellIndex);
                }
            }
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> [DVec3; 4] {
        [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]
    }

    #[test]
    fn every_level_covers_the_patch_and_carries_its_power() {
        for count in [3, 4] {
            let corners = &square()[..count];
            let finest: Vec<Spectrum> = (0..256)
                .map(|i| Spectrum::new(i as f32, 1.0, 0.5))
                .collect();
            let source = Source::new(corners, DVec3::Z, 4, &finest);
            for level in 0..=4 {
                let cells = &source.cells[level_start(level)..level_start(level + 1)];
                let area: f64 = cells.iter().map(|c| c.area).sum();
                let power: f64 = cells
                    .iter()
                    .map(|c| f64::from(c.radiosity.x) * c.area)
                    .sum();
                assert!((area - source.area()).abs() < 1e-14);
                assert!((power / area - 127.5).abs() < 1e-3, "{power}");
            }
        }
    }

    #[test]
    fn neighbours_share_a_side() {
        for (shape, inner_sides) in [
            (SourceShape::Quad, 2 * (2 * 32 * 31)),
            (SourceShape::Triangle, 3 * 1024 - 3 * 32),
        ] {
            let table = neighbour_table(shape);
            let last = &table[level_start(DEEPEST)..];
            let linked: usize = last.iter().flatten().flatten().count();
            assert_eq!(linked, inner_sides, "{shape:?}");
            for (i, row) in table.iter().enumerate() {
                for other in row.iter().flatten() {
                    assert!(table[*other as usize].contains(&Some(i as CellIndex)));
                }
            }
        }
    }
}
