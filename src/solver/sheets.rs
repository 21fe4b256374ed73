//! Patches that make one sheet: they share sides, face the same way, and nothing stands on the side between them.
//!
//! A wall goes on behind the ceiling that meets it, often as the same surface: what falls on it below says nothing of the cavity above.

use crate::geometry::{Sets, facing};
use crate::mesh::{Mesh, Patch, Side, SideKey, Sides};
use crate::visibility::{Fans, Visibility};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Where two patches look at one another: this part of the way from the side that they share to their centres.
const NEARNESS: f64 = 0.25;

/// By patch, the first of its own sheet. No patch looks for its neighbour further than `reach` from the side between them.
pub(super) fn sheets(mesh: &Mesh, visibility: &dyn Visibility, reach: f64) -> Vec<u32> {
    let sides = Sides::new(mesh, facing_side);
    let middle = |side: &Side| {
        let (_, ends) = sides.key(side);
        let [a, b] = ends.map(|end| DVec3::from_array(end.map(f64::from_bits)));
        0.5 * (a + b)
    };
    let shared: Vec<[u32; 2]> = sides
        .list
        .par_windows(2)
        .filter(|pair| pair[1].is_one_with_last)
        .map(|pair| ([pair[0].patch, pair[1].patch], middle(&pair[0])))
        .filter(|(patches, middle)| nothing_between(mesh, visibility, *patches, *middle, reach))
        .map(|(patches, _)| patches)
        .collect();
    drop(sides);
    let mut sheets = Sets::new(mesh.patches.len());
    for [a, b] in shared {
        sheets.join(a, b);
    }
    (0..mesh.patches.len() as u32)
        .map(|patch| sheets.root(patch))
        .collect()
}

/// The way that a patch faces, fronts apart from backs, and one of its sides.
fn facing_side(patch: &Patch, side: usize) -> ((usize, bool), SideKey) {
    let facing = (facing(patch.normal), patch.back);
    (facing, patch.side_key(side).0)
}

/// Whether points a little way in from the `middle` of the side that two patches share, and as much above, see one another.
fn nothing_between(
    mesh: &Mesh,
    visibility: &dyn Visibility,
    patches: [u32; 2],
    middle: DVec3,
    reach: f64,
) -> bool {
    let ways = patches.map(|number| {
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
