//! Whether two scenes differ in more than what their surfaces emit, and whether one that was stored is sound.

use super::cameras::names_a_file;
use super::text::quote;
use super::{Camera, Material, Scene, Surface, limits};
use crate::radiometry::Spectrum;
use glam::DVec3;

impl Scene {
    /// Refuses a scene that differs in anything that light depends on but emission; the error says in what.
    pub fn differs_but_in_emission(&self, other: &Scene) -> Result<(), String> {
        if self.surfaces.len() != other.surfaces.len() {
            return Err(format!(
                "{} surfaces, where there were {}",
                other.surfaces.len(),
                self.surfaces.len()
            ));
        }
        if self.metres_per_unit != other.metres_per_unit {
            return Err("its unit is another".into());
        }
        for (number, (known, new)) in self.surfaces.iter().zip(&other.surfaces).enumerate() {
            let polygon = new.polygon + 1;
            let same_corners = self.positions(known).eq(other.positions(new));
            if !same_corners || known.sides != new.sides {
                return Err(format!(
                    "surface {} (of polygon {polygon}) has other corners or sides",
                    number + 1
                ));
            }
            let reflectance = |scene: &Scene, surface: &Surface| {
                scene.materials[surface.material as usize].reflectance
            };
            if reflectance(self, known) != reflectance(other, new) {
                return Err(format!("polygon {polygon} has another reflectance"));
            }
        }
        Ok(())
    }

    /// Checks what a scene that was stored, or built in code, could have wrong and none that was loaded has: indices, coordinates,
    /// materials, the unit and the cameras. Not whether its quads are flat and convex. The error says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        for (number, surface) in self.surfaces.iter().enumerate() {
            self.check_indices(surface)
                .map_err(|found| format!("a surface (number {number}) with {found}"))?;
        }
        // Also false of what is no number.
        let within = |v: &DVec3| v.abs().cmple(DVec3::splat(limits::COORDINATE)).all();
        if let Some(number) = self.vertices.iter().position(|v| !within(v)) {
            let most = limits::COORDINATE;
            let found = self.vertices[number];
            return Err(format!(
                "a vertex (number {number}) that is nowhere: {found}, where coordinates are numbers up to {most:e}"
            ));
        }
        self.materials.iter().try_for_each(Material::check)?;
        check_unit(self.metres_per_unit)?;
        self.cameras.iter().try_for_each(Camera::check)
    }

    fn check_indices(&self, surface: &Surface) -> Result<(), String> {
        let (vertices, materials) = (self.vertices.len(), self.materials.len());
        let corners = surface.corners.indices();
        if let Some(corner) = corners.iter().find(|v| **v as usize >= vertices) {
            return Err(format!("vertex {corner} of {vertices}"));
        }
        match surface.material {
            known if (known as usize) < materials => Ok(()),
            unknown => Err(format!("material {unknown} of {materials}")),
        }
    }
}

/// Checks the length of a stored scene's unit. The error says what was found.
pub(crate) fn check_unit(metres: f64) -> Result<(), String> {
    if limits::UNIT.contains(&metres) {
        return Ok(());
    }
    let (least, most) = (limits::UNIT.start(), limits::UNIT.end());
    Err(format!(
        "a unit of {metres} m, where it has from {least:e} to {most:e}"
    ))
}

impl Material {
    /// Checks that light dies out on it and that what it emits can be summed up. The error says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        let each = |of: Spectrum, fits: &dyn Fn(f32) -> bool| of.to_array().into_iter().all(fits);
        let (reflectance, radiance) = (self.reflectance, self.emitted_radiance);
        let name = quote(&self.name);
        if !each(reflectance, &|of| (0.0..1.0).contains(&of)) {
            return Err(format!(
                "a material {name} with the reflectance {reflectance}, where each channel has from 0 to less than 1"
            ));
        }
        match each(radiance, &|of| (0.0..=limits::RADIANCE).contains(&of)) {
            true => Ok(()),
            false => Err(format!(
                "a material {name} with the emitted radiance {radiance}, where each channel has from 0 to {:e}",
                limits::RADIANCE
            )),
        }
    }
}

impl Camera {
    /// Checks a camera that was stored, as those of scene files are: pictures are written under its name. A view of the whole of a scene may be
    /// from far outside of it, so coordinates need only be finite. The error says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        let sizes = [self.width, self.height];
        let numbers = [self.eye, self.look_at, self.up];
        let rules = [
            (
                names_a_file(&self.name),
                "a name that can be part of a file's",
            ),
            (
                numbers.iter().all(|of| of.is_finite()),
                "finite coordinates",
            ),
            (
                self.horizontal_fov > 0.0 && self.horizontal_fov < 180.0,
                "a field of view between 0 and 180 degrees",
            ),
            (
                sizes.iter().all(|of| (1..=limits::PIXELS).contains(of)),
                "1 to 16384 pixels each way",
            ),
            (
                self.exposure.is_none_or(f64::is_finite),
                "a finite number of stops",
            ),
        ];
        match rules.iter().find(|(holds, _)| !holds) {
            None => Ok(()),
            Some((_, rule)) => Err(format!("a camera {} without {rule}", quote(&self.name))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_of_a_scene_at_the_limit_of_coordinates_is_sound() {
        let limit = DVec3::splat(limits::COORDINATE);
        let far = crate::scene::cameras::overview((-limit, limit));
        assert_eq!(far.check(), Ok(()));
    }

    #[test]
    fn a_material_on_which_light_grows_or_that_is_no_number_is_not_sound() {
        let sound = Material {
            name: "wall".into(),
            reflectance: Spectrum::splat(0.5),
            emitted_radiance: Spectrum::ZERO,
        };
        assert_eq!(sound.check(), Ok(()));
        for wrong in [-0.1, 1.0, f32::NAN, f32::INFINITY] {
            let mut material = sound.clone();
            material.reflectance.y = wrong;
            let found = material.check().expect_err("does not absorb");
            assert!(found.contains("`wall` with the reflectance"), "{found}");
        }
        for wrong in [-1.0, f32::NAN, f32::INFINITY] {
            let mut material = sound.clone();
            material.emitted_radiance.z = wrong;
            let found = material.check().expect_err("cannot be summed up");
            assert!(
                found.contains("`wall` with the emitted radiance"),
                "{found}"
            );
        }
    }

    #[test]
    fn a_camera_that_no_scene_file_may_have_is_not() {
        let sound = crate::scene::cameras::overview((DVec3::ZERO, DVec3::ONE));
        let refused = |spoil: &dyn Fn(&mut Camera), words: &str| {
            let mut camera = sound.clone();
            spoil(&mut camera);
            let found = camera.check().expect_err(words);
            assert!(found.contains(words), "{found}");
        };
        for name in ["", "/tmp/view", "../view", "a\\b", ".hidden", "a\nb"] {
            refused(&|of| name.clone_into(&mut of.name), "part of a file's");
        }
        refused(&|of| of.eye.x = f64::NAN, "finite coordinates");
        refused(&|of| of.look_at.y = f64::INFINITY, "finite coordinates");
        refused(&|of| of.up.z = f64::NAN, "finite coordinates");
        refused(&|of| of.horizontal_fov = 180.0, "field of view");
        refused(&|of| of.horizontal_fov = f64::NAN, "field of view");
        refused(&|of| of.width = 0, "pixels");
        refused(&|of| of.height = limits::PIXELS + 1, "pixels");
        refused(&|of| of.exposure = Some(f64::INFINITY), "stops");
    }

    #[test]
    fn a_unit_has_a_length_that_areas_stay_numbers_in() {
        for metres in [1e-3, 1.0, 0.3048] {
            assert_eq!(check_unit(metres), Ok(()));
        }
        for metres in [0.0, -1.0, 1e-13, 1e13, f64::NAN] {
            check_unit(metres).expect_err("is none");
        }
    }
}
