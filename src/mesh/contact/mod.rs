//! Lines of contact: surfaces that meet, touch or interpenetrate are split along the line before they are meshed. Triangles that
//! continue one another in a plane are one surface before that.
//!
//! An element that lies partly under a box would be interpolated across the box's edge, and light or darkness would leak
//! along it. So each surface whose inside is touched or crossed by others becomes several [`Piece`]s: convex triangles and
//! quads that tile it and whose sides cover every line of contact. All others stay one piece.
//!
//! 0. [`regions`]: which triangles are one surface; [`border`]: where that ends.
//! 1. [`near`]: a spatial index tells which surfaces come near one another.
//! 2. [`lines`]: where they meet the inside of a surface, as segments in its plane.
//! 3. [`gaps`]: where they end so close in front of it that to elements it is the same.
//! 4. [`arrange`]: the segments, snapped and split until they meet in common ends only; [`straighten`] joins those that
//!    continue one another.
//! 5. [`tile`]: a constrained Delaunay triangulation along them; [`quads`] joins triangles where nothing separates them,
//!    and [`grade`] adds points where needles remain.
//! 6. [`overlap`]: of pieces that lie in one another and face alike, one radiates.
//!
//! Everything happens in the frame, in double precision, with one tolerance, [`REACH`], but for gaps.

mod arrange;
mod border;
mod face;
mod gaps;
mod grade;
mod index;
mod lines;
mod near;
mod outline;
mod overlap;
mod quads;
mod regions;
mod shapes;
mod straighten;
mod tile;

use crate::geometry::{Frame, polygon};
use crate::scene::{Scene, Sides};
use arrange::{Arrangement, arrange, rearrange};
use face::Face;
use gaps::{Gaps, Rim, Rims};
use glam::{DVec2, DVec3};
use grade::{Grading, grade};
use lines::Line;
use near::Neighbours;
use quads::{FAIR, flatness};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use shapes::Shapes;
use std::sync::atomic::{AtomicUsize, Ordering};
use straighten::straighten;
use tile::tile;

pub use regions::Regions;

/// Surfaces closer than this fraction of the scene's extent touch, and points closer than it are one.
///
/// Files carry six or seven digits, so what is meant to touch misses by up to 1e-6 of the model. A gap is real from there
/// on, though rays, which leave a surface by 1e-5, pass only gaps wider than that.
const REACH: f64 = 1e-6;

/// A surface on which more segments than this end is left whole: it would take minutes and gigabytes.
const MOST_LINES: usize = 100_000;

/// With more surfaces than this all patches shoot at once, if the options do not say otherwise.
pub(super) const MANY: usize = 2000;

/// In a scene of many patches the least size of an element on a patch that is larger, as a part of the least size of a patch.
pub(crate) const FINEST: f64 = 0.2;

/// Surfaces that are split at a time: what comes of each is a small list, and millions of those leave holes in memory that are not given back.
const BLOCK: u32 = 1 << 15;

/// Pieces have the area of their surface to this relative precision, or it is left whole.
const SAME_AREA: f64 = 1e-9;

/// The least cosine between the normals of a piece and its surface: corners may miss their plane by 1e-5 of the surface.
const ALIGNED: f64 = 0.99;

/// A convex part of a surface that no line of contact crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Index into `Scene::surfaces`; the lowest of several that are one.
    pub surface: u32,
    /// Corners in the frame, counter-clockwise like the surface; a triangle repeats its first.
    corners: [DVec3; 4],
    count: u8,
    /// Which of its sides lie on the border of the input polygon, rather than on a cut through it.
    pub outline: [bool; 4],
    /// How far from its border light is to be evaluated, at least; in the frame.
    pub clearance: f32,
    /// Whether its front, and its back, lie in another surface that radiates to the same side.
    pub covered: [bool; 2],
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
            clearance: 0.0,
            covered: [false; 2],
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
    /// Surfaces that were not cut along the rims of thin gaps in front of them, for the same reasons.
    pub uncut: usize,
}

/// The triangles of a scene that are one surface.
pub fn regions(scene: &Scene, frame: &Frame) -> Regions {
    let positions = scene.positions_in(frame);
    Regions::of_triangles(&scene.surfaces, &positions, REACH * frame.extent())
}

/// Splits the surfaces of a scene along their lines of contact, those of a region as one; the pieces' corners are in the frame. Also along
/// the rims of gaps that are thin against elements of the length `smallest`, in the unit of the frame; 0 for none.
pub fn pieces(scene: &Scene, frame: &Frame, regions: &Regions, smallest: f64) -> Pieces {
    let shapes = Shapes::new(scene, frame);
    let count = scene.surfaces.len() as u32;
    let is_of_many = scene.surfaces.len() > MANY;
    let finest = if is_of_many { FINEST } else { 1.0 } * smallest;
    let splitter = Splitter::new(&shapes, frame, regions, Gaps::of(smallest, finest));
    let mut pieces = Pieces::default();
    pieces.list.reserve(count as usize);
    // What came of surfaces whose turn is still to come.
    let mut cut: FxHashMap<u32, Option<Vec<Piece>>> = FxHashMap::default();
    for begin in (0..count).step_by(BLOCK as usize) {
        let block = begin..count.min(begin + BLOCK);
        let numbers = block.clone().into_par_iter();
        let of_block: Vec<(u32, Option<Vec<Piece>>)> = numbers
            .filter(|number| regions.first(*number) == *number)
            .flat_map_iter(|number| match regions.members(number) {
                Some(members) => splitter.together(members),
                // Most surfaces touch no others: nothing comes of these.
                None => splitter.alone(number).into_iter().collect(),
            })
            .collect();
        cut.extend(of_block);
        for number in block {
            match cut.remove(&number) {
                Some(Some(tiles)) => pieces.list.extend(tiles),
                None if regions.first(number) != number => {}
                failed => {
                    pieces.unsplit += usize::from(failed.is_some());
                    pieces.list.push(shapes.whole(number));
                }
            }
        }
    }
    pieces.list.par_iter_mut().for_each(|piece| {
        piece.covered = splitter.covered(piece);
        let in_gaps = splitter.clearance_in_gaps(piece) as f32;
        piece.clearance = piece.clearance.max(in_gaps);
    });
    pieces.uncut = splitter.uncut.into_inner();
    pieces
}

/// What it takes to split surfaces.
struct Splitter<'a> {
    shapes: &'a Shapes<'a>,
    regions: &'a Regions,
    neighbours: Neighbours,
    reach: f64,
    gaps: Gaps,
    grading: Grading,
    /// Faces that were not cut along the rims in front of them.
    uncut: AtomicUsize,
}

impl<'a> Splitter<'a> {
    fn new(shapes: &'a Shapes, frame: &Frame, regions: &'a Regions, gaps: Gaps) -> Self {
        Self {
            shapes,
            regions,
            neighbours: Neighbours::new(shapes.surfaces, &shapes.positions),
            reach: REACH * frame.extent(),
            gaps,
            grading: Grading::of(shapes.surfaces.len(), frame),
            uncut: AtomicUsize::new(0),
        }
    }

    /// The pieces of a surface that others touch, `None` if it cannot be split; nothing for one that none touches.
    fn alone(&self, surface: u32) -> Option<(u32, Option<Vec<Piece>>)> {
        let face = Face::new(&self.shapes.corners(surface), self.reach)?;
        let lines = self.lines(&face, surface);
        let rims = self.rims(&face, surface, &lines);
        if lines.is_empty() && rims.is_empty() {
            return None;
        }
        let outline = self.shapes.outline(surface);
        let pieces = self.split(&face, surface, &lines, &rims, outline);
        Some((surface, pieces))
    }

    /// The pieces of a region, by its first surface; those of each of its members if it cannot be tiled.
    fn together(&self, members: &[u32]) -> Vec<(u32, Option<Vec<Piece>>)> {
        if let Some(pieces) = self.region(members) {
            return vec![(members[0], Some(pieces))];
        }
        let whole = |member: u32| (member, Some(vec![self.shapes.whole(member)]));
        let each = members.iter().copied();
        each.map(|member| self.alone(member).unwrap_or_else(|| whole(member)))
            .collect()
    }

    fn region(&self, members: &[u32]) -> Option<Vec<Piece>> {
        let at = |v: u32| self.shapes.positions[v as usize];
        let border = regions::border(members.iter().map(|m| &self.shapes.surfaces[*m as usize]));
        let sides: Vec<[DVec3; 2]> = border.iter().map(|side| side.map(at)).collect();
        let areas = members
            .iter()
            .map(|m| polygon::vector_area(&self.shapes.corners(*m)));
        let face = Face::around(&sides, areas.sum(), self.reach)?;
        let around = face.border.as_ref()?;
        let met = self.lines(&face, members[0]);
        let rims = self.rims(&face, members[0], &met);
        // Most regions are two halves of a quad that others meet on its border only.
        let free = |line: &Line| around.runs_along(*line, self.reach);
        if let Some(corners) = regions::quad(&border)
            && rims.is_empty()
            && met.iter().all(free)
            && flatness(corners.map(|v| face.flatten(at(v)))) >= FAIR
        {
            return Some(vec![Piece::new(members[0], &corners.map(at), [true; 4])]);
        }
        let lines = [&around.lines[..], &met].concat();
        self.split(&face, members[0], &lines, &rims, [true; 4])
    }

    /// Where surfaces of other regions meet a face.
    fn lines(&self, face: &Face, first: u32) -> Vec<Line> {
        let others = self.others(face, first, self.reach + face.thickness);
        let corners = others.map(|other| self.shapes.surfaces[other as usize].corners);
        lines::lines(face, corners, &self.shapes.positions)
    }

    /// Where surfaces of other regions end close in front of a face, away from its border and from lines on it.
    fn rims(&self, face: &Face, first: u32, lines: &[Line]) -> Vec<Rim> {
        let both_sides = self.shapes.surfaces[first as usize].sides == Sides::Both;
        let near = |margin| self.others(face, first, margin);
        self.gaps.rims(face, both_sides, lines, near, self.shapes)
    }

    /// The surfaces of other regions closer than `margin` to the box around a face.
    fn others(&self, face: &Face, first: u32, margin: f64) -> impl Iterator<Item = u32> {
        let near = self.neighbours.of(face.corners(), margin);
        near.filter(move |other| self.regions.first(*other) != first)
    }

    /// Splits a face along lines, and along rims too where that can be done; `None` if neither can.
    fn split(
        &self,
        face: &Face,
        surface: u32,
        lines: &[Line],
        rims: &[Rim],
        outline: [bool; 4],
    ) -> Option<Vec<Piece>> {
        let along = |lines: &[Line]| split(face, surface, lines, outline, self.grading);
        if rims.is_empty() {
            return along(lines);
        }
        let feet = rims.iter().map(|rim| rim.foot);
        let Some(mut pieces) = along(&lines.iter().copied().chain(feet).collect::<Vec<_>>()) else {
            self.uncut.fetch_add(1, Ordering::Relaxed);
            return along(lines);
        };
        let rims = Rims::of(rims.to_vec());
        for piece in &mut pieces {
            let corners = piece.corners().iter().map(|at| face.flatten(*at));
            piece.clearance = rims.clearance(&corners.collect::<Vec<DVec2>>()) as f32;
        }
        Some(pieces)
    }
}

/// Splits a face along lines; `None` if that fails.
fn split(
    face: &Face,
    surface: u32,
    lines: &[Line],
    outline: [bool; 4],
    grading: Grading,
) -> Option<Vec<Piece>> {
    let all = arrange(face, lines, MOST_LINES)?;
    let straight = straighten(&all.nodes, &all.edges, face.reach);
    let few = rearrange(face, &all.nodes, &straight, MOST_LINES);
    let graded = few.clone().map(|few| grade(face, few, grading));
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
            let [a, b] = [side, side + 1].map(|i| nodes[corners[i % corners.len()] as usize]);
            let on = |border: usize| a.sides & b.sides & 1 << border != 0;
            *slot = match &face.border {
                Some(border) => border.runs_along([a.at, b.at], face.reach),
                None => (0..corner_count).any(|side| on(side) && outline[side]),
            };
        }
        piece
    });
    let pieces: Vec<Piece> = pieces.collect();
    tile_exactly(face, &pieces).then_some(pieces)
}

/// Whether pieces face as their surface does and have its area.
fn tile_exactly(face: &Face, pieces: &[Piece]) -> bool {
    let whole = face.vector_area();
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
