//! Triangles that continue one another in a plane: programs cut surfaces into triangles to draw them, and the cuts say nothing of
//! the light on them. They are meshed as one surface.

use crate::scene::{Corners, Surface};
use glam::DVec3;
use rayon::prelude::*;

/// The least cosine between normals of one region: below it is a bend, however small the triangles are.
const ALIGNED: f64 = 1.0 - 1e-6;

/// Which surfaces are one.
#[derive(Debug, Clone, Default)]
pub struct Regions {
    /// By surface the lowest of its region; empty if each is alone.
    first: Vec<u32>,
    /// The members of all regions of more than one, region by region, the lowest first.
    members: Vec<u32>,
}

impl Regions {
    /// The triangles of one material and with the same radiating sides that share a side with no third surface, and lie within
    /// `reach` of the plane of the largest of them.
    pub fn of_triangles(surfaces: &[Surface], positions: &[DVec3], reach: f64) -> Self {
        let neighbours = neighbours(surfaces, positions);
        let beside = |triangle: u32| {
            let from = neighbours.partition_point(|(of, _)| *of < triangle);
            let pairs = neighbours[from..].iter();
            pairs
                .take_while(move |(of, _)| *of == triangle)
                .map(|(_, other)| *other)
        };
        let chunks = neighbours.chunk_by(|x, y| x.0 == y.0);
        let mut seeds: Vec<(f64, u32)> = Vec::with_capacity(chunks.clone().count());
        seeds.extend(chunks.map(|chunk| {
            let triangle = chunk[0].0;
            let area = doubled_area(&surfaces[triangle as usize], positions);
            (area.length(), triangle)
        }));
        // The largest triangle knows the plane best.
        seeds.par_sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
        let mut regions = Self {
            first: (0..surfaces.len() as u32).collect(),
            members: Vec::with_capacity(seeds.len()),
        };
        let mut taken = vec![false; surfaces.len()];
        let mut members = Vec::new();
        for (_, seed) in seeds {
            if taken[seed as usize] {
                continue;
            }
            let plane = Plane::of(&surfaces[seed as usize], positions);
            taken[seed as usize] = true;
            members.clear();
            members.push(seed);
            let mut next = 0;
            while next < members.len() {
                for other in beside(members[next]) {
                    let surface = &surfaces[other as usize];
                    if !taken[other as usize] && plane.holds(surface, positions, reach) {
                        taken[other as usize] = true;
                        members.push(other);
                    }
                }
                next += 1;
            }
            if members.len() > 1 {
                let lowest = members.iter().fold(seed, |lowest, m| lowest.min(*m));
                for member in &members {
                    regions.first[*member as usize] = lowest;
                }
                regions.members.extend(&members);
            }
        }
        let Self { first, members } = &mut regions;
        members.par_sort_unstable_by_key(|member| (first[*member as usize], *member));
        regions
    }

    /// The lowest surface of the region of a surface; itself if it is alone.
    pub fn first(&self, surface: u32) -> u32 {
        self.first.get(surface as usize).copied().unwrap_or(surface)
    }

    /// The surfaces of a region by its lowest; `None` for one that is alone.
    pub(super) fn members(&self, first: u32) -> Option<&[u32]> {
        let begin = self.members.partition_point(|m| self.first(*m) < first);
        let from_there = &self.members[begin..];
        let others = from_there.iter().take_while(|m| self.first(**m) == first);
        let members = &from_there[..others.count()];
        (!members.is_empty()).then_some(members)
    }
}

/// The sides of a region that belong to one of its members only, as these have them.
pub(super) fn border<'a>(surfaces: impl Iterator<Item = &'a Surface>) -> Vec<[u32; 2]> {
    let mut sides: Vec<([u32; 2], [u32; 2])> = surfaces
        .flat_map(|surface| sides(surface).map(|side| (sorted(side), side)))
        .collect();
    sides.sort_unstable();
    let alone = sides
        .chunk_by(|x, y| x.0 == y.0)
        .filter(|chunk| chunk.len() == 1);
    alone.map(|chunk| chunk[0].1).collect()
}

/// The corners that four sides go round, if they are a quad.
pub(super) fn quad(border: &[[u32; 2]]) -> Option<[u32; 4]> {
    let &[first, _, _, _] = border else {
        return None;
    };
    let after = |corner: u32| border.iter().find(|side| side[0] == corner);
    let [a, b] = first;
    let [_, c] = *after(b)?;
    let [_, d] = *after(c)?;
    (after(d)?[1] == a).then_some([a, b, c, d])
}

/// Pairs of triangles that may be one surface, both ways, in order.
fn neighbours(surfaces: &[Surface], positions: &[DVec3]) -> Vec<(u32, u32)> {
    let count = surfaces.iter().map(|of| of.corners.indices().len()).sum();
    let mut all: Vec<([u32; 2], u32)> = Vec::with_capacity(count);
    for (number, surface) in (0..).zip(surfaces) {
        all.extend(sides(surface).map(|side| (sorted(side), number)));
    }
    all.par_sort_unstable();
    let chunks = all.par_chunk_by(|x, y| x.0 == y.0);
    let mut pairs: Vec<(u32, u32)> = chunks
        .filter_map(|chunk| match chunk {
            [(side, a), (_, b)] => {
                let pair = [*a, *b].map(|number| &surfaces[number as usize]);
                may_be_one(pair, *side, positions).then_some([(*a, *b), (*b, *a)])
            }
            _ => None,
        })
        .flatten_iter()
        .collect();
    pairs.par_sort_unstable();
    pairs
}

fn may_be_one([a, b]: [&Surface; 2], side: [u32; 2], positions: &[DVec3]) -> bool {
    let are_triangles = [a, b]
        .iter()
        .all(|surface| matches!(surface.corners, Corners::Triangle(_)));
    let runs = |surface: &Surface| sides(surface).any(|own| own == side);
    are_triangles
        && a.material == b.material
        && a.sides == b.sides
        && runs(a) != runs(b)
        && aligned(doubled_area(a, positions), doubled_area(b, positions))
}

fn aligned(a: DVec3, b: DVec3) -> bool {
    a.dot(b) > ALIGNED * a.length() * b.length()
}

/// The plane of a surface.
struct Plane {
    point: DVec3,
    normal: DVec3,
}

impl Plane {
    fn of(surface: &Surface, positions: &[DVec3]) -> Self {
        Self {
            point: positions[surface.corners.indices()[0] as usize],
            normal: doubled_area(surface, positions).normalize_or_zero(),
        }
    }

    fn holds(&self, surface: &Surface, positions: &[DVec3], reach: f64) -> bool {
        let height = |v: &u32| self.normal.dot(positions[*v as usize] - self.point);
        let mut corners = surface.corners.indices().iter();
        aligned(doubled_area(surface, positions), self.normal)
            && corners.all(|v| height(v).abs() <= reach)
    }
}

fn doubled_area(surface: &Surface, positions: &[DVec3]) -> DVec3 {
    surface
        .corners
        .triangles()
        .fold(DVec3::ZERO, |sum, corners| {
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            sum + (b - a).cross(c - a)
        })
}

fn sides(surface: &Surface) -> impl Iterator<Item = [u32; 2]> + '_ {
    let corners = surface.corners.indices();
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
