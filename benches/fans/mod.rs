//! Full fans, as the vertices of a scene ask them of one source.

use crate::random::Random;
use crate::scenes::EXTENT;
use glam::{DVec3, dvec3};
use radiosity::visibility::{Fans, MAX_FAN, Triangles};

/// Neighbouring vertices that follow each other, as they do in a patch.
const NEIGHBOURS: usize = 40;

/// From points on the triangles, in the order of the triangles, to one rectangle below the ceiling.
pub fn to_ceiling(triangles: &Triangles, count: usize) -> Fans {
    let mut random = Random::new(3);
    let ceiling = triangles.vertices.iter().fold(f32::MIN, |y, v| y.max(v.y));
    let samples: Vec<DVec3> = (0..MAX_FAN)
        .map(|k| {
            let (row, column) = ((k / 8) as f64, (k % 8) as f64);
            let (x, z) = (row + random.unit(), column + random.unit());
            dvec3((x - 4.0) * 0.04, 0.0, (z - 4.0) * 0.04) * EXTENT
                + DVec3::Y * f64::from(ceiling) * 0.999
        })
        .collect();
    let mut fans = Fans::default();
    while fans.len() < count {
        let first = random.below(triangles.indices.len());
        for i in (first..triangles.indices.len()).cycle().take(NEIGHBOURS) {
            let [a, b, c] = triangles.indices[i].map(|k| triangles.vertices[k as usize].as_dvec3());
            let (centre, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
            fans.begin((centre + 1e-5 * EXTENT * normal).as_vec3());
            samples
                .iter()
                .for_each(|sample| fans.push(sample.as_vec3()));
        }
    }
    fans
}
