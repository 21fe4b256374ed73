//! A long duct: its walls are strips, along which the light falls off over their width.

use super::common::shapes::{add_cuboid, add_grey, add_quad, empty};
use super::{draft, solved};
use glam::DVec3;
use radiosity::solution::Prober;

const LENGTH: f64 = 30.0;

/// 1 m wide and high; reflects a half.
const WIDE: [DVec3; 2] = [DVec3::ZERO, DVec3::new(1.0, 1.0, LENGTH)];

/// Along the middle of a wall: metres from the light, and the irradiance there for one of 1 W/m², by an independent path tracer that
/// stops by chance alone; its standard error is below 0.2 %.
const KNOWN: [[f64; 2]; 6] = [
    [0.3, 0.38805],
    [0.6, 0.25070],
    [1.0, 0.14362],
    [1.5, 0.07609],
    [2.2, 0.03467],
    [3.1, 0.01445],
];

#[test]
fn light_falls_off_along_a_duct_as_it_should() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 0.0);
    let light = add_grey(&mut scene, 0.0, 1.0);
    add_cuboid(&mut scene, grey, WIDE, true);
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    // One end shines, the other is as good as open.
    scene.surfaces.retain(|surface| {
        let is_end = |v: &u32| scene.vertices[*v as usize].z == 0.0;
        !surface.corners.indices().iter().all(is_end)
    });
    let end = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
    add_quad(&mut scene, light, end);
    let solution = solved(&scene, draft());
    let prober = Prober::new(&solution);
    for [z, expected] in KNOWN {
        let point = DVec3::new(0.0, 0.5, z);
        let found = prober.probe(point, DVec3::X).expect("lies on a wall");
        let error = f64::from(found.irradiance.x) / expected - 1.0;
        assert!(error.abs() < 0.06, "{z} m from the light: {error:+.3}");
    }
}
