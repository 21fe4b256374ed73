//! Lines of contact: surfaces that meet, touch or interpenetrate are split along the line before they are meshed.
//!
//! An element that lies partly under a box would be interpolated across the box's edge, and light or darkness would leak
//! along it. So each surface whose inside is touched or crossed by others becomes several [`Piece`]s: convex triangles and
//! quads that tile it and whose sides cover every line of contact. All others stay one piece.
//!
//! 1. [`near`]: a spatial index tells which surfaces come near one another.
//! 2. [`lines`]: where they meet the inside of a surface, as segments in its plane.
//! 3. [`arrange`]: the segments, snapped and split until they meet in common ends only; [`straighten`] joins those that
//!    continue one another.
//! 4. [`tile`]: a constrained Delaunay triangulation along them; [`quads`] joins triangles where nothing separates them,
//!    and [`grade`] adds points where needles remain.
//!
//! Everything happens in the frame, in double precision, with one tolerance, [`REACH`].

mod arrange;
mod face;
mod grade;
mod lines;
mod near;
mod outline;
mod quads;
mod straighten;
mod tile;

use crate::geometry::{Frame, polygon};
use crate::scene::{Scene, Surface};
use arrange::{Arrangement, arrange, rearrange};
use face::Face;
use glam::DVec3;
use grade::grade;
use lines::Line;
use near::Neighbours;
use outline::Outlines;
use rayon::prelude::*;
use straighten::straighten;
use tile::tile;

/// Surfaces closer than this fraction of the scene's extent touch, and points closer than it are one.
///
/// Files carry six or seven digits, so what is meant to touch misses by up to 1e-6 of the model. A gap is real from there
/// on, though rays, which leave a surface by 1e-5, pass only gaps wider than that.
const REACH: f64 = 1e-6;

/// A surface on which more segments than this end is left whole: finding where they cross takes time with their square.
const MOST_LINES: usize = 10_000;

/// Triangles no longer than this fraction of the scene's extent keep their small angles: elements are not longer either.
const FINE: f64 = 0.1;

/// Pieces have the area of their surface to this relative precision, or it is left whole.
const SAME_AREA: f64 = 1e-9;

/// The least cosine between the normals of a piece and its surface: corners may miss their plane by 1e-5 of the surface.
const ALIGNED: f64 = 0.99;

/// A convex part of a surface that no line of contact crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Index into `Scene::surfaces`.
    pub surface: u32,
    /// Corners in the frame, counter-clockwise like the surface; a triangle repeats its first.
    corners: [DVec3; 4],
    count: u8,
    /// Which of its sides lie on the border of the input polygon, rather than on a cut through it.
    pub outline: [bool; 4],
}

impl Piece {
    /// A piece with three or four corners.
    fn new(surface: u32, corners: &[DVec3], outline: [bool; 4]) -> Self {
        let fourth = *corners.get(3).unwrap_or(&corners[0]);
        let count = corners.len() as u8;
        Self {
            surface,
            corners: [corners[0], corners[1], corners[2], fourth],
            count,
            outline,
        }
    }

    /// Its three or four corners.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..usize::from(self.count)]
    }
}

/// The pieces of a scene.
#[derive(Debug, Clone, Default)]
pub struct Pieces {
    /// In the order of the surfaces.
    pub list: Vec<Piece>,
    /// Surfaces that were left whole although others touch them: too many lines, or lines too close to tell apart.
    pub unsplit: usize,
}

/// Splits the surfaces of a scene along their lines of contact; the pieces' corners are in the frame.
pub fn pieces(scene: &Scene, frame: &Frame) -> Pieces {
    let positions = scene.positions_in(frame);
    let reach = REACH * frame.extent();
    let neighbours = Neighbours::new(&scene.surfaces, &positions);
    let outlines = Outlines::new(&scene.surfaces);
    let whole = |(number, surface): (u32, &Surface)| {
        Piece::new(
            number,
            &corners_of(surface, &positions),
            outlines.of(surface),
        )
    };

    // Most surfaces touch no others: keep only what came of those that do.
    let touched: Vec<(u32, Option<Vec<Piece>>)> = (0..scene.surfaces.len() as u32)
        .into_par_iter()
        .filter_map(|number| {
            let surface = &scene.surfaces[number as usize];
            let face = Face::new(&corners_of(surface, &positions), reach)?;
            let near = neighbours
                .of(face.corners(), reach + face.thickness)
                .filter(|other| *other != number);
            let others = near.map(|other| scene.surfaces[other as usize].corners);
            let lines = lines::lines(&face, others, &positions);
            let split = || {
                split(
                    &face,
                    number,
                    &lines,
                    outlines.of(surface),
                    FINE * frame.extent(),
                )
            };
            (!lines.is_empty()).then(|| (number, split()))
        })
        .collect();

    let mut pieces = Pieces::default();
    let mut touched = touched.into_iter().peekable();
    for (number, surface) in (0..).zip(&scene.surfaces) {
        match touched.next_if(|(of, _)| *of == number) {
            Some((_, Some(tiles))) => pieces.list.extend(tiles),
            failed => {
                pieces.unsplit += usize::from(failed.is_some());
                pieces.list.push(whole((number, surface)));
            }
        }
    }
    pieces
}

fn corners_of(surface: &Surface, positions: &[DVec3]) -> Vec<DVec3> {
    surface
        .corners
        .indices()
        .iter()
        .map(|v| positions[*v as usize])
        .collect()
}

/// Splits a face along lines; `None` if that fails.
fn split(
    face: &Face,
    surface: u32,
    lines: &[Line],
    outline: [bool; 4],
    fine: f64,
) -> Option<Vec<Piece>> {
    let all = arrange(face, lines, MOST_LINES)?;
    let straight = straighten(&all.nodes, &all.edges, face.reach);
    let few = rearrange(face, &all.nodes, &straight, MOST_LINES);
    let graded = few.clone().map(|few| grade(face, few, fine));
    // What is nearer to the input is less well shaped; it serves where rounding spoils the better.
    let attempts = [graded, few, Some(all)].into_iter().flatten();
    attempts
        .filter_map(|arrangement| tiled(face, surface, &arrangement, outline))
        .next()
}

/// The pieces of a face along an arrangement of lines; `None` if they do not tile it.
fn tiled(
    face: &Face,
    surface: u32,
    arrangement: &Arrangement,
    outline: [bool; 4],
) -> Option<Vec<Piece>> {
    let nodes = &arrangement.nodes;
    let tiles = tile(face, arrangement)?;
    let corner_count = face.corners().len();
    let positions: Vec<DVec3> = nodes
        .iter()
        .enumerate()
        .map(|(number, node)| match face.corners().get(number) {
            Some(corner) => *corner,
            None if node.sides == 0 => face.lift(node.at),
            None => {
                face.on_side(node.sides.trailing_zeros() as usize, node.at)
                    .1
            }
        })
        .collect();
    let pieces = tiles.iter().map(|tile| {
        let corners = tile.corners();
        let mut piece = Piece::new(
            surface,
            &corners
                .iter()
                .map(|n| positions[*n as usize])
                .collect::<Vec<_>>(),
            [false; 4],
        );
        for (side, slot) in piece.outline.iter_mut().enumerate().take(corners.len()) {
            let [a, b] = [side, side + 1].map(|i| nodes[corners[i % corners.len()] as usize].sides);
            *slot = (0..corner_count).any(|border| a & b & 1 << border != 0 && outline[border]);
        }
        piece
    });
    let pieces: Vec<Piece> = pieces.collect();
    tile_exactly(face, &pieces).then_some(pieces)
}

/// Whether pieces face as their surface does and have its area.
fn tile_exactly(face: &Face, pieces: &[Piece]) -> bool {
    let whole = polygon::vector_area(face.corners());
    let direction = whole.normalize_or_zero();
    let parts: Vec<DVec3> = pieces
        .iter()
        .map(|piece| polygon::vector_area(piece.corners()))
        .collect();
    let area: f64 = parts.iter().map(|part| part.length()).sum();
    let aligned = parts
        .iter()
        .all(|part| part.dot(direction) > ALIGNED * part.length());
    aligned && (area - whole.length()).abs() <= SAME_AREA * whole.length()
}
