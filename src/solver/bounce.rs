//! Reflected light on its way: between the direct light and the last gathering it arrives at *neighbourhoods*.
//!
//! What is reflected varies slowly, and the gathering at the end asks for it anew at every vertex. So until then the vertices of
//! a small cube of space whose patches hang together and face the same way receive as one: the mean of a few of them, other ones in each wave.

use super::light::Sign;
use super::run::Solver;
use super::shoot::{Beam, evaluate, receiver_at};
use super::tiling::SIZE;
use crate::geometry::{Sets, facing, jitter};
use crate::mesh::Mesh;
use crate::radiometry::Spectrum;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// Slices of a cube.
const SLICES: f64 = 4.0;

/// Patches that hang together are received for apart from others nearby if they have this part of the area of a side of a cube.
const LARGE: f64 = 1.0 / 16.0;

/// Vertices that a neighbourhood receives at.
const SAMPLES: usize = 2;

/// The vertices that light falls on, by neighbourhood.
#[derive(Debug, Clone)]
pub(super) struct Neighbourhoods {
    vertices: Vec<u32>,
    /// Where in `vertices` each ends.
    ends: Vec<u32>,
}

impl Neighbourhoods {
    pub fn new(mesh: &Mesh) -> Self {
        // As long as tiles.
        let side = SIZE * mesh.frame.extent();
        let bodies = bodies(mesh);
        let body = |v: u32| bodies[mesh.vertices[v as usize].patch as usize];
        let mut keyed: Vec<((u64, u64, u32), u32)> = (0..mesh.vertices.len() as u32)
            .into_par_iter()
            .filter(|v| mesh.weights[*v as usize] > 0.0)
            .map(|v| {
                let (cube, slice) = key(mesh, v, side);
                ((cube, slice, body(v)), v)
            })
            .collect();
        keyed.par_sort_unstable();
        let mut near = Self {
            vertices: Vec::with_capacity(keyed.len()),
            ends: Vec::new(),
        };
        let mut small = Vec::new();
        for cube in keyed.chunk_by(|a, b| a.0.0 == b.0.0) {
            for sheet in cube.chunk_by(|a, b| a.0 == b.0) {
                let vertices = sheet.iter().map(|(_, v)| *v);
                let area: f64 = vertices.clone().map(|v| mesh.weights[v as usize]).sum();
                if area >= LARGE * side * side {
                    near.add(vertices);
                } else {
                    small.extend(vertices);
                }
            }
            near.add(small.drain(..));
        }
        near
    }

    fn add(&mut self, vertices: impl Iterator<Item = u32>) {
        let before = self.vertices.len();
        self.vertices.extend(vertices);
        if self.vertices.len() > before {
            self.ends.push(self.vertices.len() as u32);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + Clone {
        let begins = [0].into_iter().chain(self.ends.iter().copied());
        let ranges = begins.zip(&self.ends);
        ranges.map(|(begin, end)| &self.vertices[begin as usize..*end as usize])
    }
}

/// Patches that share corners make one body; by patch, the first of its own.
fn bodies(mesh: &Mesh) -> Vec<u32> {
    let mut bodies = Sets::new(mesh.patches.len());
    let mut first_at = FxHashMap::default();
    for (number, patch) in (0..).zip(&mesh.patches) {
        for corner in patch.corners() {
            let place = corner.to_array().map(f64::to_bits);
            bodies.join(*first_at.entry(place).or_insert(number), number);
        }
    }
    (0..mesh.patches.len() as u32)
        .map(|patch| bodies.root(patch))
        .collect()
}

/// The cube that a vertex is in with the way its patch faces, fronts apart from backs, and the slice of the cube across that way: the
/// inside of a thin box has nothing of the light outside.
fn key(mesh: &Mesh, vertex: u32, side: f64) -> (u64, u64) {
    let of = &mesh.vertices[vertex as usize];
    let patch = &mesh.patches[of.patch as usize];
    let face = facing(patch.normal);
    let place = of.point / side;
    let [x, y, z] = place.floor().as_i64vec3().to_array();
    let [x, y, z] = [x, y, z].map(|i| (i & 0xf_ffff) as u64);
    let slice = (place[face / 2].rem_euclid(1.0) * SLICES) as u64;
    let turned = 2 * face as u64 + u64::from(patch.back);
    (turned << 60 | x << 40 | y << 20 | z, slice)
}

/// A few vertices, drawn in proportion to the area that each stands for.
fn drawn(mesh: &Mesh, of: &[u32], seed: u32) -> impl Iterator<Item = u32> {
    let count = of.len().min(SAMPLES);
    let area: f64 = of.iter().map(|v| mesh.weights[*v as usize]).sum();
    let step = area / count as f64;
    let mut next = jitter(of[0], seed)[0] * step;
    let mut passed = 0.0;
    of.iter().flat_map(move |v| {
        passed += mesh.weights[*v as usize];
        let mut times = 0;
        while next < passed {
            next += step;
            times += 1;
        }
        std::iter::repeat_n(*v, times)
    })
}

impl Solver<'_> {
    /// What sets out as `cells` arrives at all neighbourhoods.
    pub(super) fn bounce(&mut self, sign: Sign, cells: &[Spectrum], power: f64) {
        let shooter = self.radiating(cells, false);
        let sampler = self.coarse_sampler();
        let beam = Beam {
            sampler: &sampler,
            shooter: &shooter,
            sign,
        };
        let neighbourhoods = self.neighbourhoods.take();
        let neighbourhoods = neighbourhoods.unwrap_or_else(|| Neighbourhoods::new(&self.mesh));
        let arrived = self.arrivals_near(beam, &neighbourhoods);
        self.light.take_all(&self.mesh, sign);
        for (irradiance, vertices) in arrived.iter().zip(neighbourhoods.iter()) {
            for vertex in vertices {
                self.light.irradiance[*vertex as usize] += *irradiance;
                self.light.unshot[*vertex as usize] += *irradiance;
            }
        }
        self.mesh.continue_to_buried(&mut self.light.irradiance, 0);
        self.mesh.continue_to_buried(&mut self.light.unshot, 0);
        let lost = self.escape_of_all(&shooter, power);
        self.course.lost += lost * f64::from(sign.factor());
        self.course.shots += 1;
        self.neighbourhoods = Some(neighbourhoods);
        self.keep_tiling(shooter);
    }

    /// The mean of what arrives in each neighbourhood.
    fn arrivals_near(&mut self, beam: Beam, near: &Neighbourhoods) -> Vec<Spectrum> {
        let seed = self.course.shots as u32;
        let mut receivers = Vec::new();
        let mut ends = Vec::new();
        for vertices in near.iter() {
            let drawn = drawn(&self.mesh, vertices, seed);
            receivers.extend(drawn.map(|v| receiver_at(&self.mesh, &self.light, v)));
            ends.push(receivers.len());
        }
        let (gathers, rays) = evaluate(beam.sampler, beam.shooter, &receivers);
        self.course.rays += rays;
        let mut begin = 0;
        let mean = |end: &usize| {
            let of = &gathers[begin..*end];
            begin = *end;
            let sum: Spectrum = of.iter().map(|g| g.irradiance).sum();
            sum * (beam.sign.factor() / of.len().max(1) as f32)
        };
        ends.iter().map(mean).collect()
    }
}
