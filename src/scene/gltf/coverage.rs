//! The mean of what lies under a polygon, texel by texel: an emissive texture may be dark but for a few texels, and these may be very bright.
//!
//! Lines along the rows of the texture, two or more for each row, are added up exactly from one side of the triangle to the other. Lines lie where the
//! rows do and not where the triangle does, so triangles that share a side share out the texels there and none is counted twice.

use super::texture::Texture;
use crate::geometry::jitter;
use ::gltf::texture::WrappingMode;
use glam::{DVec2, DVec3};

/// The least number of lines through a triangle.
const LINES: f64 = 16.0;

/// The binary logarithm of the most lines for each row: what is so flat is not worth as many.
const FINEST: f64 = 20.0;

/// Coordinates beyond, in texels, are no place in a texture.
const FARTHEST: f64 = 1e9;

impl Texture {
    /// The mean over a triangle in the texture; `None` if it has no area there to speak of.
    pub(super) fn covered(&self, corners: [DVec2; 3]) -> Option<DVec3> {
        let (width, height) = (self.pixels.width, self.pixels.height);
        let size = DVec2::new(f64::from(width), f64::from(height));
        let mut corners = corners.map(|corner| corner * size);
        corners.sort_by(|a, b| a.y.total_cmp(&b.y));
        let [a, b, c] = corners;
        let reach = (b - a).length() + (c - a).length();
        let near = |at: &DVec2| at.is_finite() && at.abs().max_element() < FARTHEST;
        if !corners.iter().all(near) || (b - a).perp_dot(c - a).abs() <= 1e-9 * reach * reach {
            return None;
        }
        let rows = c.y - a.y;
        // Powers of two lie where the rows do. A texture that is repeated needs no more lines than it has itself.
        let finer = (LINES / rows).log2().ceil().clamp(1.0, FINEST).exp2();
        let (per_row, repeats) = match rows > f64::from(height.max(8)) {
            true => (2.0 * f64::from(height.max(8)) / rows, true),
            false => (finer, false),
        };
        let (mut sum, mut length) = (DVec3::ZERO, 0.0);
        let first = (a.y * per_row).floor() as i64;
        for line in first..=(c.y * per_row).floor() as i64 {
            let low = (line as f64 / per_row).max(a.y);
            let high = ((line + 1) as f64 / per_row).min(c.y);
            let part = match repeats {
                true => jitter(line as u32, 0)[0],
                false => 0.5,
            };
            let y = low + part * (high - low);
            let ends = [
                side(a, c, y),
                if y < b.y {
                    side(a, b, y)
                } else {
                    side(b, c, y)
                },
            ];
            let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let row = wrapped(y.floor() as i64, height, self.wrap[1]);
            sum += (high - low) * self.along(row, from, to);
            length += (high - low) * (to - from);
        }
        (length > 0.0).then(|| sum / length)
    }

    /// The sum of a row's texels between two places on it, each by how much of it lies there.
    fn along(&self, row: usize, from: f64, to: f64) -> DVec3 {
        let width = self.pixels.width;
        let colour = |place: i64| self.colour(wrapped(place, width, self.wrap[0]), row);
        let end = f64::from(width);
        if self.wrap[0] == WrappingMode::ClampToEdge {
            let within = between(from.clamp(0.0, end), to.clamp(0.0, end), colour);
            let before = to.min(0.0) - from.min(0.0);
            let after = to.max(end) - from.max(end);
            return within + before * colour(0) + after * colour(i64::from(width) - 1);
        }
        // The same texels come again after two widths, mirrored or not.
        let periods = ((to - from) / (2.0 * end)).floor();
        let rest = between(from, to - periods * 2.0 * end, colour);
        match periods > 0.0 {
            true => rest + periods * between(0.0, 2.0 * end, colour),
            false => rest,
        }
    }
}

/// Where a side between two corners is at a height.
fn side(low: DVec2, high: DVec2, y: f64) -> f64 {
    let part = (y - low.y) / (high.y - low.y);
    match part.is_finite() {
        true => low.x + part.clamp(0.0, 1.0) * (high.x - low.x),
        false => low.x,
    }
}

/// Whole texels, and the parts of the first and the last.
fn between(from: f64, to: f64, colour: impl Fn(i64) -> DVec3) -> DVec3 {
    let texels = from.floor() as i64..to.ceil() as i64;
    let part = |texel: i64| to.min((texel + 1) as f64) - from.max(texel as f64);
    texels.map(|texel| part(texel) * colour(texel)).sum()
}

/// The texel at a place on an endless row or column.
fn wrapped(place: i64, size: u32, wrap: WrappingMode) -> usize {
    let size = i64::from(size);
    (match wrap {
        WrappingMode::ClampToEdge => place.clamp(0, size - 1),
        WrappingMode::Repeat => place.rem_euclid(size),
        WrappingMode::MirroredRepeat => {
            let place = place.rem_euclid(2 * size);
            place.min(2 * size - 1 - place)
        }
    }) as usize
}
