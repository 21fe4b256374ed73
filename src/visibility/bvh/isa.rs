//! The traversal of fans by instruction set. The answers are the same bits with all of them.

use super::tree::Tree;
use super::{fan, lanes};
use crate::simd::Isa;
use crate::visibility::Fans;

/// Appends a mask for each fan.
pub fn occluded(isa: Isa, tree: &Tree, fans: &Fans, masks: &mut Vec<u64>) {
    match isa {
        Isa::Portable => fan::occluded::<lanes::Portable>(tree, fans, masks),
        // SAFETY: the processor has the instructions: `Obvhs::with_isa` keeps no value that `Isa::available` has not found.
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 => unsafe { super::x86::occluded_avx2(tree, fans, masks) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 => unsafe { super::x86::occluded_avx512(tree, fans, masks) },
    }
}
