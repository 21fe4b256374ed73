//! Which sides of the surfaces radiate, where neither the scene nor the material says it.
//!
//! Real models are sheets with any orientation. A set of polygons that hang together by edges and that is
//! closed and consistently oriented is a solid, or a room seen from inside: its stated front radiates.
//! Anything else is two-sided. Closed and consistent means that every edge is run through as often in one
//! direction as in the other. Each time once, for an ordinary solid; twice where two solids touch along
//! an edge, or where a sheet is modelled as two coincident faces back to back.

use super::polygons::Polygons;
use super::settings::SidesRule;
use super::{Sides, Surface};
use rayon::slice::ParallelSliceMut;

/// Sets the sides of all surfaces by their materials' rules.
pub(super) fn decide(
    polygons: &Polygons,
    repeated: &[bool],
    rules: &[SidesRule],
    surfaces: &mut [Surface],
) {
    let closed = match rules.contains(&SidesRule::Auto) {
        true => closed(polygons, repeated),
        false => Vec::new(),
    };
    for surface in surfaces {
        surface.sides = match rules[surface.material as usize] {
            SidesRule::Front => Sides::Front,
            SidesRule::Both => Sides::Both,
            SidesRule::Auto if closed[surface.polygon as usize] => Sides::Front,
            SidesRule::Auto => Sides::Both,
        };
    }
}

/// One polygon's use of an edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct EdgeUse {
    /// The smaller vertex index, then the larger one.
    edge: [u32; 2],
    polygon: u32,
    forward: bool,
}

/// For each polygon whether it belongs to a closed, consistently oriented set.
///
/// Polygons without area take part, since they fill the cracks that they were made for.
pub(super) fn closed(polygons: &Polygons, repeated: &[bool]) -> Vec<bool> {
    let mut uses = edge_uses(polygons, repeated);
    uses.par_sort_unstable();
    let mut sets = DisjointSets::new(polygons.len());
    let mut open = Vec::new();
    for uses in uses.chunk_by(|a, b| a.edge == b.edge) {
        let first = uses[0].polygon;
        uses.iter()
            .for_each(|other| sets.join(first, other.polygon));
        let forward = uses.iter().filter(|edge_use| edge_use.forward).count();
        if 2 * forward != uses.len() {
            open.push(first);
        }
    }
    let mut is_open = vec![false; polygons.len()];
    for polygon in open {
        is_open[sets.root(polygon) as usize] = true;
    }
    (0..polygons.len() as u32)
        .map(|polygon| !is_open[sets.root(polygon) as usize])
        .collect()
}

fn edge_uses(polygons: &Polygons, repeated: &[bool]) -> Vec<EdgeUse> {
    let mut uses = Vec::with_capacity(3 * polygons.len());
    for polygon in (0..polygons.len()).filter(|polygon| !repeated[*polygon]) {
        let corners = polygons.corners(polygon);
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        uses.extend(ends.filter(|(a, b)| a != b).map(|(a, b)| EdgeUse {
            edge: [*a.min(b), *a.max(b)],
            polygon: polygon as u32,
            forward: a < b,
        }));
    }
    uses
}

/// Union-find with path halving; the root of a set is its first polygon.
struct DisjointSets(Vec<u32>);

impl DisjointSets {
    fn new(len: usize) -> Self {
        DisjointSets((0..len as u32).collect())
    }

    fn root(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            let above = self.0[of as usize];
            self.0[of as usize] = self.0[above as usize];
            of = self.0[of as usize];
        }
        of
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
