//! The mean colour of a texture over a polygon.

use super::file::File;
use crate::codec::{Pixels, decode_jpeg, decode_png};
use crate::geometry::jitter;
use crate::radiometry::linear;
use ::gltf::image::Source;
use ::gltf::texture::WrappingMode;
use glam::{DVec2, DVec3};

/// Samples along the side of a triangle, at least and at most; in between two for each texel.
const SAMPLES: [f64; 2] = [16.0, 64.0];

/// A corner of a triangle, in space and in the textures of its material: base colour, emission.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub position: DVec3,
    pub texture: [DVec2; 2],
}

/// A decoded texture.
pub(super) struct Texture {
    pub(super) pixels: Pixels,
    /// What each of the 8-bit codes stands for.
    linear: [f64; 256],
    pub(super) wrap: [WrappingMode; 2],
}

impl Texture {
    /// Decodes it; the error says what is wrong.
    pub fn of(file: &File, texture: &::gltf::Texture) -> Result<Self, String> {
        let bytes = match texture.source().source() {
            Source::View { view, .. } => file.view(&view)?.to_vec(),
            Source::Uri { uri, .. } => file.resource(uri).map_err(|error| error.found)?,
        };
        let pixels = match bytes.as_slice() {
            [0x89, b'P', b'N', b'G', ..] => decode_png(&bytes)?,
            [0xFF, 0xD8, ..] => decode_jpeg(&bytes)?,
            _ => return Err("neither PNG nor JPEG".into()),
        };
        let sampler = texture.sampler();
        Ok(Self {
            pixels,
            linear: std::array::from_fn(|code| f64::from(linear(code as f32 / 255.0))),
            wrap: [sampler.wrap_s(), sampler.wrap_t()],
        })
    }

    /// The mean over triangles by area, linear, from samples; `which` of the corners' coordinates are this texture's.
    pub fn mean(&self, triangles: &[[Corner; 3]], which: usize) -> DVec3 {
        mean_by_area(triangles, which, |corners| self.mean_of(corners))
    }

    /// The mean over triangles by area, linear, from all that lies under them.
    pub fn whole_mean(&self, triangles: &[[Corner; 3]], which: usize) -> DVec3 {
        mean_by_area(triangles, which, |corners| {
            let mean = self.covered(corners);
            mean.unwrap_or_else(|| self.mean_of(corners))
        })
    }

    /// The mean over a triangle in the texture, from a point in each of equal triangles: anywhere in it, as evenly spaced ones may all fall
    /// on the same places of a pattern.
    fn mean_of(&self, [a, b, c]: [DVec2; 3]) -> DVec3 {
        let size = DVec2::new(f64::from(self.pixels.width), f64::from(self.pixels.height));
        let texels = [b - a, c - b, a - c].map(|side| (side * size).length());
        let longest = texels.into_iter().fold(0.0, f64::max);
        let [least, most] = SAMPLES;
        let n = (2.0 * longest).ceil().clamp(least, most) as u32;
        let at = |u: f64, v: f64| {
            let step = 1.0 / f64::from(n);
            self.texel(a + (b - a) * u * step + (c - a) * v * step)
        };
        let mut sum = DVec3::ZERO;
        for i in 0..n {
            for j in 0..n - i {
                let (u, v) = (f64::from(i), f64::from(j));
                let [s, t] = jitter(i, j);
                let (s, t) = if s + t < 1.0 {
                    (s, t)
                } else {
                    (1.0 - s, 1.0 - t)
                };
                sum += at(u + s, v + t);
                if i + j + 1 < n {
                    sum += at(u + 1.0 - t, v + 1.0 - s);
                }
            }
        }
        sum / f64::from(n * n)
    }

    fn texel(&self, at: DVec2) -> DVec3 {
        let x = place(at.x, self.pixels.width, self.wrap[0]);
        let y = place(at.y, self.pixels.height, self.wrap[1]);
        self.colour(x, y)
    }

    pub(super) fn colour(&self, x: usize, y: usize) -> DVec3 {
        let colour = self.pixels.colours[y * self.pixels.width as usize + x];
        DVec3::from(colour.map(|code| self.linear[usize::from(code)]))
    }
}

fn mean_by_area(
    triangles: &[[Corner; 3]],
    which: usize,
    mean: impl Fn([DVec2; 3]) -> DVec3,
) -> DVec3 {
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| corner.position);
        let area = (b - a).cross(c - a).length();
        sum += area * mean(triangle.map(|corner| corner.texture[which]));
        weight += area;
    }
    match weight > 0.0 {
        true => sum / weight,
        false => DVec3::ONE,
    }
}

/// The texel at a coordinate, of which 0 to 1 is the picture.
fn place(at: f64, size: u32, wrap: WrappingMode) -> usize {
    let within = match wrap {
        WrappingMode::ClampToEdge => at.clamp(0.0, 1.0),
        WrappingMode::Repeat => at.rem_euclid(1.0),
        WrappingMode::MirroredRepeat => 1.0 - (at.rem_euclid(2.0) - 1.0).abs(),
    };
    // What is no number becomes the last.
    (within * f64::from(size)).min(f64::from(size - 1)) as usize
}
