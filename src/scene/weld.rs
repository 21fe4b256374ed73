//! Equal positions become one vertex.
//!
//! Files repeat positions at seams of texture or shading, and so does `tobj` at every change of material.
//! Only positions that are equal to the last bit are joined: writers print shared vertices alike, and a
//! tolerance would close gaps that are meant.

use glam::DVec3;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Gives each distinct position an index, in the order of first appearance.
#[derive(Default)]
pub(crate) struct Welder {
    indices: HashMap<[u64; 3], u32, BuildHasherDefault<MixingHasher>>,
    positions: Vec<DVec3>,
}

impl Welder {
    /// None yet, with room for so many: a table that grows leaves a hole of each size that it had.
    pub fn with_room(positions: usize) -> Self {
        Self {
            indices: HashMap::with_capacity_and_hasher(positions, Default::default()),
            positions: Vec::with_capacity(positions),
        }
    }

    /// The index of a position.
    pub fn index(&mut self, position: DVec3) -> u32 {
        // Adding 0 turns -0 into 0, which is the same place.
        let position = position + DVec3::ZERO;
        let key = position.to_array().map(f64::to_bits);
        *self.indices.entry(key).or_insert_with(|| {
            self.positions.push(position);
            (self.positions.len() - 1) as u32
        })
    }

    /// The distinct positions, by index.
    pub fn into_positions(self) -> Vec<DVec3> {
        self.positions
    }
}

/// A multiplicative hash of whole words: a million vertices pass through it.
#[derive(Default)]
pub(super) struct MixingHasher(u64);

impl Hasher for MixingHasher {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_ne_bytes(word));
        }
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }

    fn write_u64(&mut self, word: u64) {
        let mixed = (self.0 ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.0 = mixed ^ (mixed >> 32);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
