//! One look through a camera, and the pictures it gives.

use super::lens::Lens;
use super::lines::Pen;
use super::options::RenderOptions;
use super::paint::{Painter, Pixel};
use super::picture::Picture;
use super::sight::Sight;
use super::tone::{Tone, quantise};
use super::trace::{Tracer, pattern};
use crate::radiometry::srgb;
use crate::scene::Camera;
use crate::solution::LitMesh;
use crate::visibility::{Triangles, Visibility};
use glam::Vec3;

/// What a camera sees of a solution.
#[derive(Debug, Clone)]
pub struct View {
    width: u32,
    height: u32,
    tone: Tone,
    pixels: Vec<Pixel>,
}

impl View {
    /// Looks at `mesh` through `camera`.
    ///
    /// `build` makes the engine that answers who is nearest among the given triangles; it is not called where no
    /// surface faces the camera: then there is only background.
    ///
    /// # Errors
    /// When `build` fails.
    pub fn new<E>(
        mesh: &LitMesh,
        camera: &Camera,
        options: &RenderOptions,
        build: impl FnOnce(Triangles) -> Result<Box<dyn Visibility>, E>,
    ) -> Result<Self, E> {
        let lens = Lens::new(camera);
        let (sight, triangles) = Sight::new(mesh, lens.eye);
        let (width, height) = (camera.width, camera.height);
        if triangles.indices.is_empty() {
            let pixels = vec![Pixel::BACKGROUND; width as usize * height as usize];
            return Ok(Self {
                width,
                height,
                tone: Tone::new(camera.exposure.unwrap_or(0.0)),
                pixels,
            });
        }
        let engine = build(triangles)?;
        let tracer = Tracer {
            sight: &sight,
            lens: &lens,
            engine: engine.as_ref(),
        };
        let tone = camera
            .exposure
            .map_or_else(|| tracer.meter(width, height), Tone::new);
        let painter = Painter::new(tone, Pen::new(&lens, options, &sight), &lens);
        let pixels = tracer.paint(width, height, &pattern(options.samples_per_side), &painter);
        Ok(Self {
            width,
            height,
            tone,
            pixels,
        })
    }

    /// The exposure of the tone-mapped pictures: the camera's, or what suits the picture.
    pub fn exposure(&self) -> f64 {
        self.tone.exposure()
    }

    /// Radiance (W m⁻² sr⁻¹, linear Rec. 709) and, as alpha, the fraction of the pixel that is covered by surfaces;
    /// premultiplied: the background is 0.
    pub fn radiance(&self) -> Picture<[f32; 4]> {
        self.picture(|pixel, _, _| pixel.radiance.extend(pixel.covered).to_array())
    }

    /// What the screen shows of the light, on black.
    pub fn shaded(&self) -> Picture<[u8; 3]> {
        self.picture(|pixel, x, y| dithered(pixel.display, x, y))
    }

    /// The edges of the input polygons, dark on light surfaces without light or colour of their own, on white.
    pub fn wireframe(&self) -> Picture<[u8; 3]> {
        self.picture(|pixel, _, _| [(255.0 * srgb(pixel.drawing)).round() as u8; 3])
    }

    /// As [`View::shaded`], with the boundaries of the elements as thin lines: darker than what they lie on, or
    /// brighter where that is dark. They fade where elements measure only a few pixels.
    pub fn mesh(&self) -> Picture<[u8; 3]> {
        self.picture(|pixel, x, y| dithered(pixel.meshed, x, y))
    }

    fn picture<P>(&self, colour: impl Fn(&Pixel, u32, u32) -> P) -> Picture<P> {
        let places = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let pixels = self
            .pixels
            .iter()
            .zip(places)
            .map(|(pixel, (x, y))| colour(pixel, x, y))
            .collect();
        Picture {
            width: self.width,
            height: self.height,
            pixels,
        }
    }
}

/// Display light as sRGB in 8 bits.
fn dithered(display: Vec3, x: u32, y: u32) -> [u8; 3] {
    display
        .map(srgb)
        .to_array()
        .map(|value| quantise(value, x, y))
}
