//! What points of one facet see of the other past what lies between.

use super::convex::Convex;
use super::facet::Facet;
use super::gauss::{each_more, each_node};
use super::occluder::Between;
use super::space::Space;
use super::unhindered::{seen, seen_afar};
use super::visible::{Cutter, Seen, Sight, TooIntricate};
use super::zones::{Zone, zones};
use glam::DVec3;

/// Corners are looked from a little inside, since on a common edge a form factor has no value.
const INWARDS: f64 = 1e-3;

/// Of what is seen, less than this is what rounding left.
const ROUNDING: f64 = 1e-12;

/// Integrals over a tile of one facet of what its points see of the other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub visible: f64,
    pub all: f64,
    /// Of the square of the visible share, weighted with all.
    pub squares: f64,
}

impl Sums {
    /// How unlike the points see: the variance of their shares.
    pub fn variance(&self) -> f64 {
        if self.all > 0.0 {
            (self.squares / self.all - self.share().powi(2)).max(0.0)
        } else {
            0.0
        }
    }

    pub fn sees_all(&self) -> bool {
        self.visible == self.all
    }

    fn times(self, factor: f64) -> Self {
        Self {
            visible: self.visible * factor,
            all: self.all * factor,
            squares: self.squares * factor,
        }
    }

    /// Whether all points see the same: everything, or nothing.
    pub fn is_plain(&self) -> bool {
        self.sees_all() || self.visible == 0.0
    }

    pub fn share(&self) -> f64 {
        if self.all > 0.0 {
            (self.visible / self.all).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

impl std::ops::Add for Sums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            visible: self.visible + other.visible,
            all: self.all + other.all,
            squares: self.squares + other.squares,
        }
    }
}

impl std::iter::Sum for Sums {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::default(), |a, b| a + b)
    }
}

/// Looks from one facet to the other past what lies between.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub outer: &'a Facet,
    pub inner: &'a Facet,
    pub between: &'a [Between],
    /// Which of the two facets of the pair is looked at.
    pub there: usize,
    /// Whether midpoints are enough for what is seen of the other ([`seen_afar`]).
    pub is_far: bool,
    /// What they exchange with nothing between.
    pub whole: f64,
}

impl Seen {
    /// How much that is of `all`, which is asked for only where it matters.
    pub fn of(self, all: impl FnOnce() -> f64) -> f64 {
        match self {
            Self::All => all(),
            Self::AllBut(hidden) => {
                let all = all();
                let left = all - hidden;
                if left > ROUNDING * all { left } else { 0.0 }
            }
            Self::Nothing => 0.0,
        }
    }
}

impl<'a> View<'a> {
    /// Of a point's hemisphere, what a part of the other facet would fill.
    fn measure(&self, eye: DVec3, part: &[DVec3]) -> f64 {
        let normal = self.outer.normal;
        if self.is_far {
            seen_afar(normal, eye, self.inner.normal, part)
        } else {
            seen(normal, eye, part)
        }
    }

    /// The same for all of it.
    pub fn measure_all(&self, eye: DVec3) -> f64 {
        self.measure(eye, self.inner.corners())
    }

    fn sight(&self, space: &'a Space) -> Sight<'a> {
        Sight {
            facet: self.inner,
            occluders: &space.occluders,
            between: self.between,
            there: self.there,
            extent: space.extent,
        }
    }
}

/// Looks from points; one a thread.
pub(super) struct Eyes<'a> {
    space: &'a Space,
    cutter: Cutter,
    places: Vec<(DVec3, f64)>,
}

impl<'a> Eyes<'a> {
    pub fn new(space: &'a Space) -> Self {
        Self {
            space,
            cutter: Cutter::default(),
            places: Vec::new(),
        }
    }

    /// The facet that looks, divided where what its points see has kinks, without what sees nothing.
    pub fn zones(&mut self, view: View<'_>) -> Vec<Zone> {
        zones(&mut self.cutter, view.outer, view.sight(self.space))
    }

    /// Looks from the four points of the product rule on every tile.
    pub fn look_all(&mut self, view: View<'_>) -> Result<Sums, TooIntricate> {
        let tiles = view.outer.shape.tiles();
        tiles.map(|tile| self.look(view, &tile)).sum()
    }

    /// The same on one tile.
    pub fn look(&mut self, view: View<'_>, tile: &Convex) -> Result<Sums, TooIntricate> {
        let mut sum = Ok(Sums::default());
        each_node(tile, 2, |eye, weight| self.add(view, eye, weight, &mut sum));
        sum
    }

    /// Looks from five more points on every tile, which make nine with those from which `four` were seen.
    pub fn look_closer(&mut self, view: View<'_>, four: Sums) -> Result<Sums, TooIntricate> {
        let mut sum = Ok(four.times(4.0 / 9.0));
        for tile in view.outer.shape.tiles() {
            each_more(&tile, |eye, weight| self.add(view, eye, weight, &mut sum));
        }
        sum
    }

    fn add(
        &mut self,
        view: View<'_>,
        eye: DVec3,
        weight: f64,
        sum: &mut Result<Sums, TooIntricate>,
    ) {
        if let Ok(before) = sum {
            *sum = self.look_from(view, eye, weight).map(|here| *before + here);
        }
    }

    fn look_from(&mut self, view: View<'_>, eye: DVec3, weight: f64) -> Result<Sums, TooIntricate> {
        let found = self.seen_from(view, eye)?;
        let all = view.measure_all(eye);
        let visible = found.of(|| all);
        Ok(Sums {
            visible: weight * visible,
            all: weight * all,
            squares: weight * visible * visible / all.max(f64::MIN_POSITIVE),
        })
    }

    /// What one point sees.
    pub fn seen_from(&mut self, view: View<'_>, eye: DVec3) -> Result<Seen, TooIntricate> {
        let measure = |part: &[DVec3]| view.measure(eye, part);
        self.cutter.seen(eye, view.sight(self.space), measure)
    }

    /// The mean difference between what the corners of a tile see and `share`.
    pub fn corners_differ(
        &mut self,
        view: View<'_>,
        tile: &Convex,
        share: f64,
    ) -> Result<f64, TooIntricate> {
        let mut sum = 0.0;
        for eye in corners_inside(tile) {
            let there = self.look_from(view, eye, 1.0)?;
            sum += (there.share() - share).abs();
        }
        Ok(sum / tile.corners().len() as f64)
    }

    /// Whether a facet is hidden from four points of each of some tiles of the other, which is asked before anything else since it
    /// needs no form factor.
    pub fn is_hidden(&mut self, view: View<'_>, tiles: impl Iterator<Item = Convex>) -> bool {
        self.places.clear();
        for tile in tiles {
            each_node(&tile, 2, |eye, weight| self.places.push((eye, weight)));
        }
        self.all_hidden(view)
    }

    /// The same from the corners.
    pub fn corners_hidden(&mut self, view: View<'_>) -> bool {
        let shape = &view.outer.shape;
        self.places.clear();
        self.places
            .extend(corners_inside(shape).map(|eye| (eye, 0.0)));
        self.all_hidden(view)
    }

    fn all_hidden(&mut self, view: View<'_>) -> bool {
        let sight = view.sight(self.space);
        for (eye, _) in &self.places {
            if !self.cutter.hides(*eye, sight) {
                return false;
            }
        }
        true
    }
}

/// The corners of a tile, moved inwards a little.
fn corners_inside(tile: &Convex) -> impl Iterator<Item = DVec3> + '_ {
    let corners = tile.corners();
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    corners
        .iter()
        .map(move |corner| corner.lerp(middle, INWARDS))
}
