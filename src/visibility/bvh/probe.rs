//! A triangle seen from one origin: all that does not depend on the direction, computed once for all
//! segments of a fan.
//!
//! Edge functions after Plücker: the sign of direction · ((p + q) × (q - p)) says on which side the
//! line from the origin (to which p and q are relative) passes the edge from p to q. Seen from the neighbour
//! the edge runs from q to p, and every sum and product then has the same magnitude and the opposite
//! sign; so a line that misses one triangle across a shared edge hits the other, and one that meets the
//! edge itself hits both. That holds as long as no product is fused into a sum.

use super::lanes::Lanes;
use glam::Vec3;

/// A triangle relative to an origin.
pub struct Probe {
    /// Planes through the origin and an edge; edge k is opposite to corner k.
    edges: [Vec3; 3],
    /// Of the triangle, not normalised.
    normal: Vec3,
    /// Of the triangle's plane over the origin, times the normal's length.
    height: f32,
}

/// Where a ray meets a triangle.
pub struct Crossing {
    /// In lengths of the direction.
    pub t: f32,
    /// Weight of the second corner.
    pub u: f32,
    /// Weight of the third corner.
    pub v: f32,
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
        let edge = |p: Vec3, q: Vec3| (p + q).cross(q - p);
        let normal = (b - a).cross(c - a);
        Self {
            edges: [edge(b, c), edge(c, a), edge(a, b)],
            normal,
            height: normal.dot(a),
        }
    }

    /// Which of the lanes cross the triangle between `near` and `far`, in lengths of their directions.
    #[inline(always)]
    pub fn crossed<L: Lanes>(&self, direction: [L; 3], near: L, far: L) -> u32 {
        let [a, b, c] = self.edges;
        let (u, v, w) = (dot(direction, a), dot(direction, b), dot(direction, c));
        let zero = L::splat(0.0);
        let least = u.min(v).min(w);
        let most = u.max(v).max(w);
        let inside = zero.le(least) | most.le(zero);
        if inside == 0 {
            return 0;
        }
        // t = height / speed, compared without a division; a line in the plane has speed 0 and fails.
        let speed = dot(direction, self.normal);
        let height = L::splat(self.height).with_sign_times(speed);
        let speed = speed.abs();
        inside & near.mul(speed).lt(height) & height.lt(far.mul(speed))
    }

    /// Where a single ray crosses it, at t > 0.
    pub fn crossing(&self, direction: Vec3) -> Option<Crossing> {
        let [u, v, w] = self.edges.map(|edge| direction.dot(edge));
        let inside = u.min(v).min(w) >= 0.0 || u.max(v).max(w) <= 0.0;
        let (speed, sum) = (direction.dot(self.normal), u + v + w);
        if !inside || speed == 0.0 || sum == 0.0 {
            return None;
        }
        let t = self.height / speed;
        (t > 0.0 && t < f32::INFINITY).then_some(Crossing {
            t,
            u: v / sum,
            v: w / sum,
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
