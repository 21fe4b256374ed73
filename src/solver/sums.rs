//! Sums over all of a large mesh. Their terms are found side by side and added one after the other, so that the bits are those of a plain
//! loop, with any number of threads.

use rayon::prelude::*;

/// Terms that are found before any of them is added: all at once would be as large a list as those that the mesh is made of.
const BLOCK: usize = 1 << 15;

/// A block is shared out in so many parts at the most.
const PARTS: usize = 512;

/// Finds each of `count` terms, and lets `add` have them in order.
pub(super) fn in_order<T: Send>(
    count: usize,
    term: impl Fn(usize) -> T + Sync,
    add: impl FnMut(T),
) {
    in_blocks(BLOCK, count, term, add);
}

/// The same of terms that are large: `block` of them at a time.
pub(super) fn in_blocks<T: Send>(
    block: usize,
    count: usize,
    term: impl Fn(usize) -> T + Sync,
    mut add: impl FnMut(T),
) {
    let mut terms = Vec::new();
    for first in (0..count).step_by(block) {
        let numbers = (first..count.min(first + block)).into_par_iter();
        let found = numbers.with_min_len(block / PARTS).map(&term);
        found.collect_into_vec(&mut terms);
        terms.drain(..).for_each(&mut add);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bits_are_those_of_a_plain_loop() {
        let count = 3 * BLOCK + 17;
        let term = |i: usize| 1.0 / (1.0 + i as f32);
        let mut sum = 0.0_f32;
        in_order(count, term, |term| sum += term);
        let plain =
            |terms: &mut dyn Iterator<Item = usize>| terms.fold(0.0, |sum, i| sum + term(i));
        assert_eq!(sum, plain(&mut (0..count)));
        assert_ne!(sum, plain(&mut (0..count).rev()), "the order matters");
    }
}
