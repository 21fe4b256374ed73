//! A triangle seen from one origin: all that does not depend on the direction, computed once for all
//! segments of a fan.
//!
//! Edge functions after Plücker: the sign of direction · ((p + q) × (q - p)) says on which side the line
//! from the origin (to which p and q are relative) passes the edge from p to q. Of the triangles that
//! share an edge each sees it the other way round, with the opposite sign; those around a corner agree about
//! it if all signs are right. In single precision they are, unless the value is smaller than its error
//! bound: then, rarely, the segment is asked again in double precision. So nothing slips through.

use super::lanes::Lanes;
use crate::visibility::{T_FAR, T_NEAR};
use glam::{DVec3, Vec3};

/// Error of an edge function, over the lengths of direction, sum and difference: both of the latter are
/// rounded, so are the products and the differences in the cross product, and the products and sums in the
/// dot product; that makes 7 times half of an epsilon, times √2 for the lengths. The rest is reserve.
const ERROR: f32 = 8.0 * f32::EPSILON;

/// A triangle relative to an origin.
pub struct Probe {
    corners: [Vec3; 3],
    /// Normals of the planes through the origin and an edge; edge k is opposite to corner k.
    edges: [Vec3; 3],
    /// Bound of the error of the edge functions, for a direction of length 1.
    error: f32,
    /// Of the triangle, not normalised.
    normal: Vec3,
    /// Of the triangle's plane over the origin, times the normal's length.
    height: f32,
}

/// What single precision knows about several segments.
pub struct Verdict {
    /// Those that cross the triangle for certain.
    pub crossed: u32,
    /// Those that pass so close to an edge that double precision must decide.
    pub doubtful: u32,
}

/// Where a line meets a triangle.
pub struct Crossing {
    /// In lengths of the direction.
    pub t: f64,
    /// Weight of the second corner.
    pub u: f64,
    /// Weight of the third corner.
    pub v: f64,
}

impl Probe {
    /// Looks at a triangle from `origin`.
    #[inline(always)]
    pub fn new(corners: &[Vec3; 3], origin: Vec3) -> Self {
        let [a, b, c] = [
            corners[0] - origin,
            corners[1] - origin,
            corners[2] - origin,
        ];
        // (p + q) × (q - p) is 2 p × q, and cancels less where the triangle is far and small.
        let (sums, differences) = ([b + c, c + a, a + b], [c - b, a - c, b - a]);
        let edge = |k: usize| sums[k].cross(differences[k]);
        let longest = |v: [Vec3; 3]| {
            v[0].length_squared()
                .max(v[1].length_squared())
                .max(v[2].length_squared())
        };
        let normal = differences[2].cross(c - a);
        Self {
            corners: [a, b, c],
            edges: [edge(0), edge(1), edge(2)],
            error: ERROR * (longest(sums) * longest(differences)).sqrt(),
            normal,
            height: normal.dot(a),
        }
    }

    /// Which segments cross the triangle between [`T_NEAR`] and [`T_FAR`].
    #[inline(always)]
    pub fn crossed<L: Lanes>(&self, direction: [L; 3], length: L) -> Verdict {
        let [a, b, c] = self.edges;
        let (u, v, w) = (dot(direction, a), dot(direction, b), dot(direction, c));
        let (least, most) = (u.min(v).min(w), u.max(v).max(w));
        let (error, minus_error) = (L::splat(self.error), L::splat(-self.error));
        let (error, minus_error) = (length.mul(error), length.mul(minus_error));
        let perhaps_inside = minus_error.le(least) | most.le(error);
        if perhaps_inside == 0 {
            return Verdict {
                crossed: 0,
                doubtful: 0,
            };
        }
        let inside = error.lt(least) | most.lt(minus_error);
        Verdict {
            crossed: inside & self.within(direction),
            doubtful: perhaps_inside & !inside,
        }
    }

    /// Which segments end on different sides of the triangle's plane.
    #[inline(always)]
    fn within<L: Lanes>(&self, direction: [L; 3]) -> u32 {
        // t = height / speed, compared without a division; a line in the plane has speed 0 and fails.
        let speed = dot(direction, self.normal);
        let height = L::splat(self.height).with_sign_times(speed);
        let speed = speed.abs();
        L::splat(T_NEAR).mul(speed).lt(height) & height.lt(L::splat(T_FAR).mul(speed))
    }

    /// Whether a doubtful segment crosses the triangle.
    #[cold]
    #[inline(never)]
    pub fn settle(&self, direction: Vec3) -> bool {
        self.crossing(direction)
            .is_some_and(|hit| hit.t > f64::from(T_NEAR) && hit.t < f64::from(T_FAR))
    }

    /// Where a line crosses the triangle, in double precision; edges and corners are part of it.
    pub fn crossing(&self, direction: Vec3) -> Option<Crossing> {
        let ([a, b, c], direction) = (self.corners.map(Vec3::as_dvec3), direction.as_dvec3());
        let side = |p: DVec3, q: DVec3| direction.dot((p + q).cross(q - p));
        let sides = DVec3::new(side(b, c), side(c, a), side(a, b));
        let inside = sides.min_element() >= 0.0 || sides.max_element() <= 0.0;
        let normal = (b - a).cross(c - a);
        let (speed, sum) = (normal.dot(direction), sides.element_sum());
        if !inside || speed == 0.0 || sum == 0.0 {
            return None;
        }
        Some(Crossing {
            t: normal.dot(a) / speed,
            u: sides.y / sum,
            v: sides.z / sum,
        })
    }
}

/// Always in the same order and never fused, whatever the instruction set.
#[inline(always)]
fn dot<L: Lanes>([x, y, z]: [L; 3], v: Vec3) -> L {
    x.mul(L::splat(v.x))
        .add(y.mul(L::splat(v.y)))
        .add(z.mul(L::splat(v.z)))
}
