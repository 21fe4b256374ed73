//! From the points of a pixel to what is seen there, for a whole picture.

use super::lens::Lens;
use super::paint::{Painter, Pixel};
use super::sight::{Scratch, Seen, Sight};
use super::tone::{Metered, Tone};
use crate::visibility::Visibility;
use glam::DVec2;
use rayon::prelude::*;

/// The exposure meter looks at about as many points in a row.
const METER_COLUMNS: u32 = 256;

/// The sample points of a pixel, `side` x `side` of them: one in each cell of a regular grid, no two in the same row
/// or column (canonical multi-jittering), so upright and level edges get as many shades as slanting ones. All are
/// moved by a hair off round numbers, where edges of things like to be.
pub(super) fn pattern(side: u32) -> Vec<DVec2> {
    let side = side.max(1);
    let n = f64::from(side);
    let offset = DVec2::new(0.0171, -0.0113) / (n * n);
    let place = |major: u32, minor: u32| (f64::from(major) + (f64::from(minor) + 0.5) / n) / n;
    (0..side * side)
        .map(|i| (i % side, i / side))
        .map(|(column, row)| DVec2::new(place(column, row), place(row, column)) + offset)
        .collect()
}

/// Traces points of the screen.
pub(super) struct Tracer<'a> {
    pub(super) sight: &'a Sight<'a>,
    pub(super) lens: &'a Lens,
    pub(super) engine: &'a dyn Visibility,
}

impl Tracer<'_> {
    /// The exposure that suits what is seen.
    pub(super) fn meter(&self, width: u32, height: u32) -> Tone {
        let step = width.max(height).div_ceil(METER_COLUMNS).max(1);
        let rows: Vec<u32> = (step / 2..height).step_by(step as usize).collect();
        let look_along = |&y: &u32| {
            let columns = (step / 2..width).step_by(step as usize);
            let points: Vec<_> = columns
                .map(|x| DVec2::new(f64::from(x), f64::from(y)) + pattern(1)[0])
                .collect();
            let mut seen = Vec::new();
            self.sight.look(
                self.engine,
                self.lens,
                &points,
                &mut Scratch::default(),
                &mut seen,
            );
            let meter = |seen: &Seen| Metered {
                radiosity: seen.interpolate(|vertex| vertex.radiosity),
                irradiance: seen.interpolate(|vertex| vertex.irradiance),
                weight: 1.0,
            };
            seen.iter().flatten().map(meter).collect::<Vec<_>>()
        };
        let samples: Vec<_> = rows.par_iter().flat_map_iter(look_along).collect();
        Tone::metered(&samples)
    }

    /// All pixels, row by row in parallel; `None` once they are no longer `wanted`.
    pub(super) fn paint(
        &self,
        (width, height): (u32, u32),
        pattern: &[DVec2],
        painter: &Painter,
        wanted: &(dyn Fn() -> bool + Sync),
    ) -> Option<Vec<Pixel>> {
        let mut pixels = vec![Pixel::default(); width as usize * height as usize];
        let buffers = || (Vec::new(), Scratch::default(), Vec::new(), Vec::new());
        pixels
            .par_chunks_mut((width as usize).max(1))
            .enumerate()
            .try_for_each_init(buffers, |(points, scratch, seen, near), (y, row)| {
                if !wanted() {
                    return None;
                }
                let corners = (0..width).map(|x| DVec2::new(f64::from(x), y as f64));
                points.clear();
                points.extend(
                    corners.flat_map(|corner| pattern.iter().map(move |&point| corner + point)),
                );
                self.sight
                    .look(self.engine, self.lens, points, scratch, seen);
                let samples = points.chunks(pattern.len()).zip(seen.chunks(pattern.len()));
                for (x, (pixel, (points, seen))) in row.iter_mut().zip(samples).enumerate() {
                    let middle = DVec2::new(x as f64, y as f64) + 0.5;
                    *pixel = painter.pixel(middle, points, seen, near);
                }
                Some(())
            })?;
        Some(pixels)
    }
}
