//! Several single-precision numbers that are computed together.

/// A vector of numbers. All implementations give the same bits: nothing is fused, and `min` and `max`
/// give their second argument where a number is NaN.
pub trait Lanes: Copy {
    /// How many numbers, at most 32: masks have one bit for each.
    const WIDTH: usize;

    /// The same number in all lanes.
    fn splat(value: f32) -> Self;
    /// The first [`Self::WIDTH`] numbers of a slice.
    fn load(values: &[f32]) -> Self;
    /// Writes them to the beginning of a slice.
    fn store(self, values: &mut [f32]);
    /// Sum.
    fn add(self, other: Self) -> Self;
    /// Difference.
    fn sub(self, other: Self) -> Self;
    /// Product.
    fn mul(self, other: Self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// The larger one.
    fn max(self, other: Self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// One over each number; one over `least` where it is closer to 0 than that.
    fn inverse(self, least: f32) -> Self;
    /// With the sign changed where `other` is negative.
    fn with_sign_times(self, other: Self) -> Self;
    /// Mask of the lanes that are less.
    fn lt(self, other: Self) -> u32;
    /// Mask of the lanes that are less or equal.
    fn le(self, other: Self) -> u32;
}

/// Plain arrays, for the compiler to vectorise for whatever machine it is.
#[derive(Clone, Copy)]
pub struct Portable([f32; WIDTH]);

const WIDTH: usize = 8;

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn mask(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..WIDTH).fold(0, |mask, i| mask | u32::from(f(self.0[i], other.0[i])) << i)
    }
}

impl Lanes for Portable {
    const WIDTH: usize = WIDTH;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    fn load(values: &[f32]) -> Self {
        Self(std::array::from_fn(|i| values[i]))
    }

    #[inline(always)]
    fn store(self, values: &mut [f32]) {
        values[..WIDTH].copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }

    #[inline(always)]
    fn inverse(self, least: f32) -> Self {
        Self(
            self.0
                .map(|a| 1.0 / if a.abs() < least { least } else { a }),
        )
    }

    #[inline(always)]
    fn with_sign_times(self, other: Self) -> Self {
        self.zip(other, |a, b| {
            f32::from_bits(a.to_bits() ^ (b.to_bits() & (1 << 31)))
        })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.mask(other, |a, b| a < b)
    }

    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.mask(other, |a, b| a <= b)
    }
}
