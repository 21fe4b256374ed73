//! A curve through space that stays in a neighbourhood for long: Morton's order, the bits of three coordinates in turn.

use glam::DVec3;

/// Cells along a unit of length.
const CELLS: f64 = 65536.0;

/// Bits of a coordinate.
const BITS: u32 = 21;

/// How far along the curve a point is. Coordinates are to be within 16 of 0.
pub fn along_curve(point: DVec3) -> u64 {
    let cell = (point * CELLS).floor().as_i64vec3();
    let [x, y, z] = cell.to_array().map(|along| spread(along as u64));
    x | y << 1 | z << 2
}

/// The lowest bits, two places apart.
const fn spread(number: u64) -> u64 {
    let mut bits = number & ((1 << BITS) - 1);
    bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
    bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
    bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::jitter;

    #[test]
    fn every_bit_is_at_its_place() {
        for place in 0..BITS {
            assert_eq!(spread(1 << place), 1 << (3 * place));
        }
        let step = DVec3::new(1.0, 2.0, 4.0) / CELLS;
        assert_eq!(along_curve(step), 0b100_010_001);
    }

    #[test]
    fn what_follows_one_another_is_near() {
        let point = |n: u32| {
            let ([x, y], [z, _]) = (jitter(n, 0), jitter(n, 1));
            DVec3::new(x, y, z) - 0.5
        };
        let mut points: Vec<DVec3> = (0..4096).map(point).collect();
        points.sort_by_key(|point| along_curve(*point));
        let steps = points.windows(2).map(|pair| pair[0].distance(pair[1]));
        let mean = steps.sum::<f64>() / 4095.0;
        // 16 in a row along each side: the nearest are about half of 1/16 away, any two on average 0.66.
        assert!(mean < 2.0 / 16.0, "{mean}");
    }
}
