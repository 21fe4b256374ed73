//! The quantities of light and their units.
//!
//! Every spectral quantity is three linear Rec. 709 channels. Irradiance E, exitance M and radiosity
//! B = M + ρE are in W/m² (or lm/m², if the emitters were given in lumens); power is in W.

use std::f64::consts::PI;

/// Three linear Rec. 709 channels, for what is stored per vertex.
pub type Spectrum = glam::Vec3;

/// Three channels in double precision, for sums over a scene (power, ledgers).
pub type Power = glam::DVec3;

/// Exitance M = πL of a diffuse emitter of radiance L (W m⁻² sr⁻¹).
pub fn exitance_from_radiance(radiance: Spectrum) -> Spectrum {
    radiance * PI as f32
}

/// Leaving radiance L = B/π of a diffuse surface of radiosity B.
pub fn radiance_from_radiosity(radiosity: Spectrum) -> Spectrum {
    radiosity / PI as f32
}
