//! Whether two scenes differ in more than what their surfaces emit, and whether one that was stored is sound.

use super::{Scene, Surface};

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
            if self.corners(known) != other.corners(new) || known.sides != new.sides {
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

    fn corners(&self, surface: &Surface) -> Vec<glam::DVec3> {
        let corners = surface.corners.indices().iter();
        corners.map(|v| self.vertices[*v as usize]).collect()
    }

    /// Checks the indices of a scene that was stored. The error says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        let vertices = self.vertices.len() as u64;
        let sound = |surface: &Surface| {
            let corners = surface.corners.indices().iter();
            (surface.material as usize) < self.materials.len()
                && corners.into_iter().all(|v| u64::from(*v) < vertices)
        };
        if !self.surfaces.iter().all(sound) {
            return Err("a surface whose corners or material are out of range".into());
        }
        if !self.vertices.iter().all(|v| v.is_finite()) {
            return Err("a corner that is nowhere".into());
        }
        Ok(())
    }
}
