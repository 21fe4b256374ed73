//! Faces and edges of what may come between, on which sides of them something lies, and the planes of shadows.

use crate::geometry::polygon;
use glam::DVec3;

/// The plane of a face, its normal outwards.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub normal: DVec3,
    pub offset: f64,
    /// Points no farther than this from the plane lie on it: corners may miss the plane of their face.
    pub thickness: f64,
}

/// A directed line by its Plücker coordinates, between two faces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub along: DVec3,
    pub moment: DVec3,
    pub length: f64,
    /// The face around which it runs counter-clockwise, and the other, as bits.
    left: u64,
    right: u64,
}

/// On which sides of the faces of an occluder something lies, a bit a face; in the plane of a face is both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Sides {
    pub front: u64,
    pub back: u64,
}

/// Which planes of an occluder's shadows matter to a pair: bit 0 stands for its own, the others for those along its edges. Of a large
/// surface between two small ones one edge or two are enough.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Planes(u32);

impl Planes {
    pub const ALL: Self = Self(u32::MAX);

    /// Edges from the 31st on share a bit, which stays set.
    fn bit(edge: usize) -> u32 {
        1 << (edge + 1).min(31)
    }

    pub fn without_own(self) -> Self {
        Self(self.0 & !1)
    }

    pub fn without(self, edge: usize) -> Self {
        Self(self.0 & !(Self::bit(edge) & (u32::MAX >> 1)))
    }

    pub fn has_own(self) -> bool {
        self.0 & 1 != 0
    }

    pub fn has(self, edge: usize) -> bool {
        self.0 & Self::bit(edge) != 0
    }
}

/// A plane; the normal need not have length 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    pub normal: DVec3,
    pub offset: f64,
    /// Points no higher lie on it.
    pub reach: f64,
}

impl Plane {
    /// Positive on the inside.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

impl Sides {
    /// In the plane of some face.
    pub fn is_on(self) -> bool {
        self.front & self.back != 0
    }

    /// Whether two things lie in front of one face: then the occluder is not between them.
    pub fn share_a_front(self, other: Self) -> bool {
        self.front & other.front != 0
    }
}

impl Face {
    /// The plane of a polygon; `None` where it has no area. `reach` is the distance up to which surfaces touch.
    pub fn new(corners: &[DVec3], reach: f64) -> Option<Self> {
        let vector_area = polygon::vector_area(corners);
        let normal = vector_area / vector_area.length();
        if !normal.is_finite() {
            return None;
        }
        let mut face = Self {
            normal,
            offset: normal.dot(polygon::centroid(corners)),
            thickness: 0.0,
        };
        face.thickness = reach + face.warp(corners);
        Some(face)
    }

    /// How far points miss the plane.
    pub fn warp(&self, points: &[DVec3]) -> f64 {
        let heights = points.iter().map(|p| self.height(*p).abs());
        heights.fold(0.0, f64::max)
    }

    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    pub fn reversed(self) -> Self {
        Self {
            normal: -self.normal,
            offset: -self.offset,
            ..self
        }
    }
}

impl Edge {
    pub fn new([a, b]: [DVec3; 2], left: usize, right: usize) -> Self {
        Self {
            along: b - a,
            moment: a.cross(b),
            length: a.distance(b),
            left: 1 << left,
            right: 1 << right,
        }
    }

    /// Whether all eyes on these sides see the edge as part of the silhouette: 1 with its left face, -1 with its right one, 0 not at all; `None`
    /// where that depends on the eye.
    pub fn turn(&self, sides: Sides) -> Option<f64> {
        let seen = |face: u64| match (sides.front & face != 0, sides.back & face != 0) {
            (true, false) => Some(1.0),
            (_, true) => Some(0.0),
            _ => None,
        };
        Some(seen(self.left)? - seen(self.right)?)
    }

    /// The same from an eye that sees the faces `seen`.
    pub fn turn_from(&self, seen: u64) -> f64 {
        f64::from(seen & self.left != 0) - f64::from(seen & self.right != 0)
    }
}
