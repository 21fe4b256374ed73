//! One look through a camera, and the pictures it gives.

use super::false_colour::colour as false_colour;
use super::options::RenderOptions;
use super::paint::{Pixel, contrasted};
use super::picture::Picture;
use super::place::Place;
use super::tone::{Tone, quantise};
use crate::radiometry::{Spectrum, linear, srgb};
use crate::scene::Camera;
use crate::solution::LitMesh;
use crate::visibility::{Triangles, Visibility};
use glam::Vec3;
use std::f32::consts::PI;

/// What a camera sees of a solution.
#[derive(Debug, Clone)]
pub struct View {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) tone: Tone,
    pub(super) pixels: Vec<Pixel>,
}

impl View {
    /// Memory that the pictures of a camera take until they are written, about: the view's own, the radiance, and what writing it holds.
    pub fn bytes_for(camera: &Camera) -> u64 {
        let pixels = u64::from(camera.width) * u64::from(camera.height);
        pixels * (size_of::<Pixel>() + 2 * size_of::<[f32; 4]>()) as u64
    }

    /// Looks at `mesh` through `camera`.
    ///
    /// `build` makes the engine that answers who is nearest among the given triangles; it is not called where no
    /// surface faces the camera: then there is only background.
    ///
    /// # Errors
    /// When `build` fails.
    ///
    /// # Panics
    /// If the camera's eye is no number; [`Camera::check`] tells whether a camera that was made in code is sound.
    pub fn new<E>(
        mesh: &LitMesh,
        camera: &Camera,
        options: &RenderOptions,
        build: impl FnOnce(Triangles) -> Result<Box<dyn Visibility>, E>,
    ) -> Result<Self, E> {
        let place = Place::new(mesh, camera.eye, build)?;
        Ok(place
            .view(camera, options, &|| true)
            .expect("it is wanted to the end"))
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

    /// What `value` makes of radiosity and irradiance (W/m², means over what the pixel shows of surfaces), in false colours from 0
    /// to `top`, on black; with the boundaries of the elements if `meshed`.
    pub fn false_colours(
        &self,
        top: f64,
        meshed: bool,
        value: impl Fn(Spectrum, Spectrum) -> f64,
    ) -> Picture<[u8; 3]> {
        self.picture(|pixel, _, _| {
            if pixel.covered <= 0.0 {
                return [0; 3];
            }
            let [radiosity, irradiance] =
                [pixel.radiance * PI, pixel.irradiance].map(|sum| sum / pixel.covered);
            let shade = false_colour(value(radiosity, irradiance) / top);
            let light = Vec3::from(shade.map(|c| linear(f32::from(c) / 255.0)));
            let lines = if meshed { pixel.lined } else { 0.0 };
            let light = contrasted(light, lines / pixel.covered) * pixel.covered;
            light.to_array().map(|c| (255.0 * srgb(c)).round() as u8)
        })
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
