//! A surface with coordinates in its plane.

use super::border::Border;
use crate::geometry::polygon;
use crate::mesh::Patch;
use glam::{DVec2, DVec3};

/// How many times the reach a rectangle is larger than the region in it, so that nothing of the region snaps to it.
const MARGIN: f64 = 8.0;

/// A triangle or convex quad, seen from its front: in its plane it runs counter-clockwise. Or a region of triangles, and then the
/// corners are those of a rectangle around it.
pub(super) struct Face {
    corners: [DVec3; 4],
    flat: [DVec2; 4],
    /// Unit vectors in the plane, square to each side, pointing inwards.
    inwards: [DVec2; 4],
    count: usize,
    centre: DVec3,
    normal: DVec3,
    axes: [DVec3; 2],
    /// Points of the plane closer than this are one.
    pub reach: f64,
    /// Points this close to the plane lie on it: `reach`, or more where the corners themselves miss the plane.
    pub thickness: f64,
    /// Where a region ends; all other faces end at their sides.
    pub border: Option<Border>,
}

impl Face {
    /// `None` for a sliver of less than twice the width `reach`: all of it is border.
    pub fn new(corners: &[DVec3], reach: f64) -> Option<Self> {
        let count = corners.len();
        let vector_area = polygon::vector_area(corners);
        let normal = vector_area.try_normalize()?;
        let longest = polygon::diameter(corners);
        if vector_area.length() <= 2.0 * reach * longest {
            return None;
        }
        let (u, v) = normal.any_orthonormal_pair();
        let centre = corners.iter().sum::<DVec3>() / count as f64;
        let all = std::array::from_fn(|i| corners[i % count]);
        let mut face = Self {
            corners: all,
            flat: [DVec2::ZERO; 4],
            inwards: [DVec2::ZERO; 4],
            count,
            centre,
            normal,
            axes: [u, v],
            reach,
            thickness: reach,
            border: None,
        };
        face.flat = all.map(|corner| face.flatten(corner));
        for side in 0..count {
            let [a, b] = face.side(side);
            face.inwards[side] = (b - a).perp().normalize_or_zero();
        }
        let miss = corners
            .iter()
            .map(|c| face.height(*c).abs())
            .fold(0.0, f64::max);
        face.thickness = reach + 2.0 * miss;
        Some(face)
    }

    /// A region by the sides on its border and its area along its normal; `None` if all of it is border.
    pub fn around(sides: &[[DVec3; 2]], vector_area: DVec3, reach: f64) -> Option<Self> {
        let normal = vector_area.try_normalize()?;
        let along = |side: &&[DVec3; 2]| side[0].distance_squared(side[1]);
        let [a, b] = sides.iter().max_by(|x, y| along(x).total_cmp(&along(y)))?;
        let u = (*b - *a).reject_from_normalized(normal).try_normalize()?;
        let v = normal.cross(u);
        let places = sides.iter().flatten().map(|p| {
            let to = *p - *a;
            DVec2::new(u.dot(to), v.dot(to))
        });
        let (low, high) = places.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        let (low, high) = (low - MARGIN * reach, high + MARGIN * reach);
        let corners = [
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        let mut face = Self::new(&corners.map(|p| *a + u * p.x + v * p.y), reach)?;
        let miss = sides
            .iter()
            .flatten()
            .map(|p| face.height(*p).abs())
            .fold(0.0, f64::max);
        face.thickness = reach + 2.0 * miss;
        face.border = Some(Border::new(sides, vector_area, |p| face.flatten(p)));
        Some(face)
    }

    /// Its normal, as long as its area.
    pub fn vector_area(&self) -> DVec3 {
        match &self.border {
            Some(border) => border.vector_area,
            None => polygon::vector_area(self.corners()),
        }
    }

    /// Whether a point of the plane that is on no border belongs to the face.
    pub fn encloses(&self, point: DVec2) -> bool {
        self.border
            .as_ref()
            .is_none_or(|border| border.encloses(point))
    }

    /// Corners in the plane.
    pub fn flat(&self) -> &[DVec2] {
        &self.flat[..self.count]
    }

    /// Corners in the frame.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// Ends of a side.
    pub fn side(&self, side: usize) -> [DVec2; 2] {
        [self.flat[side], self.flat[(side + 1) % self.count]]
    }

    /// Where it ends, in the plane.
    pub fn outline(&self) -> Vec<[DVec2; 2]> {
        match &self.border {
            Some(border) => border.lines.clone(),
            None => (0..self.count).map(|side| self.side(side)).collect(),
        }
    }

    /// Distance in front of the plane.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.centre)
    }

    /// The cosine of the angle between its normal and that of a polygon.
    pub fn facing(&self, corners: &[DVec3]) -> f64 {
        let vector_area = polygon::vector_area(corners);
        self.normal.dot(vector_area.normalize_or_zero())
    }

    /// Coordinates of a point's foot in the plane.
    pub fn flatten(&self, point: DVec3) -> DVec2 {
        let to = point - self.centre;
        DVec2::new(self.axes[0].dot(to), self.axes[1].dot(to))
    }

    /// Distance of a point of the plane from the line of a side, positive inside.
    pub fn depth(&self, side: usize, point: DVec2) -> f64 {
        self.inwards[side].dot(point - self.flat[side])
    }

    /// The part of a segment that lies on the face.
    pub fn clip(&self, [mut a, mut b]: [DVec2; 2]) -> Option<[DVec2; 2]> {
        for side in 0..self.count {
            let (from, to) = (self.depth(side, a), self.depth(side, b));
            if from <= 0.0 && to <= 0.0 {
                return None;
            }
            let crossing = a.lerp(b, from / (from - to));
            if from < 0.0 {
                a = crossing;
            } else if to < 0.0 {
                b = crossing;
            }
        }
        Some([a, b])
    }

    /// Whether all points lie beside one side, or on it.
    pub fn beside(&self, points: &[DVec2]) -> bool {
        (0..self.count).any(|side| points.iter().all(|p| self.depth(side, *p) <= self.reach))
    }

    /// The point of a side that is nearest to `point`: in the plane, and in the frame.
    pub fn on_side(&self, side: usize, point: DVec2) -> (DVec2, DVec3) {
        let [a, b] = self.side(side);
        let along = b - a;
        let place = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let end = self.corners[(side + 1) % self.count];
        (a.lerp(b, place), self.corners[side].lerp(end, place))
    }

    /// From the plane to the frame: to the very corner of a region, or onto the bilinear surface of a quad whose corners miss their plane.
    pub fn lift(&self, point: DVec2) -> DVec3 {
        let flat = self.centre + self.axes[0] * point.x + self.axes[1] * point.y;
        if let Some(border) = &self.border {
            return border.corner(point).unwrap_or(flat);
        }
        if self.count == 3 {
            return flat;
        }
        let patch = Patch::new(0, 0, self.corners(), false);
        let (u, v) = patch.coordinates(flat);
        patch.position_at(u, v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Face {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        Face::new(&corners.map(|(x, z)| DVec3::new(x, 1.0, -z)), 1e-6)
            .expect("a square has an area")
    }

    #[test]
    fn the_plane_and_the_frame_agree() {
        let face = square();
        for p in [DVec3::new(1.0, 1.0, -2.0), DVec3::new(3.9, 1.0, -0.1)] {
            assert!(face.lift(face.flatten(p)).distance(p) < 1e-14);
            assert!((face.height(p + DVec3::Y) - 1.0).abs() < 1e-14);
            assert!((0..4).all(|side| face.depth(side, face.flatten(p)) > 0.0));
        }
    }

    #[test]
    fn clipping_keeps_what_is_inside() {
        let face = square();
        let clip = |a: [f64; 2], b: [f64; 2]| {
            let flat = |[x, z]: [f64; 2]| face.flatten(DVec3::new(x, 1.0, -z));
            face.clip([flat(a), flat(b)])
                .map(|[a, b]| (face.lift(a), face.lift(b)))
        };
        let (a, b) = clip([-2.0, 1.0], [6.0, 1.0]).expect("it crosses");
        assert!(a.distance(DVec3::new(0.0, 1.0, -1.0)) < 1e-14);
        assert!(b.distance(DVec3::new(4.0, 1.0, -1.0)) < 1e-14);
        assert!(
            clip([-2.0, 1.0], [1.0, -3.0]).is_none(),
            "it passes by a corner"
        );
        assert!(
            clip([-1.0, 5.0], [5.0, 5.0]).is_none(),
            "it passes by a side"
        );
    }

    #[test]
    fn a_sliver_has_no_inside() {
        let sliver = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1e-7, 0.0)];
        assert!(Face::new(&sliver, 1e-6).is_none());
        assert!(Face::new(&[DVec3::ZERO; 3], 1e-6).is_none());
    }
}
