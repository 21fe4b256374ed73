//! A shooting patch as a pyramid of cells, each split into four.

use super::cell::{Cell, SourceShape};
use super::division::Division;
use super::neighbours::Neighbours;
use super::siblings::Siblings;
use crate::radiometry::Spectrum;
use glam::{DVec3, Vec3, Vec3A};

/// Cells are numbered level by level; cell `c` has the children `4c + 1 … 4c + 4`.
pub(super) type CellIndex = u32;

/// The deepest level a source can have: 1024 cells there, 1365 in all.
pub const DEEPEST: u32 = 5;

/// Cells of a source that has all levels.
pub(super) const CELLS: usize = level_start(DEEPEST + 1);

/// A cell as the image of the unit square: `origin + s along_s + t along_t + s t twist`.
#[derive(Debug, Clone)]
struct Map {
    origin: Vec3A,
    along_s: Vec3A,
    along_t: Vec3A,
    twist: Vec3A,
}

impl Map {
    fn new(cell: &Cell) -> Self {
        let [a, b, c, d] = cell.corners();
        let (far, twist) = match cell.shape() {
            SourceShape::Quad => (d, a - b + c - d),
            SourceShape::Triangle => (c, DVec3::ZERO),
        };
        Self {
            origin: a.as_vec3a(),
            along_s: (b - a).as_vec3a(),
            along_t: (far - a).as_vec3a(),
            twist: twist.as_vec3a(),
        }
    }
}

/// A shooting patch: the pyramid of its cells with the radiosity that each has to give.
#[derive(Debug, Clone)]
pub struct Source {
    division: Division,
    normal: DVec3,
    levels: u32,
    neighbours: &'static [Neighbours],
    cells: Vec<Cell>,
    /// The children of each cell that has some.
    parts: Vec<Siblings>,
    maps: Vec<Map>,
    /// Radiosity of the cells of the deepest level, close together in memory.
    finest: Vec<Spectrum>,
    cores: Vec<Source>,
}

impl Source {
    /// The pyramid over a planar convex polygon of three or four corners, counter-clockwise seen from its radiating side.
    ///
    /// `finest` holds the mean unshot radiosity of each cell of the deepest level, `4^levels` of them in the order of its [`Division`]; a coarser
    /// cell has the area-weighted mean of its children, so that the power is the same on every level.
    pub fn new(corners: &[DVec3], normal: DVec3, levels: u32, finest: &[Spectrum]) -> Self {
        assert!((1..=DEEPEST).contains(&levels) && finest.len() == 1 << (2 * levels));
        let division = Division::of(corners);
        let shape = division.shape;
        let root = [
            corners[0],
            corners[1],
            corners[2],
            *corners.get(3).unwrap_or(&corners[0]),
        ];
        let mut cells = vec![Cell::new(root, shape)];
        for level in 0..levels {
            for parent in level_start(level)..level_start(level + 1) {
                for child in cells[parent].children(division, level) {
                    cells.push(Cell::new(child, shape));
                }
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
        let families = cells[1..].chunks_exact(4);
        Self {
            division,
            normal,
            levels,
            neighbours: division.neighbours(),
            parts: families.map(Siblings::new).collect(),
            maps: cells.iter().map(Map::new).collect(),
            cells,
            finest: finest.to_vec(),
            cores: Vec::new(),
        }
    }

    /// The same patch with what some of its cells send on pyramids of their own; in this one, and in one another, they are dark.
    pub fn with_cores(self, cores: Vec<Self>) -> Self {
        Self { cores, ..self }
    }

    /// Cells that send so much that they have pyramids of their own.
    pub(super) fn cores(&self) -> &[Self] {
        &self.cores
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
        self.cells[0].outline()
    }

    /// The cells of the deepest level with their radiosity times area, for drawing points in proportion to it.
    pub fn finest(&self) -> impl Iterator<Item = (&Cell, Spectrum)> + Clone {
        let pyramids = std::iter::once(self).chain(&self.cores);
        let cells = pyramids.flat_map(|of| &of.cells[level_start(of.levels)..]);
        cells.map(|c| (c, c.radiosity * c.area as f32))
    }

    #[inline(always)]
    pub(super) fn cell(&self, index: CellIndex) -> &Cell {
        &self.cells[index as usize]
    }

    /// The children of a cell together.
    #[inline(always)]
    pub(super) fn parts(&self, parent: CellIndex) -> &Siblings {
        &self.parts[parent as usize]
    }

    /// The point at (s, t) of a cell, as [`Cell::at`] has it.
    #[inline(always)]
    pub(super) fn point_at(&self, index: CellIndex, s: f32, t: f32) -> Vec3 {
        let (s, t) = self.division.shape.folded(s, t);
        let map = &self.maps[index as usize];
        (map.origin + map.along_s * s + (map.along_t + map.twist * s) * t).into()
    }

    /// Radiosity at the point (s, t) of a cell, to the resolution of the deepest level.
    pub(super) fn radiosity_at(&self, mut index: CellIndex, s: f32, t: f32) -> Spectrum {
        let (mut s, mut t) = self.division.shape.folded(s, t);
        while self.has_children(index) {
            let (child, s2, t2) = match self.division.shape {
                SourceShape::Quad if self.is_sliced(index) => {
                    let along = if self.division.upwards {
                        &mut t
                    } else {
                        &mut s
                    };
                    let slice = (*along * 4.0).floor().min(3.0);
                    *along = *along * 4.0 - slice;
                    (slice as CellIndex, s, t)
                }
                SourceShape::Quad => {
                    let (right, upper) = (s >= 0.5, t >= 0.5);
                    let child = [[0, 3], [1, 2]][usize::from(right)][usize::from(upper)];
                    (
                        child,
                        2.0 * s - f32::from(right),
                        2.0 * t - f32::from(upper),
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
    #[inline(always)]
    pub(super) fn has_children(&self, index: CellIndex) -> bool {
        (index as usize) < level_start(self.levels)
    }

    /// Whether the children of a cell are slices.
    #[inline(always)]
    pub(super) fn is_sliced(&self, index: CellIndex) -> bool {
        (index as usize) < level_start(self.division.sliced)
    }

    /// How much of the difference that its parts make to a cell is its error, as that is of second order: of parts half as long a third is left, of slices a
    /// fifteenth.
    #[inline(always)]
    pub(super) fn extrapolation(&self, index: CellIndex) -> f32 {
        if self.is_sliced(index) {
            16.0 / 15.0
        } else {
            4.0 / 3.0
        }
    }

    /// The cells of the same level across each side.
    #[inline(always)]
    pub(super) fn neighbours(&self, index: CellIndex) -> Neighbours {
        self.neighbours[index as usize]
    }
}

/// The four children of a cell.
pub(super) fn children(cell: CellIndex) -> impl DoubleEndedIterator<Item = CellIndex> + Clone {
    4 * cell + 1..=4 * cell + 4
}

/// Number of the first cell of a level.
pub(super) const fn level_start(level: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form_factor::{
        Formula, Gather, Receiver, Sampler, Scratch, SourceThresholds, ToleranceScale,
    };
    use crate::geometry::jitter;
    use crate::visibility::{Obvhs, Triangles};

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
    fn single_precision_aims_at_the_same_points() {
        let [a, b, c, d] = square();
        let long = [a, b + 9.0 * DVec3::X, c + 9.0 * DVec3::X, d];
        for corners in [
            &long,
            &[a, b, c, d][..],
            &[a, b, c + DVec3::X, d],
            &[a, b, c],
        ] {
            let source = Source::new(corners, DVec3::Z, 2, &[Spectrum::ONE; 16]);
            for index in 0..level_start(3) as CellIndex {
                for (s, t) in [(0.1_f32, 0.2), (0.9, 0.3), (0.4, 0.9)] {
                    let at = source.cell(index).at(f64::from(s), f64::from(t));
                    assert!(source.point_at(index, s, t).distance(at.as_vec3()) < 1e-6);
                }
            }
        }
    }

    /// Cells of a quad and of a triangle, the middle one among them.
    #[test]
    fn a_core_gives_what_its_cell_would() {
        let [a, b, c, d] = square();
        let facing_down = [a, d, c, b];
        let blocker = Triangles {
            vertices: [[0.0, 0.0, -0.01], [0.5, 0.0, -0.01], [0.0, 0.5, -0.01]]
                .map(Vec3::from)
                .to_vec(),
            indices: vec![[0, 1, 2]],
        };
        let sampler = Sampler {
            visibility: &Obvhs::new(&blocker).expect("one triangle is enough"),
            extent: 2.0,
            formula: Formula::Hybrid(5.0),
            thresholds: SourceThresholds {
                difference: 1e-4,
                estimate: 1e-3,
                raw: false,
                scale: ToleranceScale {
                    reference: 1.0,
                    local_share: 0.0,
                },
            },
        };
        let receivers: Vec<(Receiver, u32)> = (0..50)
            .map(|i| {
                let [[x, y], [z, _]] = [0, 1].map(|k| jitter(i, k));
                let receiver = Receiver {
                    point: DVec3::new(x, y, -0.1 - z),
                    normal: DVec3::Z,
                    irradiance: 0.0,
                };
                (receiver, i)
            })
            .collect();
        for corners in [&facing_down[..], &facing_down[..3]] {
            for bright in 0..4 {
                let mut finest = [Spectrum::ZERO; 64];
                let dark = Source::new(corners, DVec3::NEG_Z, 3, &finest);
                finest[16 * bright..][..16].fill(Spectrum::ONE);
                let plain = Source::new(corners, DVec3::NEG_Z, 3, &finest);
                let cell = dark.cell(1 + bright as CellIndex).outline();
                let core = Source::new(cell, DVec3::NEG_Z, 2, &[Spectrum::ONE; 16]);
                let cored = dark.clone().with_cores(vec![core]);
                let power = |of: &Source| of.finest().map(|(_, power)| power.x).sum::<f32>();
                assert!((power(&cored) / power(&plain) - 1.0).abs() < 1e-6);
                let mut scratch = Scratch::default();
                let mut received = |source: &Source| {
                    let mut gathers = vec![Gather::default(); receivers.len()];
                    sampler.gather(source, &receivers, &mut scratch, &mut gathers);
                    let sum = |of: fn(&Gather) -> Spectrum| {
                        gathers.iter().map(|gather| of(gather).x).sum::<f32>()
                    };
                    [sum(|g| g.unoccluded), sum(|g| g.irradiance)]
                };
                let ([all, seen], [expected, in_view]) = (received(&cored), received(&plain));
                assert!((all / expected - 1.0).abs() < 1e-3, "{all} {expected}");
                assert!((seen - in_view).abs() < 0.03 * all, "{seen} {in_view}");
            }
        }
    }
}
