//! Vertices that receive reflected light as one: those of a small cube of space whose patches face the same way, and make one sheet or see one
//! another. The few that reflect most of the direct light, as in the reveal of a window, are divided until none reflects much of it.
//!
//! What stands close in front of a vertex hides the room from it: vertices in a gap between two panes, or below a bowl, receive apart from those
//! that are in the open on the same sheet. Without, the gaps of a window's frame were as bright as the room around, and the gathering, which is
//! one reflection, could not put that right.

use super::sheets::{see_one_another, sheets};
use super::tiling::SIZE;
use crate::geometry::{bounds, facing, jitter, lift};
use crate::mesh::{Mesh, NONE, Patch};
use crate::radiometry::Spectrum;
use crate::visibility::{Hit, Ray, Visibility};
use glam::Vec3;
use rayon::prelude::*;

/// Ways that a patch may face: out of each side of a cube, as a front or as a back.
const WAYS: u8 = 12;

/// Slices of a cube.
const SLICES: u64 = 4;

/// The patches of a sheet are received for apart from others nearby if they have this part of the area of a side of a cube.
const LARGE: f64 = 1.0 / 16.0;

/// Pools that a small part of a cube is tried with.
const MOST_POOLS: usize = 4;

/// A neighbourhood that reflects more than one over this of all direct light is divided: one vertex draws for all of it. With an eighth of
/// this, reveals of a window that light a whole kitchen were 1 % off, and all that they light with them.
const SHARES: f64 = 65536.0;

/// Vertices that are asked together what is in front of them.
const BLOCK: usize = 1024;

/// Something in front of a vertex is in the same [`Closeness`] from its distance to this part of it.
const STEP: f64 = 0.25;

/// How close in front of a vertex something is: 0 if it is no nearer than a slice, one more for each time that it is within a [`STEP`] of that.
type Closeness = u8;

/// Nearer things are not told apart.
const CLOSEST: Closeness = 3;

/// Parts of a cube: its slices by closeness.
const PARTS: u64 = SLICES * (CLOSEST as u64 + 1);

/// The vertices that light falls on, by neighbourhood.
#[derive(Debug, Clone)]
pub(super) struct Neighbourhoods {
    lists: Lists,
    /// In which each vertex is; none that is buried is in any.
    pub of: Vec<u32>,
}

impl Neighbourhoods {
    /// Those of a mesh; if the `direct` light is known, small where much of it is reflected.
    pub fn new(mesh: &Mesh, visibility: &dyn Visibility, direct: Option<&[Spectrum]>) -> Self {
        let mut lists = nearby(mesh, visibility);
        if let Some(direct) = direct {
            lists = divided(&lists, mesh, direct);
        }
        let mut of = vec![NONE; mesh.vertices.len()];
        for (number, vertices) in (0..).zip(lists.iter()) {
            for vertex in vertices {
                of[*vertex as usize] = number;
            }
        }
        Self { lists, of }
    }

    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + Clone {
        self.lists.iter()
    }
}

/// The vertices that are in a small cube, face the same way and make one sheet or see one another.
fn nearby(mesh: &Mesh, visibility: &dyn Visibility) -> Lists {
    let side = side(mesh);
    let sheets = sheets(mesh, visibility, side / SLICES as f64);
    let sheet = |v: u32| sheets[mesh.vertices.patch_of(v) as usize];
    let closeness = closeness(mesh, visibility, side / SLICES as f64);
    let close = |v: u32| closeness[v as usize];
    let sees = |a: u32, b: u32| {
        let [from, to] = [a, b].map(|v| above(mesh, v, close(v)));
        see_one_another(visibility, from, to)
    };
    let ways: Vec<u8> = mesh.patches.par_iter().map(|of| way(&of)).collect();
    let mut near = Lists::with_room(mesh.vertices.len());
    let (mut alike, mut keyed) = (Vec::new(), Vec::new());
    // One way of facing after the other: with their keys, all vertices at once would take as much memory as the light on them.
    for way in 0..WAYS {
        let faces = |v: &u32| ways[mesh.vertices.patch_of(*v) as usize] == way;
        let open = (0..mesh.vertices.len() as u32).filter(|v| !mesh.buried[*v as usize]);
        alike.clear();
        alike.extend(open.filter(faces));
        keyed.clear();
        let alike = alike.par_iter().copied();
        keyed.par_extend(alike.map(|v| (key(mesh, v, close(v), side), sheet(v), v)));
        keyed.par_sort_unstable();
        let cubes: Vec<Lists> = keyed
            .par_chunk_by(|a, b| a.0 / PARTS == b.0 / PARTS)
            .map(|cube| {
                let parts = cube.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
                let parts = parts.map(|part| part.iter().map(|(_, _, v)| *v).collect());
                let is_large = |of: &Vec<u32>| !is_little(mesh, area(mesh, of));
                let (mut large, small): (Vec<Vec<u32>>, Vec<Vec<u32>>) = parts.partition(is_large);
                large.extend(pooled(small, sees));
                Lists::of(&large)
            })
            .collect();
        let lists = cubes.iter().flat_map(Lists::iter);
        lists.for_each(|vertices| near.push(vertices));
    }
    near
}

/// Those that reflect much of the direct light in smaller ones: on a few of them depends how bright all is.
fn divided(lists: &Lists, mesh: &Mesh, direct: &[Spectrum]) -> Lists {
    let reflected = |vertex: u32| {
        let patch = mesh.vertices.patch_of(vertex) as usize;
        let reflectance = mesh.patches.reflectance(patch);
        f64::from((direct[vertex as usize] * reflectance).element_sum()) * weight(mesh, vertex)
    };
    let all: f64 = lists.vertices.iter().map(|v| reflected(*v)).sum();
    let mut near = Lists::with_room(lists.vertices.len());
    for vertices in lists.iter() {
        let mut pending = vec![vertices.to_vec()];
        while let Some(part) = pending.pop() {
            let power: f64 = part.iter().map(|v| reflected(*v)).sum();
            let is_strong = power > all / SHARES;
            match is_strong.then(|| halves(mesh, &part)).flatten() {
                Some(halves) => pending.extend(halves),
                None => near.push(&part),
            }
        }
    }
    near
}

/// Lists of vertices, one after the other: as many lists by themselves would take more memory than the vertices in them.
#[derive(Debug, Clone, Default)]
struct Lists {
    vertices: Vec<u32>,
    /// Where in `vertices` each ends.
    ends: Vec<u32>,
}

impl Lists {
    /// None yet, with room for so many vertices.
    fn with_room(vertices: usize) -> Self {
        Self {
            vertices: Vec::with_capacity(vertices),
            ends: Vec::new(),
        }
    }

    fn of(lists: &[Vec<u32>]) -> Self {
        let mut all = Self::default();
        lists.iter().for_each(|list| all.push(list));
        all
    }

    fn push(&mut self, list: &[u32]) {
        self.vertices.extend(list);
        self.ends.push(self.vertices.len() as u32);
    }

    fn iter(&self) -> impl Iterator<Item = &[u32]> + Clone {
        let begins = [0].into_iter().chain(self.ends.iter().copied());
        let ranges = begins.zip(&self.ends);
        ranges.map(|(begin, end)| &self.vertices[begin as usize..*end as usize])
    }
}

/// The cube that a vertex is in, and the slice of it across the way that its patch faces: the inside of a thin box has nothing of the light
/// outside. Last, how close something is in front.
fn key(mesh: &Mesh, vertex: u32, close: Closeness, side: f64) -> u64 {
    let patch = mesh.patch(mesh.vertices.patch_of(vertex));
    let face = facing(patch.normal);
    let place = mesh.point(vertex) / side;
    let [x, y, z] = place.floor().as_i64vec3().to_array();
    let [x, y, z] = [x, y, z].map(|i| (i & 0x3_ffff) as u64);
    let slice = (place[face / 2].rem_euclid(1.0) * SLICES as f64) as u64;
    let cube = x << 36 | y << 18 | z;
    cube * PARTS + slice * (PARTS / SLICES) + u64::from(close)
}

/// The way that a patch faces, fronts apart from backs.
fn way(patch: &Patch) -> u8 {
    2 * facing(patch.normal) as u8 + u8::from(patch.back)
}

/// Parts that can see one another put together.
fn pooled(parts: Vec<Vec<u32>>, sees: impl Fn(u32, u32) -> bool) -> Vec<Vec<u32>> {
    let mut pools: Vec<Vec<u32>> = Vec::new();
    for part in parts {
        let mut recent = pools.iter_mut().rev().take(MOST_POOLS);
        match recent.find(|pool| sees(part[0], pool[0])) {
            Some(pool) => pool.extend(part),
            None => pools.push(part),
        }
    }
    pools
}

/// Vertices on either side of the middle of the box around them, across where it is longest; `None` where all are in one place.
fn halves(mesh: &Mesh, vertices: &[u32]) -> Option<[Vec<u32>; 2]> {
    let point = |v: &u32| mesh.point(*v);
    let (low, high) = bounds(vertices.iter().map(point));
    let axis = (high - low).max_position();
    let middle = low.midpoint(high)[axis];
    let (left, right): (Vec<u32>, Vec<u32>) =
        vertices.iter().partition(|v| point(v)[axis] < middle);
    (!left.is_empty() && !right.is_empty()).then_some([left, right])
}

/// A point above a vertex, for looking around in a cube: nothing is between.
fn above(mesh: &Mesh, vertex: u32, close: Closeness) -> Vec3 {
    let (point, normal) = mesh.receiver(vertex);
    let free = side(mesh) / SLICES as f64 * STEP.powi(i32::from(close));
    (point + normal * (free * STEP)).as_vec3()
}

/// How close something is in front of each vertex, where a `slice` is so thick.
fn closeness(mesh: &Mesh, visibility: &dyn Visibility, slice: f64) -> Vec<Closeness> {
    let extent = mesh.frame.extent();
    let in_front = |vertex: u32| {
        let (point, normal) = mesh.receiver(vertex);
        let origin = lift(point, normal, extent).as_vec3();
        let direction = normal.as_vec3();
        Ray { origin, direction }
    };
    let of = |hit: &Option<Hit>| {
        let distance = hit.map_or(f64::INFINITY, |hit| f64::from(hit.t));
        let within = |close: &Closeness| distance < slice * STEP.powi(i32::from(*close));
        (0..CLOSEST).take_while(within).count() as Closeness
    };
    let vertices = 0..mesh.vertices.len() as u32;
    // What receives with others sees what they see.
    let asked = vertices.clone().filter(|v| mesh.receiver_for(*v) == *v);
    let asked: Vec<u32> = asked.collect();
    let answers = asked.par_chunks(BLOCK).flat_map_iter(|block| {
        let rays: Vec<Ray> = block.iter().map(|v| in_front(*v)).collect();
        let mut hits = Vec::new();
        visibility.nearest(&rays, &mut hits);
        hits.iter().map(of).collect::<Vec<_>>()
    });
    let answers: Vec<Closeness> = answers.collect();
    let mut closeness = vec![0; mesh.vertices.len()];
    for (vertex, close) in asked.iter().zip(answers) {
        closeness[*vertex as usize] = close;
    }
    for vertex in vertices {
        closeness[vertex as usize] = closeness[mesh.receiver_for(vertex) as usize];
    }
    closeness
}

/// The side of a cube: as long as two tiles.
fn side(mesh: &Mesh) -> f64 {
    2.0 * SIZE * mesh.frame.extent()
}

/// Whether a part of a cube is so small that it is pooled with others.
fn is_little(mesh: &Mesh, area: f64) -> bool {
    area < LARGE * side(mesh).powi(2)
}

/// What vertices stand for together.
fn area(mesh: &Mesh, of: &[u32]) -> f64 {
    of.iter().map(|v| weight(mesh, *v)).sum()
}

/// What a vertex stands for: next to nothing where it has no area.
fn weight(mesh: &Mesh, vertex: u32) -> f64 {
    mesh.weights[vertex as usize].max(f64::MIN_POSITIVE)
}

/// One of the vertices, drawn in proportion to the area that each stands for.
pub(super) fn drawn(mesh: &Mesh, of: &[u32], seed: u32) -> u32 {
    let mut left = jitter(of[0], seed)[0] * area(mesh, of);
    let reached = of.iter().find(|v| {
        left -= weight(mesh, **v);
        left < 0.0
    });
    *reached.unwrap_or(&of[of.len() - 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MeshLimits;
    use crate::scene::Scene;
    use crate::solver::occluders;
    use crate::visibility::{EngineChoice, build};

    /// A wall of one square metre, and a board a millimetre in front of nearly the lower half of it.
    const WALL_AND_BOARD: &str = "\
        v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n\
        v 0 0 0.001\nv 1 0 0.001\nv 1 0.49 0.001\nv 0 0.49 0.001\nf 8 7 6 5\n";

    fn mesh_of_wall_and_board() -> (Scene, Mesh) {
        let folder = tempfile::tempdir().expect("there is room");
        let file = folder.path().join("wall.obj");
        std::fs::write(&file, WALL_AND_BOARD).expect("there is room");
        let scene = Scene::load(&file).expect("it can be read");
        let limits = MeshLimits {
            initial_size: 0.003,
            max_depth: 10,
            min_size: 0.001,
        };
        let mesh = Mesh::new(&scene, limits);
        (scene, mesh)
    }

    #[test]
    fn no_neighbourhood_reflects_much_of_the_direct_light() {
        let (scene, mesh) = mesh_of_wall_and_board();
        let engine = build(EngineChoice::Obvhs, &occluders(&scene, &mesh), 0).expect("it can");
        let direct = vec![Spectrum::ONE; mesh.vertices.len()];
        let known = Neighbourhoods::new(&mesh, &*engine, Some(&direct));
        let largest = known.iter().filter(|of| of.len() > 1);
        let largest = largest.map(|of| area(&mesh, of)).fold(0.0, f64::max);
        let all: f64 = known.iter().map(|of| area(&mesh, of)).sum();
        assert!(largest < 1.001 * all / SHARES, "one has {largest} of {all}");
        let count = known.iter().count();
        assert!(count > 60_000, "{count} neighbourhoods");
    }

    #[test]
    fn what_is_covered_receives_apart_from_what_is_in_the_open() {
        let (scene, mesh) = mesh_of_wall_and_board();
        let engine = build(EngineChoice::Obvhs, &occluders(&scene, &mesh), 0).expect("it can");
        let faces_board = |v: u32| mesh.receiver(v).1.z > 0.0;
        let is_covered = |v: &u32| mesh.frame.leave(mesh.receiver(*v).0).y < 0.49;
        let (mut covered, mut open) = (0, 0);
        let all = Neighbourhoods::new(&mesh, &*engine, None);
        for vertices in all.iter().filter(|vertices| faces_board(vertices[0])) {
            match vertices.iter().filter(|v| is_covered(v)).count() {
                0 => open += 1,
                count => {
                    assert_eq!(count, vertices.len());
                    covered += 1;
                }
            }
        }
        // A cube has a 64th of the extent for a side.
        assert!((64 * 33..65 * 35).contains(&open), "{open} in the open");
        assert!(covered > 0, "{covered} are covered");
    }
}
