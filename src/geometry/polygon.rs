//! Planar convex polygons of a few corners: area, normal, centroid, distance, clipping to a half-space.

use glam::DVec3;

/// Half the sum of cross products: its direction is the normal, its length the area.
#[inline]
pub fn vector_area(corners: &[DVec3]) -> DVec3 {
    let origin = corners[0];
    let fan = corners.windows(2).skip(1);
    fan.map(|w| (w[0] - origin).cross(w[1] - origin))
        .sum::<DVec3>()
        * 0.5
}

/// The solid angle that a triangle fills seen from a point, sr: positive from behind, where its corners run clockwise.
pub fn solid_angle(triangle: [DVec3; 3], point: DVec3) -> f64 {
    // Van Oosterom and Strackee (1983), eq. 8.
    let [a, b, c] = triangle.map(|p| p - point);
    let [x, y, z] = [a, b, c].map(DVec3::length);
    let below = x * y * z + a.dot(b) * z + a.dot(c) * y + b.dot(c) * x;
    2.0 * a.dot(b.cross(c)).atan2(below)
}

/// Centre of mass of a convex polygon; the mean of the corners where there is no area.
pub fn centroid(corners: &[DVec3]) -> DVec3 {
    let origin = corners[0];
    let (mut total, mut moment) = (0.0, DVec3::ZERO);
    for w in corners.windows(2).skip(1) {
        let (a, b) = (w[0] - origin, w[1] - origin);
        let area = a.cross(b).length();
        total += area;
        moment += (a + b) * area;
    }
    if total > 0.0 {
        origin + moment / (3.0 * total)
    } else {
        corners.iter().sum::<DVec3>() / corners.len() as f64
    }
}

/// The longest distance between two corners.
pub fn diameter(corners: &[DVec3]) -> f64 {
    let mut longest: f64 = 0.0;
    for (i, a) in corners.iter().enumerate() {
        for b in &corners[i + 1..] {
            longest = longest.max(a.distance_squared(*b));
        }
    }
    longest.sqrt()
}

/// Distance of a point from a planar convex polygon, counter-clockwise about its unit normal.
pub fn distance(point: DVec3, corners: &[DVec3], normal: DVec3) -> f64 {
    let height = normal.dot(point - corners[0]);
    let mut aside: f64 = 0.0;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if normal.cross(b - *a).dot(point - *a) < 0.0 {
            let along = ((point - *a).dot(b - *a) / b.distance_squared(*a)).clamp(0.0, 1.0);
            let foot = a.lerp(b, along);
            let beside = point - foot - normal * height;
            aside = if aside == 0.0 {
                beside.length()
            } else {
                aside.min(beside.length())
            };
        }
    }
    debug_assert!(vector_area(corners).dot(normal) > 0.0);
    height.hypot(aside)
}

/// A convex polygon of at most [`Clipped::MOST`] corners, kept without allocation.
#[derive(Debug, Clone, Copy)]
pub struct Clipped {
    corners: [DVec3; Self::MOST],
    len: usize,
}

impl Clipped {
    /// A quad cut by one plane has five corners; one that lies in the plane up to rounding may alternate between its sides,
    /// and then has six.
    pub const MOST: usize = 6;

    /// The corners that are left, in order; fewer than three mean that nothing is left.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..self.len]
    }

    fn push(&mut self, corner: DVec3) {
        self.corners[self.len] = corner;
        self.len += 1;
    }
}

/// The part of a convex polygon (three or four corners) where `height` ≥ 0, for a linear function `height`.
pub fn clip(corners: &[DVec3], height: impl Fn(DVec3) -> f64) -> Clipped {
    debug_assert!(corners.len() <= 4);
    let mut kept = Clipped {
        corners: [DVec3::ZERO; Clipped::MOST],
        len: 0,
    };
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (ha, hb) = (height(a), height(b));
        if ha >= 0.0 {
            kept.push(a);
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            kept.push(a + (b - a) * (ha / (ha - hb)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];

    #[test]
    fn an_octant_fills_an_eighth_of_the_sphere() {
        let octant = [DVec3::X, DVec3::Y, DVec3::Z];
        let eighth = std::f64::consts::FRAC_PI_2;
        assert!((solid_angle(octant, DVec3::ZERO) - eighth).abs() < 1e-15);
        assert!(solid_angle(octant, DVec3::ONE) < 0.0, "from its front");
    }

    #[test]
    fn unit_square() {
        assert_eq!(vector_area(&UNIT), DVec3::Z);
        assert_eq!(centroid(&UNIT), DVec3::new(0.5, 0.5, 0.0));
        assert_eq!(diameter(&UNIT), 2f64.sqrt());
    }

    #[test]
    fn clipping_keeps_the_area_above_the_line() {
        for (offset, area) in [(-2.0, 1.0), (0.25, 0.75), (1.0, 0.0), (3.0, 0.0)] {
            let kept = clip(&UNIT, |p| p.x - offset);
            let left = if kept.corners().len() < 3 {
                0.0
            } else {
                vector_area(kept.corners()).z
            };
            assert!((left - area).abs() < 1e-15, "x ≥ {offset}: {left}");
        }
        let rounding = clip(&UNIT, |p| (p.x - 0.5) * (p.y - 0.5));
        assert_eq!(rounding.corners().len(), 6);
        let corner_cut = clip(&UNIT, |p| 1.5 - p.x - p.y);
        assert_eq!(corner_cut.corners().len(), 5);
        assert!((vector_area(corner_cut.corners()).z - 0.875).abs() < 1e-15);
    }
}
