//! Patches that make one sheet: they share sides, face the same way, and nothing stands on the side between them.
//!
//! A wall goes on behind the ceiling that meets it, often as the same surface: what falls on it below says nothing of the cavity above.

use crate::geometry::{Sets, facing};
use crate::mesh::{Mesh, SideKey};
use crate::visibility::{Fans, Visibility};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::hash::BuildHasher;

/// Where two patches look at one another: this part of the way from the side that they share to their centres.
const NEARNESS: f64 = 0.25;

/// By patch, the first of its own sheet. No patch looks for its neighbour further than `reach` from the side between them.
pub(super) fn sheets(mesh: &Mesh, visibility: &dyn Visibility, reach: f64) -> Vec<u32> {
    let mut by_side: Vec<Side> = (0..mesh.patches.len() as u32)
        .into_par_iter()
        .flat_map_iter(|number| sides(mesh, number))
        .collect();
    by_side.par_sort_unstable_by(|a, b| {
        let digests = a.digest.cmp(&b.digest);
        digests.then_with(|| (a.facing(mesh), a.patch).cmp(&(b.facing(mesh), b.patch)))
    });
    let shared: Vec<Shared> = by_side
        .par_windows(2)
        .filter(|pair| pair[0].is_with(&pair[1], mesh))
        .map(|pair| Shared(pair[0].patch, pair[1].patch, pair[0].middle(mesh)))
        .filter(|shared| nothing_between(mesh, visibility, *shared, reach))
        .collect();
    let mut sheets = Sets::new(mesh.patches.len());
    for Shared(a, b, _) in shared {
        sheets.join(a, b);
    }
    (0..mesh.patches.len() as u32)
        .map(|patch| sheets.root(patch))
        .collect()
}

/// Two patches, and the middle of a side that they share.
#[derive(Clone, Copy)]
struct Shared(u32, u32, DVec3);

/// The way that a patch faces, fronts apart from backs, and one of its sides.
type Facing = ((usize, bool), SideKey);

/// A side of a patch. There are millions, so what tells them apart is made anew where their digests do not.
#[derive(Clone, Copy)]
struct Side {
    /// Of its [`Facing`].
    digest: u64,
    patch: u32,
    number: u8,
}

impl Side {
    fn new(mesh: &Mesh, patch: u32, number: u8) -> Self {
        let mut side = Self {
            digest: 0,
            patch,
            number,
        };
        side.digest = FxBuildHasher.hash_one(side.facing(mesh));
        side
    }

    fn facing(&self, mesh: &Mesh) -> Facing {
        let patch = mesh.patch(self.patch);
        let (side, _) = patch.side_key(usize::from(self.number));
        ((facing(patch.normal), patch.back), side)
    }

    /// Whether both are one side, of patches that face alike.
    fn is_with(&self, other: &Self, mesh: &Mesh) -> bool {
        self.digest == other.digest && self.facing(mesh) == other.facing(mesh)
    }

    fn middle(&self, mesh: &Mesh) -> DVec3 {
        let (_, side) = self.facing(mesh);
        let [a, b] = side.map(|end| DVec3::from_array(end.map(f64::from_bits)));
        0.5 * (a + b)
    }
}

fn sides(mesh: &Mesh, patch: u32) -> impl Iterator<Item = Side> {
    let count = mesh.patch(patch).corners().len() as u8;
    (0..count).map(move |number| Side::new(mesh, patch, number))
}

/// Whether points a little way in from the middle of the side that two patches share, and as much above, see one another.
fn nothing_between(mesh: &Mesh, visibility: &dyn Visibility, shared: Shared, reach: f64) -> bool {
    let Shared(a, b, middle) = shared;
    let ways = [a, b].map(|number| {
        let patch = mesh.patch(number);
        let corners = patch.corners();
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        (centre - middle, patch.normal)
    });
    let lengths = ways.map(|(inwards, _)| NEARNESS * inwards.length());
    let way = lengths[0].min(lengths[1]).min(reach);
    let [from, to] =
        ways.map(|(inwards, normal)| middle + way * (inwards.normalize_or_zero() + normal));
    see_one_another(visibility, from.as_vec3(), to.as_vec3())
}

/// Whether nothing is between two points.
pub(super) fn see_one_another(visibility: &dyn Visibility, a: Vec3, b: Vec3) -> bool {
    let mut fans = Fans::default();
    fans.begin(a);
    fans.push(b);
    let mut masks = Vec::new();
    visibility.occluded(&fans, &mut masks);
    masks == [0]
}
