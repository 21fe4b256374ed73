//! Where the borders of patches meet: their vertices, welded to shared positions.

use crate::mesh::{Mesh, NONE};
use crate::scene::Welder;
use glam::DVec3;
use rayon::prelude::*;
use rstar::primitives::GeomWithData;
use rstar::{AABB, RTree};

/// Vertices of different patches closer than this fraction of the scene's extent are one position.
const WELD: f64 = 1e-7;

/// A place on a border, with the number of its position.
type Place = GeomWithData<[f64; 3], u32>;

/// Vertices on the borders of patches, welded.
pub(super) struct Borders {
    /// In the frame.
    pub positions: Vec<DVec3>,
    /// Number of the position of each vertex of the mesh; [`NONE`] of those inside of patches.
    of_vertex: Vec<u32>,
    /// Where there are vertices. Those of one position need not be in one place to the last bit.
    places: RTree<Place>,
    tolerance: f64,
}

impl Borders {
    pub fn new(mesh: &Mesh) -> Self {
        let tolerance = WELD * mesh.frame.extent();
        let on_border = |v: u32| {
            let vertex = mesh.vertex(v);
            let is_there = mesh.patch(vertex.patch).on_border(vertex.lattice);
            is_there.then(|| (v, mesh.position(v)))
        };
        let vertices = (0..mesh.vertices.len() as u32).into_par_iter();
        let vertices: Vec<_> = vertices.filter_map(on_border).collect();
        // Nearly all that meet do so to the last bit: a tree of their places alone is a fraction of one of the vertices.
        let mut welder = Welder::default();
        let mut of_vertex = vec![NONE; mesh.vertices.len()];
        for (vertex, place) in vertices {
            of_vertex[vertex as usize] = welder.index(place);
        }
        let places = welder.into_positions();
        let numbered = places.iter().zip(0..);
        let numbered = numbered.map(|(place, n)| Place::new(place.to_array(), n));
        let mut tree = RTree::bulk_load(numbered.collect());
        let (of_place, positions) = welded(&places, &tree, tolerance);
        for number in of_vertex.iter_mut().filter(|number| **number != NONE) {
            *number = of_place[*number as usize];
        }
        tree.iter_mut()
            .for_each(|place| place.data = of_place[place.data as usize]);
        Self {
            positions,
            of_vertex,
            places: tree,
            tolerance,
        }
    }

    /// The position of a vertex, if it is on a border.
    pub fn position_of(&self, vertex: u32) -> Option<u32> {
        let position = self.of_vertex[vertex as usize];
        (position != NONE).then_some(position)
    }

    /// The positions on the open segment from `a` to `b`, in order, with their place on it; one may be there more than once.
    pub fn between(&self, a: DVec3, b: DVec3) -> Vec<(f64, u32)> {
        let margin = DVec3::splat(self.tolerance);
        let envelope = AABB::from_corners(
            (a.min(b) - margin).to_array(),
            (a.max(b) + margin).to_array(),
        );
        let along = b - a;
        let length = along.length();
        let place = |point: &Place| {
            let to = DVec3::from_array(*point.geom()) - a;
            let place = to.dot(along) / (length * length);
            let aside = (to - along * place).length();
            let inside = place * length > 2.0 * self.tolerance
                && (1.0 - place) * length > 2.0 * self.tolerance;
            (inside && aside <= self.tolerance).then_some((place, point.data))
        };
        let near = self.places.locate_in_envelope(envelope);
        let mut found: Vec<_> = near.filter_map(place).collect();
        found.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        found
    }
}

/// The number of the position of each of `places`, which `tree` holds by number, and the positions: a place is welded to the first that is
/// one and near enough.
fn welded(places: &[DVec3], tree: &RTree<Place>, tolerance: f64) -> (Vec<u32>, Vec<DVec3>) {
    let earlier = |(place, number): (&DVec3, u32)| -> Vec<u32> {
        let near = tree.locate_within_distance(place.to_array(), tolerance * tolerance);
        near.map(|of| of.data).filter(|n| *n < number).collect()
    };
    let numbered = places.par_iter().zip(0..places.len() as u32);
    let earlier: Vec<Vec<u32>> = numbered.map(earlier).collect();
    let (mut of_place, mut positions) = (Vec::with_capacity(places.len()), Vec::new());
    // By position the place that it is in.
    let mut first_of: Vec<u32> = Vec::new();
    for ((place, number), earlier) in places.iter().zip(0..).zip(earlier) {
        let is_first = |n: &&u32| first_of[of_place[**n as usize] as usize] == **n;
        match earlier.iter().filter(is_first).min() {
            Some(first) => of_place.push(of_place[*first as usize]),
            None => {
                of_place.push(positions.len() as u32);
                positions.push(*place);
                first_of.push(number);
            }
        }
    }
    (of_place, positions)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_welded_to_the_first_that_is_near_enough() {
        // The third is near to the second, but not to the first, which the second is welded to.
        let places = [0.0, 0.8, 1.6, 5.0, 2.3].map(|x| DVec3::new(x, 0.0, 0.0));
        let numbered = places.iter().zip(0..);
        let numbered = numbered.map(|(place, n)| Place::new(place.to_array(), n));
        let tree = RTree::bulk_load(numbered.collect());
        let (of_place, positions) = welded(&places, &tree, 1.0);
        assert_eq!(of_place, [0, 0, 1, 2, 1]);
        assert_eq!(positions, [places[0], places[2], places[3]]);
    }
}
