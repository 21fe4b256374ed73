//! Arrays of numbers whose length is known before they are written: what binary mesh formats point into.

use glam::{DVec3, Vec3};
use std::io::{self, Write};

type Fill<'a> = dyn Fn(&mut dyn Write) -> io::Result<()> + 'a;

/// One array, made while it is written: meshes are large, and their numbers are in memory once already.
pub(super) struct Block<'a> {
    /// How many bytes it writes.
    pub bytes: u64,
    fill: Box<Fill<'a>>,
}

impl<'a> Block<'a> {
    /// `count` items of `N` bytes each, all little-endian.
    pub fn new<const N: usize, I: Iterator<Item = [u8; N]>>(
        count: usize,
        items: impl Fn() -> I + 'a,
    ) -> Self {
        Self {
            bytes: (count * N) as u64,
            fill: Box::new(move |out| items().try_for_each(|item| out.write_all(&item))),
        }
    }

    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        (self.fill)(out)
    }
}

/// Where each block begins, `header` bytes before each included, and where the last one ends.
pub(super) fn offsets(blocks: &[Block], header: u64) -> (Vec<u64>, u64) {
    let mut end = 0;
    let begins = blocks.iter().map(|block| {
        let begin = end;
        end += header + block.bytes;
        begin
    });
    (begins.collect(), end)
}

/// Three single-precision numbers as bytes.
pub(super) fn floats(values: Vec3) -> [u8; 12] {
    joined(values.to_array().map(f32::to_le_bytes))
}

/// Three double-precision numbers as bytes.
pub(super) fn doubles(values: DVec3) -> [u8; 24] {
    joined(values.to_array().map(f64::to_le_bytes))
}

/// Three indices as bytes.
pub(super) fn indices(values: [u32; 3]) -> [u8; 12] {
    joined(values.map(u32::to_le_bytes))
}

fn joined<const N: usize, const M: usize, const ALL: usize>(parts: [[u8; N]; M]) -> [u8; ALL] {
    let mut all = [0; ALL];
    all.copy_from_slice(parts.as_flattened());
    all
}

/// The lowest and the highest coordinates.
pub(super) fn bounds(places: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    places.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    })
}

/// Whether rounding to `f32` would move some position by more than 1e-5 of the extent of them all.
pub(super) fn needs_double(positions: &[DVec3]) -> bool {
    let (low, high) = bounds(positions.iter().copied());
    let tolerance = 1e-5 * (high - low).max_element();
    positions.iter().any(|position| {
        (position.as_vec3().as_dvec3() - position)
            .abs()
            .max_element()
            > tolerance
    })
}
