//! `KHR_lights_punctual`: lights without extent, which no surface can be; refused, or made small surfaces on request.

use super::file::File;
use super::nodes::Placed;
use super::{Building, Reading, watts};
use crate::scene::{SceneError, limits};
use ::gltf::khr_lights_punctual::Kind;
use glam::DVec3;
use std::f64::consts::PI;

/// The lights to be made surfaces of.
pub(super) struct Lights {
    list: Vec<Lamp>,
    radius: f64,
    metres_per_unit: f64,
    left_out: usize,
}

/// A light where it stands.
struct Lamp {
    name: String,
    place: DVec3,
    /// Where a spot light points; `None` for one that shines all around.
    axis: Option<DVec3>,
    /// W/sr.
    intensity: DVec3,
}

impl Lights {
    /// Refuses lights that the settings do not speak of, and those that shine from nowhere.
    pub fn of(file: &File, placed: &[Placed], how: Reading) -> Result<Self, SceneError> {
        let mut lights = Self {
            list: Vec::new(),
            radius: how.point_light_radius.unwrap_or_default(),
            metres_per_unit: how.metres_per_unit,
            left_out: 0,
        };
        let found = placed.iter().filter(|node| node.node.light().is_some());
        let count = found.clone().count();
        if how.point_light_radius.is_none() && count > 0 {
            let found = format!("{count} lights that have no surface (KHR_lights_punctual)");
            let expected = "emitting materials instead; or in a scene.toml `point_light_radius`, the radius of \
                            the spheres to put there, or 0 to leave such lights out";
            return Err(file.error(found, expected));
        }
        if lights.radius == 0.0 {
            lights.left_out = count;
            return Ok(lights);
        }
        for node in found {
            lights.list.extend(Lamp::of(file, node, lights.radius)?);
        }
        Ok(lights)
    }

    /// Adds a sphere of triangles for a light that shines all around, a square for a spot.
    pub fn shine(&self, building: &mut Building) {
        building.noticed.lights = self.left_out;
        for lamp in &self.list {
            building.group(Some(&lamp.name));
            let polygons = match lamp.axis {
                None => sphere(lamp.place, self.radius),
                Some(axis) => vec![square(lamp.place, axis, self.radius)],
            };
            let area: f64 = polygons.iter().map(|polygon| area(polygon)).sum();
            // A sphere gives 4π times its intensity, π times its radiance and area; a square along its axis its radiance times its area.
            let share = if lamp.axis.is_none() { 4.0 } else { 1.0 };
            building.noticed.spots += usize::from(lamp.axis.is_some());
            let radiance = share * lamp.intensity / (area * self.metres_per_unit.powi(2));
            let material = building.palette.light(lamp.name.clone(), radiance);
            for polygon in polygons {
                let corners: Vec<u32> = polygon.iter().map(|p| building.welder.index(*p)).collect();
                building.push(corners, material);
            }
        }
    }
}

impl Lamp {
    fn of(file: &File, placed: &Placed, radius: f64) -> Result<Option<Self>, SceneError> {
        let Some(light) = placed.node.light() else {
            return Ok(None);
        };
        let axis = match light.kind() {
            Kind::Point => None,
            Kind::Spot { .. } => {
                let forward = placed.to_scene.transform_vector3(DVec3::NEG_Z);
                Some(forward.normalize_or(DVec3::NEG_Y))
            }
            Kind::Directional => {
                let found = "a directional light (KHR_lights_punctual), which is nowhere";
                return Err(file.error(found, "a large emitting surface instead"));
            }
        };
        let place = placed.to_scene.transform_point3(DVec3::ZERO);
        if place.is_nan() || place.abs().max_element() + radius > limits::COORDINATE {
            let found = format!("a light at {place} (KHR_lights_punctual)");
            let expected = format!("finite coordinates, at most {:e}", limits::COORDINATE);
            return Err(file.error(found, &expected));
        }
        let colour = DVec3::from(light.color().map(f64::from));
        let name = placed.node.name().or(light.name()).unwrap_or("light");
        Ok(Some(Self {
            name: name.to_owned(),
            place,
            axis,
            intensity: watts(colour * f64::from(light.intensity())),
        }))
    }
}

fn area(polygon: &[DVec3]) -> f64 {
    let triangles = polygon[1..].windows(2);
    let doubled = triangles.map(|side| (side[0] - polygon[0]).cross(side[1] - polygon[0]));
    doubled.sum::<DVec3>().length() / 2.0
}

/// An icosahedron, counter-clockwise seen from outside.
fn sphere(centre: DVec3, radius: f64) -> Vec<Vec<DVec3>> {
    const FACES: [[usize; 3]; 20] = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let corner = |number: usize| {
        let (one, long) = ([-1.0, 1.0][number % 2], [golden, -golden][number % 4 / 2]);
        let place = match number / 4 {
            0 => DVec3::new(one, long, 0.0),
            1 => DVec3::new(0.0, one, long),
            _ => DVec3::new(long, 0.0, one),
        };
        centre + radius * place.normalize()
    };
    FACES.map(|face| face.map(corner).to_vec()).to_vec()
}

/// A square with the area of a disk of that radius, its front along `axis`.
fn square(centre: DVec3, axis: DVec3, radius: f64) -> Vec<DVec3> {
    let (u, v) = axis.any_orthonormal_pair();
    let half = radius * PI.sqrt() / 2.0;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(a, b)| centre + half * (a * u + b * v));
    corners.to_vec()
}
