//! Lanes of AVX2 and AVX-512, and the functions that are compiled for them.
//!
//! The types are private to `bvh`, and only the functions at the end of this file name them: code that
//! uses them exists nowhere else, and `Isa` calls those functions after asking the processor.

use super::fan;
use super::lanes::Lanes;
use super::tree::Tree;
use crate::visibility::Fans;
use std::arch::x86_64::*;

/// Eight numbers in a register of AVX.
#[derive(Clone, Copy)]
struct Avx2(__m256);

/// Sixteen numbers in a register of AVX-512.
#[derive(Clone, Copy)]
struct Avx512(__m512);

// SAFETY of all blocks below: they run inside of `occluded_avx2` only, see above; `load` checks the
// length of the slice.
impl Lanes for Avx2 {
    const WIDTH: usize = 8;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_set1_ps(value) })
    }

    #[inline(always)]
    fn load(values: &[f32]) -> Self {
        let values = &values[..Self::WIDTH];
        // SAFETY: see above.
        Self(unsafe { _mm256_loadu_ps(values.as_ptr()) })
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_add_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }

    #[inline(always)]
    fn with_sign_times(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm256_xor_ps(self.0, _mm256_and_ps(_mm256_set1_ps(-0.0), other.0)) })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        // SAFETY: see above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
    }

    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        // SAFETY: see above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
    }
}

// SAFETY of all blocks below: they run inside of `occluded_avx512` only, see above; `load` checks the
// length of the slice.
impl Lanes for Avx512 {
    const WIDTH: usize = 16;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm512_set1_ps(value) })
    }

    #[inline(always)]
    fn load(values: &[f32]) -> Self {
        let values = &values[..Self::WIDTH];
        // SAFETY: see above.
        Self(unsafe { _mm512_loadu_ps(values.as_ptr()) })
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm512_add_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm512_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm512_abs_ps(self.0) })
    }

    #[inline(always)]
    fn with_sign_times(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe {
            let sign = _mm512_set1_epi32(i32::MIN);
            let sign = _mm512_and_si512(sign, _mm512_castps_si512(other.0));
            _mm512_castsi512_ps(_mm512_xor_si512(sign, _mm512_castps_si512(self.0)))
        })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        // SAFETY: see above.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        // SAFETY: see above.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
}

/// [`fan::occluded`], compiled for AVX2.
#[target_feature(enable = "avx2")]
pub fn occluded_avx2(tree: &Tree, fans: &Fans, masks: &mut Vec<u64>) {
    fan::occluded::<Avx2>(tree, fans, masks);
}

/// [`fan::occluded`], compiled for AVX-512.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
pub fn occluded_avx512(tree: &Tree, fans: &Fans, masks: &mut Vec<u64>) {
    fan::occluded::<Avx512>(tree, fans, masks);
}
