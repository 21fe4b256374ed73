//! Polygons that a file has twice, which would shine twice.

use super::polygons::Polygons;
use super::weld::MixingHasher;
use rayon::slice::ParallelSliceMut;
use std::hash::Hasher;

/// For every polygon whether it repeats another one, with the same corners in the same order around, and is to be left out. Of polygons
/// that repeat one another the first that emits stays, or else the first: a lamp is not put out by the wall that it was drawn on.
///
/// One with the same corners the other way around is no repetition but the back of a sheet.
pub(super) fn find(polygons: &Polygons, emits: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut hashed: Vec<(u64, u32)> = (0..polygons.len())
        .map(|polygon| (hash(polygons.corners(polygon)), polygon as u32))
        .collect();
    hashed.par_sort_unstable();
    let mut repeated = vec![false; polygons.len()];
    for alike in hashed.chunk_by(|a, b| a.0 == b.0).filter(|of| of.len() > 1) {
        // Equal hashes are rarely more than one, and then nearly always equal polygons.
        let mut kept: Vec<usize> = Vec::new();
        for polygon in alike.iter().map(|(_, polygon)| *polygon as usize) {
            let corners = |of: usize| around(polygons.corners(of));
            let same = kept
                .iter_mut()
                .find(|other| corners(**other).eq(corners(polygon)));
            match same {
                None => kept.push(polygon),
                Some(other) if emits(polygon) && !emits(*other) => {
                    repeated[std::mem::replace(other, polygon)] = true;
                }
                Some(_) => repeated[polygon] = true,
            }
        }
    }
    repeated
}

/// The corners from the one with the smallest index on, wherever the file begins.
fn around(corners: &[u32]) -> impl Iterator<Item = u32> {
    let begin = (0..corners.len())
        .min_by_key(|place| corners[*place])
        .unwrap_or(0);
    corners[begin..].iter().chain(&corners[..begin]).copied()
}

fn hash(corners: &[u32]) -> u64 {
    let mut hasher = MixingHasher::default();
    around(corners).for_each(|corner| hasher.write_u32(corner));
    hasher.finish()
}
