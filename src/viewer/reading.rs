//! The light at a point that somebody clicked on.

use super::exhibit::Exhibit;
use super::look::Look;
use crate::radiometry::{Spectrum, photometric};
use crate::render::{Place, Sighting};
use crate::visibility::{EngineChoice, VisibilityError, build};
use glam::DVec2;
use std::fmt;

/// The light at a point of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Where, and how much.
    pub sighting: Sighting,
    /// Illuminance, lx.
    pub illuminance: f64,
    /// What the surface is called; empty if it has no name.
    pub surface: String,
}

impl Reading {
    /// What a look shows at a point of its picture, in pixels from the upper left corner; `None` where there is nothing. A single
    /// ray needs no tree: every triangle is asked, in double precision.
    ///
    /// # Errors
    /// When the mesh cannot be traced.
    pub fn take(
        exhibit: &Exhibit,
        look: &Look,
        at: DVec2,
    ) -> Result<Option<Self>, VisibilityError> {
        let engine = |triangles| build(EngineChoice::BruteForce, &triangles, 1);
        let place = Place::new(&exhibit.lit, look.camera.eye, engine)?;
        let sighting = place.sighting(&look.camera, at);
        Ok(sighting.map(|sighting| {
            let triangle = &exhibit.lit.triangles[sighting.triangle as usize];
            Self {
                illuminance: photometric(sighting.irradiance, exhibit.efficacy),
                surface: exhibit.labels.polygon(triangle.polygon),
                sighting,
            }
        }))
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Sighting {
            point,
            radiosity,
            irradiance,
            ..
        } = self.sighting;
        write!(
            f,
            "{} lx, irradiance {} W/m2, radiosity {} W/m2 at {:.6},{:.6},{:.6}",
            short(self.illuminance),
            channels(irradiance),
            channels(radiosity),
            point.x,
            point.y,
            point.z
        )?;
        match self.surface.as_str() {
            "" => Ok(()),
            surface => write!(f, " on {surface}"),
        }
    }
}

fn channels(spectrum: Spectrum) -> String {
    let parts = spectrum.to_array().map(|c| short(f64::from(c)));
    parts.join(" ")
}

/// Four digits.
fn short(value: f64) -> String {
    let digits = match value.abs() {
        size if size > 0.0 => 3 - size.log10().floor() as i32,
        _ => 0,
    };
    format!("{value:.*}", digits.clamp(0, 9) as usize)
}
