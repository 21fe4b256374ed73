//! The engine in pure Rust: obvhs builds the tree, our own traversal walks it.
//!
//! `tree` turns obvhs' binary tree into pairs of siblings, `probe` is the watertight test of a triangle
//! seen from one origin, `fan` takes all segments of a fan through the tree together, in `lanes` of
//! several numbers; `nearest` follows one ray to its first hit. The traversal of fans is written once and
//! compiled for several instruction sets (`x86`, by `isa`), of which one is chosen at run time.

mod fan;
mod isa;
mod lanes;
mod nearest;
mod probe;
mod tree;
#[cfg(target_arch = "x86_64")]
mod x86;

use super::{EngineInfo, Fans, Hit, MAX_FAN, Ray, Triangles, Visibility, VisibilityError};
use crate::simd::Isa;
use tree::Tree;

/// Version of obvhs in `Cargo.toml`; the crate does not tell it.
const OBVHS_VERSION: &str = "0.4";

/// By triangle: boxes, nodes and indices of obvhs, then our corners and pairs.
const BUILD_BYTES: u64 = 400;

/// A tree over the triangles, traversed by whole fans.
#[derive(Debug)]
pub struct Obvhs {
    tree: Tree,
    isa: Isa,
}

impl Obvhs {
    /// Builds the tree, on one thread: its shape then depends on nothing but the triangles.
    pub fn new(triangles: &Triangles) -> Result<Self, VisibilityError> {
        Self::with_isa(triangles, Isa::widest())
    }

    /// The same with an instruction set of one's choice; in place of one that this processor lacks, its widest is taken.
    pub fn with_isa(triangles: &Triangles, isa: Isa) -> Result<Self, VisibilityError> {
        triangles.validate()?;
        let is_there = Isa::available().contains(&isa);
        Ok(Self {
            tree: Tree::new(triangles),
            isa: if is_there { isa } else { Isa::widest() },
        })
    }
}

impl Obvhs {
    /// Memory that building a tree over so many triangles takes at most: obvhs' own structures beside ours.
    pub const fn bytes_to_build(triangles: usize) -> u64 {
        triangles as u64 * BUILD_BYTES
    }
}

impl Visibility for Obvhs {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            name: "obvhs",
            version: OBVHS_VERSION.to_owned(),
            isa: self.isa.name().to_owned(),
            packet_width: MAX_FAN as u32,
            bytes: self.tree.bytes(),
        }
    }

    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>) {
        masks.clear();
        isa::occluded(self.isa, &self.tree, fans, masks);
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        hits.clear();
        let mut stack = Vec::with_capacity(self.tree.depth());
        hits.extend(
            rays.iter()
                .map(|ray| nearest::nearest(&self.tree, ray, &mut stack)),
        );
    }
}

#[cfg(test)]
mod tests;
