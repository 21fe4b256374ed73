//! Eq. (1): the point-to-disk approximation.

use glam::DVec3;

/// Form factor from the point at the origin with unit `normal` to a small area at `to` with unit normal
/// `source_normal`, taken for a disk: `F = ΔA cosθ_s cosθ_r / (π r² + ΔA)`.
///
/// Exact for a disk on the axis that faces the point; elsewhere a second-order approximation in size over distance.
/// 0 where either side looks away.
pub fn point_to_disk(normal: DVec3, to: DVec3, source_normal: DVec3, area: f64) -> f64 {
    let r2 = to.length_squared();
    let receiver = normal.dot(to);
    let source = -source_normal.dot(to);
    if receiver <= 0.0 || source <= 0.0 {
        return 0.0;
    }
    area * receiver * source / (r2 * (std::f64::consts::PI * r2 + area))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_disk_on_the_axis_is_exact() {
        for (radius, height) in [(1.0, 1.0), (0.3, 2.0), (5.0, 0.1)] {
            let computed =
                point_to_disk(DVec3::Z, DVec3::Z * height, -DVec3::Z, PI * radius * radius);
            let exact = radius * radius / (height * height + radius * radius);
            assert!(
                (computed - exact).abs() < 1e-15,
                "r {radius} h {height}: {computed} {exact}"
            );
        }
    }

    #[test]
    fn nothing_arrives_from_behind() {
        assert_eq!(point_to_disk(DVec3::Z, -DVec3::Z, DVec3::Z, 1.0), 0.0);
        assert_eq!(point_to_disk(DVec3::Z, DVec3::Z, DVec3::Z, 1.0), 0.0);
    }
}
