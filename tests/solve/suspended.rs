//! A panel that hangs below a ceiling: what is above it sees little but its dark back, and yet lies in no solid.

use super::clusters::clustered;
use super::common::closed_form::to_polygon;
use super::common::shapes::{add_grey, add_level, empty};
use super::{draft, engines, solved_by};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::Prober;

/// A floor of 4 m that shines with 1 W/m², a ceiling above it and a panel of 1 m below that.
const FLOOR: [[f64; 2]; 2] = [[-2.0, -2.0], [2.0, 2.0]];
const CEILING: f64 = 3.0;
const PANEL: [[f64; 2]; 2] = [[-0.5, -0.5], [0.5, 0.5]];
const GAP: f64 = 0.1;

fn scene() -> Scene {
    let mut scene = empty();
    let black = add_grey(&mut scene, 0.0, 0.0);
    let light = add_grey(&mut scene, 0.0, 1.0);
    add_level(&mut scene, light, FLOOR, 0.0, true);
    add_level(&mut scene, black, FLOOR, CEILING, false);
    add_level(&mut scene, black, PANEL, CEILING - GAP, false);
    scene
}

/// What the ceiling would receive without the panel.
fn unoccluded(point: DVec3) -> f64 {
    let [[x0, z0], [x1, z1]] = FLOOR;
    let corners = [(x0, z0), (x1, z0), (x1, z1), (x0, z1)].map(|(x, z)| DVec3::new(x, 0.0, z));
    to_polygon(point, DVec3::NEG_Y, &corners)
}

/// The floor is hidden from all that is no farther than 0.3 m from the middle: the panel ends at two gaps from there.
#[test]
fn the_ceiling_above_a_panel_is_dark() {
    let places = [-0.3, -0.1, 0.05, 0.2, 0.3];
    for engine in engines() {
        for options in [draft(), clustered(draft())] {
            let solution = solved_by(&scene(), options, engine, 0);
            let prober = Prober::new(&solution);
            for (x, z) in places.iter().flat_map(|x| places.map(|z| (*x, z))) {
                let point = DVec3::new(x, CEILING, z);
                let found = prober.probe(point, DVec3::NEG_Y).expect("on the ceiling");
                let lit = f64::from(found.irradiance.x) / unoccluded(point);
                assert!(
                    lit.abs() < 0.1,
                    "{engine}: {lit:.3} of the light at {x}, {z}"
                );
            }
        }
    }
}
