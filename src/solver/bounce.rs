//! Reflected light on its way: between the direct light and the last gathering it arrives at *neighbourhoods*.
//!
//! What is reflected varies slowly, and the gathering at the end asks for it anew at every vertex. So until then the vertices of
//! a small cube of space whose patches face the same way, and make one sheet or see one another, receive as one: what one of them does,
//! another in each wave. (With two, `staircase2` took longer and came no nearer to its reference.) The few that reflect most of the
//! direct light, as in the reveal of a window, are divided until none reflects much of it.
//!
//! All points look at the same place of a cluster, and as that is seen more or less often than the rest of it, all is too bright or too dark.
//! What is sent and does not escape arrives, so what arrived is scaled to that: a kitchen with white walls was 2 to 4 % too dark without.

use super::course::{Bounce, Direct, Stage};
use super::light::Sign;
use super::run::Solver;
use super::sheets::{see_one_another, sheets};
use super::shoot::{Beam, evaluate, receiver_at};
use super::tiling::SIZE;
use crate::form_factor::Gather;
use crate::geometry::{facing, jitter};
use crate::mesh::{Mesh, NONE};
use crate::radiometry::{Power, Spectrum};
use crate::visibility::Visibility;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Slices of a cube.
const SLICES: u64 = 4;

/// The patches of a sheet are received for apart from others nearby if they have this part of the area of a side of a cube.
const LARGE: f64 = 1.0 / 16.0;

/// Pools that a small part of a cube is tried with.
const MOST_POOLS: usize = 4;

/// What arrives is taken to be too little or too much by no more than this factor.
const MOST_CLOSING: f64 = 1.25;

/// A neighbourhood that reflects more than this part of all direct light is divided.
const SHARES: f64 = 8192.0;

/// A bounce is taken to be no stronger than this part of the one before it.
pub(super) const MOST_RATIO: f64 = 0.95;

/// The vertices that light falls on, by neighbourhood.
#[derive(Debug, Clone)]
pub(super) struct Neighbourhoods {
    lists: Lists,
    /// In which each vertex is; none that is buried is in any.
    of: Vec<u32>,
}

impl Bounce {
    /// What is `unshot` after it over what was before it.
    pub fn ratio_to(&self, unshot: Power) -> Spectrum {
        let before = self.unshot.abs().max(Power::splat(f64::MIN_POSITIVE));
        let ratio = (unshot.abs() / before).min(Power::splat(MOST_RATIO));
        ratio.as_vec3()
    }
}

impl Neighbourhoods {
    pub fn new(mesh: &Mesh, visibility: &dyn Visibility) -> Self {
        let side = side(mesh);
        let sheets = sheets(mesh, visibility, side / SLICES as f64);
        let sheet = |v: u32| sheets[mesh.vertices[v as usize].patch as usize];
        let mut keyed: Vec<(u64, u32, u32)> = (0..mesh.vertices.len() as u32)
            .into_par_iter()
            .map(|v| (key(mesh, v, side), sheet(v), v))
            .collect();
        keyed.retain(|(_, _, v)| !mesh.buried[*v as usize]);
        keyed.par_sort_unstable();
        let sees = |a: u32, b: u32| {
            let [a, b] = [a, b].map(|v| above(mesh, v));
            see_one_another(visibility, a, b)
        };
        let cubes: Vec<Lists> = keyed
            .par_chunk_by(|a, b| a.0 / SLICES == b.0 / SLICES)
            .map(|cube| {
                let parts = cube.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
                let parts = parts.map(|part| part.iter().map(|(_, _, v)| *v).collect());
                let is_large = |of: &Vec<u32>| !is_little(mesh, area(mesh, of));
                let (mut large, small): (Vec<Vec<u32>>, Vec<Vec<u32>>) = parts.partition(is_large);
                large.extend(pooled(small, sees));
                Lists::of(&large)
            })
            .collect();
        drop(keyed);
        let mut near = Self::none(mesh);
        for vertices in cubes.iter().flat_map(Lists::iter) {
            near.push(vertices);
        }
        near
    }

    /// None yet.
    fn none(mesh: &Mesh) -> Self {
        Self {
            lists: Lists {
                vertices: Vec::with_capacity(mesh.vertices.len()),
                ends: Vec::new(),
            },
            of: vec![NONE; mesh.vertices.len()],
        }
    }

    /// Adds that of the given vertices.
    fn push(&mut self, vertices: &[u32]) {
        for vertex in vertices {
            self.of[*vertex as usize] = self.lists.ends.len() as u32;
        }
        self.lists.push(vertices);
    }

    /// Those that reflect much of the direct light in smaller ones: on a few of them depends how bright all is.
    fn divided(self, mesh: &Mesh, direct: &[Spectrum]) -> Self {
        let reflected = |vertex: u32| {
            let reflectance = mesh.patch(mesh.vertices[vertex as usize].patch).reflectance;
            f64::from((direct[vertex as usize] * reflectance).element_sum()) * weight(mesh, vertex)
        };
        let all: f64 = self.lists.vertices.iter().map(|v| reflected(*v)).sum();
        let mut near = Self::none(mesh);
        for vertices in self.iter() {
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

    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + Clone {
        self.lists.iter()
    }
}

/// Lists of vertices, one after the other: as many lists by themselves would take more memory than the vertices in them.
#[derive(Debug, Clone, Default)]
struct Lists {
    vertices: Vec<u32>,
    /// Where in `vertices` each ends.
    ends: Vec<u32>,
}

impl Lists {
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

/// The cube that a vertex is in with the way its patch faces, fronts apart from backs, and the slice of the cube across that way: the
/// inside of a thin box has nothing of the light outside.
fn key(mesh: &Mesh, vertex: u32, side: f64) -> u64 {
    let patch = mesh.patch(mesh.vertices[vertex as usize].patch);
    let face = facing(patch.normal);
    let place = mesh.point(vertex) / side;
    let [x, y, z] = place.floor().as_i64vec3().to_array();
    let [x, y, z] = [x, y, z].map(|i| (i & 0x3_ffff) as u64);
    let slice = (place[face / 2].rem_euclid(1.0) * SLICES as f64) as u64;
    let turned = 2 * face as u64 + u64::from(patch.back);
    (turned << 54 | x << 36 | y << 18 | z) * SLICES + slice
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
    let (low, high) = vertices
        .iter()
        .map(point)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    let axis = (high - low).max_position();
    let middle = low.midpoint(high)[axis];
    let (left, right): (Vec<u32>, Vec<u32>) =
        vertices.iter().partition(|v| point(v)[axis] < middle);
    (!left.is_empty() && !right.is_empty()).then_some([left, right])
}

/// A point above a vertex, for looking around in a cube.
fn above(mesh: &Mesh, vertex: u32) -> Vec3 {
    let (point, normal) = mesh.receiver(vertex);
    (point + normal * (side(mesh) / 16.0)).as_vec3()
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
fn drawn(mesh: &Mesh, of: &[u32], seed: u32) -> u32 {
    let mut left = jitter(of[0], seed)[0] * area(mesh, of);
    let reached = of.iter().find(|v| {
        left -= weight(mesh, **v);
        left < 0.0
    });
    *reached.unwrap_or(&of[of.len() - 1])
}

impl Solver<'_> {
    /// What sets out as `cells` arrives at all neighbourhoods; `before` is how it was.
    pub(super) fn bounce(&mut self, sign: Sign, cells: &[Spectrum], sent: Power, before: Bounce) {
        let power = sent.element_sum() / self.emitted().element_sum();
        let shooter = self.radiating(cells, true);
        let sampler = self.sampler();
        let beam = Beam {
            sampler: &sampler,
            shooter: &shooter,
            sign,
        };
        if self.light.is_unreflected() {
            self.course.direct = Some(Direct {
                irradiance: self.light.irradiance.clone(),
                lost: self.course.lost,
            });
        }
        let neighbourhoods = self.neighbourhoods.take();
        let neighbourhoods = neighbourhoods.unwrap_or_else(|| {
            let direct = self.course.direct.as_ref();
            let near = Neighbourhoods::new(&self.mesh, self.visibility);
            match direct {
                Some(direct) => near.divided(&self.mesh, &direct.irradiance),
                None => near,
            }
        });
        let arrived = self.arrivals_near(beam, &neighbourhoods);
        let lost = self.escape_of_all(&shooter, power);
        let closing = self.closing(sent - lost.all, &arrived, &neighbourhoods);
        self.light.take_all(sign);
        let at = neighbourhoods.of.par_iter().map(|near| match *near {
            NONE => Spectrum::ZERO,
            near => arrived[near as usize].irradiance * closing * sign.factor(),
        });
        self.light.receive(at);
        self.mesh
            .continue_to_buried(&mut self.light.irradiance, |e| e, 0);
        self.mesh
            .continue_to_buried(&mut self.light.unshot, |e| e, 0);
        self.course.lost += lost * f64::from(sign.factor());
        self.course.shots += 1;
        self.neighbourhoods = Some(neighbourhoods);
        self.keep_tiling(shooter);
        self.course.stage = Stage::Bounced(before);
    }

    /// By how much what arrived falls short of what was sent and not lost.
    fn closing(&self, sent: Power, arrived: &[Gather], near: &Neighbourhoods) -> Spectrum {
        let of = near.of.iter().zip(&self.mesh.weights);
        let powers = of
            .filter(|(near, _)| **near != NONE)
            .map(|(near, weight)| arrived[*near as usize].irradiance.as_dvec3() * *weight);
        let came: Power = powers.sum();
        let ratio = sent / came.max(Power::splat(f64::MIN_POSITIVE));
        let bounds = [1.0 / MOST_CLOSING, MOST_CLOSING].map(Power::splat);
        ratio.clamp(bounds[0], bounds[1]).as_vec3()
    }

    /// What arrives at one vertex of each neighbourhood.
    fn arrivals_near(&mut self, beam: Beam, near: &Neighbourhoods) -> Vec<Gather> {
        let seed = self.course.shots as u32;
        let near: Vec<&[u32]> = near.iter().collect();
        let receivers: Vec<_> = near
            .par_iter()
            .with_min_len(64)
            .map(|vertices| drawn(&self.mesh, vertices, seed))
            .map(|vertex| receiver_at(&self.mesh, &self.light, vertex))
            .collect();
        let (gathers, rays) = evaluate(beam.sampler, beam.shooter, &receivers);
        self.course.rays += rays;
        gathers
    }
}
