//! Which sides of the surfaces radiate, where neither the scene nor the material says it.
//!
//! Real models are sheets with any orientation. A set of polygons that hang together by edges and that is
//! closed and consistently oriented is a solid, or a room seen from inside: its stated front radiates.
//! Anything else is two-sided, and so is a solid that is `inside_out`. Closed and consistent means that every edge is run through as often in one
//! direction as in the other. Each time once, for an ordinary solid; twice where two solids touch along
//! an edge, or where a sheet is modelled as two coincident faces back to back. Of such two each radiates from its front, whatever the rule.

use super::backs::back_to_back;
use super::geometry::Geometry;
use super::materials::Materials;
use super::polygons::Polygons;
use super::settings::SidesRule;
use super::{Sides, Surface, duplicates, inside_out};
use crate::geometry::Sets;
use rayon::slice::ParallelSliceMut;

/// Sets the sides of all surfaces by their materials' rules; `shines` says which polygons emit. Returns the polygons of solids that
/// are inside out, if that decided.
pub(super) fn decide(
    polygons: &Polygons,
    repeated: &[bool],
    rules: &[SidesRule],
    shines: impl Fn(usize) -> bool,
    surfaces: &mut [Surface],
) -> Vec<usize> {
    let (is_skin, inside_out) = match rules.contains(&SidesRule::Auto) {
        true => skins(polygons, repeated, shines),
        false => Default::default(),
    };
    for surface in &mut *surfaces {
        surface.sides = match rules[surface.material as usize] {
            SidesRule::Front => Sides::Front,
            SidesRule::Both => Sides::Both,
            SidesRule::Auto if is_skin[surface.polygon as usize] => Sides::Front,
            SidesRule::Auto => Sides::Both,
        };
    }
    if surfaces.iter().any(|surface| surface.sides == Sides::Both) {
        // The back of one of these would be the front of the other once more.
        for number in back_to_back(surfaces, &polygons.positions).into_keys() {
            surfaces[number as usize].sides = Sides::Front;
        }
    }
    let rule = |polygon: usize| rules[polygons.materials[polygon] as usize];
    let decided = |polygon: &usize| {
        inside_out[*polygon] && !repeated[*polygon] && rule(*polygon) == SidesRule::Auto
    };
    (0..inside_out.len()).filter(decided).collect()
}

/// Light leaves the front of a polygon; a double-sided emitter that is not the skin of a solid becomes two, back to back.
pub(super) fn shine_from_both(geometry: &mut Geometry, materials: &mut Materials) {
    if materials.shining.is_empty() {
        return;
    }
    let polygons = &mut geometry.polygons;
    let repeated = duplicates::find(polygons, |polygon| materials.emit(polygons, polygon));
    let bodies = Bodies::new(polygons, &repeated);
    for (polygon, repeated) in repeated.iter().enumerate() {
        let material = polygons.materials[polygon];
        let shines = materials.shining.contains(&material);
        if shines && !bodies.is_closed(polygon as u32) && !repeated {
            let back: Vec<u32> = polygons.corners(polygon).iter().rev().copied().collect();
            polygons.push(back, material);
            geometry.group_of.push(geometry.group_of[polygon]);
        }
    }
    for material in &materials.shining {
        materials.sides[*material as usize] = SidesRule::Front;
    }
}

/// For each polygon whether it is the skin of a solid or room, as its front says; and whether of a solid that is inside out.
fn skins(
    polygons: &Polygons,
    repeated: &[bool],
    shines: impl Fn(usize) -> bool,
) -> (Vec<bool>, Vec<bool>) {
    let bodies = Bodies::new(polygons, repeated);
    let inside_out = inside_out::find(polygons, &bodies, shines);
    let is_skin = |polygon: usize| bodies.is_closed(polygon as u32) && !inside_out[polygon];
    ((0..polygons.len()).map(is_skin).collect(), inside_out)
}

/// One polygon's use of an edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct EdgeUse {
    /// The smaller vertex index, then the larger one.
    edge: [u32; 2],
    polygon: u32,
    forward: bool,
}

/// The polygons that hang together by edges.
pub(super) struct Bodies {
    /// For each polygon the first of its set.
    roots: Vec<u32>,
    /// Whether the set of each first is open, or not consistently oriented.
    is_open: Vec<bool>,
}

impl Bodies {
    /// The sets of all polygons. Those without area take part, since they fill the cracks that they were made for.
    pub fn new(polygons: &Polygons, repeated: &[bool]) -> Self {
        let mut uses = edge_uses(polygons, repeated);
        uses.par_sort_unstable();
        let mut bodies = Sets::new(polygons.len());
        let mut open = Vec::new();
        for uses in uses.chunk_by(|a, b| a.edge == b.edge) {
            let first = uses[0].polygon;
            uses.iter()
                .for_each(|other| bodies.join(first, other.polygon));
            let forward = uses.iter().filter(|edge_use| edge_use.forward).count();
            if 2 * forward != uses.len() {
                open.push(first);
            }
        }
        let mut is_open = vec![false; polygons.len()];
        for polygon in open {
            is_open[bodies.root(polygon) as usize] = true;
        }
        let roots = (0..polygons.len() as u32).map(|polygon| bodies.root(polygon));
        Self {
            roots: roots.collect(),
            is_open,
        }
    }

    /// Whether a polygon belongs to a closed, consistently oriented set.
    pub fn is_closed(&self, polygon: u32) -> bool {
        !self.is_open[self.roots[polygon as usize] as usize]
    }

    /// The polygons of each set, by their first ones.
    pub fn members(&self) -> Vec<Vec<u32>> {
        let mut order: Vec<u32> = (0..self.roots.len() as u32).collect();
        order.par_sort_by_key(|polygon| (self.roots[*polygon as usize], *polygon));
        let sets = order.chunk_by(|a, b| self.roots[*a as usize] == self.roots[*b as usize]);
        sets.map(<[u32]>::to_vec).collect()
    }
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
