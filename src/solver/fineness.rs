//! How finely light is sampled where a vertex stands for much.
//!
//! Tolerances of the mesh grow as elements shrink, so that the squared error is shared out evenly over the area. What a vertex
//! of a large element has of noise covers as much as that of a hundred small ones, and large elements are few: in a kitchen of a million triangles
//! one in 25 looks at the clusters. There these are opened further and get more rays, which took a fifth of the squared error of evenly lit walls.

use super::shoot::Shooter;
use super::tiling::SIZE;
use crate::form_factor::SourceThresholds;

/// Elements as long as this part of the scene's extent, two tiles, are sampled with the thresholds as they are …
const SHORT: f64 = 2.0 * SIZE;

/// … and for each time that they are twice as long thresholds are halved, but no more often than this.
const MOST_HALVINGS: u32 = 2;

/// How often thresholds are halved at most. A patch that shoots alone is split where its rays disagree, and needs no more.
pub(super) fn most_halvings(shooter: &Shooter) -> u32 {
    match shooter {
        Shooter::Patch(_) => 0,
        Shooter::All { .. } => MOST_HALVINGS,
    }
}

/// How often they are for what stands for an element with sides as long as `side` says, a part of the scene's extent.
pub(super) fn halvings(shooter: &Shooter, side: impl FnOnce() -> f64) -> u32 {
    match most_halvings(shooter) {
        0 => 0,
        most => ((side() / SHORT).log2().max(0.0) as u32).min(most),
    }
}

/// Thresholds that were halved so often.
pub(super) fn halved(thresholds: SourceThresholds, times: u32) -> SourceThresholds {
    thresholds.scaled(0.5_f64.powi(times as i32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form_factor::Sampler;
    use crate::radiometry::Spectrum;
    use crate::solver::arrived::Arrived;
    use crate::solver::light::Sign;
    use crate::solver::options::Preset;
    use crate::solver::shoot::{Beam, shoot_at};
    use crate::solver::trial::{Trial, all_light, as_clusters};

    /// All light of the Cornell box as clusters, at all vertices.
    #[test]
    fn what_stands_for_a_long_element_is_sampled_more_finely() {
        let trial = Trial::after(1, as_clusters(Preset::Draft));
        let solver = trial.solver();
        let (mesh, light) = (&solver.mesh, &solver.light);
        let sampler = solver.sampler();
        let shooter = all_light(&solver);
        let found = |factor: f64, side: f64| {
            let sampler = Sampler {
                thresholds: sampler.thresholds.scaled(factor),
                ..sampler
            };
            let beam = Beam {
                sampler: &sampler,
                shooter: &shooter,
                sign: Sign::Positive,
            };
            let times = halvings(&shooter, || side);
            let open = (0..mesh.vertices.len() as u32).filter(|v| !mesh.buried[*v as usize]);
            let vertices: Vec<(u32, u32)> = open.map(|v| (v, times)).collect();
            let mut arrived = Arrived::nothing(mesh);
            let rays = shoot_at(mesh, light, beam, &vertices, &mut arrived);
            (arrived.irradiance, rays)
        };
        let (exact, _) = found(0.02, SHORT);
        let error = |(irradiance, rays): (Vec<Spectrum>, u64)| {
            let off = irradiance.iter().zip(&exact);
            let squares = off.map(|(a, b)| a.distance_squared(*b));
            (squares.sum::<f32>().sqrt(), rays)
        };
        let (short, rays_short) = error(found(1.0, SHORT));
        let (long, rays_long) = error(found(1.0, 4.0 * SHORT));
        let (longest, rays_longest) = error(found(1.0, 64.0 * SHORT));
        assert!(rays_long > 2 * rays_short, "{rays_long} of {rays_short}");
        assert!(long < 0.7 * short, "{long} of {short}");
        assert_eq!((longest, rays_longest), (long, rays_long));
    }
}
