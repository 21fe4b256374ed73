//! Obstructed view factors that others have published, to their printed digits.

use crate::common::shapes::rectangle;
use crate::setup::{close, matrix_with, portable, quads};
use glam::{DVec3, dvec3};
use radiosity::matrix::Options;

/// Half a unit of the last digit printed: eight of them.
const PRINTED: f64 = 0.5e-8;

/// Shapiro's case, from FACET (UCID-19887, 1983, Fig. 12) and, to more digits, Walton's *Calculation of Obstructed View Factors by Adaptive
/// Integration* (NISTIR 6925, 2002, Fig. 13 and Table 1): squares of 1, 1 apart, and between them, at three quarters of the way, two
/// of 0.5 back to back. Walton has F_12 as the difference of two factors rounded to the last digit, which leaves a whole unit of it; the exact
/// difference is 0.1156206022.
#[test]
fn walton_and_shapiro_two_squares_past_two_back_to_back() {
    let at = dvec3(0.25, 0.25, 0.75);
    let (u, v) = (DVec3::X * 0.5, DVec3::Y * 0.5);
    let list = [
        rectangle(DVec3::ZERO, DVec3::X, DVec3::Y),
        rectangle(DVec3::Z, DVec3::Y, DVec3::X),
        rectangle(at, v, u),
        rectangle(at, u, v),
    ];
    let options = Options {
        tolerance: 1e-9,
        ..portable()
    };
    let found = matrix_with(&quads(&list), &options);
    for (i, j, printed, unit) in [
        (1, 2, 0.115_620_61, 2.0),
        (2, 1, 0.115_620_61, 2.0),
        (3, 1, 0.336_817_17, 1.0),
        (1, 3, 0.084_204_294, 0.1),
        (4, 2, 0.794_452_72, 1.0),
        (2, 4, 0.198_613_18, 1.0),
        (1, 4, 0.0, 1.0),
        (3, 4, 0.0, 1.0),
    ] {
        let factor = found.factor(i - 1, j - 1);
        close(factor, printed, PRINTED * unit, &format!("F_{i}{j}"));
    }
    let unobstructed = matrix_with(&quads(&list[..2]), &options);
    close(unobstructed.factor(0, 1), 0.199_824_90, PRINTED, "F*_12");
}
