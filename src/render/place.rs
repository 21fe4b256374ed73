//! A place to look from: what can be seen there, made ready once for any number of looks around.

use super::lens::Lens;
use super::lines::Pen;
use super::options::RenderOptions;
use super::paint::{Painter, Pixel};
use super::sight::{Scratch, Sight};
use super::tone::Tone;
use super::trace::{Tracer, pattern};
use super::view::View;
use crate::radiometry::Spectrum;
use crate::scene::Camera;
use crate::solution::LitMesh;
use crate::visibility::{Triangles, Visibility};
use glam::{DVec2, DVec3};

/// What can be seen of a mesh from one point.
pub struct Place<'a> {
    mesh: &'a LitMesh,
    eye: DVec3,
    sight: Sight<'a>,
    /// None where no surface faces the eye.
    engine: Option<Box<dyn Visibility>>,
}

/// A point of a surface that is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// Where it is, in scene units.
    pub point: DVec3,
    /// Index into [`LitMesh::triangles`].
    pub triangle: u32,
    /// Radiosity B there, W/m².
    pub radiosity: Spectrum,
    /// Irradiance E there, W/m².
    pub irradiance: Spectrum,
}

impl<'a> Place<'a> {
    /// Stands at `eye`. `build` makes the engine that answers who is nearest among the given triangles; it is not called
    /// where no surface faces the eye.
    ///
    /// # Errors
    /// When `build` fails.
    pub fn new<E>(
        mesh: &'a LitMesh,
        eye: DVec3,
        build: impl FnOnce(Triangles) -> Result<Box<dyn Visibility>, E>,
    ) -> Result<Self, E> {
        let (sight, triangles) = Sight::new(mesh, eye);
        let engine = match triangles.indices.is_empty() {
            true => None,
            false => Some(build(triangles)?),
        };
        Ok(Self {
            mesh,
            eye,
            sight,
            engine,
        })
    }

    /// Where it is, in scene units.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Looks through `camera`, which has to stand here; `None` once the view is no longer `wanted`, which is asked row by row.
    ///
    /// # Panics
    /// If the camera stands elsewhere.
    pub fn view(
        &self,
        camera: &Camera,
        options: &RenderOptions,
        wanted: &(dyn Fn() -> bool + Sync),
    ) -> Option<View> {
        let lens = self.lens(camera);
        let (width, height) = (camera.width, camera.height);
        let Some(tracer) = self.tracer(&lens) else {
            let pixels = vec![Pixel::BACKGROUND; width as usize * height as usize];
            return Some(View {
                width,
                height,
                tone: Tone::new(camera.exposure.unwrap_or(0.0)),
                pixels,
            });
        };
        let tone = camera
            .exposure
            .map_or_else(|| tracer.meter(width, height), Tone::new);
        let painter = Painter::new(tone, Pen::new(&lens, options, &self.sight), &lens);
        let pattern = pattern(options.samples_per_side);
        let pixels = tracer.paint((width, height), &pattern, &painter, wanted)?;
        Some(View {
            width,
            height,
            tone,
            pixels,
        })
    }

    /// What `camera`, which has to stand here, shows at a point of its picture: `(0, 0)` is the upper left corner of the first pixel.
    ///
    /// # Panics
    /// If the camera stands elsewhere.
    pub fn sighting(&self, camera: &Camera, at: DVec2) -> Option<Sighting> {
        let lens = self.lens(camera);
        let mut seen = Vec::new();
        let engine = self.tracer(&lens)?.engine;
        self.sight
            .look(engine, &lens, &[at], &mut Scratch::default(), &mut seen);
        let seen = seen.first()?.as_ref()?;
        Some(Sighting {
            point: seen.point(self.mesh),
            triangle: seen.triangle,
            radiosity: seen.interpolate(|vertex| vertex.radiosity),
            irradiance: seen.interpolate(|vertex| vertex.irradiance),
        })
    }

    fn lens(&self, camera: &Camera) -> Lens {
        assert_eq!(camera.eye, self.eye, "the camera stands here");
        Lens::new(camera)
    }

    fn tracer<'t>(&'t self, lens: &'t Lens) -> Option<Tracer<'t>> {
        Some(Tracer {
            sight: &self.sight,
            lens,
            engine: self.engine.as_deref()?,
        })
    }
}
