//! What a point sees of a facet past the surfaces between: exactly, by cutting their shadows out of it.

use super::convex::{Convex, fan, part_above};
use super::facet::Facet;
use super::occluder::{Between, Occluder};
use super::silhouette::Plane;
use glam::DVec3;
use std::ops::Range;

/// More fragments than this are not worth cutting: rays do it faster.
const MOST_FRAGMENTS: usize = 128;

/// Room for fragments and planes, reused from point to point.
#[derive(Default)]
pub(super) struct Cutter {
    /// The planes of all shadows, one after the other.
    planes: Vec<Plane>,
    shadows: Vec<Range<usize>>,
    fragments: Vec<Convex>,
    /// What a shadow covers of the facet, plane by plane: before the next, and after.
    covered: (Vec<DVec3>, Vec<DVec3>),
}

/// The shape has become too intricate to cut further.
#[derive(Debug, PartialEq)]
pub(super) struct TooIntricate;

/// What a point sees of a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Seen {
    All,
    /// All but this much.
    AllBut(f64),
    Nothing,
}

/// What a shadow does to a facet.
enum Shadow {
    Misses,
    /// Its planes that run through the facet have been appended.
    Cuts,
    Covers,
}

/// A point, what it looks at, past what.
#[derive(Clone, Copy)]
pub(super) struct Sight<'a> {
    pub facet: &'a Facet,
    pub occluders: &'a [Occluder],
    pub between: &'a [Between],
    /// Which of the two facets of the pair is looked at.
    pub there: usize,
    pub extent: f64,
}

impl Cutter {
    /// What `eye` sees, by the `measure` of what is hidden.
    pub fn seen(
        &mut self,
        eye: DVec3,
        sight: Sight<'_>,
        measure: impl Fn(&[DVec3]) -> f64,
    ) -> Result<Seen, TooIntricate> {
        self.planes.clear();
        self.shadows.clear();
        let mut hidden = 0.0;
        for between in sight.between {
            let begin = self.planes.len();
            match self.shadow(eye, sight, between) {
                Shadow::Misses => {}
                Shadow::Covers => return Ok(Seen::Nothing),
                Shadow::Cuts => hidden += self.hidden_first_by(begin, sight.facet, &measure)?,
            }
        }
        Ok(match self.shadows.is_empty() {
            true => Seen::All,
            false => Seen::AllBut(hidden),
        })
    }

    /// Whether occluders hide all of a facet from `eye`, as far as that is easily told.
    pub fn hides(&mut self, eye: DVec3, sight: Sight<'_>) -> bool {
        self.planes.clear();
        self.fragments.clear();
        self.fragments.push(sight.facet.shape);
        for between in sight.between {
            let begin = self.planes.len();
            match self.shadow(eye, sight, between) {
                Shadow::Misses => continue,
                Shadow::Covers => return true,
                Shadow::Cuts => {}
            }
            if subtract(&self.planes[begin..], &mut self.fragments).is_err() {
                return false;
            }
            if self.fragments.is_empty() {
                return true;
            }
        }
        false
    }

    /// The planes through a facet of the shadows that one occluder casts on it from several points; `None` if some casts none.
    pub fn shadow_from_all(
        &mut self,
        eyes: &[DVec3],
        sight: Sight<'_>,
        between: &Between,
    ) -> Option<&[Plane]> {
        self.planes.clear();
        for eye in eyes {
            if let Shadow::Misses = self.shadow(*eye, sight, between) {
                return None;
            }
        }
        Some(&self.planes)
    }

    /// Appends the planes of a shadow that run through the facet.
    fn shadow(&mut self, eye: DVec3, sight: Sight<'_>, between: &Between) -> Shadow {
        let begin = self.planes.len();
        let mut misses = false;
        let Between {
            occluder,
            planes,
            sides,
        } = between;
        let occluder = &sight.occluders[*occluder as usize];
        let there = sides[sight.there];
        let hides = occluder.shadow(eye, *planes, there, sight.extent, |plane| {
            let (low, high) = sight.facet.range_over(plane.normal, plane.offset);
            misses = high <= plane.reach;
            if !misses && low < -plane.reach {
                self.planes.push(plane);
            }
            !misses
        });
        if misses || !hides {
            self.planes.truncate(begin);
            Shadow::Misses
        } else if self.planes.len() == begin {
            Shadow::Covers
        } else {
            Shadow::Cuts
        }
    }

    /// The measure of what the shadow with the planes from `begin` on hides of a facet and none before it does.
    fn hidden_first_by(
        &mut self,
        begin: usize,
        facet: &Facet,
        measure: impl Fn(&[DVec3]) -> f64,
    ) -> Result<f64, TooIntricate> {
        let [mut from, mut to] = [&mut self.covered.0, &mut self.covered.1];
        from.clear();
        from.extend_from_slice(facet.corners());
        for plane in &self.planes[begin..] {
            part_above(from, |c| plane.height(c), plane.reach, to);
            if to.len() < 3 {
                self.planes.truncate(begin);
                return Ok(0.0);
            }
            std::mem::swap(&mut from, &mut to);
        }
        let is_first = self.shadows.is_empty();
        self.shadows.push(begin..self.planes.len());
        if is_first {
            return Ok(measure(from));
        }
        self.fragments.clear();
        self.fragments.extend(fan(from));
        for earlier in &self.shadows[..self.shadows.len() - 1] {
            subtract(&self.planes[earlier.clone()], &mut self.fragments)?;
        }
        let fragments = self.fragments.iter();
        Ok(fragments.map(|part| measure(part.corners())).sum())
    }
}

/// Takes the common part of all half-spaces off all fragments.
fn subtract(planes: &[Plane], fragments: &mut Vec<Convex>) -> Result<(), TooIntricate> {
    // Backwards, since the last part of what is cut takes its place.
    for k in (0..fragments.len()).rev() {
        if misses(&fragments[k], planes) {
            continue;
        }
        let (fragment, before) = (fragments[k], fragments.len());
        if cut_out(fragment, planes, fragments)?.is_some() {
            fragments.swap_remove(k);
        } else {
            fragments.truncate(before);
        }
    }
    if fragments.len() > MOST_FRAGMENTS {
        Err(TooIntricate)
    } else {
        Ok(())
    }
}

/// Whether a fragment lies outside of one half-space.
fn misses(fragment: &Convex, planes: &[Plane]) -> bool {
    let outside = |plane: &Plane| {
        fragment
            .corners()
            .iter()
            .all(|c| plane.height(*c) <= plane.reach)
    };
    planes.iter().any(outside)
}

/// Appends the parts of a fragment outside of any half-space, and returns the part within all; `None` if there is none.
pub(super) fn cut_out(
    mut rest: Convex,
    planes: &[Plane],
    parts: &mut Vec<Convex>,
) -> Result<Option<Convex>, TooIntricate> {
    let mut heights = [0.0; Convex::MOST];
    for plane in planes {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (slot, corner) in heights.iter_mut().zip(rest.corners()) {
            *slot = plane.height(*corner);
            low = low.min(*slot);
            high = high.max(*slot);
        }
        if high <= plane.reach {
            return Ok(None);
        }
        if low >= -plane.reach {
            continue;
        }
        if rest.is_full() {
            return Err(TooIntricate);
        }
        let halves = rest.divide_at(&heights, plane.reach);
        parts.push(halves.below);
        rest = halves.above;
    }
    Ok(Some(rest))
}

#[cfg(test)]
mod tests {
    use super::super::silhouette::{Planes, Sides};
    use super::super::unhindered::seen;
    use super::*;

    fn square(height: f64, size: f64, at: [f64; 2]) -> Vec<DVec3> {
        [[-size, size], [size, size], [size, -size], [-size, -size]]
            .map(|[u, v]| DVec3::new(u + at[0], v + at[1], height))
            .to_vec()
    }

    fn seen_past(occluders: &[Vec<DVec3>]) -> f64 {
        let facet = Facet::new(Convex::new(&square(2.0, 1.0, [0.0; 2]))).expect("has an area");
        let occluders: Vec<_> = occluders
            .iter()
            .filter_map(|c| Occluder::new(c.clone(), 1e-6))
            .collect();
        let between = |(k, occluder): (usize, &Occluder)| Between {
            occluder: k as u32,
            planes: Planes::ALL,
            sides: [Sides::default(), occluder.sides(&facet)],
        };
        let between: Vec<_> = occluders.iter().enumerate().map(between).collect();
        let sight = Sight {
            facet: &facet,
            occluders: &occluders,
            between: &between,
            there: 1,
            extent: 4.0,
        };
        let measure = |part: &[DVec3]| seen(DVec3::Z, DVec3::ZERO, part);
        let mut cutter = Cutter::default();
        let found = cutter.seen(DVec3::ZERO, sight, measure).expect("is simple");
        let all = measure(facet.corners());
        let left = match found {
            Seen::All => all,
            Seen::AllBut(hidden) => all - hidden,
            Seen::Nothing => 0.0,
        };
        assert_eq!(cutter.hides(DVec3::ZERO, sight), left < 1e-12);
        left
    }

    #[test]
    fn what_is_hidden_and_what_is_seen_add_up() {
        let all = seen_past(&[]);
        let hole = seen_past(&[square(1.0, 0.25, [0.1, 0.05])]);
        let around = [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        // Four squares that leave a window of 0.25 by 0.25 around the middle.
        let frame: Vec<_> = around
            .iter()
            .map(|[x, y]| square(1.0, 1.0, [x * 1.25 + 0.1, y * 1.25 + 0.05]))
            .collect();
        let window = seen_past(&frame);
        assert!(
            (hole + window - all).abs() < 1e-9,
            "{hole} + {window} = {all}"
        );
        assert!(window > 0.01 && hole > 0.01);
    }

    #[test]
    fn a_surface_beyond_or_beside_hides_nothing() {
        let all = seen_past(&[]);
        for harmless in [
            square(3.0, 9.0, [0.0; 2]),
            square(-1.0, 9.0, [0.0; 2]),
            square(1.0, 0.5, [5.0, 0.0]),
        ] {
            assert_eq!(seen_past(&[harmless]), all);
        }
        assert_eq!(seen_past(&[square(1.0, 0.6, [0.0; 2])]), 0.0);
        let halves = [square(1.0, 0.6, [0.5, 0.0]), square(1.0, 0.6, [-0.5, 0.0])];
        assert!(seen_past(&halves) < 1e-12);
    }
}
