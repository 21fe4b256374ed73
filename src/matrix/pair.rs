//! What two facets exchange: nothing, all that they would unhindered, or the visible share of it.

use super::effect::{Effect, Lines};
use super::facet::Facet;
use super::hidden::{Looker, Share};
use super::occluder::{Between, Near};
use super::silhouette::Sides;
use super::space::Space;
use super::unhindered::exchange;

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
    /// Whether `lines` are those of the pair at hand.
    has_lines: bool,
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
            has_lines: false,
            rays: 0,
        }
    }

    /// The same, which takes nothing for granted about what is partly hidden.
    pub fn with_care(mut self) -> Self {
        self.looker.is_careful = true;
        self
    }

    /// The exchange of two facets; `near` are the surfaces that may come between facet i and others. The same for (i, j) and (j, i), bit
    /// for bit.
    pub fn exchange(&mut self, i: u32, j: u32, near: &[Near]) -> Exchange {
        let (first, second) = (i.min(j), i.max(j));
        let here = usize::from(first != i);
        let [a, b] = [first, second].map(|k| &self.space.facets[k as usize]);
        let reach = self.space.horizon;
        let Some(a_seen) = a.in_front_of(b, reach) else {
            return Exchange::default();
        };
        let Some(b_seen) = b.in_front_of(a, reach) else {
            return Exchange::default();
        };
        // What is cut off at a horizon lies on other sides.
        let here = [&a_seen, &b_seen][here].is_whole().then_some(here);
        if !self.find_between([&a_seen, &b_seen], near, here) {
            return Exchange::default();
        }
        let [i, j] = [first, second];
        let nodes = [(&a_seen, i), (&b_seen, j)]
            .map(|(part, k)| part.is_whole().then(|| &self.space.nodes[k as usize]));
        let accuracy = self.space.accuracy(i, j);
        let whole = exchange(&a_seen, &b_seen, nodes, accuracy);
        let accuracy = accuracy * whole;
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

    /// Leaves in `between` what may hide some of either facet from the other; false if one body or surface hides all. The sides of `near`
    /// are those on which the facet with the number `here` lies.
    fn find_between(&mut self, pair: [&Facet; 2], near: &[Near], here: Option<usize>) -> bool {
        self.between.clear();
        self.has_lines = false;
        near.iter().all(|near| {
            let occluder = &self.space.occluders[near.occluder as usize];
            let mut sides = [Sides::default(); 2];
            for (k, facet) in pair.into_iter().enumerate() {
                sides[k] = match here == Some(k) {
                    true => near.sides,
                    false => occluder.sides(facet),
                };
            }
            self.find_effect(pair, near.occluder, sides)
        })
    }

    /// Adds an occluder to what lies between; false if it hides all.
    fn find_effect(&mut self, [a, b]: [&Facet; 2], k: u32, sides: [Sides; 2]) -> bool {
        let occluder = &self.space.occluders[k as usize];
        if sides[0].share_a_front(sides[1])
            || occluder.is_beside([a.centroid, b.centroid], a.radius.max(b.radius))
            || !occluder.rises_over(a)
            || !occluder.rises_over(b)
        {
            return true;
        }
        let is_outside = |k: usize| occluder.is_outside([a, b][k], sides[k]);
        if occluder.is_body() && !(is_outside(0) && is_outside(1)) {
            let mut members = occluder.members.clone();
            return members.all(|member| {
                let face = &self.space.occluders[member as usize];
                self.find_effect([a, b], member, [face.sides(a), face.sides(b)])
            });
        }
        if !std::mem::replace(&mut self.has_lines, true) {
            self.lines.set(a.corners(), b.corners());
        }
        let ends = [a.corners(), b.corners()];
        match occluder.effect(&self.lines, ends, sides, self.space.extent) {
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
