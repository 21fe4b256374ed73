//! Where two walls meet: light right into the corner.

use super::common::closed_form::to_polygon;
use super::common::shapes::{add_grey, add_level, add_quad, empty};
use super::{engines, solved_by};
use glam::DVec3;
use radiosity::solution::Prober;
use radiosity::solver::Preset;

/// A floor of 2 m by 2 m, and on its edge x = 0 a wall of 1 m by 2 m that emits 1 W/m².
#[test]
fn the_floor_beside_a_luminous_wall_is_right_up_to_the_edge() {
    let mut scene = empty();
    let light = add_grey(&mut scene, 0.0, 1.0);
    let black = add_grey(&mut scene, 0.0, 0.0);
    let wall = [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)].map(|(y, z)| DVec3::new(0.0, y, z));
    add_quad(&mut scene, light, wall);
    add_level(&mut scene, black, [[0.0, 0.0], [2.0, 2.0]], 0.0, true);
    for engine in engines() {
        let solution = solved_by(&scene, Preset::Standard.options(), engine, 0);
        let prober = Prober::new(&solution);
        for distance in [1e-4, 1e-3, 0.003, 0.01, 0.03, 0.1, 0.3] {
            for z in [0.31, 0.9, 1.47] {
                let point = DVec3::new(distance, 0.0, z);
                let exact = to_polygon(point, DVec3::Y, &wall);
                let found = prober.probe(point, DVec3::Y).expect("on the floor");
                let error = f64::from(found.irradiance.x) / exact - 1.0;
                assert!(
                    error.abs() < 0.01,
                    "{distance} from the edge, z {z}: {error:.4} by {engine}"
                );
            }
        }
    }
}
