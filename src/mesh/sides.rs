//! The sides of all patches, those that are one after the other.

use super::{Mesh, Patch};
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::hash::{BuildHasher, Hash};

/// Patches whose sides are listed at a time: all at once would be listed twice, by thread and together.
const BLOCK: u32 = 1 << 15;

/// A side of a patch. There are millions, so the key that says which sides are one is made anew where their digests do not tell.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    digest: u64,
    /// The patch.
    pub patch: u32,
    number: u8,
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
        // Where sides that are not one have one digest, which hardly ever happens, their keys tell them apart.
        let of = |side: &Side| key(&mesh.patch(side.patch), side.number());
        let alike = list.par_chunk_by_mut(|a, b| a.digest == b.digest);
        let alike = alike.filter(|sides| sides.len() > 1);
        alike.for_each(|sides| sides.sort_by_key(of));
        Self { mesh, key, list }
    }

    /// The key of a side.
    pub fn key(&self, side: &Side) -> K {
        (self.key)(&self.mesh.patch(side.patch), side.number())
    }

    /// Whether two sides are one.
    pub fn are_one(&self, a: &Side, b: &Side) -> bool {
        a.digest == b.digest && self.key(a) == self.key(b)
    }
}
