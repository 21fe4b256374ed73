//! The shooting patch as the form factors want it: unshot radiosity on a pyramid of cells.

use super::cells::{Quad, areas, cells_at, parts, root};
use super::light::{Light, Sign};
use super::options::{Options, Shooting};
use super::run::Solver;
use crate::form_factor::{DEEPEST, Division, Source, SourceThresholds};
use crate::mesh::{Mesh, Patch};
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;
use std::collections::VecDeque;

impl Solver<'_> {
    /// The source that shoots all that a patch has of one sign in `light`.
    pub(super) fn source_of(
        &self,
        light: &Light,
        shooter: (usize, Sign),
        thresholds: &SourceThresholds,
    ) -> Source {
        let cells = cells_of(&self.mesh, light, shooter, &self.options, thresholds);
        source_from(&self.mesh, shooter.0, &cells)
    }
}

/// What `patch` shoots of one sign: unshot radiosity by cell of the deepest level of its [`Source`], then that of its cores, each by cells of its own. The
/// total power is exactly that of the interpolant, buried parts included: rays find out that nothing leaves those.
pub(super) fn cells_of(
    mesh: &Mesh,
    light: &Light,
    (patch, sign): (usize, Sign),
    options: &Options,
    thresholds: &SourceThresholds,
) -> Vec<Spectrum> {
    let peak = mesh
        .vertices_of(patch as u32)
        .map(|v| light.unshot_radiosity(mesh, v, sign).max_element())
        .fold(0.0, f32::max);
    // No form factor exceeds 1, so a source this dim is never split where thresholds do not follow the local light.
    let unit = thresholds.scale.reference;
    let fixed = !thresholds.raw && thresholds.scale.local_share == 0.0;
    let dim = fixed && f64::from(peak) <= unit * thresholds.difference.min(thresholds.estimate);
    let levels = if dim { 1 } else { options.source_levels() };
    let mean = mean_of(mesh, light, (patch, sign));
    if options.shooting == Shooting::Mean {
        return vec![mean.as_vec3(); 1 << (2 * levels)];
    }
    let of = mesh.patches.at(patch);
    let means = |grid: &Grid, mean| Some(means_in(mesh, light, (patch, sign), grid, mean));
    let pyramids = pyramids(&of, levels, mean, means).expect("a mean for each cell");
    pyramids.into_iter().flat_map(|p| p.means).collect()
}

/// A patch as a source with the unshot radiosity of [`cells_of`].
pub(super) fn source_from(mesh: &Mesh, patch: usize, cells: &[Spectrum]) -> Source {
    let of = mesh.patches.at(patch);
    let pyramids = stored(&of, cells).expect("cells that were made so, or checked when read");
    let mut sources = pyramids.into_iter().map(|mut pyramid| {
        let corners = pyramid.whole.map(|[u, v]| of.position_at(u, v));
        for core in pyramid.cores {
            pyramid.means[core] = Spectrum::ZERO;
        }
        let levels = pyramid.means.len().ilog2() / 2;
        let corners = &corners[..of.corners().len()];
        Source::new(corners, of.normal, levels, &pyramid.means)
    });
    let whole = sources.next().expect("the pyramid of the patch itself");
    whole.with_cores(sources.collect())
}

/// Whether a list may be what [`cells_of`] made for a patch.
pub(super) fn fits(mesh: &Mesh, patch: usize, cells: &[Spectrum]) -> bool {
    stored(&mesh.patches.at(patch), cells).is_some()
}

/// A cell with this many times its even share of what the patch sends is a core: it has a pyramid of its own, or what is in a small part of it would be
/// spread over all of it. Of a floor of 400 m a cell is 12 m wide, and what a lamp lights there may be no wider.
const CORE: f64 = 32.0;

/// A patch, or a core of it, cut into cells.
struct Grid {
    whole: Quad,
    area: f64,
    cells: Vec<Quad>,
    areas: Vec<f64>,
}

impl Grid {
    fn new(of: &Patch, (whole, area): (Quad, f64), levels: u32) -> Self {
        let corners = whole.map(|[u, v]| of.position_at(u, v));
        let division = Division::of(&corners[..of.corners().len()]);
        let cells = cells_at(whole, division, levels);
        Self {
            whole,
            area,
            areas: areas(of, &cells),
            cells,
        }
    }

    fn powers(&self, means: &[Spectrum]) -> impl Iterator<Item = Power> {
        let powers = means.iter().zip(&self.areas);
        powers.map(|(mean, area)| mean.as_dvec3() * *area)
    }
}

/// A pyramid by the cells of its deepest level.
struct Pyramid {
    whole: Quad,
    means: Vec<Spectrum>,
    /// Which cells have a pyramid of their own.
    cores: Vec<usize>,
}

/// The pyramid of a patch with so many levels, then those of its cores, of all levels; `means_in` is asked for the means of cells that together have a
/// mean. It ends: where the interpolant is that of one element, no cell has much more than another.
fn pyramids(
    of: &Patch,
    levels: u32,
    mean: Power,
    mut means_in: impl FnMut(&Grid, Power) -> Option<Vec<Spectrum>>,
) -> Option<Vec<Pyramid>> {
    let patch = (root(of.is_triangle()), of.area);
    let mut open = VecDeque::from([(patch, levels, mean)]);
    let mut sent = None;
    let mut pyramids = Vec::new();
    while let Some((whole, levels, mean)) = open.pop_front() {
        let grid = Grid::new(of, whole, levels);
        let means = means_in(&grid, mean)?;
        let powers = || grid.powers(&means).map(Power::element_sum);
        let sent = *sent.get_or_insert_with(|| powers().sum::<f64>());
        let least = CORE * sent / means.len() as f64;
        let cores = powers().enumerate().filter(|(_, power)| *power > least);
        let cores: Vec<usize> = cores.map(|(cell, _)| cell).collect();
        open.extend(cores.iter().map(|cell| {
            let core = (grid.cells[*cell], grid.areas[*cell]);
            (core, DEEPEST, means[*cell].as_dvec3())
        }));
        pyramids.push(Pyramid {
            whole: grid.whole,
            means,
            cores,
        });
    }
    Some(pyramids)
}

/// The pyramids that a list of [`cells_of`] describes.
fn stored(of: &Patch, cells: &[Spectrum]) -> Option<Vec<Pyramid>> {
    // Each core has as many cells as a patch can have: what is left over tells the levels of the patch.
    let count = |levels: u32| 1_usize << (2 * levels);
    let is_left = |levels: &u32| cells.len() % count(DEEPEST) == count(*levels) % count(DEEPEST);
    let levels = (1..=DEEPEST).find(is_left)?;
    if cells.len() == count(levels) {
        // Without cores; earlier versions made none.
        return Some(vec![Pyramid {
            whole: root(of.is_triangle()),
            means: cells.to_vec(),
            cores: Vec::new(),
        }]);
    }
    let mut rest = cells;
    let next = |grid: &Grid, _| {
        let (means, after) = rest.split_at_checked(grid.cells.len())?;
        rest = after;
        Some(means.to_vec())
    };
    let pyramids = pyramids(of, levels, Power::ZERO, next)?;
    rest.is_empty().then_some(pyramids)
}

/// Mean unshot radiosity of a patch, buried parts included.
fn mean_of(mesh: &Mesh, light: &Light, (patch, sign): (usize, Sign)) -> Power {
    let full = |v: u32| light.unshot_radiosity(mesh, v, sign).as_dvec3() * mesh.full_weight(v);
    let vertices = mesh.vertices_of(patch as u32);
    vertices.map(full).sum::<Power>() / mesh.patches.at(patch).area
}

/// Mean unshot radiosity of each of the cells that a patch is cut into; together they have the power of the patch.
pub(super) fn means_on(
    mesh: &Mesh,
    light: &Light,
    (patch, sign): (usize, Sign),
    cells: Vec<Quad>,
) -> Vec<Spectrum> {
    let mean = mean_of(mesh, light, (patch, sign));
    if cells.len() == 1 {
        return vec![mean.as_vec3()];
    }
    let of = mesh.patches.at(patch);
    let grid = Grid {
        whole: root(of.is_triangle()),
        area: of.area,
        areas: areas(&of, &cells),
        cells,
    };
    means_in(mesh, light, (patch, sign), &grid, mean)
}

/// Cells are looked at in parts as small as elements, but in no more than this many halvings: on a large floor that has a single lamp all light may be
/// in a few small elements.
const FINEST: u32 = 8;

/// Mean unshot radiosity of each of the cells of a grid that together have a mean.
fn means_in(
    mesh: &Mesh,
    light: &Light,
    (patch, sign): (usize, Sign),
    grid: &Grid,
    mean: Power,
) -> Vec<Spectrum> {
    if light.is_own(mesh, patch, sign) {
        return vec![mean.as_vec3(); grid.cells.len()];
    }
    let radiosity = |v: u32| light.unshot_radiosity(mesh, v, sign);
    let cells = grid.cells.par_iter().with_min_len(64);
    let mut means: Vec<Spectrum> = cells
        .map(|cell| cell_mean(mesh, patch, cell, &radiosity, FINEST))
        .collect();
    let found = grid.powers(&means).sum::<Power>() / grid.area;
    // Where the cells missed nearly all of it, all have the mean.
    let missed = found.cmple(mean * 1e-3);
    let correction = Power::select(missed, Power::ZERO, mean / found).as_vec3();
    let instead = Power::select(missed, mean, Power::ZERO).as_vec3();
    means
        .iter_mut()
        .for_each(|cell| *cell = *cell * correction + instead);
    means
}

/// The interpolant at the cell's centre; where elements are finer than the cell, the mean over its parts.
pub(super) fn cell_mean(
    mesh: &Mesh,
    patch: usize,
    cell: &Quad,
    radiosity: &impl Fn(u32) -> Spectrum,
    finer: u32,
) -> Spectrum {
    let triangle = mesh.patches.at(patch).is_triangle();
    let count = if triangle { 3.0 } else { 4.0 };
    let corners = &cell[..count as usize];
    let [u, v] = [0, 1].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / count);
    let leaf = mesh.leaf_at(patch as u32, u, v);
    let [width, height] = [0, 1].map(|i| {
        let along = corners.iter().map(|c| c[i]);
        let (low, high) = along.fold((1.0, 0.0), |(low, high), x| (x.min(low), x.max(high)));
        high - low
    });
    let side = f64::max(width, height);
    if finer > 0 && mesh.unit_side(leaf) < 0.9 * side {
        return parts(cell, triangle)
            .iter()
            .map(|part| cell_mean(mesh, patch, part, radiosity, finer - 1))
            .sum::<Spectrum>()
            * 0.25;
    }
    let point = mesh.patches.at(patch).position_at(u, v);
    mesh.interpolated(leaf, point, radiosity)
}
