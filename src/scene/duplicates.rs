//! Polygons that a file has twice, which would shine twice.

use super::obj::Polygons;
use super::weld::MixingHasher;
use std::collections::HashSet;
use std::hash::BuildHasherDefault;

/// For every polygon whether an earlier one has the same corners in the same order around.
///
/// One with the same corners the other way around is no repetition but the back of a sheet.
pub(super) fn find(polygons: &Polygons) -> Vec<bool> {
    let hasher = BuildHasherDefault::<MixingHasher>::default;
    let mut small: HashSet<[u32; 4], _> =
        HashSet::with_capacity_and_hasher(polygons.len(), hasher());
    let mut large: HashSet<Vec<u32>> = HashSet::new();
    let mut repeated = Vec::with_capacity(polygons.len());
    for polygon in 0..polygons.len() {
        let corners = polygons.corners(polygon);
        // Begin at the smallest index, wherever the file begins.
        let begin = (0..corners.len()).min_by_key(|i| corners[*i]).unwrap_or(0);
        let around = corners[begin..].iter().chain(&corners[..begin]).copied();
        let new = if corners.len() <= 4 {
            let mut key = [u32::MAX; 4];
            key.iter_mut()
                .zip(around)
                .for_each(|(slot, corner)| *slot = corner);
            small.insert(key)
        } else {
            large.insert(around.collect())
        };
        repeated.push(!new);
    }
    repeated
}
