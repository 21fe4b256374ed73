//! The sides of all patches, those that are one after the other.

use super::{Mesh, Patch};
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::hash::{BuildHasher, Hash};

/// Patches whose sides are listed at a time: all at once would be listed twice, by thread and together.
const BLOCK: u32 = 1 << 15;

/// A side of a patch. There are millions, so no key that says which sides are one is kept: a digest is, and what the keys of those with the same
/// have said.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    digest: u64,
    /// The patch.
    pub patch: u32,
    number: u8,
    /// Whether it is one with that before it in the list.
    pub is_one_with_last: bool,
}

impl Side {
    /// From which corner of the patch to the next it goes.
    pub fn number(&self) -> usize {
        usize::from(self.number)
    }
}

/// All sides, in the order of their digests and keys and then of their patches.
pub struct Sides<'a, F> {
    mesh: &'a Mesh,
    key: F,
    /// The sides.
    pub list: Vec<Side>,
}

impl<'a, K: Ord + Hash, F: Fn(&Patch, usize) -> K + Sync> Sides<'a, F> {
    /// The sides of the patches of a mesh, which are one if their keys are the same.
    pub fn new(mesh: &'a Mesh, key: F) -> Self {
        let sides = |patch: u32| {
            let of = mesh.patch(patch);
            let digest = |number| FxBuildHasher.hash_one(key(&of, usize::from(number)));
            let side = |number| Side {
                digest: digest(number),
                patch,
                number,
                is_one_with_last: false,
            };
            (0..of.corners().len() as u8).map(side).collect::<Vec<_>>()
        };
        let count = mesh.patches.len() as u32;
        let mut list: Vec<Side> = Vec::with_capacity(4 * count as usize);
        for first in (0..count).step_by(BLOCK as usize) {
            let block = first..count.min(first + BLOCK);
            list.par_extend(block.into_par_iter().flat_map_iter(sides));
        }
        list.par_sort_unstable_by_key(|side| (side.digest, side.patch, side.number));
        let of = |side: &Side| key(&mesh.patch(side.patch), side.number());
        let alike = list.par_chunk_by_mut(|a, b| a.digest == b.digest);
        alike
            .filter(|sides| sides.len() > 1)
            .for_each(|sides| tell_apart(sides, of));
        Self { mesh, key, list }
    }

    /// The key of a side.
    pub fn key(&self, side: &Side) -> K {
        (self.key)(&self.mesh.patch(side.patch), side.number())
    }
}

/// Finds which sides with the same digest are one. Hardly ever are not all.
fn tell_apart<K: Ord>(sides: &mut [Side], key: impl Fn(&Side) -> K) {
    let first = key(&sides[0]);
    if sides[1..].iter().all(|side| key(side) == first) {
        sides[1..]
            .iter_mut()
            .for_each(|side| side.is_one_with_last = true);
        return;
    }
    sides.sort_by_cached_key(&key);
    for i in 1..sides.len() {
        sides[i].is_one_with_last = key(&sides[i]) == key(&sides[i - 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_tell_apart_what_has_one_digest() {
        let side = |patch| Side {
            digest: 7,
            patch,
            number: 0,
            is_one_with_last: false,
        };
        let found = |keys: [u32; 4]| {
            let mut sides = [0, 1, 2, 3].map(side);
            tell_apart(&mut sides, |side| keys[side.patch as usize]);
            sides.map(|side| (side.patch, side.is_one_with_last))
        };
        let all_one = [(0, false), (1, true), (2, true), (3, true)];
        assert_eq!(found([5, 5, 5, 5]), all_one);
        let two_pairs = [(1, false), (3, true), (0, false), (2, true)];
        assert_eq!(found([6, 5, 6, 5]), two_pairs);
    }
}
