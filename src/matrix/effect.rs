//! What an occluder does to all lines between two facets at once: an exact answer where it meets none of them, or all.

use super::occluder::Occluder;
use super::silhouette::{Edge, Planes, Sides};
use glam::DVec3;

/// What an occluder does to the lines between two facets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effect {
    /// It meets none of them.
    None,
    /// It may meet some; these are the planes of its shadows that may run through them.
    Some(Planes),
    /// It meets all of them.
    All,
}

impl Occluder {
    /// What it does to the lines from all corners of one facet to all of another, the `ends`, which lie on the given sides; of a body,
    /// outside.
    ///
    /// The volume spanned by an edge and the ends of a line is linear in either end. So if no line between corners passes
    /// an edge of the silhouette on the inside, no line between the facets does, and what all corners see through it, all points do.
    pub fn effect(
        &self,
        lines: &Lines,
        ends: [&[DVec3]; 2],
        [from, to]: [Sides; 2],
        extent: f64,
    ) -> Effect {
        if from.share_a_front(to) || (!self.is_body() && (from.is_on() || to.is_on())) {
            return Effect::None;
        }
        let mut planes = Planes::ALL;
        // Whether all eyes on either side see one and the same silhouette, and all of the other within it.
        let (mut all_inside, mut has_silhouette) = ([true; 2], [false; 2]);
        for (k, edge) in self.edges().iter().enumerate() {
            let turns = [edge.turn(from), edge.turn(to).map(|turn| -turn)];
            let along = |turn: &Option<f64>| turn.filter(|turn| *turn != 0.0);
            let Some(sign) = turns.iter().find_map(along) else {
                for (all, turn) in all_inside.iter_mut().zip(turns) {
                    *all &= turn.is_some();
                }
                continue;
            };
            // Lines that pass the edge nearer than 1e-8 of the scene touch it.
            let reach = 1e-8 * edge.length * extent * extent;
            let (least, most) = lines.volumes(edge, sign);
            if most <= reach {
                return Effect::None;
            }
            let inside = least >= 0.0;
            for (side, turn) in turns.into_iter().enumerate() {
                all_inside[side] &= turn.is_some_and(|turn| turn == 0.0 || inside);
                has_silhouette[side] |= turn.is_some_and(|turn| turn != 0.0);
            }
            if inside {
                planes = planes.without(k);
            }
        }
        if !self.is_body() && !ends.iter().all(|points| self.is_clear_of(points)) {
            Effect::Some(planes)
        } else if (0..2).any(|side| all_inside[side] && has_silhouette[side]) {
            Effect::All
        } else {
            Effect::Some(planes.without_own())
        }
    }
}

/// The lines from all corners of one polygon to all of another.
pub(super) struct Lines {
    count: usize,
    /// Direction and moment, component by component, so that several are done at once.
    components: [[f64; Self::MOST]; 6],
}

impl Lines {
    /// Most lines that are looked at; more corners than that are rare.
    const MOST: usize = 36;

    /// No lines.
    pub const NONE: Self = Self {
        count: 0,
        components: [[0.0; Self::MOST]; 6],
    };

    /// Takes the lines between two polygons.
    pub fn set(&mut self, from: &[DVec3], to: &[DVec3]) {
        self.count = 0;
        if from.len() * to.len() > Self::MOST {
            return;
        }
        for x in from {
            for y in to {
                let (along, moment) = (*y - *x, x.cross(*y));
                let values = [along.x, along.y, along.z, moment.x, moment.y, moment.z];
                for (list, value) in self.components.iter_mut().zip(values) {
                    list[self.count] = value;
                }
                self.count += 1;
            }
        }
    }

    /// Least and most volume that a line spans with an edge, times `sign`: positive where lines from the front pass inside.
    fn volumes(&self, edge: &Edge, sign: f64) -> (f64, f64) {
        if self.count == 0 {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let (m, d) = (edge.moment * -sign, edge.along * -sign);
        let [ax, ay, az, mx, my, mz] = self.components.each_ref().map(|list| &list[..self.count]);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..self.count {
            let volume =
                ax[k] * m.x + ay[k] * m.y + az[k] * m.z + mx[k] * d.x + my[k] * d.y + mz[k] * d.z;
            least = if volume < least { volume } else { least };
            most = if volume > most { volume } else { most };
        }
        (least, most)
    }
}

#[cfg(test)]
mod tests {
    use super::super::convex::Convex;
    use super::super::facet::Facet;
    use super::*;

    fn square(height: f64, size: f64, x: f64) -> Vec<DVec3> {
        [[-size, -size], [size, -size], [size, size], [-size, size]]
            .map(|[u, v]| DVec3::new(u + x, v, height))
            .to_vec()
    }

    fn effect(occluder: &Occluder, from: &Facet, to: &Facet) -> Effect {
        let mut lines = Lines::NONE;
        lines.set(from.corners(), to.corners());
        let sides = [from, to].map(|facet| occluder.sides(facet));
        occluder.effect(&lines, [from, to].map(|facet| facet.corners()), sides, 4.0)
    }

    #[test]
    fn a_square_between_two_squares() {
        let facet = |height| {
            let mut corners = square(height, 1.0, 0.0);
            if height > 0.0 {
                corners.reverse();
            }
            Facet::new(Convex::new(&corners)).expect("has an area")
        };
        let (below, above) = (facet(0.0), facet(2.0));
        // How many of the four edges matter.
        let edges_of = |effect: Effect| match effect {
            Effect::None => None,
            Effect::All => Some(0),
            Effect::Some(planes) => Some((0..4).filter(|k| planes.has(*k)).count()),
        };
        for (size, x, edges) in [
            (1.01, 0.0, Some(0)),
            (0.5, 0.0, Some(4)),
            (1.0, 1.5, Some(1)),
            (1.0, 2.0, None),
            (1.0, 2.5, None),
        ] {
            let mut corners = square(1.0, size, x);
            for _ in 0..2 {
                let between = Occluder::new(corners.clone(), 1e-6).expect("has an area");
                let [there, back] = [
                    effect(&between, &below, &above),
                    effect(&between, &above, &below),
                ];
                assert_eq!(edges_of(there), edges, "{size} {x}");
                assert_eq!(edges_of(back), edges, "{size} {x}");
                corners.reverse();
            }
        }
        let beyond = Occluder::new(square(2.5, 9.0, 0.0), 1e-6).expect("has an area");
        assert_eq!(effect(&beyond, &below, &above), Effect::None);
    }
}
