//! Points and the quads that they see: what the kernels of form factors are measured on.

use glam::{DVec3, dvec3};
use radiosity::form_factor::point_to_visible_polygon;
use radiosity::geometry::{jitter, polygon};

/// Enough pairs that branches cannot be learnt by heart, few enough to stay in the first cache.
const PAIRS: u32 = 128;

/// A quad relative to the point that sees it, with what Eq. (1) needs precomputed as the solver does.
pub struct Pair {
    pub corners: [DVec3; 4],
    pub to: DVec3,
    pub normal: DVec3,
    pub area: f64,
}

pub fn pairs() -> Vec<Pair> {
    (0..PAIRS).map(pair).collect()
}

/// A square at one to ten times its size, facing the point more or less, above its horizon.
fn pair(key: u32) -> Pair {
    let [[a, b], [c, d]] = [jitter(key, 0), jitter(key, 1)];
    let centre = (1.0 + 9.0 * a) * dvec3(b - 0.5, c - 0.5, 1.0);
    let u = dvec3(1.0, 0.0, 0.4 * (d - 0.5));
    let v = dvec3(0.0, -1.0, 0.4 * (a - 0.5));
    let corner = centre - 0.5 * (u + v);
    let corners = [corner, corner + u, corner + u + v, corner + v];
    let twice = polygon::vector_area(&corners);
    Pair {
        corners,
        to: centre,
        normal: twice.normalize(),
        area: twice.length(),
    }
}

/// A normal for which the horizon runs through the middle of the quad.
pub fn across(pair: &Pair) -> DVec3 {
    dvec3(pair.to.z, 0.0, -pair.to.x) * pair.to.length_recip()
}

pub fn clipped(normal: DVec3, pair: &Pair) -> f64 {
    point_to_visible_polygon(normal, &pair.corners).0
}
