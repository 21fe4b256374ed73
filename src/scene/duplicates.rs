//! Polygons that a file has twice, which would shine twice.

use super::polygons::Polygons;
use super::weld::MixingHasher;
use rayon::slice::ParallelSliceMut;
use std::hash::Hasher;

/// For every polygon whether an earlier one has the same corners in the same order around.
///
/// One with the same corners the other way around is no repetition but the back of a sheet.
pub(super) fn find(polygons: &Polygons) -> Vec<bool> {
    let mut hashed: Vec<(u64, u32)> = (0..polygons.len())
        .map(|polygon| (hash(polygons.corners(polygon)), polygon as u32))
        .collect();
    hashed.par_sort_unstable();
    let mut repeated = vec![false; polygons.len()];
    for alike in hashed.chunk_by(|a, b| a.0 == b.0) {
        // Equal hashes are rarely more than one, and then nearly always equal polygons.
        let mut different: Vec<u32> = Vec::new();
        for (_, polygon) in alike {
            let corners = |of: u32| around(polygons.corners(of as usize));
            let known = different
                .iter()
                .any(|other| corners(*other).eq(corners(*polygon)));
            repeated[*polygon as usize] = known;
            if alike.len() > 1 && !known {
                different.push(*polygon);
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
