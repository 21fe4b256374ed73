//! A flat convex surface that may come between two facets, and what it does to a pair: an exact answer for all lines at once.

use super::convex::Convex;
use super::facet::Facet;
use crate::geometry::polygon;
use glam::DVec3;

/// A convex polygon that blocks light from both sides.
#[derive(Debug, Clone)]
pub(super) struct Occluder {
    pub corners: Vec<DVec3>,
    normal: DVec3,
    offset: f64,
    /// Points no farther than this from the plane lie on the surface: its own corners may miss their plane.
    pub thickness: f64,
    pub low: DVec3,
    pub high: DVec3,
    edges: Vec<Edge>,
}

/// An occluder that may come between a pair, by its number, and the planes of its shadows that matter there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between {
    pub occluder: u32,
    pub planes: Planes,
}

/// A directed line by its Plücker coordinates.
#[derive(Debug, Clone, Copy)]
struct Edge {
    along: DVec3,
    moment: DVec3,
    length: f64,
}

/// On which side of a plane something lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Front,
    Back,
    /// In the plane.
    On,
    Across,
}

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

/// Which planes of an occluder's shadows matter to a pair: bit 0 stands for its own, the others for those along its edges. Of a large
/// surface between two small ones one edge or two are enough.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Planes(u32);

impl Planes {
    pub const ALL: Self = Self(u32::MAX);

    /// Edges from the 31st on share a bit, which stays set.
    fn bit(edge: usize) -> u32 {
        1 << (edge + 1).min(31)
    }

    fn without_own(self) -> Self {
        Self(self.0 & !1)
    }

    fn without(self, edge: usize) -> Self {
        Self(self.0 & !(Self::bit(edge) & (u32::MAX >> 1)))
    }

    fn has_own(self) -> bool {
        self.0 & 1 != 0
    }

    fn has(self, edge: usize) -> bool {
        self.0 & Self::bit(edge) != 0
    }
}

impl Occluder {
    /// `None` where there is no area. `reach` is the distance up to which surfaces touch.
    pub fn new(corners: Vec<DVec3>, reach: f64) -> Option<Self> {
        let vector_area = polygon::vector_area(&corners);
        let normal = vector_area / vector_area.length();
        if !normal.is_finite() {
            return None;
        }
        let offset = normal.dot(polygon::centroid(&corners));
        let warp = corners
            .iter()
            .map(|c| (normal.dot(*c) - offset).abs())
            .fold(0.0, f64::max);
        let (low, high) = polygon::bounds(&corners);
        let edges = (0..corners.len()).map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            Edge {
                along: b - a,
                moment: a.cross(b),
                length: a.distance(b),
            }
        });
        Some(Self {
            normal,
            offset,
            thickness: warp + reach,
            low,
            high,
            edges: edges.collect(),
            corners,
        })
    }

    /// Height of a point over the front.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// Where a set of points lies.
    pub fn side(&self, points: &[DVec3]) -> Side {
        let heights = points.iter().map(|p| self.height(*p));
        self.side_of_range(
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(x), h.max(x))
            }),
        )
    }

    /// Where a box lies.
    pub fn side_of_box(&self, low: DVec3, high: DVec3) -> Side {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let (at, spread) = (self.height(middle), self.normal.abs().dot(half));
        self.side_of_range((at - spread, at + spread))
    }

    fn side_of_range(&self, (low, high): (f64, f64)) -> Side {
        match (low >= -self.thickness, high <= self.thickness) {
            (true, true) => Side::On,
            (true, false) => Side::Front,
            (false, true) => Side::Back,
            (false, false) => Side::Across,
        }
    }

    /// Whether some of it reaches in front of a facet's plane.
    pub fn rises_over(&self, facet: &Facet) -> bool {
        self.corners
            .iter()
            .any(|c| facet.height(*c) > self.thickness)
    }

    /// What it does to the lines from all corners of one facet to all of another.
    ///
    /// The volume spanned by an edge and the ends of a line is linear in either end. So if no line between corners passes
    /// an edge on the inside, no line between the facets does, and what all corners see through the surface, all points do.
    pub fn effect(&self, lines: &Lines, extent: f64) -> Effect {
        let (from, to) = (
            self.side(lines.from.corners()),
            self.side(lines.to.corners()),
        );
        let front_to_back = match (from, to) {
            (Side::On, _) | (_, Side::On) => return Effect::None,
            (Side::Front, Side::Front) | (Side::Back, Side::Back) => return Effect::None,
            (Side::Front, _) | (_, Side::Back) => true,
            (Side::Back, _) | (_, Side::Front) => false,
            (Side::Across, Side::Across) => return Effect::Some(Planes::ALL),
        };
        let sign = if front_to_back { 1.0 } else { -1.0 };
        let mut all_inside = true;
        let mut planes = Planes::ALL;
        for (k, edge) in self.edges.iter().enumerate() {
            // Lines that pass the edge nearer than 1e-8 of the scene touch it.
            let reach = 1e-8 * edge.length * extent * extent;
            let (least, most) = lines.volumes(edge, sign);
            if most <= reach {
                return Effect::None;
            }
            all_inside &= least >= 0.0;
            if least >= 0.0 {
                planes = planes.without(k);
            }
        }
        let apart = from != Side::Across && to != Side::Across;
        if !(apart && self.is_between(lines)) {
            Effect::Some(planes)
        } else if all_inside {
            Effect::All
        } else {
            Effect::Some(planes.without_own())
        }
    }

    /// Whether the ends of all lines keep clear of the plane.
    fn is_between(&self, lines: &Lines) -> bool {
        let clear = |points: &[DVec3]| {
            points
                .iter()
                .all(|p| self.height(*p).abs() > self.thickness)
        };
        clear(lines.from.corners()) && clear(lines.to.corners())
    }

    /// The half-spaces, those of `wanted`, whose common part is all that it hides from `eye`; none if it is seen edge-on.
    pub fn shadow(&self, eye: DVec3, wanted: Planes, extent: f64, planes: &mut Vec<Plane>) {
        planes.clear();
        let height = self.height(eye);
        if height.abs() <= self.thickness {
            return;
        }
        let sign = -height.signum();
        if wanted.has_own() {
            planes.push(Plane {
                normal: self.normal * sign,
                offset: self.offset * sign + self.thickness,
                reach: ROUNDING * extent,
            });
        }
        for (k, edge) in self.edges.iter().enumerate() {
            if !wanted.has(k) {
                continue;
            }
            let normal = (edge.along.cross(eye) + edge.moment) * sign;
            planes.push(Plane {
                normal,
                offset: normal.dot(eye),
                reach: ROUNDING * extent * extent * edge.length,
            });
        }
    }
}

/// Heights below this, in units of the scene's extent, are rounding.
const ROUNDING: f64 = 1e-12;

/// A plane; the normal need not have length 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    normal: DVec3,
    offset: f64,
    /// Points no higher lie on it.
    pub reach: f64,
}

impl Plane {
    /// Positive on the inside.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

/// The lines from all corners of one polygon to all of another.
pub(super) struct Lines {
    from: Convex,
    to: Convex,
    count: usize,
    /// Direction and moment, component by component, so that several are done at once.
    components: [[f64; Self::MOST]; 6],
}

impl Lines {
    /// Most lines that are looked at; more corners than that are rare.
    const MOST: usize = 36;

    /// No lines.
    pub const NONE: Self = Self {
        from: Convex::EMPTY,
        to: Convex::EMPTY,
        count: 0,
        components: [[0.0; Self::MOST]; 6],
    };

    /// Takes the lines between two polygons.
    pub fn set(&mut self, from: &Convex, to: &Convex) {
        (self.from, self.to, self.count) = (*from, *to, 0);
        if from.corners().len() * to.corners().len() > Self::MOST {
            return;
        }
        for x in from.corners() {
            for y in to.corners() {
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
        let [ax, ay, az, mx, my, mz] = &self.components;
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..self.count {
            let volume =
                ax[k] * m.x + ay[k] * m.y + az[k] * m.z + mx[k] * d.x + my[k] * d.y + mz[k] * d.z;
            least = least.min(volume);
            most = most.max(volume);
        }
        (least, most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(height: f64, size: f64, x: f64) -> Vec<DVec3> {
        [[-size, -size], [size, -size], [size, size], [-size, size]]
            .map(|[u, v]| DVec3::new(u + x, v, height))
            .to_vec()
    }

    #[test]
    fn a_square_between_two_squares() {
        let (below, above) = (square(0.0, 1.0, 0.0), square(2.0, 1.0, 0.0));
        let between = |from: &[DVec3], to: &[DVec3]| {
            let mut lines = Lines::NONE;
            lines.set(&Convex::new(from), &Convex::new(to));
            lines
        };
        // How many of the four edges matter.
        let edges_of = |effect: Effect| match effect {
            Effect::None => None,
            Effect::All => Some(0),
            Effect::Some(planes) => Some((0..4).filter(|k| planes.has(*k)).count()),
        };
        let (lines, back) = (between(&below, &above), between(&above, &below));
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
                assert_eq!(edges_of(between.effect(&lines, 4.0)), edges, "{size} {x}");
                assert_eq!(edges_of(between.effect(&back, 4.0)), edges, "{size} {x}");
                corners.reverse();
            }
        }
        let beyond = Occluder::new(square(2.5, 9.0, 0.0), 1e-6).expect("has an area");
        assert_eq!(beyond.effect(&lines, 4.0), Effect::None);
    }

    #[test]
    fn a_shadow_is_what_lies_behind() {
        let corners = square(1.0, 0.5, 0.0);
        for turned in [corners.clone(), corners.into_iter().rev().collect()] {
            let occluder = Occluder::new(turned, 1e-6).expect("has an area");
            let mut planes = Vec::new();
            occluder.shadow(DVec3::ZERO, Planes::ALL, 4.0, &mut planes);
            let hidden = |p: DVec3| planes.iter().all(|plane| plane.height(p) > 0.0);
            assert!(hidden(DVec3::new(0.9, -0.9, 2.0)));
            assert!(!hidden(DVec3::new(1.1, 0.0, 2.0)));
            assert!(!hidden(DVec3::new(0.1, 0.0, 0.9)));
        }
    }
}
