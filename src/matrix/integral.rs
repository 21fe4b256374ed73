//! What is seen from zones of a facet, integrated: the worst tile is halved first, across the direction in which it is roughest.
//!
//! Through a slit of a thousandth of a facet's width, points see something only beside an edge, over a length as small. Quarters go there
//! slowly, and four points that hardly see anything agree with sixteen that do not either. So every tile tells by the rule of `genz_malik`
//! what it may have missed. Along one slit all tiles miss the same: their errors are added up with their signs, and count for no less than
//! if they had any. What only corners saw has no sign.

use super::convex::Convex;
use super::facet::Facet;
use super::gauss::place;
use super::genz_malik::{Estimate, POINTS, RULE, roughness};
use super::look::{Eyes, View};
use super::unhindered::exchange;
use super::visible::{Seen, TooIntricate};
use super::zones::Zone;
use glam::DVec3;

/// Where these are not enough, the error is stated as it is then.
const MOST_TILES: usize = 512;

/// Of the error that an integral may have, what the exchange of all zones unhindered may be off by.
const KNOWN: f64 = 0.01;

/// An integral with its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integral {
    pub value: f64,
    pub error: f64,
}

/// What is integrated over a zone: what is visible, or, where that is smoother, as beside a common edge, what is hidden of what is known.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Of {
    Visible,
    Hidden,
}

/// A quad, or a triangle with its last corner twice.
type Quad = [DVec3; 4];

#[derive(Debug, Clone, Copy)]
struct Tile {
    corners: Quad,
    of: Of,
    estimate: Estimate,
    /// Whether it is halved between its first two corners.
    halves_first: bool,
}

impl Eyes<'_> {
    /// Integrates what is visible from `zones` to `tolerance`.
    pub fn integral(
        &mut self,
        view: View<'_>,
        zones: &[Zone],
        tolerance: f64,
    ) -> Result<Integral, TooIntricate> {
        let accuracy = KNOWN * tolerance / view.whole;
        let whole = |part: &Convex| {
            let facet = Facet::new(*part);
            facet.map_or(0.0, |it| exchange(&it, view.inner, [None; 2], accuracy))
        };
        let (mut known, mut tiles) = (0.0, Vec::with_capacity(2 * zones.len()));
        for zone in zones {
            if zone.is_clear {
                known += whole(&zone.shape);
                continue;
            }
            for part in zone.shape.tiles() {
                let tile = self.first_tile(view, part.quad())?;
                if tile.of == Of::Hidden {
                    known += whole(&part);
                }
                tiles.push(tile);
            }
        }
        loop {
            let error = error(&tiles);
            let Some(worst) = worst(&tiles).filter(|_| error > tolerance) else {
                let value = known + tiles.iter().map(Tile::visible).sum::<f64>();
                return Ok(Integral { value, error });
            };
            let halved = tiles[worst];
            let [one, other] = halved.halves();
            tiles[worst] = self.tile(view, one, halved.of)?;
            tiles.push(self.tile(view, other, halved.of)?);
        }
    }

    /// A tile of what is smoother on it.
    fn first_tile(&mut self, view: View<'_>, corners: Quad) -> Result<Tile, TooIntricate> {
        let (mut visible, mut hidden) = ([0.0; POINTS], [0.0; POINTS]);
        for (k, (eye, area)) in places(corners).enumerate() {
            let seen = self.seen_from(view, eye)?;
            let all = view.measure_all(eye);
            visible[k] = area * seen.of(|| all);
            hidden[k] = area * all - visible[k];
        }
        let [seen, missed] = [(&visible, Of::Visible), (&hidden, Of::Hidden)]
            .map(|(values, of)| Tile::new(corners, of, values));
        Ok(match missed.estimate.error() < seen.estimate.error() {
            true => missed,
            false => seen,
        })
    }

    fn tile(&mut self, view: View<'_>, corners: Quad, of: Of) -> Result<Tile, TooIntricate> {
        let mut values = [0.0; POINTS];
        for (value, (eye, area)) in values.iter_mut().zip(places(corners)) {
            let seen = self.seen_from(view, eye)?;
            let all = || view.measure_all(eye);
            *value = area
                * match (of, seen) {
                    (Of::Visible, seen) => seen.of(all),
                    (Of::Hidden, Seen::All) => 0.0,
                    (Of::Hidden, Seen::AllBut(hidden)) => hidden,
                    (Of::Hidden, Seen::Nothing) => all(),
                };
        }
        Ok(Tile::new(corners, of, &values))
    }
}

impl Tile {
    fn new(corners: Quad, of: Of, values: &[f64; POINTS]) -> Self {
        let [a, b, _, d] = corners;
        let [first, second] = roughness(values);
        Self {
            corners,
            of,
            estimate: RULE.estimate(values),
            halves_first: match first == second {
                true => a.distance_squared(b) >= a.distance_squared(d),
                false => first > second,
            },
        }
    }

    /// What it adds to what is visible, beside what is known.
    fn visible(&self) -> f64 {
        match self.of {
            Of::Visible => self.estimate.value,
            Of::Hidden => -self.estimate.value,
        }
    }

    fn shift(&self) -> f64 {
        match self.of {
            Of::Visible => self.estimate.shift,
            Of::Hidden => -self.estimate.shift,
        }
    }

    fn halves(&self) -> [Quad; 2] {
        let [a, b, c, d] = self.corners;
        if self.halves_first {
            let (low, high) = (a.midpoint(b), d.midpoint(c));
            [[a, low, high, d], [low, b, c, high]]
        } else {
            let (left, right) = (a.midpoint(d), b.midpoint(c));
            [[a, b, right, left], [left, right, c, d]]
        }
    }
}

/// The points of the rule on a quad, each with the area for which it stands if it has all the weight.
fn places(corners: Quad) -> impl Iterator<Item = (DVec3, f64)> {
    RULE.points
        .iter()
        .map(move |[u, v]| place(corners, 0.5 + 0.5 * u, 0.5 + 0.5 * v))
}

fn error(tiles: &[Tile]) -> f64 {
    let shifts = || tiles.iter().map(Tile::shift);
    let together = shifts().sum::<f64>().abs();
    let apart = shifts().map(|shift| shift * shift).sum::<f64>().sqrt();
    let beyond: f64 = tiles.iter().map(|tile| tile.estimate.beyond).sum();
    together.max(apart) + beyond
}

/// The tile to be halved next; none where there are too many.
fn worst(tiles: &[Tile]) -> Option<usize> {
    let error = |k: &usize| tiles[*k].estimate.error();
    let ordered = |a: &usize, b: &usize| error(a).total_cmp(&error(b)).then(b.cmp(a));
    (0..tiles.len())
        .max_by(ordered)
        .filter(|_| tiles.len() < MOST_TILES)
}
