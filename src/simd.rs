//! Instruction sets: which this processor has, and code compiled for the widest of them.
//!
//! The one room beside `visibility` with unsafe code, behind a safe face. Nothing here changes a result: Rust fuses no operations, so the
//! same code gives the same bits for every instruction set, in more or fewer numbers at a time.

use std::sync::OnceLock;

/// An instruction set that code is compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// Whatever the program was compiled for.
    Portable,
    /// 8 single-precision numbers at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// 16 of them.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

/// Work that gains from wide instructions: plain loops over arrays, for the compiler to vectorise.
pub trait Kernel {
    /// What it gives.
    type Output;

    /// To be marked `#[inline(always)]`, and so all that it calls in its inner loops. An instruction takes `WIDTH` numbers in single precision.
    fn run<const WIDTH: usize>(self) -> Self::Output;
}

impl Default for Isa {
    fn default() -> Self {
        Self::widest()
    }
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

    /// The best of them.
    pub fn widest() -> Self {
        static WIDEST: OnceLock<Isa> = OnceLock::new();
        *WIDEST.get_or_init(|| *Self::available().last().expect("the portable one"))
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

    /// Runs `kernel`, compiled for this instruction set if the processor has it.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Portable => kernel.run::<4>(),
            // SAFETY: the processor has the instructions. Anyone can write `Isa::Avx2`, but only this crate can name a `Kernel`, and runs
            // its own by `Scratch::isa` and `ClusterScratch::isa`: the widest set of those found, which nobody outside can replace.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { run_avx2(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { run_avx512(kernel) },
        }
    }
}

/// Asks for the memory that holds `of`, which is needed soon, and does not wait for it.
#[inline(always)]
pub fn prefetch<T: ?Sized>(of: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        const LINE: usize = 64;
        let first = std::ptr::from_ref(of).cast::<i8>();
        for offset in (0..size_of_val(of)).step_by(LINE) {
            // SAFETY: within `of`; and a prefetch of any address does nothing that can be seen.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(first.add(offset)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = of;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<8>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn run_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<16>()
}
