//! The four parts of a cell, looked at together: each instruction serves all four, and so does each wait for a root or a quotient.

use super::cell::Cell;
use super::hybrid::{Formula, Receiver};
use super::polygon::{point_to_quads, point_to_visible_polygon};
use crate::radiometry::Spectrum;
use glam::DVec3;
use std::f64::consts::PI;

/// A number of each part.
pub(super) type Four<T = f64> = [T; 4];

/// The four parts of a cell, number by number.
#[derive(Debug, Clone)]
pub(super) struct Siblings {
    centroid: [Four; 3],
    area: Four,
    squared_diameter: Four,
    radius: Four,
    /// By axis, the first corners of all parts, then the second ones, and so on; a triangle repeats its first.
    corners: [[f64; 16]; 3],
    corner_count: usize,
    radiosity: [Four<f32>; 3],
}

/// What a point sees of the four parts of a cell, occlusion left aside.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sights {
    /// Form factors from the point to the parts.
    pub form_factor: Four,
    /// Relative errors that Eq. (1) may have here, to leading order; 0 for Eq. (2).
    pub uncertainty: Four,
    /// Whether the horizon cuts them.
    pub is_cut: Four<bool>,
}

/// Where the parts are, seen from a point.
struct Bearings {
    /// How high their centroids are above its horizon.
    height: Four,
    /// How far it is in front of their plane.
    front: Four,
    squared_distance: Four,
}

impl Siblings {
    pub fn new(parts: &[Cell]) -> Self {
        let mut siblings = Self {
            centroid: [[0.0; 4]; 3],
            area: [0.0; 4],
            squared_diameter: [0.0; 4],
            radius: [0.0; 4],
            corners: [[0.0; 16]; 3],
            corner_count: parts[0].corner_count(),
            radiosity: [[0.0; 4]; 3],
        };
        for (i, part) in parts.iter().enumerate() {
            siblings.area[i] = part.area;
            siblings.squared_diameter[i] = part.diameter * part.diameter;
            siblings.radius[i] = part.radius;
            for axis in 0..3 {
                siblings.centroid[axis][i] = part.centroid[axis];
                siblings.radiosity[axis][i] = part.radiosity[axis];
                for (k, corner) in part.corners().iter().enumerate() {
                    siblings.corners[axis][4 * k + i] = corner[axis];
                }
            }
        }
        siblings
    }

    /// The radiosity of a part in its strongest channel.
    #[inline(always)]
    pub fn strongest(&self, part: usize) -> f64 {
        let [r, g, b] = self.radiosity.each_ref().map(|channel| channel[part]);
        f64::from(r.max(g).max(b))
    }

    /// What the parts give together if a point sees so much of each.
    #[inline(always)]
    pub fn irradiance(&self, form_factors: &Four) -> Spectrum {
        let sum = |radiosity: &Four<f32>| -> f32 {
            (0..4).map(|i| radiosity[i] * form_factors[i] as f32).sum()
        };
        Spectrum::from(self.radiosity.each_ref().map(sum))
    }

    /// Their form factors by Eq. (1).
    #[inline(always)]
    pub fn disks(&self, receiver: Receiver, normal: DVec3) -> Four {
        self.eq_1(&self.bearings(receiver, normal))
    }

    /// The form factors from `receiver` to the parts, which face along `normal`, by the five-times rule.
    ///
    /// The largest projected width is taken for its bound that holds in every direction, the diameter.
    #[inline(always)]
    pub fn sights(&self, formula: Formula, receiver: Receiver, normal: DVec3) -> Sights {
        let bearings = self.bearings(receiver, normal);
        let mut sights = Sights {
            form_factor: self.eq_1(&bearings),
            uncertainty: [0.0; 4],
            is_cut: [false; 4],
        };
        let squared_factor = match formula {
            Formula::Hybrid(factor) => factor * factor,
            Formula::Disk => 0.0,
            Formula::Polygon => f64::INFINITY,
        };
        let (mut is_close, mut is_beside) = ([false; 4], [false; 4]);
        for i in 0..4 {
            let (height, radius) = (bearings.height[i], self.radius[i]);
            let squared_distance = bearings.squared_distance[i];
            sights.uncertainty[i] = self.squared_diameter[i] / squared_distance;
            let is_seen = (bearings.front[i] > 0.0) & (height > -radius);
            is_close[i] = is_seen & (squared_distance <= squared_factor * self.squared_diameter[i]);
            is_beside[i] = is_seen & (height < radius);
        }
        let any = |of: Four<bool>| of[0] | of[1] | of[2] | of[3];
        if formula != Formula::Disk && (any(is_close) || any(is_beside)) {
            self.look_closely(receiver, is_close, is_beside, &mut sights);
        }
        sights
    }

    /// Eq. (2) for the parts that are close, and for those that the horizon turns out to cut.
    #[inline(always)]
    fn look_closely(
        &self,
        receiver: Receiver,
        is_close: Four<bool>,
        is_beside: Four<bool>,
        sights: &mut Sights,
    ) {
        let Receiver { point, normal, .. } = receiver;
        let mut corners = self.corners;
        let mut height = [0.0; 16];
        for axis in 0..3 {
            for i in 0..16 {
                corners[axis][i] -= point[axis];
                height[i] += normal[axis] * corners[axis][i];
            }
        }
        let form_factors = point_to_quads(normal, &corners);
        for i in 0..4 {
            let lowest = height[i]
                .min(height[4 + i])
                .min(height[8 + i])
                .min(height[12 + i]);
            if is_beside[i] & (lowest < 0.0) {
                let corner = |k: usize| DVec3::from([0, 1, 2].map(|axis| corners[axis][4 * k + i]));
                let outline = [corner(0), corner(1), corner(2), corner(3)];
                let (above, _) = point_to_visible_polygon(normal, &outline[..self.corner_count]);
                sights.form_factor[i] = above;
                sights.uncertainty[i] = 0.0;
                sights.is_cut[i] = true;
            } else if is_close[i] {
                sights.form_factor[i] = form_factors[i].max(0.0);
                sights.uncertainty[i] = 0.0;
            }
        }
    }

    #[inline(always)]
    fn bearings(&self, receiver: Receiver, normal: DVec3) -> Bearings {
        let mut bearings = Bearings {
            height: [0.0; 4],
            front: [0.0; 4],
            squared_distance: [0.0; 4],
        };
        for axis in 0..3 {
            for i in 0..4 {
                let to = self.centroid[axis][i] - receiver.point[axis];
                bearings.height[i] += receiver.normal[axis] * to;
                bearings.front[i] -= normal[axis] * to;
                bearings.squared_distance[i] += to * to;
            }
        }
        bearings
    }

    #[inline(always)]
    fn eq_1(&self, bearings: &Bearings) -> Four {
        std::array::from_fn(|i| {
            // At the centroid itself there is no direction, and nothing arrives.
            let squared_distance = bearings.squared_distance[i].max(1e-150);
            let cosines = bearings.height[i].max(0.0) * bearings.front[i].max(0.0);
            let disk = PI * squared_distance + self.area[i];
            self.area[i] * cosines / (squared_distance * disk)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form_factor::SourceShape;
    use crate::form_factor::{point_to_disk, point_to_polygon};
    use crate::geometry::jitter;

    const DOWN: DVec3 = DVec3::NEG_Z;

    /// Four cells at z = 0 that face down and are of different sizes.
    fn parts(shape: SourceShape) -> Vec<Cell> {
        let part = |i: u32| {
            let corner = |k: u32| {
                let [x, y] = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]][k as usize];
                let [s, t] = jitter(i, k).map(|j| 0.3 * j);
                DVec3::new(x + s + 2.0 * f64::from(i), y + t, 0.0) / f64::from(i + 1)
            };
            let last = if shape == SourceShape::Quad { 3 } else { 0 };
            Cell::new([corner(0), corner(1), corner(2), corner(last)], shape)
        };
        (0..4).map(part).collect()
    }

    /// Points all around, near and far, that look everywhere.
    fn receivers(count: u32) -> impl Iterator<Item = Receiver> {
        (0..count).map(|i| {
            let [[x, y], [z, far], [a, b]] = [0, 1, 2].map(|k| jitter(i, k));
            let from = DVec3::new(2.0 * x, y, -z) - 0.5;
            Receiver {
                point: from * if far < 0.7 { 1.0 } else { 12.0 },
                normal: (DVec3::new(a, b, jitter(i, 3)[0]) - 0.5).normalize(),
                irradiance: 0.0,
            }
        })
    }

    /// The same for one part, as the rule is written.
    fn plain(formula: Formula, receiver: Receiver, part: &Cell) -> (f64, f64, bool) {
        let to = part.centroid - receiver.point;
        if DOWN.dot(to) >= 0.0 {
            return (0.0, 0.0, false);
        }
        let corners: Vec<DVec3> = part.outline().iter().map(|c| *c - receiver.point).collect();
        let heights = || corners.iter().map(|corner| receiver.normal.dot(*corner));
        let above = heights().filter(|height| *height >= 0.0).count();
        if above == 0 {
            return (0.0, 0.0, false);
        }
        let is_far = match formula {
            Formula::Hybrid(factor) => to.length() > factor * part.diameter,
            Formula::Disk => true,
            Formula::Polygon => false,
        };
        let disk = point_to_disk(receiver.normal, to, DOWN, part.area);
        let uncertainty = part.diameter.powi(2) / to.length_squared();
        if formula != Formula::Disk && above < corners.len() {
            let cut = point_to_visible_polygon(receiver.normal, &corners).0;
            (cut, 0.0, true)
        } else if is_far {
            (disk, uncertainty, false)
        } else {
            (point_to_polygon(receiver.normal, &corners), 0.0, false)
        }
    }

    #[test]
    fn four_together_are_seen_as_one_by_one() {
        let (mut by_eq_1, mut by_eq_2, mut cut_ones) = (0, 0, 0);
        for shape in [SourceShape::Quad, SourceShape::Triangle] {
            let parts = parts(shape);
            let siblings = Siblings::new(&parts);
            for formula in [Formula::Hybrid(5.0), Formula::Disk, Formula::Polygon] {
                for receiver in receivers(3000) {
                    let sights = siblings.sights(formula, receiver, DOWN);
                    for (i, part) in parts.iter().enumerate() {
                        let (form_factor, uncertainty, is_cut) = plain(formula, receiver, part);
                        let found = sights.form_factor[i];
                        assert!((found - form_factor).abs() < 1e-12, "{found} {form_factor}");
                        if form_factor > 0.0 {
                            assert_eq!(sights.is_cut[i], is_cut);
                            assert!((sights.uncertainty[i] - uncertainty).abs() < 1e-12);
                            by_eq_1 += usize::from(uncertainty > 0.0);
                            by_eq_2 += usize::from(uncertainty == 0.0 && !is_cut);
                            cut_ones += usize::from(is_cut);
                        }
                    }
                }
            }
        }
        assert!(
            by_eq_1.min(by_eq_2).min(cut_ones) > 1000,
            "{by_eq_1} {by_eq_2} {cut_ones}"
        );
    }

    #[test]
    fn a_point_in_the_middle_of_a_part_receives_nothing() {
        let parts = parts(SourceShape::Quad);
        let siblings = Siblings::new(&parts);
        for normal in [DVec3::Z, DVec3::X, DOWN] {
            let receiver = Receiver {
                point: parts[1].centroid,
                normal,
                irradiance: 0.0,
            };
            assert_eq!(siblings.disks(receiver, DOWN), [0.0; 4]);
            for formula in [Formula::Hybrid(5.0), Formula::Disk, Formula::Polygon] {
                assert_eq!(
                    siblings.sights(formula, receiver, DOWN).form_factor,
                    [0.0; 4]
                );
            }
        }
    }
}
