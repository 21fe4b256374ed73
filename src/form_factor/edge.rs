//! The angle of an edge over its sine, from the cosine alone: the kernel of Eq. (2) without `acos` or `atan2`.

use std::f64::consts::PI;

/// θ / sin θ for the angle θ in [0, π) whose cosine and squared sine are given, to 3e-11 relative; finite at both ends.
/// Beside π the cosine has lost the angle (1 - cos²θ is all rounding where a point comes near an edge): the sine, from
/// the cross product, has not.
///
/// With t = tan(θ/2) and s = t² = (1 - cos θ)/(1 + cos θ), θ/sin θ = (1 + s) · atan(√s)/√s. The last factor is a
/// polynomial for s ≤ 1, interpolated at Chebyshev nodes; angles above 90° go through π - θ. Near θ = 0 the result is
/// 1 + (1 - cos θ)/3 + …, so nothing cancels there as it does in `acos`.
///
/// Many angles at once, so that one polynomial's latency serves all sides of a polygon, or of several.
#[inline(always)]
pub fn angles_over_sines<const N: usize>(cosines: &[f64; N], squared_sines: &[f64; N]) -> [f64; N] {
    let mut s = [0.0; N];
    for i in 0..N {
        let c = cosines[i].abs().min(1.0);
        s[i] = (1.0 - c) / (1.0 + c);
    }
    let mut angles = atan_root_over_root(&s);
    for i in 0..N {
        angles[i] *= 1.0 + s[i];
    }
    if cosines.iter().all(|cosine| *cosine >= 0.0) {
        return angles;
    }
    for i in 0..N {
        let obtuse = PI / squared_sines[i].max(1e-300).sqrt() - angles[i];
        angles[i] = if cosines[i] >= 0.0 { angles[i] } else { obtuse };
    }
    angles
}

/// atan(√s)/√s on [0, 1].
#[inline(always)]
fn atan_root_over_root<const N: usize>(s: &[f64; N]) -> [f64; N] {
    const COEFFICIENTS: [f64; 13] = [
        0.8704197513671037,
        -0.10187654224951163,
        0.020851851175689575,
        -0.005030866470199314,
        0.0013155868256299447,
        -0.00036095980296257945,
        0.00010226961650882142,
        -2.972520955591348e-05,
        8.768357571140902e-06,
        -2.4925007920279273e-06,
        7.520015073709182e-07,
        -3.320596692183189e-07,
        1.0235203580963182e-07,
    ];
    let mut sum = [COEFFICIENTS[12]; N];
    for coefficient in COEFFICIENTS[..12].iter().rev() {
        for i in 0..N {
            sum[i] = sum[i] * (2.0 * s[i] - 1.0) + coefficient;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle_over_sine(cosine: f64, sine: f64) -> f64 {
        angles_over_sines(&[cosine, 1.0, -0.5, 0.0], &[sine * sine, 0.0, 0.75, 1.0])[0]
    }

    #[test]
    fn agrees_with_the_library_over_all_angles() {
        for i in 1..20_000 {
            let angle = PI * f64::from(i) / 20_000.0;
            let exact = angle / angle.sin();
            let error = angle_over_sine(angle.cos(), angle.sin()) / exact - 1.0;
            // Beside π the cosine itself has lost the angle: 1e-16 / sin² θ.
            assert!(
                error.abs() < 3e-11 + 1e-15 / angle.sin().powi(2),
                "{angle}: {error:e}"
            );
        }
        assert!((angle_over_sine(1.0, 0.0) - 1.0).abs() < 2e-11);
        assert!(angle_over_sine(-1.0, 0.0).is_finite());
    }
}
