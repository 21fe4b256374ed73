//! The shooting patch as the form factors want it: unshot radiosity on a pyramid of cells.

use super::light::{Light, Sign};
use super::options::{Options, Shooting};
use super::run::Solver;
use crate::form_factor::{Division, Source, SourceShape, SourceThresholds};
use crate::geometry::polygon::vector_area;
use crate::mesh::{Mesh, Patch};
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;

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

/// A patch as a source with the unshot radiosity of [`cells_of`].
pub(super) fn source_from(mesh: &Mesh, patch: usize, cells: &[Spectrum]) -> Source {
    let of = mesh.patches.at(patch);
    let levels = cells.len().ilog2() / 2;
    Source::new(of.corners(), of.normal, levels, cells)
}

/// Cells are looked at in parts as small as elements, but in no more than this many halvings: on a large floor that has a single lamp all light may be
/// in a few small elements.
const FINEST: u32 = 8;

/// A triangle or parallelogram of coordinates on a patch; a triangle repeats its first corner.
pub(super) type Quad = [[f64; 2]; 4];

/// What `patch` shoots of one sign: unshot radiosity by cell of the deepest level of its [`Source`]. The total power is exactly that
/// of the interpolant, buried parts included: rays find out that nothing leaves those.
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
    cells_on(mesh, light, (patch, sign), levels, options.shooting)
}

/// The same on a given level; on level 0 the mean of the patch.
fn cells_on(
    mesh: &Mesh,
    light: &Light,
    shooter: (usize, Sign),
    levels: u32,
    shooting: Shooting,
) -> Vec<Spectrum> {
    let count = 1 << (2 * levels);
    if shooting == Shooting::Mean {
        return vec![mean_of(mesh, light, shooter).as_vec3(); count];
    }
    let division = Division::of(mesh.patches.at(shooter.0).corners());
    means_on(mesh, light, shooter, &cells_at(division, levels))
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
    cells: &[Quad],
) -> Vec<Spectrum> {
    let mean = mean_of(mesh, light, (patch, sign));
    if cells.len() == 1 || light.is_own(mesh, patch, sign) {
        return vec![mean.as_vec3(); cells.len()];
    }
    let of = mesh.patches.at(patch);
    let radiosity = |v: u32| light.unshot_radiosity(mesh, v, sign);
    let mut means: Vec<Spectrum> = cells
        .par_iter()
        .with_min_len(64)
        .map(|cell| cell_mean(mesh, patch, cell, &radiosity, FINEST))
        .collect();
    let weighted = means
        .iter()
        .zip(areas(&of, cells))
        .map(|(b, area)| b.as_dvec3() * area);
    let shot = weighted.sum::<Power>() / of.area;
    // Where the cells missed nearly all of it, all have the mean.
    let missed = shot.cmple(mean * 1e-3);
    let correction = Power::select(missed, Power::ZERO, mean / shot).as_vec3();
    let instead = Power::select(missed, mean, Power::ZERO).as_vec3();
    means
        .iter_mut()
        .for_each(|cell| *cell = *cell * correction + instead);
    means
}

/// The cells of a level, each by its three or four corners in the coordinates of the patch.
pub(super) fn cells_at(division: Division, levels: u32) -> Vec<Quad> {
    let mut cells = vec![root(division.shape() == SourceShape::Triangle)];
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

fn root(triangle: bool) -> Quad {
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

/// The areas of the cells that a patch is cut into. On triangles and parallelograms they are as large as in the coordinates.
fn areas(of: &Patch, cells: &[Quad]) -> Vec<f64> {
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
