//! All patches of a large scene as the tiles that its clusters are made of.

use super::escape::Part;
use super::light::{Light, Sign};
use super::options::Shooting;
use super::shoot::Shooter;
use super::source::{Quad, cells_at, cells_on};
use crate::form_factor::{Clusters, DEEPEST, Tile};
use crate::mesh::{Mesh, Patch};
use crate::radiometry::Spectrum;
use glam::DVec3;
use rayon::prelude::*;

/// Tiles are no longer than this fraction of the scene's extent, unless their patch would need more than [`DEEPEST`] levels.
pub(super) const SIZE: f64 = 1.0 / 64.0;

/// The tiles of a mesh. They depend on its patches alone, not on how these are meshed.
#[derive(Debug, Clone)]
pub(super) struct Tiling {
    pub clusters: Clusters,
    /// Levels by which each patch is cut into tiles; `None` for one that radiates nothing.
    levels: Vec<Option<u32>>,
}

impl Tiling {
    pub fn new(mesh: &Mesh) -> Self {
        let levels = levels(mesh);
        let of_patch = |(patch, levels): (&Patch, &Option<u32>)| {
            let cells = levels.map(|l| cells_at(patch.is_triangle(), l));
            let cells = cells.unwrap_or_default();
            let tiles: Vec<Tile> = cells.iter().map(|cell| tile(patch, cell)).collect();
            tiles
        };
        let tiles = mesh.patches.par_iter().zip(&levels).flat_map_iter(of_patch);
        Self {
            clusters: Clusters::new(tiles.collect(), mesh.frame.extent()),
            levels,
        }
    }

    /// The tiles with all of `whole` to send, to be looked at once more.
    pub fn radiating(mut self, mesh: &Mesh, whole: &Light) -> Shooter {
        let radiosity = self.unshot(mesh, whole, Sign::Positive);
        self.clusters.radiate(radiosity, 0x6175_6469);
        Shooter::All {
            tiling: self,
            settled: true,
        }
    }

    /// The tiles with what they send, to draw points from.
    pub fn parts(
        &self,
    ) -> impl Iterator<Item = Part<impl Fn(f64, f64) -> DVec3 + '_>> + Clone + '_ {
        let patches = (0..).zip(&self.levels);
        let patches = patches.flat_map(|(patch, levels)| {
            let count = levels.map_or(0, |l| 1 << (2 * l));
            std::iter::repeat_n(patch, count)
        });
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

    /// What each tile has unshot of one sign.
    pub fn unshot(&self, mesh: &Mesh, light: &Light, sign: Sign) -> Vec<Spectrum> {
        let of_patch = |(patch, levels): (usize, &Option<u32>)| {
            let cells = |l| cells_on(mesh, light, (patch, sign), l, Shooting::Interpolated);
            levels.map(cells).unwrap_or_default()
        };
        let patches = self.levels.par_iter().enumerate().with_min_len(64);
        patches.flat_map_iter(of_patch).collect()
    }
}

/// Tiles that the patches of a mesh make.
pub(super) fn tile_count(mesh: &Mesh) -> usize {
    levels(mesh).iter().flatten().map(|l| 1 << (2 * l)).sum()
}

fn levels(mesh: &Mesh) -> Vec<Option<u32>> {
    let longest = SIZE * mesh.frame.extent();
    let levels = |patch: &Patch| {
        let radiates = patch.reflectance != Spectrum::ZERO || patch.exitance != Spectrum::ZERO;
        let corners = patch.corners().iter();
        let next = patch.corners().iter().cycle().skip(1);
        let side = corners
            .zip(next)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f64::max);
        let levels = (side / longest)
            .log2()
            .ceil()
            .clamp(0.0, f64::from(DEEPEST));
        radiates.then_some(levels as u32)
    };
    mesh.patches.iter().map(levels).collect()
}

fn tile(patch: &Patch, cell: &Quad) -> Tile {
    let corners = cell.map(|[u, v]| patch.position_at(u, v));
    let count = patch.corners().len();
    Tile::new(&corners[..count], patch.normal, patch.back)
}
