//! Lines along the edges of polygons and elements, as wide on the screen wherever they are.

use super::cells::Cells;
use super::lens::Lens;
use super::options::RenderOptions;
use super::sight::{Seen, Sight};
use crate::solution::LitTriangle;
use glam::DVec2;
use std::collections::HashMap;

/// Around things smaller than this many pixels no line is drawn ...
const GONE: f64 = 1.5;
/// ... and around those larger than this in full. In between lines fade, or what is dense would become a blot.
const FULL: f64 = 6.0;
/// A line lies on a surface if it is no farther from its plane than this fraction of the distance from the eye: input
/// is not exactly planar.
const ON_SURFACE: f64 = 1e-5;

/// Draws the edges of polygons and of elements, sample by sample.
pub(super) struct Pen<'a> {
    lens: &'a Lens,
    options: &'a RenderOptions,
    /// Distance between the samples of a pixel: edges of lines are softened by as much.
    spacing: f64,
    strokes: Vec<Stroke>,
    cells: Cells,
}

/// A line on the screen, along a piece of the boundary of an element that faces the eye.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stroke {
    ends: (DVec2, DVec2),
    /// One over the depth of the ends: what is linear on the screen.
    nearness: (f64, f64),
    /// How strong it is as an edge of an element, 0 to 1.
    mesh: f64,
    /// How strong it is as an edge of an input polygon; 0 if it is not one.
    wire: f64,
}

/// How much of a sample lines cover, 0 to 1.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cover {
    /// Lines around input polygons.
    pub(super) wire: f32,
    /// Lines around elements.
    pub(super) mesh: f32,
}

impl<'a> Pen<'a> {
    pub(super) fn new(lens: &'a Lens, options: &'a RenderOptions, sight: &Sight) -> Self {
        let spacing = 1.0 / f64::from(options.samples_per_side.max(1));
        let strokes = strokes(lens, sight, reach(options, spacing));
        let segments: Vec<_> = strokes.iter().map(|stroke| stroke.ends).collect();
        let cells = Cells::new(lens.size(), &segments, reach(options, spacing));
        Self {
            lens,
            options,
            spacing,
            strokes,
            cells,
        }
    }

    /// Puts into `near` the lines that can cover samples of the pixel with this middle.
    pub(super) fn approach(&self, middle: DVec2, near: &mut Vec<Stroke>) {
        let reach = reach(self.options, self.spacing) + 0.5 * std::f64::consts::SQRT_2;
        let strokes = self
            .cells
            .near(middle)
            .iter()
            .map(|&index| self.strokes[index as usize]);
        near.clear();
        near.extend(strokes.filter(|stroke| stroke.closest(middle).1 < reach));
    }

    /// How much the lines in `near` cover of the sample `at` a point of the screen.
    ///
    /// Edges of polygons are drawn in full width unless something is in front of them, so also beside an outline.
    /// Edges of elements are drawn only on the surfaces that they lie on.
    pub(super) fn cover(&self, near: &[Stroke], at: DVec2, seen: Option<&Seen>) -> Cover {
        near.iter().fold(Cover::default(), |cover, stroke| {
            let (along, distance) = stroke.closest(at);
            let wire = stroke.wire * self.ink(self.options.wire_width, distance);
            let mesh = stroke.mesh * self.ink(self.options.mesh_width, distance);
            if wire.max(mesh) <= 0.0 {
                return cover;
            }
            // In front of the surface that is seen here, on it or behind it, in units of what counts as on it.
            let height = seen.map_or(f64::INFINITY, |seen| self.height(stroke, along, seen));
            Cover {
                wire: if height >= -1.0 {
                    cover.wire.max(wire as f32)
                } else {
                    cover.wire
                },
                mesh: if height.abs() <= 1.0 {
                    cover.mesh.max(mesh as f32)
                } else {
                    cover.mesh
                },
            }
        })
    }

    fn ink(&self, width: f64, distance: f64) -> f64 {
        ((0.5 * width - distance) / self.spacing + 0.5).clamp(0.0, 1.0)
    }

    fn height(&self, stroke: &Stroke, along: f64, seen: &Seen) -> f64 {
        let depth = 1.0 / (stroke.nearness.0 + along * (stroke.nearness.1 - stroke.nearness.0));
        let direction = self
            .lens
            .direction(stroke.ends.0.lerp(stroke.ends.1, along));
        let point = self.lens.eye + direction * (depth / self.lens.focal);
        seen.height(point) / (ON_SURFACE * depth)
    }
}

impl Stroke {
    /// The point closest to `at`, as a fraction of the way from one end to the other, and its distance.
    fn closest(&self, at: DVec2) -> (f64, f64) {
        let (from, to) = self.ends;
        let length = (to - from).length_squared();
        let along = if length > 0.0 {
            ((at - from).dot(to - from) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (along, at.distance(from.lerp(to, along)))
    }
}

/// How far from a line its ink can be.
fn reach(options: &RenderOptions, spacing: f64) -> f64 {
    0.5 * (options.wire_width.max(options.mesh_width) + spacing)
}

/// The outer sides of all triangles that face the eye, as far as they are on the screen or within `margin` of it and
/// strong enough to be seen.
fn strokes(lens: &Lens, sight: &Sight, margin: f64) -> Vec<Stroke> {
    let polygon_sizes = polygon_sizes(lens, sight);
    let stroke = |triangle: &LitTriangle| {
        let [centre, a, b] = sight.positions(triangle);
        let line = lens.line(a, b)?;
        let (a, b) = lens.clip(a, b, margin)?;
        // As much beyond the centre as on this side of it.
        let element_size = lens
            .project(centre)
            .map(|(centre, _)| 2.0 * line.dot(lens.direction(centre)).abs());
        let mesh = element_size.map_or(1.0, strength);
        let wire = if triangle.on_border {
            strength(polygon_sizes[&triangle.polygon])
        } else {
            0.0
        };
        let ((a, a_depth), (b, b_depth)) = (lens.project(a)?, lens.project(b)?);
        let stroke = Stroke {
            ends: (a, b),
            nearness: (1.0 / a_depth, 1.0 / b_depth),
            mesh,
            wire,
        };
        (mesh.max(wire) > 0.0).then_some(stroke)
    };
    sight.triangles().filter_map(stroke).collect()
}

/// How large each polygon looks, in pixels: the side of a square of the same area, where it looks largest.
fn polygon_sizes(lens: &Lens, sight: &Sight) -> HashMap<u32, f64> {
    let mut areas: HashMap<u32, f64> = HashMap::new();
    for triangle in sight.triangles() {
        *areas.entry(triangle.polygon).or_default() += sight.area_vector(triangle).length();
    }
    let mut sizes: HashMap<u32, f64> = HashMap::new();
    for triangle in sight.triangles() {
        let area = sight.area_vector(triangle).normalize() * areas[&triangle.polygon];
        for place in sight.positions(triangle) {
            let to_eye = lens.eye - place;
            let size = lens.focal * area.dot(to_eye.normalize()).max(0.0).sqrt() / to_eye.length();
            let largest = sizes.entry(triangle.polygon).or_default();
            *largest = largest.max(size);
        }
    }
    sizes
}

/// Of the lines around something of this size in pixels.
fn strength(size: f64) -> f64 {
    let x = ((size - GONE) / (FULL - GONE)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
