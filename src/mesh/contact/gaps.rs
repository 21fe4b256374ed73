//! Rims: where another surface ends close in front of a face without touching it.
//!
//! Behind a baseboard that stands a millimetre off a wall it is dark, and the light ends within millimetres of the rim. For elements of
//! centimetres that is a step, as it is below a box that touches; one across it is bright or dark beyond the rim, and a row of them has
//! teeth. So the face is cut along the rim, seen square to the face. What rays meet stays as it is: light enters the gap as before.
//! That light is not for the elements beside the rim, which have vertices on it: there these look from where the gap is no more to be seen.
//! What has corners in the gap, like the back of the baseboard, looks from as far inside, and what ends at a low step from as far beside it: a
//! millimetre would be bright or dark for a whole element. So it is with gaps that are thin against the very smallest elements, and not
//! below a rim that shines.
//!
//! Only rims count, not all that is near: where a surface goes on beyond its side, as from one triangle of a sheet or of a cushion to the
//! next, the gap goes on too. Cut along gaps up to a fraction of the least size of elements, meshes had these errors (nRMS, path-traced
//! references; of the interior the mean of three first sizes, which differ by 0.2 %):
//!
//! | fraction | none | 1/8 | 1/4 | 1/2 |
//! |---|---|---|---|---|
//! | Geometry, standard | 0.73 | 1.36 | 0.67 | 1.67 |
//! | Geometry, accurate | 0.22 | 0.60 | 0.18 | 0.21 |
//! | interior with gaps of 0.9 mm in 29 m, standard | 2.80 | 2.51 | 2.35 | 2.35 |
//!
//! Where Geometry is worse, that is on undersides a little higher than what is cut. With a quarter it has 28 % fewer vertices, the interior
//! 5 %. Uncut, boxes that hover are a fifth too dark at the foot, for what they see of the floor; cut, nothing there is off by 5 %.
//! Since corners in gaps look from further inside, Geometry, standard, is at 0.60, and a kitchen with slits in its window's frame at 4.8 for 7.4.

use super::face::Face;
use super::index::Index;
use super::lines::{Line, inside};
use super::shapes::Shapes;
use super::{Piece, Splitter};
use crate::geometry::polygon;
use crate::scene::Sides;
use glam::{DVec2, DVec3};

/// The highest gap, in lengths of the smallest elements: of the light at its rim a twentieth is left after two heights, in half of such
/// an element.
const HIGHEST: f64 = 0.25;

/// Vertices beside a rim, and corners in a gap, are evaluated this many heights of the gap away from where it opens.
const CLEARANCE: f64 = 2.0;

/// The cosine of the steepest slope against a face of what lies in front of it; what is steeper stands on it.
const LYING: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Which gaps are thin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gaps {
    /// How high they are at most, in the frame.
    height: f64,
    /// How high those are at most that vertices keep clear of: against the smallest elements that there may be on a large surface.
    clear: f64,
    /// The length of the smallest elements.
    smallest: f64,
}

/// A side of a surface by the bits of its ends, in order: files repeat a vertex where normals differ.
type Key = [[u64; 3]; 2];

/// A side of a surface in front of a face.
struct Side {
    key: Key,
    /// Whether the surface is on its left from the first end to the second, seen from the front of the face.
    left: bool,
    /// Whether the surface lies in front of the face, rather than stand on it.
    lies: bool,
    rim: Rim,
}

/// What is a rim, or may be one.
#[derive(Clone, Copy)]
pub(super) struct Rim {
    /// That of its upper end.
    height: f64,
    /// In the plane of the face.
    pub foot: Line,
    /// How far from it light is evaluated, at least.
    clearance: f64,
}

/// The rims in front of a face, by place.
pub(super) struct Rims {
    list: Vec<Rim>,
    feet: Index,
    highest: f64,
}

impl Rims {
    pub fn of(list: Vec<Rim>) -> Self {
        Self {
            feet: Index::of(list.iter().map(|rim| rim.foot)),
            highest: list.iter().map(|rim| rim.height).fold(0.0, f64::max),
            list,
        }
    }

    /// How far from the border of a piece of the face light is evaluated, if rims are beside it.
    pub fn clearance(&self, corners: &[DVec2]) -> f64 {
        let beside = |at: &DVec2| {
            let near = self.feet.near([*at; 2], self.highest);
            let rims = near.map(|number| self.list[number]);
            let is_near = |rim: &Rim| nearest_on(rim.foot, *at).distance(*at) <= rim.height;
            rims.filter(is_near)
                .map(|rim| rim.clearance)
                .fold(0.0, f64::max)
        };
        corners.iter().map(beside).fold(0.0, f64::max)
    }
}

impl Splitter<'_> {
    /// How far from the border of a piece light is evaluated, if it has corners in thin gaps or at low steps. Where a gap opens, light comes
    /// in as far as it is high, and is not for an element of many times its length that has a corner there.
    pub(super) fn clearance_in_gaps(&self, piece: &Piece) -> f64 {
        let corners = piece.corners();
        if self.gaps.is_small(corners) || self.gaps.clear <= self.reach {
            return 0.0;
        }
        let heights = corners.iter().map(|corner| self.gap_at(piece, *corner));
        CLEARANCE * heights.flatten().fold(0.0, f64::max)
    }

    /// The height of what lies in front of a corner of a piece, or ends beside it no farther than it is high.
    fn gap_at(&self, piece: &Piece, corner: DVec3) -> Option<f64> {
        let normal = polygon::vector_area(piece.corners()).try_normalize()?;
        let own = self.regions.first(piece.surface);
        let both_sides = self.shapes.surfaces[piece.surface as usize].sides == Sides::Both;
        let height_of = |other: u32| {
            let face = Face::new(&self.shapes.corners(other), self.reach)?;
            let facing = face.facing(piece.corners());
            let up = -face.height(corner) / facing;
            let height = up.abs();
            let is_thin = (face.thickness..=self.gaps.clear).contains(&height);
            if facing.abs() <= LYING || !is_thin || !both_sides && up < 0.0 {
                return None;
            }
            let foot = face.flatten(corner + up * normal);
            let mut depths = (0..face.corners().len()).map(|side| face.depth(side, foot));
            depths.all(|depth| depth > -height).then_some(height)
        };
        let near = self.neighbours.of(&[corner], 2.0 * self.gaps.clear);
        let others =
            near.filter(|other| self.regions.first(*other) != own && !self.shapes.emits(*other));
        others.filter_map(height_of).min_by(f64::total_cmp)
    }
}

impl Gaps {
    /// Those that are thin against elements of this length, in the frame, of which on large surfaces some may be as small as `finest`; none
    /// if these are 0.
    pub fn of(smallest: f64, finest: f64) -> Self {
        Self {
            height: HIGHEST * smallest,
            clear: HIGHEST * finest,
            smallest,
        }
    }

    /// Whether a face is hardly larger than the smallest elements: it is not worth a cut, and there may be a million of those.
    fn is_small(&self, corners: &[DVec3]) -> bool {
        polygon::diameter(corners) <= 2.0 * self.smallest
    }

    /// The rims in front of a face, or on both of its sides, with feet that keep away from the border and from `lines` of contact. `near` gives the surfaces closer than a distance.
    pub fn rims<I: Iterator<Item = u32>>(
        &self,
        face: &Face,
        both_sides: bool,
        lines: &[Line],
        near: impl FnOnce(f64) -> I,
        shapes: &Shapes,
    ) -> Vec<Rim> {
        if self.is_small(face.corners()) || self.height <= face.thickness {
            return Vec::new();
        }
        let lowest = if both_sides { -self.height } else { 0.0 };
        let mut sides: Vec<Side> = near(self.height)
            .flat_map(|other| self.sides(face, lowest, other, shapes))
            .collect();
        sides.sort_by_key(|side| side.key);
        // One that two lying surfaces have in common, on either side of it, is no rim.
        let ends = |of: &&[Side]| {
            let stands = of.iter().any(|side| !side.lies);
            stands || of.iter().all(|side| side.left == of[0].left)
        };
        let rims = sides.chunk_by(|a, b| a.key == b.key).filter(ends);
        let on_face = |rim: Rim| {
            let foot = inside(face, rim.foot)?;
            Some(Rim { foot, ..rim })
        };
        let mut rims: Vec<Rim> = rims.filter_map(|of| on_face(of[0].rim)).collect();
        // Of rims above one another the lowest is sharpest.
        rims.sort_by(|x, y| x.height.total_cmp(&y.height));
        bent(&rims, [&face.outline()[..], lines].concat())
    }

    /// The sides that a surface has in the gap, between the heights `lowest` and that of the gap.
    fn sides(&self, face: &Face, lowest: f64, other: u32, shapes: &Shapes) -> Vec<Side> {
        let corners = shapes.corners(other);
        let feet: Vec<DVec2> = corners.iter().map(|corner| face.flatten(*corner)).collect();
        if face.beside(&feet) {
            return Vec::new();
        }
        let facing = face.facing(&corners);
        let side = |i: usize| {
            let ends = [corners[i], corners[(i + 1) % corners.len()]];
            // No zero but the positive one: both are the same place.
            let [a, b] = ends.map(|end| (end + 0.0).to_array().map(f64::to_bits));
            let turned = b < a;
            let (key, ends) = match turned {
                true => ([b, a], [ends[1], ends[0]]),
                false => ([a, b], ends),
            };
            let (height, foot) = self.within(face, lowest, ends)?;
            let keeps_clear = height <= self.clear && !shapes.emits(other);
            let clearance = if keeps_clear { CLEARANCE * height } else { 0.0 };
            Some(Side {
                key,
                left: turned != (facing > 0.0),
                lies: facing.abs() > LYING,
                rim: Rim {
                    height,
                    foot,
                    clearance,
                },
            })
        };
        (0..corners.len()).filter_map(side).collect()
    }

    /// The height and the foot of what of a side is in the gap; of one that rises from it, only if that is as long as an element. One that touches the
    /// face is a line of contact already.
    fn within(&self, face: &Face, lowest: f64, ends: [DVec3; 2]) -> Option<(f64, Line)> {
        let heights = ends.map(|end| face.height(end));
        let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
        let touches = low >= -face.thickness && high <= face.thickness;
        if touches || high < lowest || low > self.height {
            return None;
        }
        let [a, b] = ends.map(|end| face.flatten(end));
        if low >= lowest && high <= self.height {
            return Some((high.max(-low), [a, b]));
        }
        let foot = |height: f64| {
            let within = height.clamp(lowest, self.height);
            a.lerp(b, (within - heights[0]) / (heights[1] - heights[0]))
        };
        let foot = heights.map(foot);
        (foot[0].distance(foot[1]) > self.smallest).then_some((self.height, foot))
    }
}

/// What is between a rim and a line beside it that is nearer than the gap is high would be a row of needles, and the light at the rim is
/// no sharper. So rims are bent onto lines, and onto lower rims; the lines stay as they are.
fn bent(rims: &[Rim], lines: Vec<Line>) -> Vec<Rim> {
    let mut all = Index::of(lines);
    let mut bent = Vec::new();
    for rim in rims {
        let is_near = |a: DVec2, b: DVec2| a.distance(b) <= rim.height;
        // Its ends move by its height, what it passes is as far away, and what lies on that again.
        let mut near = all.lines_near(rim.foot, 4.0 * rim.height);
        for part in chain(rim.foot, &near, is_near).windows(2) {
            let [a, b] = [part[0], part[1]];
            let on_others = |place: &f64| {
                let at = a.lerp(b, *place);
                near.iter().any(|line| is_near(nearest_on(*line, at), at))
            };
            if !is_near(a, b) && ![0.25, 0.5, 0.75].iter().all(on_others) {
                let foot = [a, b];
                near.push(foot);
                all.push(foot);
                bent.push(Rim { foot, ..*rim });
            }
        }
    }
    bent
}

/// A rim by way of the ends of the lines that it passes.
fn chain(rim: Line, lines: &[Line], is_near: impl Fn(DVec2, DVec2) -> bool) -> Vec<DVec2> {
    let [a, b] = rim.map(|end| snapped(end, lines, &is_near));
    let along = (b - a) / (b - a).length_squared();
    let passed = lines.iter().flatten().filter_map(|end| {
        let place = (*end - a).dot(along);
        let passes = place > 0.0 && place < 1.0 && is_near(a.lerp(b, place), *end);
        passes.then_some((place, *end))
    });
    let mut chain: Vec<(f64, DVec2)> = passed.chain([(0.0, a), (1.0, b)]).collect();
    chain.sort_by(|x, y| x.0.total_cmp(&y.0));
    chain.into_iter().map(|(_, at)| at).collect()
}

/// A point, moved to the nearest end of a line if one is near, else to the nearest point of one.
fn snapped(point: DVec2, lines: &[Line], is_near: impl Fn(DVec2, DVec2) -> bool) -> DVec2 {
    let nearest = |of: &mut dyn Iterator<Item = DVec2>| {
        let near = of.filter(|at| is_near(*at, point));
        near.min_by(|x, y| x.distance(point).total_cmp(&y.distance(point)))
    };
    nearest(&mut lines.iter().flatten().copied())
        .or_else(|| nearest(&mut lines.iter().map(|line| nearest_on(*line, point))))
        .unwrap_or(point)
}

/// The point of a segment that is nearest to another.
fn nearest_on([a, b]: Line, point: DVec2) -> DVec2 {
    let along = b - a;
    let place = (point - a).dot(along) / along.length_squared();
    a.lerp(b, place.clamp(0.0, 1.0))
}
