//! All patches of a mesh as they are kept: of some scenes there is one for every four vertices, and what follows from the corners, or is
//! the same for many, would take most of the memory.

use super::grid::Grid;
use super::{Element, Lattice, Patch, Vertex};
use crate::radiometry::Spectrum;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::hash::Hash;
use std::ops::Range;

/// No grid has more columns or rows than this.
pub(super) const MOST_ALONG: u32 = 1 << 10;

/// The patches of a mesh.
#[derive(Debug, Clone, Default)]
pub struct Patches {
    records: Vec<Record>,
    /// In the frame, no two the same.
    corners: Vec<DVec3>,
    /// Reflectance and exitance, no two pairs the same.
    colours: Vec<[Spectrum; 2]>,
}

/// What a patch has of its own.
#[derive(Debug, Clone, Copy)]
struct Record {
    corners: [u32; 4],
    surface: u32,
    polygon: u32,
    colours: u32,
    /// The first element of its coarsest grid.
    root: u32,
    grid: [u16; 2],
    first_vertex: u32,
    is_triangle: bool,
    back: bool,
    outline: [bool; 4],
}

/// Where the corners and colours of patches are, by their bits.
#[derive(Default)]
pub(super) struct Known {
    corners: FxHashMap<[u64; 3], u32>,
    colours: FxHashMap<[u32; 6], u32>,
}

impl Patches {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The patch with a number. Who asks for a part of it pays for little more if this is compiled where it is asked for.
    #[inline(always)]
    pub fn at(&self, number: usize) -> Patch {
        let of = &self.records[number];
        let corners = of.corners.map(|corner| self.corners[corner as usize]);
        let count = if of.is_triangle { 3 } else { 4 };
        let [reflectance, exitance] = self.colours[of.colours as usize];
        let grid = of.grid();
        Patch {
            outline: of.outline,
            reflectance,
            exitance,
            roots: of.root..of.root + grid.elements(),
            grid: (grid.columns, grid.rows),
            first_vertex: of.first_vertex,
            ..Patch::new(of.surface, of.polygon, &corners[..count], of.back)
        }
    }

    /// The reflectance of that.
    #[inline]
    pub fn reflectance(&self, number: usize) -> Spectrum {
        self.colours[self.records[number].colours as usize][0]
    }

    /// The coarsest grid of each.
    pub(super) fn grids(&self) -> impl Iterator<Item = Grid> + Clone + '_ {
        self.records.iter().map(Record::grid)
    }

    /// The first element and the first vertex after those of the coarsest grids.
    pub(super) fn first_after(&self) -> (u32, u32) {
        self.records.last().map_or((0, 0), |last| {
            let grid = last.grid();
            (
                last.root + grid.elements(),
                last.first_vertex + grid.vertices(),
            )
        })
    }

    /// The vertices of its coarsest grid.
    #[inline]
    pub(super) fn first_vertices(&self, number: u32) -> Range<u32> {
        let of = &self.records[number as usize];
        of.first_vertex..of.first_vertex + of.grid().vertices()
    }

    /// That of these with a number.
    #[inline(always)]
    pub(super) fn first_vertex(&self, patch: u32, number: u32) -> Vertex {
        let of = &self.records[patch as usize];
        let (grid, of_grid) = (of.grid(), number - of.first_vertex);
        Vertex {
            patch,
            lattice: grid.lattice(of_grid),
            maker: of.root + grid.maker(of_grid),
        }
    }

    /// That of these at a lattice point, if there is one.
    pub(super) fn first_at(&self, patch: u32, lattice: Lattice) -> Option<u32> {
        let of = &self.records[patch as usize];
        let of_grid = of.grid().vertex_at(lattice);
        of_grid.map(|vertex| of.first_vertex + vertex)
    }

    /// The element of its coarsest grid with a number, as it is before it is split.
    #[inline(always)]
    pub(super) fn root(&self, patch: u32, number: u32) -> Element {
        let of = &self.records[patch as usize];
        of.grid().element(patch, number - of.root, of.first_vertex)
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Patch> + DoubleEndedIterator + Clone + '_ {
        (0..self.len()).map(|number| self.at(number))
    }

    /// Those of a surface, or of the several of which it is the first, with their numbers.
    pub fn of_surface(&self, surface: u32) -> impl Iterator<Item = (u32, Patch)> + '_ {
        let first = self.records.partition_point(|of| of.surface < surface);
        let all = self.records[first..].iter();
        let of = all.take_while(move |of| of.surface == surface);
        (first..)
            .zip(of)
            .map(|(number, _)| (number as u32, self.at(number)))
    }

    /// All of them, in parallel.
    pub fn par_iter(&self) -> impl IndexedParallelIterator<Item = Patch> + '_ {
        (0..self.len())
            .into_par_iter()
            .map(|number| self.at(number))
    }

    /// Adds one.
    pub(super) fn push(&mut self, patch: &Patch, known: &mut Known) {
        let mut corners = [0; 4];
        for (slot, corner) in corners.iter_mut().zip(patch.corners()) {
            let bits = corner.to_array().map(f64::to_bits);
            *slot = place(&mut known.corners, bits, &mut self.corners, *corner);
        }
        if patch.is_triangle() {
            corners[3] = corners[0];
        }
        let colours = [patch.reflectance, patch.exitance];
        self.records.push(Record {
            corners,
            surface: patch.surface,
            polygon: patch.polygon,
            colours: place(
                &mut known.colours,
                bits(colours),
                &mut self.colours,
                colours,
            ),
            root: patch.roots.start,
            grid: [patch.grid.0, patch.grid.1].map(|n| n as u16),
            first_vertex: patch.first_vertex,
            is_triangle: patch.is_triangle(),
            back: patch.back,
            outline: patch.outline,
        });
    }

    /// Lets patches emit what `exitance` says of them.
    pub fn relight(&mut self, exitance: impl Fn(&Patch) -> Spectrum) {
        let (mut colours, mut known) = (Vec::new(), FxHashMap::default());
        for number in 0..self.len() {
            let patch = self.at(number);
            let now = [patch.reflectance, exitance(&patch)];
            self.records[number].colours = place(&mut known, bits(now), &mut colours, now);
        }
        self.colours = colours;
    }

    /// Gives back the memory that pushes have left over.
    pub(super) fn shrink(&mut self) {
        self.records.shrink_to_fit();
        self.corners.shrink_to_fit();
    }
}

impl Record {
    #[inline(always)]
    fn grid(&self) -> Grid {
        let [columns, rows] = self.grid.map(u32::from);
        Grid {
            is_triangle: self.is_triangle,
            columns,
            rows,
        }
    }
}

fn bits([reflectance, exitance]: [Spectrum; 2]) -> [u32; 6] {
    let ([a, b, c], [d, e, f]) = (reflectance.to_array(), exitance.to_array());
    [a, b, c, d, e, f].map(f32::to_bits)
}

/// The place of a thing in a list, where it is added if its key is not known.
fn place<K: Hash + Eq, T>(known: &mut FxHashMap<K, u32>, key: K, list: &mut Vec<T>, of: T) -> u32 {
    *known.entry(key).or_insert_with(|| {
        list.push(of);
        list.len() as u32 - 1
    })
}
