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
/// Four angles at once, so that one polynomial's latency serves all sides of a quad.
#[inline(always)]
pub fn angles_over_sines(cosines: [f64; 4], squared_sines: [f64; 4]) -> [f64; 4] {
    let c = cosines.map(|cosine| cosine.abs().min(1.0));
    let s = c.map(|c| (1.0 - c) / (1.0 + c));
    let atan = atan_root_over_root(s);
    let acute: [f64; 4] = std::array::from_fn(|i| (1.0 + s[i]) * atan[i]);
    if cosines.iter().all(|cosine| *cosine >= 0.0) {
        return acute;
    }
    std::array::from_fn(|i| {
        let obtuse = PI / squared_sines[i].max(1e-300).sqrt() - acute[i];
        if cosines[i] >= 0.0 { acute[i] } else { obtuse }
    })
}

/// atan(√s)/√s on [0, 1].
#[inline(always)]
fn atan_root_over_root(s: [f64; 4]) -> [f64; 4] {
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
    let x = s.map(|s| 2.0 * s - 1.0);
    let mut sum = [COEFFICIENTS[12]; 4];
    for coefficient in COEFFICIENTS[..12].iter().rev() {
        sum = std::array::from_fn(|i| sum[i] * x[i] + coefficient);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle_over_sine(cosine: f64, sine: f64) -> f64 {
        angles_over_sines([cosine, 1.0, -0.5, 0.0], [sine * sine, 0.0, 0.75, 1.0])[0]
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
