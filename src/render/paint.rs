//! From what is seen at the points of a pixel to its colours.

use super::lens::Lens;
use super::lines::{Pen, Stroke};
use super::sight::Seen;
use super::tone::Tone;
use crate::radiometry::{linear, radiance_from_radiosity, srgb};
use glam::{DVec2, DVec3, Vec3};

/// Shade of lines on the light surfaces of the wireframe, and of what is behind them.
const INK: f32 = 0.01;
const PAPER: f32 = 1.0;
/// How much darker the boundary of an element is than its surroundings, in sRGB ...
const MESH_CONTRAST: f32 = 0.22;
/// ... unless these are darker than this: then it is as much brighter.
const MESH_FLIP: f32 = 0.25;

/// Means over a pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pixel {
    pub(super) radiance: Vec3,
    pub(super) irradiance: Vec3,
    /// The fraction of the pixel where there is a surface.
    pub(super) covered: f32,
    /// Display light, linear. The mean of tone-mapped samples: the edge of a bright light stays smooth.
    pub(super) display: Vec3,
    /// Line drawing, linear.
    pub(super) drawing: f32,
    /// As `display`, with the boundaries of elements drawn on it.
    pub(super) meshed: Vec3,
    /// How much of the pixel these boundaries cover.
    pub(super) lined: f32,
}

impl Pixel {
    /// Where there is no surface.
    pub(super) const BACKGROUND: Self = Self {
        radiance: Vec3::ZERO,
        irradiance: Vec3::ZERO,
        covered: 0.0,
        display: Vec3::ZERO,
        drawing: PAPER,
        meshed: Vec3::ZERO,
        lined: 0.0,
    };
}

/// Turns what is seen into pixels.
pub(super) struct Painter<'a> {
    tone: Tone,
    pen: Pen<'a>,
    /// Where the light of the line drawing comes from.
    light: DVec3,
}

impl<'a> Painter<'a> {
    /// The line drawing is lit from behind the eye, above and to the left, so that the walls, floor and ceiling of a
    /// room all have different shades.
    pub(super) fn new(tone: Tone, pen: Pen<'a>, lens: &Lens) -> Self {
        let light = (0.45 * lens.up - 0.3 * lens.right - lens.forward).normalize();
        Self { tone, pen, light }
    }

    /// The mean of the samples of the pixel with this middle; `near` is memory to use again.
    pub(super) fn pixel(
        &self,
        middle: DVec2,
        points: &[DVec2],
        seen: &[Option<Seen>],
        near: &mut Vec<Stroke>,
    ) -> Pixel {
        self.pen.approach(middle, near);
        let mut sum = Pixel::default();
        for (&point, seen) in points.iter().zip(seen) {
            self.add(&mut sum, point, seen.as_ref(), near);
        }
        let share = 1.0 / points.len() as f32;
        Pixel {
            radiance: sum.radiance * share,
            irradiance: sum.irradiance * share,
            covered: sum.covered * share,
            display: sum.display * share,
            drawing: sum.drawing * share,
            meshed: sum.meshed * share,
            lined: sum.lined * share,
        }
    }

    fn add(&self, sum: &mut Pixel, point: DVec2, seen: Option<&Seen>, near: &[Stroke]) {
        let cover = self.pen.cover(near, point, seen);
        let surface = seen.map_or(PAPER, |seen| {
            (0.6 + 0.3 * seen.normal.dot(self.light)) as f32
        });
        sum.drawing += surface + (INK - surface) * cover.wire;
        if let Some(seen) = seen {
            let radiance = radiance_from_radiosity(seen.interpolate(|vertex| vertex.radiosity));
            let display = self.tone.display(radiance);
            sum.radiance += radiance;
            sum.irradiance += seen.interpolate(|vertex| vertex.irradiance);
            sum.covered += 1.0;
            sum.lined += cover.mesh;
            sum.display += display;
            sum.meshed += if cover.mesh > 0.0 {
                contrasted(display, cover.mesh)
            } else {
                display
            };
        }
    }
}

/// A line of this strength on a surface of this colour (both linear).
pub(super) fn contrasted(display: Vec3, strength: f32) -> Vec3 {
    let shade = display.map(srgb);
    let contrast = if shade.max_element() > MESH_FLIP {
        -MESH_CONTRAST
    } else {
        MESH_CONTRAST
    };
    (shade + contrast * strength)
        .clamp(Vec3::ZERO, Vec3::ONE)
        .map(linear)
}
