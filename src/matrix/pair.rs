//! What two facets exchange: nothing, all that they would unhindered, or the visible share of it.

use super::facet::Facet;
use super::hidden::{Looker, Share};
use super::effect::{Effect, Lines};
use super::occluder::Between;
use super::space::Space;
use glam::DVec3;

/// What a pair of facets exchanges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Exchange {
    /// A_i F_ij = A_j F_ji, in frame units squared.
    pub amount: f64,
    /// Estimate of its error.
    pub error: f64,
    pub kind: Kind,
}

/// How an exchange was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Kind {
    /// The facets face away from one another, or one surface hides them: exactly 0.
    #[default]
    Nothing,
    /// Nothing lies between.
    Unhindered,
    /// Shadows were cut out.
    Cut,
    /// Rays were traced.
    Sampled,
    /// As either, but the limit came before the tolerance.
    Limited,
}

/// Works through pairs; one a thread.
pub(super) struct Worker<'a> {
    space: &'a Space,
    looker: Looker<'a>,
    between: Vec<Between>,
    lines: Lines,
    /// Rays traced so far.
    pub rays: u64,
}

impl<'a> Worker<'a> {
    pub fn new(space: &'a Space) -> Self {
        Self {
            space,
            looker: Looker::new(space),
            between: Vec::new(),
            lines: Lines::NONE,
            rays: 0,
        }
    }

    /// The exchange of two facets; `near` are the surfaces that may come between. The same for (i, j) and (j, i), bit for bit.
    pub fn exchange(&mut self, i: u32, j: u32, near: &[u32]) -> Exchange {
        let (i, j) = (i.min(j), i.max(j));
        let [a, b] = [i, j].map(|k| &self.space.facets[k as usize]);
        let reach = self.space.horizon;
        let Some(a_seen) = a.in_front_of(b, reach) else {
            return Exchange::default();
        };
        let Some(b_seen) = b.in_front_of(a, reach) else {
            return Exchange::default();
        };
        if !self.find_between(&a_seen, &b_seen, near) {
            return Exchange::default();
        }
        let nodes = [(&a_seen, i), (&b_seen, j)]
            .map(|(part, k)| part.is_whole().then(|| &self.space.nodes[k as usize]));
        let ranges = &self.space.ranges;
        let whole = ranges.exchange(&a_seen, &b_seen, nodes);
        let accuracy = ranges.accuracy * whole;
        if self.between.is_empty() || whole == 0.0 {
            return Exchange {
                amount: whole,
                error: accuracy,
                kind: Kind::Unhindered,
            };
        }
        let tolerance = self.space.share_tolerance(i, j, whole);
        let Share {
            visible,
            error,
            kind,
            rays,
        } = self
            .looker
            .share([&a_seen, &b_seen], &self.between, whole, tolerance, [i, j]);
        self.rays += rays;
        Exchange {
            amount: whole * visible,
            error: whole * error + accuracy * visible,
            kind,
        }
    }

    /// Leaves in `between` what may hide some of either facet from the other; false if one body or surface hides all.
    fn find_between(&mut self, a: &Facet, b: &Facet, near: &[u32]) -> bool {
        self.between.clear();
        if near.is_empty() {
            return true;
        }
        self.lines.set(&a.shape, &b.shape);
        let bounds = (a.low.min(b.low), a.high.max(b.high));
        near.iter().all(|k| self.find_effect([a, b], *k, bounds))
    }

    /// Adds an occluder to what lies between; false if it hides all.
    fn find_effect(&mut self, [a, b]: [&Facet; 2], k: u32, (low, high): (DVec3, DVec3)) -> bool {
        let occluder = &self.space.occluders[k as usize];
        let apart = occluder.low.cmpge(high).any() || occluder.high.cmple(low).any();
        if apart || !occluder.rises_over(a) || !occluder.rises_over(b) {
            return true;
        }
        let sides = [a, b].map(|facet| occluder.sides(facet.corners()));
        let is_outside = |k: usize| occluder.is_outside([a, b][k], sides[k]);
        if occluder.is_body() && !(is_outside(0) && is_outside(1)) {
            let mut members = occluder.members.clone();
            return members.all(|member| self.find_effect([a, b], member, (low, high)));
        }
        match occluder.effect(&self.lines, sides, self.space.extent) {
            Effect::None => true,
            Effect::All => false,
            Effect::Some(planes) => {
                self.between.push(Between {
                    occluder: k,
                    planes,
                    sides,
                });
                true
            }
        }
    }
}
