//! Cameras, where they stand in the scene.

use super::Noticed;
use super::nodes::Placed;
use crate::scene::cameras::{DEFAULT_SIZE, LONGEST_NAME, names_a_file};
use crate::scene::{Camera, limits};
use ::gltf::camera::Projection;
use glam::DVec3;

/// The perspective cameras of the nodes.
pub(super) fn cameras(placed: &[Placed], noticed: &mut Noticed) -> Vec<Camera> {
    let mut cameras: Vec<Camera> = Vec::new();
    for node in placed {
        let Some(camera) = node.node.camera() else {
            continue;
        };
        let Projection::Perspective(lens) = camera.projection() else {
            noticed.orthographic += 1;
            continue;
        };
        let name = node.node.name().or(camera.name()).unwrap_or_default();
        let aspect = f64::from(lens.aspect_ratio().unwrap_or(4.0 / 3.0));
        let fov = 2.0 * (aspect * (f64::from(lens.yfov()) / 2.0).tan()).atan();
        cameras.extend(view(node, aspect, fov.to_degrees()).map(|view| Camera {
            name: unique(name, &cameras),
            ..view
        }));
    }
    cameras
}

/// A camera looks along its own -z, with its y up; `None` if its numbers make no sense.
fn view(node: &Placed, aspect: f64, horizontal_fov: f64) -> Option<Camera> {
    let eye = node.to_scene.transform_point3(DVec3::ZERO);
    let axis = |axis| node.to_scene.transform_vector3(axis).try_normalize();
    let (forward, up) = (axis(DVec3::NEG_Z)?, axis(DVec3::Y)?);
    let width = DEFAULT_SIZE.0;
    let height = (f64::from(width) / aspect).round();
    let fine = horizontal_fov > 0.0
        && horizontal_fov < 180.0
        && (1.0..=f64::from(limits::PIXELS)).contains(&height)
        && forward.cross(up).length() > 1e-6
        && eye.abs().max_element() <= 1e9;
    fine.then(|| Camera {
        name: String::new(),
        eye,
        look_at: eye + forward,
        up,
        horizontal_fov,
        width,
        height: height as u32,
        exposure: None,
    })
}

/// The name, or one that a folder of pictures can have, with a number if it is taken.
fn unique(name: &str, taken: &[Camera]) -> String {
    let has_room = name.len() + " 1000000".len() <= LONGEST_NAME;
    let plain = match names_a_file(name) && has_room {
        true => name.to_owned(),
        false => format!("camera {}", taken.len() + 1),
    };
    let mut name = plain.clone();
    let mut number = 2;
    while taken.iter().any(|camera| camera.name == name) {
        name = format!("{plain} {number}");
        number += 1;
    }
    name
}
