//! From the mesh to conforming triangles: where patches meet, each takes up the vertices that the other has there.

use super::lit_mesh::{LitMesh, LitTriangle, LitVertex};
use crate::mesh::{Mesh, NONE};
use crate::radiometry::Spectrum;
use crate::solver::Light;
use glam::DVec3;
use rstar::primitives::GeomWithData;
use rstar::{AABB, RTree};
use rustc_hash::FxHashMap;

/// Vertices of different patches closer than this fraction of the scene's extent are one position.
const WELD: f64 = 1e-7;

type Point = GeomWithData<[f64; 3], u32>;

/// Triangulates the leaves of `mesh` with the light on it.
pub(super) fn conform(mesh: &Mesh, light: &Light) -> LitMesh {
    let borders = Borders::new(mesh);
    let mut builder = Builder {
        mesh,
        light,
        borders: &borders,
        lit: LitMesh::default(),
        vertices: FxHashMap::default(),
        dark: Vec::new(),
    };
    builder.lit.positions = borders
        .positions
        .iter()
        .map(|p| mesh.frame.leave(*p))
        .collect();
    for leaf in mesh.leaves() {
        builder.add(leaf);
    }
    builder.finish()
}

/// Vertices on the borders of patches, welded.
struct Borders {
    /// In the frame.
    positions: Vec<DVec3>,
    /// Number of the position of a border vertex.
    of_vertex: FxHashMap<u32, u32>,
    tree: RTree<Point>,
    tolerance: f64,
}

impl Borders {
    fn new(mesh: &Mesh) -> Self {
        let tolerance = WELD * mesh.frame.extent();
        let on_border = |v: &u32| {
            let vertex = mesh.vertex(*v);
            mesh.patch(vertex.patch).on_border(vertex.lattice)
        };
        let vertices: Vec<u32> = (0..mesh.vertices.len() as u32).filter(on_border).collect();
        let all = vertices
            .iter()
            .map(|v| Point::new(mesh.position(*v).to_array(), *v))
            .collect();
        let close: RTree<Point> = RTree::bulk_load(all);
        let (mut positions, mut of_vertex) = (Vec::new(), FxHashMap::default());
        for vertex in vertices {
            if !of_vertex.contains_key(&vertex) {
                let position = mesh.position(vertex);
                for same in close.locate_within_distance(position.to_array(), tolerance * tolerance)
                {
                    of_vertex.entry(same.data).or_insert(positions.len() as u32);
                }
                positions.push(position);
            }
        }
        let welded = positions
            .iter()
            .zip(0..)
            .map(|(p, number)| Point::new(p.to_array(), number))
            .collect();
        Self {
            positions,
            of_vertex,
            tree: RTree::bulk_load(welded),
            tolerance,
        }
    }

    /// The positions on the open segment from `a` to `b`, in order, with their place on it.
    fn between(&self, a: DVec3, b: DVec3) -> Vec<(f64, u32)> {
        let margin = DVec3::splat(self.tolerance);
        let envelope = AABB::from_corners(
            (a.min(b) - margin).to_array(),
            (a.max(b) + margin).to_array(),
        );
        let along = b - a;
        let length = along.length();
        let place = |point: &Point| {
            let to = DVec3::from_array(*point.geom()) - a;
            let place = to.dot(along) / (length * length);
            let aside = (to - along * place).length();
            let inside = place * length > 2.0 * self.tolerance
                && (1.0 - place) * length > 2.0 * self.tolerance;
            (inside && aside <= self.tolerance).then_some((place, point.data))
        };
        let mut found: Vec<_> = self
            .tree
            .locate_in_envelope(envelope)
            .filter_map(place)
            .collect();
        found.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        found
    }
}

struct Builder<'a> {
    mesh: &'a Mesh,
    light: &'a Light,
    borders: &'a Borders,
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

impl Builder<'_> {
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
        let welded = self.borders.of_vertex.get(&vertex);
        let key = welded.map_or(Key::Inner(vertex), |position| Key::Border {
            patch,
            position: *position,
        });
        if let Some(known) = self.vertices.get(&key) {
            return *known;
        }
        let position = welded.copied().unwrap_or_else(|| {
            self.lit
                .positions
                .push(self.mesh.frame.leave(self.mesh.position(vertex)));
            self.lit.positions.len() as u32 - 1
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
