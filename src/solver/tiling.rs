//! All patches of a large scene as the tiles that its clusters are made of.
//!
//! A tile is even, and that is wrong for what is beside it: a pane that is bright at its rim and dark in the middle lights the pane behind it as
//! if it were grey. So for the gathering tiles are cut into four, and these again, where what they send is uneven.

use super::cells::{Quad, cells_at, cells_in, parts, root};
use super::escape::Part;
use super::light::{Light, Sign};
use super::options::Options;
use super::shoot::Shooter;
use super::source::{cell_mean, means_on};
use crate::form_factor::{Clusters, DEEPEST, Division, SourceShape, Tile, ToleranceScale};
use crate::geometry::polygon::diameter;
use crate::mesh::{Mesh, Patch};
use crate::radiometry::Spectrum;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// Tiles are no longer than this fraction of the scene's extent; those of triangles are, if it took more than [`DEEPEST`] levels.
pub(super) const SIZE: f64 = 1.0 / 128.0;

/// An uneven tile is cut into four, and these again, at most so many times.
const MOST_CUTS: u32 = 4;

/// Patches of which the tiles are made at once.
const SLICE: usize = 1 << 14;

/// Stands before what the parts of a cell send that is cut into four.
const CUT: Spectrum = Spectrum::NAN;

/// The tiles of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Tiling {
    pub clusters: Clusters,
    /// How each patch is cut into cells; `None` for one that radiates nothing. This depends on the patches alone, not on how they are meshed.
    cuts: Vec<Option<Cut>>,
    uneven: Uneven,
}

/// By patch with cells that are cut into four: which ones are, a cell before its parts. All others are tiles.
type Uneven = FxHashMap<u32, Vec<bool>>;

/// How a patch is cut into tiles; no side into more than [`SIZE`] asks for.
#[derive(Debug, Clone, Copy)]
enum Cut {
    /// A triangle, into four so many times.
    Levels(u8),
    /// A quad, into so many columns and rows.
    Grid(u16, u16),
}

impl Tiling {
    /// A tile for each cell.
    pub fn new(mesh: &Mesh) -> Self {
        Self::with(mesh, cuts(mesh), Uneven::default())
    }

    /// Tiles for what was `sent` once; see [`Self::unshot`].
    pub fn for_sent(mesh: &Mesh, sent: &[Spectrum]) -> Self {
        let cuts = cuts(mesh);
        let uneven = uneven_in(&cuts, sent).unwrap_or_default();
        Self::with(mesh, cuts, uneven)
    }

    /// Tiles on none of which what is unshot differs by more than the thresholds of test 2 allow on an element as large.
    pub fn even(mesh: &Mesh, light: &Light, (options, scale): (&Options, ToleranceScale)) -> Self {
        let cuts = cuts(mesh);
        let evenness = Evenness {
            mesh,
            light,
            options,
            scale,
        };
        let of_patch = |(patch, cut): (usize, &Option<Cut>)| {
            let marks = evenness.marks(patch, (*cut)?);
            marks.contains(&true).then_some((patch as u32, marks))
        };
        let patches = cuts.par_iter().enumerate();
        let uneven = patches.filter_map(of_patch).collect();
        Self::with(mesh, cuts, uneven)
    }

    fn with(mesh: &Mesh, cuts: Vec<Option<Cut>>, uneven: Uneven) -> Self {
        let of_patch = |number: u32, cut: Cut| {
            let patch = mesh.patch(number);
            let cells = cut.cells(uneven.get(&number));
            let tiles: Vec<Tile> = cells.iter().map(|cell| tile(&patch, cell)).collect();
            tiles
        };
        let count = counts(&cuts, &uneven).map(|(_, count)| count).sum();
        let tiles = listed(&cuts, count, of_patch);
        Self {
            clusters: Clusters::new(tiles, mesh.frame.extent()),
            cuts,
            uneven,
        }
    }

    /// The tiles send what was `sent`; `seed` draws the points that rays are aimed at.
    pub fn radiate(&mut self, sent: &[Spectrum], seed: u32) {
        let of_tiles = sent.iter().filter(|sent| !sent.is_nan());
        self.clusters.radiate(of_tiles.copied().collect(), seed);
    }

    /// The tiles with all of `whole` to send, to be looked at once more.
    pub fn radiating(mut self, mesh: &Mesh, whole: &Light) -> Shooter {
        let sent = self.unshot(mesh, whole, Sign::Positive);
        self.radiate(&sent, 0x6175_6469);
        Shooter::All {
            tiling: self,
            settled: true,
        }
    }

    /// The tiles with what they send, to draw points from.
    pub fn parts(
        &self,
    ) -> impl Iterator<Item = Part<impl Fn(f64, f64) -> DVec3 + '_>> + Clone + '_ {
        let counts = counts(&self.cuts, &self.uneven);
        let patches = counts.flat_map(|(patch, count)| std::iter::repeat_n(patch, count));
        let part = |(patch, (tile, radiosity)): (u32, (&'_ Tile, Spectrum))| {
            let tile = *tile;
            Part {
                patch,
                normal: tile.normal.as_dvec3(),
                power: radiosity * tile.area(),
                at: move |s, t| tile.at(s as f32, t as f32).as_dvec3(),
            }
        };
        patches.zip(self.clusters.tiles()).map(part)
    }

    /// What each tile has unshot of one sign, and [`CUT`] before that of the parts of a cell that is cut into four.
    pub fn unshot(&self, mesh: &Mesh, light: &Light, sign: Sign) -> Vec<Spectrum> {
        let of_patch = |patch: u32, cut: Cut| {
            let marks = self.uneven.get(&patch);
            let means = means_on(mesh, light, (patch as usize, sign), cut.cells(marks));
            match marks {
                Some(marks) => marked(marks, means),
                None => means,
            }
        };
        let marks = self.uneven.values().flatten();
        let room = self.clusters.tiles().len() + marks.filter(|is_cut| **is_cut).count();
        listed(&self.cuts, room, of_patch)
    }
}

/// How many tiles each patch is.
fn counts<'a>(
    cuts: &'a [Option<Cut>],
    uneven: &'a Uneven,
) -> impl Iterator<Item = (u32, usize)> + Clone + 'a {
    (0..).zip(cuts).map(|(patch, cut)| {
        let count = match uneven.get(&patch) {
            Some(marks) => marks.iter().filter(|is_cut| !**is_cut).count(),
            None => cut.map_or(0, |cut| cut.count()),
        };
        (patch, count)
    })
}

/// What `of_patch` says of each patch that radiates, one after the other, no more than `room` in all. A slice of the patches at a time:
/// put together at once, all would be there twice.
fn listed<T: Send>(
    cuts: &[Option<Cut>],
    room: usize,
    of_patch: impl Fn(u32, Cut) -> Vec<T> + Sync,
) -> Vec<T> {
    let mut list = Vec::with_capacity(room);
    for (slice, cuts) in cuts.chunks(SLICE).enumerate() {
        let numbered = cuts.par_iter().enumerate();
        list.par_extend(numbered.flat_map_iter(|(place, cut)| {
            let number = (slice * SLICE + place) as u32;
            cut.map(|cut| of_patch(number, cut)).unwrap_or_default()
        }));
    }
    list
}

impl Cut {
    fn of(patch: &Patch, longest: f64) -> Self {
        let parts = |side: f64| (side / longest).ceil().max(1.0);
        match patch.corners() {
            [a, b, c, d] => {
                let width = a.distance(*b).max(c.distance(*d));
                let height = b.distance(*c).max(d.distance(*a));
                Self::Grid(parts(width) as u16, parts(height) as u16)
            }
            corners => {
                let levels = parts(diameter(corners)).log2().ceil() as u32;
                Self::Levels(levels.min(DEEPEST) as u8)
            }
        }
    }

    fn count(self) -> usize {
        match self {
            Self::Levels(levels) => 1 << (2 * levels),
            Self::Grid(columns, rows) => columns as usize * rows as usize,
        }
    }

    const fn is_triangle(self) -> bool {
        matches!(self, Self::Levels(_))
    }

    /// The cells before any is cut into four.
    fn whole_cells(self) -> Vec<Quad> {
        match self {
            Self::Levels(levels) => {
                let even = Division::even(SourceShape::Triangle);
                cells_at(root(true), even, levels.into())
            }
            Self::Grid(columns, rows) => cells_in(columns.into(), rows.into()),
        }
    }

    /// The cells that are tiles, with what is cut into four by its `marks`.
    fn cells(self, marks: Option<&Vec<bool>>) -> Vec<Quad> {
        let whole = self.whole_cells();
        let Some(marks) = marks else {
            return whole;
        };
        let mut cells = Vec::new();
        let mut open: Vec<Quad> = whole.into_iter().rev().collect();
        for is_cut in marks {
            let cell = open.pop().expect("there is a mark for each cell");
            if *is_cut {
                open.extend(parts(&cell, self.is_triangle()).into_iter().rev());
            } else {
                cells.push(cell);
            }
        }
        cells
    }
}

/// Where what is unshot is uneven.
struct Evenness<'a> {
    mesh: &'a Mesh,
    light: &'a Light,
    options: &'a Options,
    scale: ToleranceScale,
}

impl Evenness<'_> {
    /// Which cells of a patch are cut into four, a cell before its parts.
    fn marks(&self, patch: usize, cut: Cut) -> Vec<bool> {
        let of = self.mesh.patch(patch as u32);
        if self.mesh.is_small(&of) || self.light.is_own(self.mesh, patch, Sign::Positive) {
            return Vec::new();
        }
        // A floor may have more cells than all other patches together.
        let whole = cut.whole_cells().into_par_iter().with_min_len(16);
        let marks = whole.flat_map_iter(|cell| self.marks_of(patch, cell, cut.is_triangle()));
        marks.collect()
    }

    /// Whether a cell is cut into four, and which of its parts are.
    fn marks_of(&self, patch: usize, whole: Quad, is_triangle: bool) -> Vec<bool> {
        let mut marks = Vec::new();
        let mut open = vec![(whole, 0)];
        while let Some((cell, cuts)) = open.pop() {
            let parts = parts(&cell, is_triangle);
            let is_cut = cuts < MOST_CUTS && self.differ(patch, &cell, &parts);
            marks.push(is_cut);
            if is_cut {
                open.extend(parts.into_iter().rev().map(|part| (part, cuts + 1)));
            }
        }
        marks
    }

    /// Whether what the parts of a cell have unshot differs by more than its size allows.
    fn differ(&self, patch: usize, cell: &Quad, parts: &[Quad; 4]) -> bool {
        let radiosity = |v: u32| self.light.unshot_radiosity(self.mesh, v, Sign::Positive);
        let means = parts.map(|part| cell_mean(self.mesh, patch, &part, &radiosity, 1));
        let low = means.into_iter().fold(Spectrum::INFINITY, Spectrum::min);
        let high = means.into_iter().fold(Spectrum::ZERO, Spectrum::max);
        let of = self.mesh.patch(patch as u32);
        let corners = cell.map(|[u, v]| of.position_at(u, v));
        let side = diameter(&corners[..of.corners().len()]);
        let growth = self.options.growth(side / self.mesh.frame.extent());
        let unit = self.scale.at(f64::from(high.max_element())) * growth;
        f64::from((high - low).max_element()) > self.options.epsilon_r * unit
    }
}

/// The means of the tiles of a patch, with a mark before those of the parts of a cell that is cut into four.
fn marked(marks: &[bool], means: Vec<Spectrum>) -> Vec<Spectrum> {
    let mut means = means.into_iter();
    let sent = marks.iter().map(|is_cut| match is_cut {
        true => CUT,
        false => means.next().expect("there is a mean for each tile"),
    });
    sent.collect()
}

/// Whether `sent` has a number for each tile of a mesh, as [`Tiling::unshot`] gives them.
pub(super) fn fits(mesh: &Mesh, sent: &[Spectrum]) -> bool {
    uneven_in(&cuts(mesh), sent).is_some()
}

/// Which cells are cut into four as what they have `sent` is marked; `None` if it is not that of these patches.
fn uneven_in(cuts: &[Option<Cut>], sent: &[Spectrum]) -> Option<Uneven> {
    let mut uneven = Uneven::default();
    let mut left = sent;
    for (patch, cut) in (0..).zip(cuts) {
        let mut open = cut.map_or(0, |cut| cut.count());
        let mut end = 0;
        while open > 0 {
            open = if left.get(end)?.is_nan() {
                open + 3
            } else {
                open - 1
            };
            end += 1;
        }
        let (of_patch, after) = left.split_at(end);
        if of_patch.iter().any(|sent| sent.is_nan()) {
            uneven.insert(patch, of_patch.iter().map(|sent| sent.is_nan()).collect());
        }
        left = after;
    }
    left.is_empty().then_some(uneven)
}

/// Cells that the patches of a mesh are cut into, each a tile if its light is even.
pub(super) fn cell_count(mesh: &Mesh) -> usize {
    cuts(mesh).iter().flatten().map(|cut| cut.count()).sum()
}

fn cuts(mesh: &Mesh) -> Vec<Option<Cut>> {
    let longest = SIZE * mesh.frame.extent();
    let cut = |patch: Patch| {
        let radiates = patch.reflectance != Spectrum::ZERO || patch.exitance != Spectrum::ZERO;
        radiates.then(|| Cut::of(&patch, longest))
    };
    mesh.patches.par_iter().map(cut).collect()
}

fn tile(patch: &Patch, cell: &Quad) -> Tile {
    let corners = cell.map(|[u, v]| patch.position_at(u, v));
    let count = patch.corners().len();
    Tile::new(&corners[..count], patch.normal, patch.back)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::options::Preset;
    use crate::solver::trial::Trial;

    #[test]
    fn uneven_tiles_are_cut_and_known_again_by_what_they_sent() {
        let options = Preset::Accurate.options();
        let trial = Trial::after(1, options.clone());
        let solver = trial.solver();
        let mesh = &solver.mesh;
        let light = solver.whole(Spectrum::ONE);
        let scale = solver.sampler().thresholds.scale;
        let tiling = Tiling::even(mesh, &light, (&options, scale));
        let sent = tiling.unshot(mesh, &light, Sign::Positive);
        let tiles = tiling.clusters.tiles().len();
        assert!(tiles > cell_count(mesh), "{tiles} tiles");

        let again = Tiling::for_sent(mesh, &sent);
        let corners = |of: &Tiling| -> Vec<Tile> { of.clusters.tiles().map(|t| *t.0).collect() };
        assert!(corners(&again) == corners(&tiling));
        assert!(fits(mesh, &sent));
        assert!(!fits(mesh, &sent[1..]) && !fits(mesh, &[&sent[..], &[CUT]].concat()));

        let mut radiating = again;
        radiating.radiate(&sent, 0);
        let power = radiating.parts().map(|part| part.power.as_dvec3());
        let power: glam::DVec3 = power.sum();
        let patches = 0..mesh.patches.len();
        let unshot = patches.map(|patch| light.unshot_power(mesh, patch, Sign::Positive));
        let unshot: glam::DVec3 = unshot.sum();
        assert!(
            (power - unshot).abs().max_element() < 1e-5 * unshot.max_element(),
            "{power} of {unshot}"
        );
    }
}
