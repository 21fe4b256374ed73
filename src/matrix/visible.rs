//! What a point sees of a facet past the surfaces between: exactly, by cutting their shadows out of it.

use super::convex::Convex;
use super::facet::Facet;
use super::occluder::{Occluder, Plane, Planes};
use glam::DVec3;

/// More fragments than this are not worth cutting: rays do it faster.
const MOST_FRAGMENTS: usize = 128;

/// Room for fragments and planes, reused from point to point.
#[derive(Default)]
pub(super) struct Cutter {
    fragments: Vec<Convex>,
    planes: Vec<Plane>,
}

/// The shape has become too intricate to cut further.
#[derive(Debug, PartialEq)]
pub(super) struct TooIntricate;

impl Cutter {
    /// The sum of `measure` over what `eye` sees of `facet` past the occluders; `None` if that is all of it.
    pub fn seen<'a>(
        &mut self,
        eye: DVec3,
        facet: &Facet,
        occluders: impl Iterator<Item = (&'a Occluder, Planes)>,
        extent: f64,
        measure: impl Fn(&[DVec3]) -> f64,
    ) -> Result<Option<f64>, TooIntricate> {
        if !self.cut_shadows(eye, facet, occluders, extent)? {
            return Ok(None);
        }
        let parts = self.fragments.iter();
        let visible = parts.map(|part| measure(part.corners())).sum();
        Ok(Some(visible))
    }

    /// Whether occluders hide all of a facet from `eye`.
    pub fn hides<'a>(
        &mut self,
        eye: DVec3,
        facet: &Facet,
        occluders: impl Iterator<Item = (&'a Occluder, Planes)>,
        extent: f64,
    ) -> Result<bool, TooIntricate> {
        self.cut_shadows(eye, facet, occluders, extent)?;
        Ok(self.fragments.is_empty())
    }

    /// Leaves in `fragments` what is seen; false if that is the whole facet.
    fn cut_shadows<'a>(
        &mut self,
        eye: DVec3,
        facet: &Facet,
        occluders: impl Iterator<Item = (&'a Occluder, Planes)>,
        extent: f64,
    ) -> Result<bool, TooIntricate> {
        self.fragments.clear();
        self.fragments.push(facet.shape);
        let mut is_less = false;
        for (occluder, wanted) in occluders {
            occluder.shadow(eye, wanted, extent, &mut self.planes);
            if self.planes.is_empty() {
                continue;
            }
            is_less |= self.subtract()?;
            if self.fragments.is_empty() {
                break;
            }
        }
        Ok(is_less)
    }

    /// Takes the common part of all half-spaces off all fragments; false if there is none.
    fn subtract(&mut self) -> Result<bool, TooIntricate> {
        let mut is_less = false;
        // Backwards, since the last part of what is cut takes its place.
        for k in (0..self.fragments.len()).rev() {
            if misses(&self.fragments[k], &self.planes) {
                continue;
            }
            let (fragment, before) = (self.fragments[k], self.fragments.len());
            if cut_out(fragment, &self.planes, &mut self.fragments)? == Left::All {
                self.fragments.truncate(before);
            } else {
                self.fragments.swap_remove(k);
                is_less = true;
            }
        }
        if self.fragments.len() > MOST_FRAGMENTS {
            Err(TooIntricate)
        } else {
            Ok(is_less)
        }
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

/// How much of a fragment a shadow leaves.
#[derive(PartialEq)]
enum Left {
    All,
    Less,
}

/// Appends the parts of a fragment outside of any half-space.
fn cut_out(
    mut rest: Convex,
    planes: &[Plane],
    parts: &mut Vec<Convex>,
) -> Result<Left, TooIntricate> {
    let mut heights = [0.0; Convex::MOST];
    for plane in planes {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (slot, corner) in heights.iter_mut().zip(rest.corners()) {
            *slot = plane.height(*corner);
            low = low.min(*slot);
            high = high.max(*slot);
        }
        if high <= plane.reach {
            return Ok(Left::All);
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
    Ok(Left::Less)
}

#[cfg(test)]
mod tests {
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
        let shadows = occluders.iter().map(|it| (it, Planes::ALL));
        Cutter::default()
            .seen(DVec3::ZERO, &facet, shadows, 4.0, |part| {
                seen(DVec3::Z, DVec3::ZERO, part)
            })
            .expect("is simple")
            .unwrap_or_else(|| seen(DVec3::Z, DVec3::ZERO, facet.corners()))
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
        assert_eq!(seen_past(&halves), 0.0);
    }
}
