//! Which instructions the traversal of fans uses. The answers are the same bits with all of them.

use super::tree::Tree;
use super::{fan, lanes};
use crate::visibility::Fans;

/// An instruction set that the traversal is compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// Whatever the program was compiled for.
    Portable,
    /// 8 lanes.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// 16 lanes.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Isa {
    /// Those that this processor has, the best one last.
    pub fn available() -> Vec<Self> {
        #[cfg(target_arch = "x86_64")]
        {
            let mut available = vec![Self::Portable];
            if is_x86_feature_detected!("avx2") {
                available.push(Self::Avx2);
            }
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                available.push(Self::Avx512);
            }
            available
        }
        #[cfg(not(target_arch = "x86_64"))]
        vec![Self::Portable]
    }

    /// For reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => "AVX-512",
        }
    }

    /// Appends a mask for each fan.
    pub fn occluded(self, tree: &Tree, fans: &Fans, masks: &mut Vec<u64>) {
        match self {
            Self::Portable => fan::occluded::<lanes::Portable>(tree, fans, masks),
            // SAFETY: this value comes from `available`, which found the instructions.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { super::x86::occluded_avx2(tree, fans, masks) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { super::x86::occluded_avx512(tree, fans, masks) },
        }
    }
}
