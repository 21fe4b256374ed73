//! The visible share of a pair with surfaces between: two independent quadratures, one over each facet, that must agree.
//!
//! From a point of one facet the visible part of the other is known exactly ([`super::visible`]), so only the integral over the
//! point is left. It is smooth from the side that is farther from what lies between and nearly a step from the nearer one;
//! where the two sides agree, both are right. Where they do not, the smoother one is refined until it is stable. Numbers of points that
//! agree by accident are found out by a third that does not. If the other side still says something else, as it does where all points miss a
//! sliver, the smoother one is divided into zones ([`super::zones`]) and integrated without trust in a few points ([`super::integral`]).
//! So is it where agreement says nothing: where next to nothing is visible, where the sides mirror one another, and where row sums tell that
//! it went wrong all the same ([`super::again`]).
//!
//! What the pair would exchange unhindered is known beforehand. Where the same points come to something else, as they do near a
//! common edge, the difference is visible as far as the tiles are that caused it.

use super::convex::Convex;
use super::facet::Facet;
use super::integral::Integral;
use super::look::{Eyes, Sums, View};
use super::occluder::Between;
use super::pair::Kind;
use super::rays::Sampler;
use super::refined::Refined;
use super::silhouette::Planes;
use super::space::Space;
use super::unhindered::{exchange, is_afar};
use super::visible::TooIntricate;

/// With more surfaces than this between, rays are traced instead.
const MOST_CUT: usize = 64;

/// Of the tolerance of a share, how accurately its parts are measured.
const MEASURED: f64 = 0.1;

/// How often a tile may be quartered.
const DEEPEST: u32 = 5;

/// What four points that see alike may have missed, in units of the tile and of what its corners see otherwise: a fifth of the tile lies
/// outside of them, where a shadow that reaches two corners grows from nothing.
const BETWEEN_POINTS: f64 = 0.2;

/// What nine points may have missed of a shadow that four of them did not meet: the tenth of the tile that lies beyond them.
const MISSED: f64 = 0.1;

/// The error of the quarters over what they changed: a kink runs through two of the four, where it matters an eighth as much.
const GAIN: f64 = 1.0 / 3.0;

/// What of a tolerance each quarter may use: a kink runs through twice as many cells on each level, with errors of either sign.
const SHARED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Four and nine points of one side may agree by accident: this much of what they differ by from four points of the other is error too.
const OTHER: f64 = 0.5;

/// The less smooth side may differ by as much as its own error, but by no more than this many tolerances.
const AGREES: f64 = 4.0;

/// Four and sixteen points of one side may agree by accident too: this much of what nine differ from the sixteen by must be no more than
/// the tolerance. Of 5,900 pairs in random rooms seven were off by more than four times what was estimated; of these it leaves one,
/// whose sides were alike.
const NINE: f64 = 0.75;

/// Where less than this is visible from either side, few points may have missed most of it: slits along edges.
const DARK: f64 = 0.01;

/// Of the tolerance, what both sides are integrated to where nothing is taken for granted.
const CAREFUL: f64 = 0.1;

/// Sides that see the same to within this fraction of what is exchanged mirror one another, as adjacent walls around a cube do: each says
/// what the other says, whatever both miss.
const MIRRORED: f64 = 1e-6;

/// What came out.
pub(super) struct Share {
    /// The share of the unhindered exchange that is left, 0 to 1.
    pub visible: f64,
    pub error: f64,
    pub kind: Kind,
    pub rays: u64,
}

impl Share {
    /// A share with its error, found by cutting.
    fn of((visible, error): (f64, f64), tolerance: f64) -> Self {
        let kind = if error <= tolerance {
            Kind::Cut
        } else {
            Kind::Limited
        };
        Self {
            visible,
            error,
            kind,
            rays: 0,
        }
    }
}

/// Finds visible shares.
pub(super) struct Looker<'a> {
    space: &'a Space,
    eyes: Eyes<'a>,
    /// What lies between, in the order in which it is cut out from either side.
    orders: [Vec<Between>; 2],
    sampler: Sampler<'a>,
    /// Whether agreement between few points is not enough.
    pub is_careful: bool,
}

impl<'a> Looker<'a> {
    pub fn new(space: &'a Space) -> Self {
        Self {
            space,
            eyes: Eyes::new(space),
            orders: Default::default(),
            sampler: Sampler::new(space),
            is_careful: false,
        }
    }

    /// The share of `whole`, what two facets exchange unhindered, that passes the surfaces between, to within `tolerance`; `key`
    /// seeds jitter.
    pub fn share(
        &mut self,
        facets: [&Facet; 2],
        between: &[Between],
        whole: f64,
        tolerance: f64,
        key: [u32; 2],
    ) -> Share {
        if between.len() <= MOST_CUT
            && let Ok(share) = self.cut(facets, between, whole, tolerance)
        {
            return share;
        }
        // The outline of a round body has more corners than there is room for; each of its faces has few.
        let faces = self.faces(facets, between);
        if (between.len() + 1..=MOST_CUT).contains(&faces.len())
            && let Ok(share) = self.cut(facets, &faces, whole, tolerance)
        {
            return share;
        }
        self.sampler.share(facets, tolerance, key)
    }

    /// What lies between, with its faces in place of each body.
    fn faces(&self, facets: [&Facet; 2], between: &[Between]) -> Vec<Between> {
        let occluders = &self.space.occluders;
        let mut faces = Vec::new();
        for it in between {
            let body = &occluders[it.occluder as usize];
            if !body.is_body() {
                faces.push(*it);
            }
            faces.extend(body.members.clone().filter_map(|member| {
                let sides = facets.map(|facet| occluders[member as usize].sides(facet));
                let is_between = !sides[0].share_a_front(sides[1]);
                is_between.then_some(Between {
                    occluder: member,
                    planes: Planes::ALL,
                    sides,
                })
            }));
        }
        faces
    }

    fn cut(
        &mut self,
        [a, b]: [&Facet; 2],
        between: &[Between],
        whole: f64,
        tolerance: f64,
    ) -> Result<Share, TooIntricate> {
        let mut orders = std::mem::take(&mut self.orders);
        for (order, eye) in orders.iter_mut().zip([a, b]) {
            // What faces the eye hides the backs of solids: cut out first, it leaves nothing for them to cut.
            order.clear();
            order.extend_from_slice(between);
            let occluders = &self.space.occluders;
            order.sort_by_key(|it| {
                occluders[it.occluder as usize].is_seen_from_behind(eye.centroid)
            });
        }
        let gap = a.centroid.distance(b.centroid) - a.radius - b.radius;
        let view = |outer, inner, k: usize| View {
            outer,
            inner,
            between: &orders[k],
            there: 1 - k,
            whole,
            is_far: is_afar(gap, inner, MEASURED * tolerance),
        };
        let views = [view(a, b, 0), view(b, a, 1)];
        let share = match self.is_careful {
            true => self.integrate_with_care(views, tolerance),
            false => self.integrate(views, tolerance),
        };
        self.orders = orders;
        share
    }

    /// Looks from few points of both sides, refines the smoother one where that is not enough, and divides it where they differ.
    fn integrate(&mut self, views: [View<'_>; 2], tolerance: f64) -> Result<Share, TooIntricate> {
        let [view, back] = views;
        let sides = [view, back];
        let is_hidden = |it: &View<'_>| self.eyes.is_hidden(*it, it.outer.shape.tiles());
        if sides.iter().all(is_hidden) && self.eyes.corners_hidden(view) {
            let zones = self.eyes.zones(view);
            let tiles = zones.iter().flat_map(|zone| zone.shape.tiles());
            if self.eyes.is_hidden(view, tiles) {
                return Ok(Share::of((0.0, 0.0), tolerance));
            }
        }
        let coarse = [self.eyes.look_all(view)?, self.eyes.look_all(back)?];
        if are_mirrored(coarse, view.whole) {
            return Ok(Share::of(self.divide(view, tolerance)?, tolerance));
        }
        if coarse.iter().all(|it| it.share() < DARK) {
            let found = self.divide(view, tolerance)?;
            let other = self.divide(back, tolerance)?;
            return Ok(Share::of(better(found, other), tolerance));
        }
        if coarse.iter().all(Sums::sees_all) {
            let error = BETWEEN_POINTS * self.eyes.corners_differ(view, &view.outer.shape, 1.0)?;
            if error <= tolerance {
                return Ok(Share::of((1.0, error), tolerance));
            }
        }
        let (mut smooth, mut rough) = ((view, coarse[0]), (back, coarse[1]));
        if smooth.1.variance() > rough.1.variance() {
            std::mem::swap(&mut smooth, &mut rough);
        }
        let mut guess = self.guess(smooth)?;
        if guess.1.max((guess.0 - rough.1.share()).abs()) <= tolerance {
            return Ok(Share::of(guess, tolerance));
        }
        let mut other = self.guess(rough)?;
        if other.1 < guess.1 {
            std::mem::swap(&mut smooth, &mut rough);
            std::mem::swap(&mut guess, &mut other);
        }
        let limit = other.1.clamp(tolerance, AGREES * tolerance);
        let agrees = |found: (f64, f64)| (found.0 - other.0).abs() <= limit;
        let differs = OTHER * (guess.0 - rough.1.share()).abs();
        if guess.1.max(differs) <= tolerance && agrees(guess) {
            return Ok(Share::of(guess, tolerance));
        }
        let found = self.refine_all(smooth, guess.0, tolerance)?;
        if found.1 <= tolerance && agrees(found) {
            return Ok(Share::of(found, tolerance));
        }
        let found = self.divide(smooth.0, tolerance)?;
        if found.1 <= tolerance {
            return Ok(Share::of(found, tolerance));
        }
        let other = self.divide(rough.0, tolerance)?;
        Ok(Share::of(better(found, other), tolerance))
    }

    /// Divides both sides, whatever few points say.
    fn integrate_with_care(
        &mut self,
        [view, back]: [View<'_>; 2],
        tolerance: f64,
    ) -> Result<Share, TooIntricate> {
        let found = self.divide(view, CAREFUL * tolerance)?;
        let other = self.divide(back, CAREFUL * tolerance)?;
        Ok(Share::of(better(found, other), tolerance))
    }

    /// The share that one side sees, with its error, divided along the lines where what its points see has kinks.
    fn divide(&mut self, view: View<'_>, tolerance: f64) -> Result<(f64, f64), TooIntricate> {
        let zones = self.eyes.zones(view);
        let Integral { value, error } = self.eyes.integral(view, &zones, tolerance * view.whole)?;
        Ok(((value / view.whole).clamp(0.0, 1.0), error / view.whole))
    }

    /// The share that one side sees from nine points a tile, and its error.
    fn guess(&mut self, (view, coarse): (View<'_>, Sums)) -> Result<(f64, f64), TooIntricate> {
        let fine = self.eyes.look_closer(view, coarse)?;
        let share = fine.share();
        let error = (share - coarse.share())
            .abs()
            .hypot(share * (1.0 - share) * (fine.all / view.whole - 1.0));
        let missed = if coarse.is_plain() { MISSED } else { 0.0 };
        Ok((share, error.max(missed)))
    }

    /// The share that one side sees, refined to `tolerance`, with its error; `side` is what it sees from four points a tile, `nine` the
    /// share from nine.
    fn refine_all(
        &mut self,
        side: (View<'_>, Sums),
        nine: f64,
        tolerance: f64,
    ) -> Result<(f64, f64), TooIntricate> {
        let whole = side.0.whole;
        let shape = side.0.outer.shape;
        let tiles: Vec<Convex> = shape.tiles().collect();
        let refined = self.refine_tiles(side, &tiles, tolerance, 0)?;
        let found = refined.share(whole);
        if refined.depth > 0 || NINE * (found.0 - nine).abs() <= tolerance {
            return Ok(found);
        }
        let refined = self.refine_tiles(side, &tiles, tolerance, 1)?;
        Ok(refined.share(whole))
    }

    /// Refines all tiles, quartering their quarters so many times at `least`.
    fn refine_tiles(
        &mut self,
        (view, coarse): (View<'_>, Sums),
        tiles: &[Convex],
        tolerance: f64,
        least: u32,
    ) -> Result<Refined, TooIntricate> {
        let mut refined = Refined::default();
        for tile in tiles {
            let (here, whole) = match tiles.len() {
                1 => (coarse, view.whole),
                _ => {
                    let whole = Facet::new(*tile).map_or(0.0, |it| {
                        exchange(&it, view.inner, [None; 2], MEASURED * tolerance)
                    });
                    (self.eyes.look(view, tile)?, whole)
                }
            };
            let part = self.refine(view, tile, here, tolerance * view.whole, 0, least)?;
            refined.add(part.completed(whole));
        }
        Ok(refined)
    }

    /// Quarters a tile until the error of its visible integral is below `tolerance`; its own depth is `depth`, and `least` is to be
    /// reached.
    fn refine(
        &mut self,
        view: View<'_>,
        tile: &Convex,
        coarse: Sums,
        tolerance: f64,
        depth: u32,
        least: u32,
    ) -> Result<Refined, TooIntricate> {
        let quarters = tile.quarters();
        let mut parts = [Sums::default(); 4];
        for (part, quarter) in parts.iter_mut().zip(&quarters) {
            *part = self.eyes.look(view, quarter)?;
        }
        let fine: Sums = parts.iter().copied().sum();
        let shift = GAIN * (fine.visible - coarse.share() * fine.all);
        let mut error = shift.abs();
        if error <= tolerance && fine.is_plain() {
            let differ = self.eyes.corners_differ(view, tile, fine.share())?;
            error = 0.5 * BETWEEN_POINTS * differ * fine.all;
        }
        if (error <= tolerance && depth >= least) || depth == DEEPEST {
            let unsteady = (fine.all - coarse.all).abs();
            let off = Sums {
                visible: unsteady * fine.share(),
                all: unsteady,
                ..Sums::default()
            };
            return Ok(Refined {
                sums: fine,
                off,
                error,
                shift,
                depth,
            });
        }
        let mut refined = Refined::default();
        for (part, quarter) in parts.into_iter().zip(&quarters) {
            refined.add(self.refine(view, quarter, part, SHARED * tolerance, depth + 1, least)?);
        }
        Ok(refined)
    }
}

/// Whether both sides see a part, and the same one.
fn are_mirrored(sides: [Sums; 2], whole: f64) -> bool {
    let [one, other] = sides.map(|it| it.visible);
    !sides.iter().any(Sums::is_plain) && (one - other).abs() <= MIRRORED * whole
}

/// Of two shares with their errors the better one; what they differ by is error too.
fn better(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    let (share, error) = if one.1 <= other.1 { one } else { other };
    (share, error.max((one.0 - other.0).abs()))
}
