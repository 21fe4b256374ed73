//! All patches of a large scene as the tiles that its clusters are made of.

use super::escape::Part;
use super::light::{Light, Sign};
use super::shoot::Shooter;
use super::source::{Quad, cells_at, cells_in, means_on};
use crate::form_factor::{Clusters, DEEPEST, Tile};
use crate::geometry::polygon::diameter;
use crate::mesh::{Mesh, Patch};
use crate::radiometry::Spectrum;
use glam::DVec3;
use rayon::prelude::*;

/// Tiles are no longer than this fraction of the scene's extent; those of triangles are, if it took more than [`DEEPEST`] levels.
pub(super) const SIZE: f64 = 1.0 / 128.0;

/// The tiles of a mesh. They depend on its patches alone, not on how these are meshed.
#[derive(Debug, Clone)]
pub(super) struct Tiling {
    pub clusters: Clusters,
    /// How each patch is cut into tiles; `None` for one that radiates nothing.
    cuts: Vec<Option<Cut>>,
}

/// How a patch is cut into tiles.
#[derive(Debug, Clone, Copy)]
enum Cut {
    /// A triangle, into four so many times.
    Levels(u32),
    /// A quad, into so many columns and rows.
    Grid(u32, u32),
}

impl Tiling {
    pub fn new(mesh: &Mesh) -> Self {
        let cuts = cuts(mesh);
        let of_patch = |(patch, cut): (Patch, &Option<Cut>)| {
            let cells = cut.map(|cut| cut.cells()).unwrap_or_default();
            let tiles: Vec<Tile> = cells.iter().map(|cell| tile(&patch, cell)).collect();
            tiles
        };
        let tiles = mesh.patches.par_iter().zip(&cuts).flat_map_iter(of_patch);
        Self {
            clusters: Clusters::new(tiles.collect(), mesh.frame.extent()),
            cuts,
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
        let patches = (0..).zip(&self.cuts);
        let patches = patches.flat_map(|(patch, cut)| {
            let count = cut.map_or(0, |cut| cut.count());
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
        let of_patch = |(patch, cut): (usize, &Option<Cut>)| {
            let means = |cut: Cut| means_on(mesh, light, (patch, sign), &cut.cells());
            cut.map(means).unwrap_or_default()
        };
        let patches = self.cuts.par_iter().enumerate().with_min_len(64);
        patches.flat_map_iter(of_patch).collect()
    }
}

impl Cut {
    fn of(patch: &Patch, longest: f64) -> Self {
        let parts = |side: f64| (side / longest).ceil().max(1.0);
        match patch.corners() {
            [a, b, c, d] => {
                let width = a.distance(*b).max(c.distance(*d));
                let height = b.distance(*c).max(d.distance(*a));
                Self::Grid(parts(width) as u32, parts(height) as u32)
            }
            corners => {
                let levels = parts(diameter(corners)).log2().ceil() as u32;
                Self::Levels(levels.min(DEEPEST))
            }
        }
    }

    fn count(self) -> usize {
        match self {
            Self::Levels(levels) => 1 << (2 * levels),
            Self::Grid(columns, rows) => columns as usize * rows as usize,
        }
    }

    fn cells(self) -> Vec<Quad> {
        match self {
            Self::Levels(levels) => cells_at(true, levels),
            Self::Grid(columns, rows) => cells_in(columns, rows),
        }
    }
}

/// Tiles that the patches of a mesh make.
pub(super) fn tile_count(mesh: &Mesh) -> usize {
    cuts(mesh).iter().flatten().map(|cut| cut.count()).sum()
}

fn cuts(mesh: &Mesh) -> Vec<Option<Cut>> {
    let longest = SIZE * mesh.frame.extent();
    let cut = |patch: Patch| {
        let radiates = patch.reflectance != Spectrum::ZERO || patch.exitance != Spectrum::ZERO;
        radiates.then(|| Cut::of(&patch, longest))
    };
    mesh.patches.iter().map(cut).collect()
}

fn tile(patch: &Patch, cell: &Quad) -> Tile {
    let corners = cell.map(|[u, v]| patch.position_at(u, v));
    let count = patch.corners().len();
    Tile::new(&corners[..count], patch.normal, patch.back)
}
