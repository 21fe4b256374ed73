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

/// Weights of the channels in luminance: the middle row of the matrix from linear Rec. 709 to CIE XYZ.
pub const LUMINANCE_WEIGHTS: Spectrum = Spectrum::new(0.2126, 0.7152, 0.0722);

/// Lumens per watt of white light whose three channels are equal: 179, what Radiance assumes (its `WHTEFFICACY`) for
/// energy spread evenly over the visible spectrum. A scene whose emitters are given in lumens has an efficacy of 1.
pub const WHITE_EFFICACY: f64 = 179.0;

/// Illuminance in lux of an irradiance (W/m²): `efficacy` lumens per watt times the weighted sum of the channels.
/// Exitance in lm/m² and, of a radiance, luminance in cd/m² follow in the same way.
pub fn photometric(irradiance: Spectrum, efficacy: f64) -> f64 {
    efficacy * irradiance.as_dvec3().dot(LUMINANCE_WEIGHTS.as_dvec3())
}

/// The sRGB transfer function (IEC 61966-2-1): what a picture holds of linear light from 0 to 1.
pub fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// The inverse of [`srgb`].
pub fn linear(srgb: f32) -> f32 {
    if srgb <= 0.040_45 {
        srgb / 12.92
    } else {
        ((srgb + 0.055) / 1.055).powf(2.4)
    }
}
