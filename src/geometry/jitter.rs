//! Seeded jitter: the same pair of numbers in [0, 1) for the same key, on any thread.

/// Two independent numbers in [0, 1) that depend on the key alone (two rounds of the SplitMix64 finaliser).
#[inline(always)]
pub fn jitter(a: u32, b: u32) -> [f64; 2] {
    let mut z = ((u64::from(a) << 32) | u64::from(b)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    for _ in 0..2 {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
    }
    let unit = |bits: u64| (bits as u32) as f64 * (1.0 / 4_294_967_296.0);
    [unit(z), unit(z >> 32)]
}

#[cfg(test)]
mod tests {
    use super::jitter;

    #[test]
    fn jitter_fills_the_unit_square_evenly() {
        let mut cells = [0u32; 64];
        for i in 0..64_000u32 {
            let [s, t] = jitter(i / 300, i % 300);
            cells[(s * 8.0) as usize * 8 + (t * 8.0) as usize] += 1;
        }
        // 1000 a cell on average, standard deviation 31.4; five of them.
        assert!(cells.iter().all(|&n| n.abs_diff(1000) < 160), "{cells:?}");
    }
}
