//! Neighbours in one plane joined to the fewest convex surfaces: a wall of a thousand tiles hides what one rectangle hides.

use crate::geometry::polygon::vector_area;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Polygons by their vertices, joined across shared sides as long as the union is convex, without the corners in the middle of its
/// sides; each with how far the vertices of its members miss its plane. Vertices may miss plane and line by `reach`.
pub(super) fn joined(polygons: Vec<Vec<u32>>, positions: &[DVec3], reach: f64) -> Vec<Joined> {
    let mut joiner = Joiner::new(polygons, positions, reach);
    for seed in 0..joiner.loops.len() {
        while joiner.grow(seed) {}
    }
    let loops = joiner
        .loops
        .iter()
        .zip(&joiner.members)
        .filter(|(outline, _)| !outline.is_empty());
    loops
        .map(|(outline, members)| joiner.finished(outline, members))
        .collect()
}

/// A convex surface made of several.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Joined {
    pub corners: Vec<DVec3>,
    /// All vertices of the members.
    pub vertices: Vec<DVec3>,
}

struct Joiner<'a> {
    positions: &'a [DVec3],
    reach: f64,
    /// Outlines with all their vertices; empty once they have become part of another.
    loops: Vec<Vec<u32>>,
    members: Vec<Vec<u32>>,
    normals: Vec<DVec3>,
    /// The polygon on the left of a directed side.
    owner: FxHashMap<(u32, u32), usize>,
}

impl<'a> Joiner<'a> {
    fn new(loops: Vec<Vec<u32>>, positions: &'a [DVec3], reach: f64) -> Self {
        let mut owner = FxHashMap::default();
        for (number, outline) in loops.iter().enumerate() {
            for side in sides(outline) {
                owner.insert(side, number);
            }
        }
        let normal = |outline: &Vec<u32>| {
            let corners: Vec<DVec3> = outline.iter().map(|v| positions[*v as usize]).collect();
            vector_area(&corners).normalize_or_zero()
        };
        let normals = loops.iter().map(normal).collect();
        Self {
            positions,
            reach,
            members: loops.clone(),
            normals,
            loops,
            owner,
        }
    }

    /// Joins one neighbour to a polygon; false if none fits.
    fn grow(&mut self, seed: usize) -> bool {
        let owner = |(a, b): (u32, u32)| self.owner.get(&(b, a)).copied();
        let mut neighbours: Vec<usize> = sides(&self.loops[seed]).filter_map(owner).collect();
        neighbours.dedup();
        neighbours.retain(|other| *other != seed);
        let fitting = |other: &usize| Some((*other, self.union(seed, *other)?));
        let Some((other, union)) = neighbours.iter().find_map(fitting) else {
            return false;
        };
        self.join(seed, other, union);
        true
    }

    /// The outline of two polygons as one, if it is convex, flat and in one piece.
    fn union(&self, seed: usize, other: usize) -> Option<Vec<u32>> {
        let normal = self.normals[seed];
        let at = |v: u32| self.positions[v as usize];
        let offset = normal.dot(at(self.loops[seed][0]));
        let flat = self.loops[other]
            .iter()
            .all(|v| (normal.dot(at(*v)) - offset).abs() <= self.reach);
        if !flat || normal.dot(self.normals[other]) < 0.999 {
            return None;
        }
        let owners = [seed, other];
        let inner = |side: &(u32, u32)| {
            self.owner
                .get(&(side.1, side.0))
                .is_some_and(|o| owners.contains(o))
        };
        let both = owners.iter().flat_map(|k| sides(&self.loops[*k]));
        let mut next = FxHashMap::default();
        let mut first = None;
        for (a, b) in both.filter(|side| !inner(side)) {
            first.get_or_insert(a);
            // A vertex that two sides leave: the parts touch there again, around a hole.
            if next.insert(a, b).is_some() {
                return None;
            }
        }
        let first = first?;
        let mut outline = vec![first];
        let mut last = next[&first];
        while last != first {
            outline.push(last);
            if outline.len() > next.len() {
                return None;
            }
            last = *next.get(&last)?;
        }
        (outline.len() == next.len() && self.is_convex(&outline, normal)).then_some(outline)
    }

    fn is_convex(&self, outline: &[u32], normal: DVec3) -> bool {
        let n = outline.len();
        let at = |i: usize| self.positions[outline[i % n] as usize];
        (0..n).all(|i| bulge(at(i), at(i + 1), at(i + 2), normal) >= -self.reach)
    }

    fn join(&mut self, seed: usize, other: usize, union: Vec<u32>) {
        let gone = std::mem::take(&mut self.loops[other]);
        for side in sides(&gone).chain(sides(&self.loops[seed])) {
            self.owner.remove(&side);
        }
        for side in sides(&union) {
            self.owner.insert(side, seed);
        }
        self.loops[seed] = union;
        let members = std::mem::take(&mut self.members[other]);
        self.members[seed].extend(members);
    }

    fn finished(&self, outline: &[u32], members: &[u32]) -> Joined {
        let positions = |list: &[u32]| -> Vec<DVec3> {
            list.iter().map(|v| self.positions[*v as usize]).collect()
        };
        let mut corners = positions(outline);
        let normal = vector_area(&corners).normalize_or_zero();
        let mut at = 0;
        while at < corners.len() && corners.len() > 3 {
            let n = corners.len();
            let (a, b, c) = (
                corners[(at + n - 1) % n],
                corners[at],
                corners[(at + 1) % n],
            );
            if bulge(a, b, c, normal) <= self.reach {
                corners.remove(at);
            } else {
                at += 1;
            }
        }
        Joined {
            corners,
            vertices: positions(members),
        }
    }
}

fn sides(outline: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    (0..outline.len()).map(|i| (outline[i], outline[(i + 1) % outline.len()]))
}

/// How far a corner stands out over the line between its neighbours.
fn bulge(a: DVec3, b: DVec3, c: DVec3, normal: DVec3) -> f64 {
    let chord = c - a;
    (b - a).cross(chord).dot(normal) / chord.length().max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(
        columns: u32,
        rows: u32,
        keep: impl Fn(u32, u32) -> bool,
    ) -> (Vec<Vec<u32>>, Vec<DVec3>) {
        let stride = columns + 1;
        let positions = (0..stride * (rows + 1))
            .map(|k| DVec3::new(f64::from(k % stride), f64::from(k / stride), 0.0))
            .collect();
        let mut quads = Vec::new();
        for v in 0..rows {
            for u in 0..columns {
                let k = v * stride + u;
                if keep(u, v) {
                    quads.push(vec![k, k + 1, k + 1 + stride, k + stride]);
                }
            }
        }
        (quads, positions)
    }

    #[test]
    fn a_grid_is_one_rectangle() {
        let (quads, positions) = grid(7, 5, |_, _| true);
        let whole = joined(quads, &positions, 1e-9);
        assert_eq!(whole.len(), 1);
        assert_eq!(whole[0].corners.len(), 4);
        assert_eq!(vector_area(&whole[0].corners).z, 35.0);
    }

    #[test]
    fn a_hole_stays_open() {
        let (quads, positions) = grid(5, 5, |u, v| (u, v) != (2, 2));
        let parts = joined(quads, &positions, 1e-9);
        let area: f64 = parts.iter().map(|p| vector_area(&p.corners).z).sum();
        assert_eq!(area, 24.0);
        assert!(parts.len() <= 6, "{}", parts.len());
    }
}
