//! From the mesh to conforming triangles: where patches meet, each takes up the vertices that the other has there.

use super::borders::Borders;
use super::lit_mesh::{LitMesh, LitTriangle, LitVertex};
use crate::mesh::{Mesh, NONE};
use crate::radiometry::Spectrum;
use crate::solver::Light;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// About how many vertices patches have that are triangulated together …
const SHARE: usize = 1 << 12;

/// … and how many such shares are in memory beside what they are added to.
const ABREAST: usize = 64;

/// Triangulates the leaves of `mesh`, patch by patch, with the light on it.
pub(super) fn conform(mesh: &Mesh, light: &Light) -> LitMesh {
    let borders = Borders::new(mesh);
    let positions = borders.positions.par_iter();
    let mut lit = LitMesh {
        positions: positions.map(|p| mesh.frame.leave(*p)).collect(),
        ..LitMesh::default()
    };
    for shares in shares(mesh).chunks(ABREAST) {
        let parts = shares.par_iter().with_max_len(1).map(|patches| {
            let mut builder = Builder::new(mesh, light, &borders);
            let leaves = patches.clone().flat_map(|p| mesh.leaves_of(&mesh.patch(p)));
            leaves.for_each(|leaf| builder.add(leaf));
            builder.finish()
        });
        let parts: Vec<LitMesh> = parts.collect();
        for part in parts {
            append(&mut lit, part, borders.positions.len() as u32);
        }
    }
    lit
}

/// All patches, in runs of about as many vertices.
fn shares(mesh: &Mesh) -> Vec<Range<u32>> {
    let (mut shares, mut first, mut vertices) = (Vec::new(), 0, 0);
    for patch in 0..mesh.patches.len() as u32 {
        vertices += mesh.vertex_count(patch);
        if vertices >= SHARE {
            shares.push(first..patch + 1);
            (first, vertices) = (patch + 1, 0);
        }
    }
    shares.push(first..mesh.patches.len() as u32);
    shares
}

/// Adds a part with positions, vertices and triangles of its own; the first `shared` positions are those of all.
fn append(lit: &mut LitMesh, part: LitMesh, shared: u32) {
    let own = lit.positions.len() as u32 - shared;
    let first = lit.vertices.len() as u32;
    lit.positions.extend(part.positions);
    lit.vertices.extend(part.vertices.into_iter().map(|vertex| {
        let is_own = vertex.position >= shared;
        LitVertex {
            position: vertex.position + if is_own { own } else { 0 },
            ..vertex
        }
    }));
    let triangles = part.triangles.into_iter();
    lit.triangles.extend(triangles.map(|triangle| LitTriangle {
        vertices: triangle.vertices.map(|v| first + v),
        ..triangle
    }));
}

/// The triangles of some patches.
struct Builder<'a> {
    mesh: &'a Mesh,
    light: &'a Light,
    borders: &'a Borders,
    /// Its positions are numbered after those of the borders.
    lit: LitMesh,
    /// Lit vertex of a mesh vertex, or of a patch at a welded position.
    vertices: FxHashMap<Key, u32>,
    /// By lit vertex: buried, and no open vertex in any of its triangles so far.
    dark: Vec<bool>,
}

#[derive(PartialEq, Eq, Hash, Clone, Copy)]
enum Key {
    Inner(u32),
    Border { patch: u32, position: u32 },
}

impl<'a> Builder<'a> {
    fn new(mesh: &'a Mesh, light: &'a Light, borders: &'a Borders) -> Self {
        Self {
            mesh,
            light,
            borders,
            lit: LitMesh::default(),
            vertices: FxHashMap::default(),
            dark: Vec::new(),
        }
    }

    fn add(&mut self, leaf: u32) {
        let of = self.mesh.element(leaf);
        let patch = self.mesh.patch(of.patch);
        let centre = self.vertex(of.centre);
        for (side, a, b) in of.sides() {
            let chain: &[u32] = if of.hanging[side] == NONE {
                &[a, b]
            } else {
                &[a, of.hanging[side], b]
            };
            for pair in chain.windows(2) {
                let [from, to] = [pair[0], pair[1]].map(|v| self.mesh.lattice_of(v));
                let border = patch.common_side(from, to);
                let stops = if border.is_some() {
                    self.stops(pair[0], pair[1])
                } else {
                    vec![self.vertex(pair[0]), self.vertex(pair[1])]
                };
                for ends in stops.windows(2) {
                    self.lit.triangles.push(LitTriangle {
                        vertices: [centre, ends[0], ends[1]],
                        element: leaf,
                        polygon: patch.polygon,
                        on_border: border.is_some_and(|side| patch.outline[side]),
                    });
                }
            }
        }
    }

    /// The lit vertices along a piece of the border: its ends, and between them what other patches have there.
    fn stops(&mut self, a: u32, b: u32) -> Vec<u32> {
        let patch = self.mesh.vertices.patch_of(a);
        let (first, last) = (self.vertex(a), self.vertex(b));
        let mut stops = vec![first];
        for (place, position) in self
            .borders
            .between(self.mesh.position(a), self.mesh.position(b))
        {
            let [from, to] = [a, b].map(|v| self.light.irradiance[v as usize]);
            let irradiance = from.lerp(to, place as f32);
            let buried = self.mesh.buried[a as usize] && self.mesh.buried[b as usize];
            let key = Key::Border { patch, position };
            if !self.vertices.contains_key(&key) {
                self.insert(key, patch, position, irradiance, buried);
            }
            let stop = self.vertices[&key];
            if !stops.contains(&stop) && stop != last {
                stops.push(stop);
            }
        }
        stops.push(last);
        stops
    }

    fn vertex(&mut self, vertex: u32) -> u32 {
        let patch = self.mesh.vertices.patch_of(vertex);
        let welded = self.borders.position_of(vertex);
        let key = welded.map_or(Key::Inner(vertex), |position| Key::Border {
            patch,
            position,
        });
        if let Some(known) = self.vertices.get(&key) {
            return *known;
        }
        let position = welded.unwrap_or_else(|| {
            let positions = &mut self.lit.positions;
            positions.push(self.mesh.frame.leave(self.mesh.position(vertex)));
            (self.borders.positions.len() + positions.len()) as u32 - 1
        });
        self.insert(
            key,
            patch,
            position,
            self.light.irradiance[vertex as usize],
            self.mesh.buried[vertex as usize],
        )
    }

    fn insert(
        &mut self,
        key: Key,
        patch: u32,
        position: u32,
        irradiance: Spectrum,
        buried: bool,
    ) -> u32 {
        let of = self.mesh.patch(patch);
        let radiosity = of.exitance + of.reflectance * irradiance;
        let number = self.lit.vertices.len() as u32;
        self.lit.vertices.push(LitVertex {
            position,
            normal: of.normal.as_vec3(),
            irradiance,
            radiosity,
        });
        self.vertices.insert(key, number);
        self.dark.push(buried);
        number
    }

    /// Takes the light from buried vertices that no triangle shares with an open one: nothing arrives there, and only what they emit leaves.
    /// All triangles of a vertex are here, as they are of its patch.
    fn finish(mut self) -> LitMesh {
        let mut beside_open = vec![false; self.lit.vertices.len()];
        for triangle in &self.lit.triangles {
            if triangle.vertices.iter().any(|v| !self.dark[*v as usize]) {
                triangle
                    .vertices
                    .iter()
                    .for_each(|v| beside_open[*v as usize] = true);
            }
        }
        for triangle in &self.lit.triangles {
            let patch = self.mesh.elements.patch_of(triangle.element);
            let covered = triangle.vertices.into_iter().map(|v| v as usize);
            for vertex in covered.filter(|v| !beside_open[*v]) {
                let vertex = &mut self.lit.vertices[vertex];
                vertex.radiosity = self.mesh.patch(patch).exitance;
                vertex.irradiance = Spectrum::ZERO;
            }
        }
        self.lit
    }
}
