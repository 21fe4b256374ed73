//! A look at a solution, and the picture it gives.

use super::exhibit::Exhibit;
use crate::radiometry::photometric;
use crate::render::{Picture, Place, RenderOptions, View, legend, round_above};
use crate::scene::Camera;

/// The tallest legend, in pixels.
const LEGEND: u32 = 420;

/// What the colours of a picture stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The light as an eye sees it.
    Light,
    /// Illuminance, lx, in false colours.
    Illuminance,
    /// Radiosity, W/m², mean of the channels, in false colours.
    Radiosity,
}

impl Quantity {
    pub(super) fn next(self) -> Self {
        match self {
            Self::Light => Self::Illuminance,
            Self::Illuminance => Self::Radiosity,
            Self::Radiosity => Self::Light,
        }
    }
}

/// How much work a picture is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fineness {
    /// One ray for a square of pixels with this side.
    Coarse(u32),
    /// As `radiosity render` draws.
    Full,
}

/// What is to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// From where, how large, how bright.
    pub camera: Camera,
    /// What the colours stand for.
    pub quantity: Quantity,
    /// Whether the boundaries of the elements are shown.
    pub elements: bool,
    /// By how many stops the scale of false colours is shorter than what suits the solution.
    pub shorter: f64,
}

/// A picture for the window.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// May be smaller than the window, and is stretched then.
    pub picture: Picture<[u8; 3]>,
    /// To be laid over it on the right.
    pub legend: Option<Picture<[u8; 3]>>,
    /// Stops of the exposure, whether it shows or not.
    pub exposure: f64,
}

impl Look {
    /// Draws it from a place where its camera stands; `None` once it is no longer `wanted`.
    pub fn draw(
        &self,
        exhibit: &Exhibit,
        place: &Place,
        fineness: Fineness,
        wanted: &(dyn Fn() -> bool + Sync),
    ) -> Option<Frame> {
        let (camera, options) = self.as_fine_as(fineness);
        let view = place.view(&camera, &options, wanted)?;
        let scale = self.scale(exhibit);
        let picture = match (scale, self.elements) {
            (None, false) => view.shaded(),
            (None, true) => view.mesh(),
            (Some((top, _)), elements) => self.false_colours(&view, exhibit, top, elements),
        };
        let height = self.camera.height.min(LEGEND);
        Some(Frame {
            picture,
            legend: scale.map(|(top, unit)| legend(top, unit, height)),
            exposure: view.exposure(),
        })
    }

    fn as_fine_as(&self, fineness: Fineness) -> (Camera, RenderOptions) {
        let (side, options) = match fineness {
            Fineness::Full => (1, RenderOptions::standard()),
            Fineness::Coarse(side) => (
                side.max(1),
                RenderOptions {
                    samples_per_side: 1,
                    ..RenderOptions::standard()
                },
            ),
        };
        let camera = Camera {
            width: self.camera.width.div_ceil(side),
            height: self.camera.height.div_ceil(side),
            ..self.camera.clone()
        };
        (camera, options)
    }

    /// The end of the scale of false colours and its unit.
    fn scale(&self, exhibit: &Exhibit) -> Option<(f64, &'static str)> {
        let (level, unit) = match self.quantity {
            Quantity::Light => return None,
            Quantity::Illuminance => (exhibit.illuminance, "lx"),
            Quantity::Radiosity => (exhibit.radiosity, "W/m2"),
        };
        Some((round_above(level * (-self.shorter).exp2()), unit))
    }

    fn false_colours(
        &self,
        view: &View,
        exhibit: &Exhibit,
        top: f64,
        elements: bool,
    ) -> Picture<[u8; 3]> {
        view.false_colours(top, elements, |radiosity, irradiance| match self.quantity {
            Quantity::Illuminance => photometric(irradiance, exhibit.efficacy),
            _ => f64::from(radiosity.element_sum()) / 3.0,
        })
    }
}

impl Frame {
    /// Fills a window of this size, row by row from the top: 8 bits of red, green and blue from the 17th bit down.
    pub fn fill(&self, window: &mut [u32], width: u32, height: u32) {
        let picture = &self.picture;
        for (y, row) in window.chunks_exact_mut(width.max(1) as usize).enumerate() {
            let from = (y as u64 * u64::from(picture.height) / u64::from(height)) as u32;
            for (x, pixel) in row.iter_mut().enumerate() {
                let column = (x as u64 * u64::from(picture.width) / u64::from(width)) as u32;
                *pixel = packed(*picture.at(column, from));
            }
        }
        if let Some(legend) = &self.legend {
            let left = width.saturating_sub(legend.width);
            let top = height.saturating_sub(legend.height) / 2;
            for y in 0..legend.height.min(height) {
                for x in 0..legend.width.min(width) {
                    window[((top + y) * width + left + x) as usize] = packed(*legend.at(x, y));
                }
            }
        }
    }
}

fn packed([red, green, blue]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, red, green, blue])
}
