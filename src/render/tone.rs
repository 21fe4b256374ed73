//! From radiance to what a screen shows.

use crate::radiometry::{LUMINANCE_WEIGHTS, Spectrum, radiance_from_radiosity, srgb};
use crate::solution::LitMesh;
use glam::Vec3;

/// Up to here a screen shows radiance in proportion; brighter things approach white.
const KNEE: f32 = 0.6;
/// What automatic exposure makes of the logarithmic mean.
const KEY: f64 = 0.2;
/// What is darker than this fraction of the brightest does not count as lit.
const DARK: f64 = 1e-3;

/// The way from radiance to display: exposure, then per channel a straight line up to 0.6 and, smoothly joined to it,
/// `0.6 + 0.4 (1 - exp(-(x - 0.6) / 0.4))` above, which never reaches 1: lights fade to white instead of clipping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    exposure: f64,
    gain: f32,
}

impl Tone {
    /// Multiplies radiance by 2^`exposure`: the result is what the screen shows, 1 being its white.
    pub fn new(exposure: f64) -> Self {
        Self {
            exposure,
            gain: exposure.exp2() as f32,
        }
    }

    /// The exposure that suits a whole solution, every piece of surface counted by its area.
    pub fn for_mesh(mesh: &LitMesh) -> Self {
        let samples = mesh.triangles.iter().map(|triangle| {
            let corners = triangle.vertices.map(|index| mesh.vertices[index as usize]);
            let [a, b, c] = corners.map(|corner| mesh.positions[corner.position as usize]);
            Metered {
                radiosity: corners
                    .iter()
                    .map(|corner| corner.radiosity)
                    .sum::<Spectrum>()
                    / 3.0,
                irradiance: corners
                    .iter()
                    .map(|corner| corner.irradiance)
                    .sum::<Spectrum>()
                    / 3.0,
                weight: 0.5 * (b - a).cross(c - a).length(),
            }
        });
        Self::metered(&samples.collect::<Vec<_>>())
    }

    /// Brings the logarithmic mean of the luminance of what is lit to a fifth of white. Lights do not count unless
    /// there is nothing else: they give themselves away by a radiosity above their irradiance, as ρ < 1. Where all is
    /// dark, 0.
    pub(super) fn metered(samples: &[Metered]) -> Self {
        let reflecting = samples.iter().filter(|sample| !sample.emits());
        let mean = log_mean(reflecting).or_else(|| log_mean(samples.iter()));
        Self::new(mean.map_or(0.0, |mean| (KEY / mean).log2()))
    }

    /// The exponent that radiance is multiplied by 2 to the power of, for [`crate::scene::Camera::exposure`].
    pub fn exposure(self) -> f64 {
        self.exposure
    }

    /// Display light, linear, 0 to 1 per channel.
    pub fn display(self, radiance: Spectrum) -> Vec3 {
        (radiance * self.gain).map(|x| {
            if x > KNEE {
                KNEE + (1.0 - KNEE) * (1.0 - (-(x - KNEE) / (1.0 - KNEE)).exp())
            } else {
                x.max(0.0)
            }
        })
    }

    /// The 8-bit sRGB colour of a single thing, such as a vertex.
    pub fn colour(self, radiance: Spectrum) -> [u8; 3] {
        self.display(radiance)
            .to_array()
            .map(|x| (255.0 * srgb(x)).round() as u8)
    }
}

/// What the exposure meter sees at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Metered {
    pub(super) radiosity: Spectrum,
    pub(super) irradiance: Spectrum,
    /// How much of the whole it stands for.
    pub(super) weight: f64,
}

impl Metered {
    fn emits(&self) -> bool {
        self.radiosity.cmpgt(self.irradiance).any()
    }

    /// Luminance of the leaving radiance, by the weights of Rec. 709.
    fn luminance(&self) -> f64 {
        f64::from(radiance_from_radiosity(self.radiosity).dot(LUMINANCE_WEIGHTS))
    }
}

/// The weighted geometric mean of the luminance of what is lit; `None` if nothing is.
fn log_mean<'a>(samples: impl Iterator<Item = &'a Metered> + Clone) -> Option<f64> {
    let threshold = DARK * samples.clone().map(Metered::luminance).fold(0.0, f64::max);
    let lit = samples.filter(|sample| sample.luminance() > threshold);
    let (sum, weight) = lit.fold((0.0, 0.0), |(sum, weight), sample| {
        (
            sum + sample.weight * sample.luminance().ln(),
            weight + sample.weight,
        )
    });
    (weight > 0.0).then(|| (sum / weight).exp())
}

/// `value` (0 to 1) in 8 bits. What lies between two steps alternates between them in an 8 x 8 pattern (Bayer's), so
/// a slow gradient shows no bands; what lies on a step stays on it.
pub(super) fn quantise(value: f32, x: u32, y: u32) -> u8 {
    let rank = (0..3).fold(0, |rank, bit| {
        let (x, y) = (x >> bit & 1, y >> bit & 1);
        rank << 2 | (x ^ y) << 1 | y
    });
    (255.0 * value + (rank as f32 + 0.5) / 64.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(radiosity: f32, irradiance: f32) -> Metered {
        Metered {
            radiosity: Spectrum::splat(radiosity),
            irradiance: Spectrum::splat(irradiance),
            weight: 1.0,
        }
    }

    #[test]
    fn srgb_has_its_published_values() {
        for (linear, encoded) in [
            (0.0, 0.0),
            (0.002, 0.02584),
            (0.18, 0.46135),
            (0.5, 0.73536),
            (1.0, 1.0),
        ] {
            assert!((srgb(linear) - encoded).abs() < 1e-5, "{linear}");
            assert!(
                (crate::radiometry::linear(encoded) - linear).abs() < 1e-4,
                "{encoded}"
            );
        }
    }

    #[test]
    fn exposure_is_in_stops_and_the_curve_is_straight_up_to_the_knee() {
        let radiance = Spectrum::new(0.1, 0.05, 0.0);
        assert_eq!(Tone::new(2.0).display(radiance), 4.0 * radiance);
        assert_eq!(Tone::new(-1.0).display(radiance), 0.5 * radiance);
    }

    #[test]
    fn the_shoulder_is_smooth_rises_and_stays_below_white() {
        let at = |x: f32| Tone::new(0.0).display(Spectrum::splat(x)).x;
        let slope = (at(KNEE + 1e-3) - at(KNEE)) / 1e-3;
        assert!((slope - 1.0).abs() < 0.01, "{slope}");
        assert!(at(1.0) < at(2.0) && at(2.0) < at(3.0) && at(1e9) <= 1.0);
        assert_eq!(
            Tone::new(0.0).colour(Spectrum::new(1e9, f32::INFINITY, -1.0)),
            [255, 255, 0]
        );
    }

    #[test]
    fn lights_do_not_set_the_exposure_unless_they_are_alone() {
        let wall = grey(std::f32::consts::PI / 10.0, 1.0);
        let light = grey(1000.0, 0.5);
        assert!((Tone::metered(&[wall, light]).exposure() - 1.0).abs() < 1e-5);
        assert!(Tone::metered(&[light]).exposure() < -9.0);
    }

    #[test]
    fn darkness_does_not_set_the_exposure() {
        let wall = grey(std::f32::consts::PI / 5.0, 1.0);
        assert!(
            Tone::metered(&[wall, grey(0.0, 0.0), grey(1e-9, 1e-8)])
                .exposure()
                .abs()
                < 1e-5
        );
        assert_eq!(Tone::metered(&[grey(0.0, 0.0)]).exposure(), 0.0);
        assert_eq!(Tone::metered(&[]).exposure(), 0.0);
    }

    #[test]
    fn dither_keeps_steps_and_averages_between_them() {
        let sum = |value: f32| {
            (0..64)
                .map(|i| u32::from(quantise(value, i % 8, i / 8)))
                .sum::<u32>()
        };
        for step in 0..=255 {
            assert_eq!(sum(step as f32 / 255.0), 64 * step);
        }
        assert_eq!(sum(100.25 / 255.0), 64 * 100 + 16);
    }
}
