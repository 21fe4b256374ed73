//! Small scenes, the pieces that a mesh makes of them, and what holds for all pieces.

use crate::common::shapes::{CUBOID, cuboid_corner};
use glam::{DQuat, DVec3, Vec3};
use radiosity::geometry::polygon::{diameter, vector_area};
use radiosity::mesh::{Mesh, MeshLimits, Regions, regions, split_at_contacts};
use radiosity::scene::{Corners, Material, Scene, Sides, Surface};

/// A scene of the given triangles and quads, each with vertices of its own; all white, from the front.
#[derive(Debug, Clone, Default)]
pub struct Polygons(pub Vec<Vec<DVec3>>);

impl Polygons {
    /// Adds a polygon.
    pub fn with(mut self, corners: &[DVec3]) -> Self {
        self.0.push(corners.to_vec());
        self
    }

    /// Adds the polygons of others, turned about the origin and moved.
    pub fn and(mut self, others: &Self, turn: DQuat, by: DVec3) -> Self {
        let moved = |polygon: &Vec<DVec3>| polygon.iter().map(|p| turn * *p + by).collect();
        self.0.extend(others.0.iter().map(moved));
        self
    }

    /// All of them scaled, then moved.
    pub fn mapped(&self, scale: f64, by: DVec3) -> Self {
        Self(
            self.0
                .iter()
                .map(|polygon| polygon.iter().map(|p| *p * scale + by).collect())
                .collect(),
        )
    }

    /// The scene; vertices at equal positions are one if they are `welded`.
    pub fn scene(&self, welded: bool) -> Scene {
        let (mut vertices, mut surfaces) = (Vec::new(), Vec::new());
        for (polygon, number) in self.0.iter().zip(0..) {
            let vertex = |p: &DVec3| {
                let position = || vertices.iter().position(|v| v == p);
                let known = welded.then(position).flatten();
                known.unwrap_or_else(|| {
                    vertices.push(*p);
                    vertices.len() - 1
                }) as u32
            };
            let indices: Vec<u32> = polygon.iter().map(vertex).collect();
            let corners = match indices[..] {
                [a, b, c] => Corners::Triangle([a, b, c]),
                [a, b, c, d] => Corners::Quad([a, b, c, d]),
                _ => panic!("a triangle or a quad"),
            };
            surfaces.push(Surface {
                corners,
                material: 0,
                polygon: number,
                sides: Sides::Front,
            });
        }
        let white = Material {
            name: "white".into(),
            reflectance: Vec3::splat(0.5),
            emitted_radiance: Vec3::ZERO,
        };
        Scene {
            name: "contact".into(),
            metres_per_unit: 1.0,
            input_polygons: surfaces.len(),
            vertices,
            surfaces,
            materials: vec![white],
            cameras: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

/// A square floor around the origin, facing up.
pub fn floor(size: f64) -> Polygons {
    let h = size / 2.0;
    let corners = [(-h, h), (h, h), (h, -h), (-h, -h)].map(|(x, z)| DVec3::new(x, 0.0, z));
    Polygons::default().with(&corners)
}

/// A box around the origin that faces outwards: left, right, bottom, top, back, front.
pub fn cuboid(size: DVec3) -> Polygons {
    let ends = [-0.5 * size, 0.5 * size];
    let side = |side: [usize; 4]| side.map(|number| cuboid_corner(number, ends)).to_vec();
    Polygons(CUBOID.map(side).to_vec())
}

/// A sphere of triangles with the given rings.
pub fn sphere(radius: f64, rings: u32) -> Polygons {
    let at = |ring: u32, step: u32| {
        let (sin_t, cos_t) = (std::f64::consts::PI * f64::from(ring) / f64::from(rings)).sin_cos();
        let (sin_p, cos_p) = (std::f64::consts::TAU * f64::from(step % (2 * rings))
            / f64::from(2 * rings))
        .sin_cos();
        let edge = ring == 0 || ring == rings;
        if edge {
            DVec3::Y * cos_t.round()
        } else {
            DVec3::new(sin_t * cos_p, cos_t, -sin_t * sin_p)
        }
    };
    let mut sphere = Polygons::default();
    for ring in 0..rings {
        for step in 0..2 * rings {
            let [a, b, c, d] = [
                at(ring, step),
                at(ring + 1, step),
                at(ring + 1, step + 1),
                at(ring, step + 1),
            ];
            if ring + 1 < rings {
                sphere.0.push([a, b, c].map(|p| p * radius).to_vec());
            }
            if ring > 0 {
                sphere.0.push([a, c, d].map(|p| p * radius).to_vec());
            }
        }
    }
    sphere
}

/// What surfaces are split into, by surface, in scene coordinates; and the coarsest mesh.
pub struct Pieces {
    pub mesh: Mesh,
    pub of: Vec<Vec<Vec<DVec3>>>,
    /// By surface how much of the sides of its pieces lies on its border.
    outlined: Vec<f64>,
}

/// The footprint of a box of this size around the origin.
pub const UNIT: [DVec3; 2] = [DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 0.0, 0.5)];

/// The sides of a rectangle on the floor.
pub fn footprint([low, high]: [DVec3; 2]) -> [[DVec3; 2]; 4] {
    let at = [
        (low.x, low.z),
        (high.x, low.z),
        (high.x, high.z),
        (low.x, high.z),
    ]
    .map(|(x, z)| DVec3::new(x, 0.0, z));
    [0, 1, 2, 3].map(|i| [at[i], at[(i + 1) % 4]])
}

/// Meshes a scene and checks what holds for every mesh.
pub fn pieces(scene: &Scene) -> Pieces {
    pieces_down_to(scene, 0.1)
}

/// That with elements no smaller than a fraction of the scene.
pub fn pieces_down_to(scene: &Scene, min_size: f64) -> Pieces {
    let mesh = Mesh::new(
        scene,
        MeshLimits {
            initial_size: 10.0,
            max_depth: 4,
            min_size,
        },
    );
    let regions = regions(scene, &mesh.frame);
    let smallest = min_size * mesh.frame.extent();
    let (mut of, mut outlined) = (
        vec![Vec::new(); scene.surfaces.len()],
        vec![0.0; scene.surfaces.len()],
    );
    for piece in split_at_contacts(scene, &mesh.frame, &regions, smallest).list {
        let corners = piece.corners().iter().map(|p| mesh.frame.leave(*p));
        let corners: Vec<DVec3> = corners.collect();
        let outline = sides(&corners).zip(piece.outline).filter(|side| side.1);
        outlined[piece.surface as usize] += outline.map(|side| side.0).sum::<f64>();
        of[piece.surface as usize].push(corners);
    }
    let pieces = Pieces { mesh, of, outlined };
    for (number, members) in members(&regions, scene).iter().enumerate() {
        match members[..] {
            [] => assert!(pieces.of[number].is_empty(), "surface {number}"),
            [_] => assert_tiled(scene, &pieces, number),
            _ => assert_tiled_together(scene, &pieces, members),
        }
    }
    pieces
}

/// Scene corners of a surface.
pub fn corners(scene: &Scene, surface: usize) -> Vec<DVec3> {
    scene.positions(&scene.surfaces[surface]).collect()
}

/// For each surface those of the region of which it is the first: itself alone if it is in none, none if another is the first.
fn members(regions: &Regions, scene: &Scene) -> Vec<Vec<usize>> {
    let mut members = vec![Vec::new(); scene.surfaces.len()];
    for surface in 0..scene.surfaces.len() {
        members[regions.first(surface as u32) as usize].push(surface);
    }
    members
}

/// The pieces of a region are convex, face as its members do, have their centres on them and their area.
fn assert_tiled_together(scene: &Scene, pieces: &Pieces, members: &[usize]) {
    let of = &pieces.of[members[0]];
    let members: Vec<Vec<DVec3>> = members.iter().map(|m| corners(scene, *m)).collect();
    let area: DVec3 = members.iter().map(|m| vector_area(m)).sum();
    let normal = area.normalize();
    let sum: f64 = of.iter().map(|piece| vector_area(piece).dot(normal)).sum();
    assert!(
        (sum / area.length() - 1.0).abs() < 1e-6,
        "{sum} of {}",
        area.length()
    );
    for piece in of {
        let n = piece.len();
        let turns = (0..n).map(|i| {
            (piece[(i + 1) % n] - piece[i]).cross(piece[(i + 2) % n] - piece[(i + 1) % n])
        });
        assert!(
            turns.map(|turn| turn.dot(normal)).all(|turn| turn > 0.0),
            "{piece:?}"
        );
        let centre = piece.iter().sum::<DVec3>() / n as f64;
        let on_one = members
            .iter()
            .any(|m| depth(m, centre, normal) > -1e-9 * diameter(m));
        assert!(on_one, "{piece:?}");
    }
}

/// Pieces are convex and oriented as their surface, lie within it and have its area; the sides on its border make up its
/// outline.
fn assert_tiled(scene: &Scene, pieces: &Pieces, number: usize) {
    let whole = corners(scene, number);
    let area = vector_area(&whole);
    let normal = area.normalize();
    let tolerance = 1e-9 * diameter(&whole);
    let sum: f64 = pieces.of[number]
        .iter()
        .map(|piece| vector_area(piece).dot(normal))
        .sum();
    // Rounding of coordinates far from the origin comes on top.
    let rounding = 1e-15 * whole.iter().map(|p| p.length()).fold(0.0, f64::max) / diameter(&whole);
    let slack = 1e-9 + 100.0 * rounding;
    assert!(
        (sum / area.length() - 1.0).abs() < slack,
        "surface {number}: {sum} of {}",
        area.length()
    );
    for piece in &pieces.of[number] {
        let n = piece.len();
        for i in 0..n {
            let (before, after) = (
                piece[(i + 1) % n] - piece[i],
                piece[(i + 2) % n] - piece[(i + 1) % n],
            );
            assert!(
                before.cross(after).dot(normal) > 0.0,
                "surface {number}: {piece:?} is not convex"
            );
            let inside =
                depth(&whole, piece[i], normal) >= -tolerance - 10.0 * rounding * diameter(&whole);
            assert!(inside, "surface {number}: {piece:?} leaves it");
        }
    }
    let outline = pieces.outlined[number];
    let perimeter: f64 = sides(&whole).sum();
    assert!(
        (outline / perimeter - 1.0).abs() < 1e-6,
        "surface {number}: an outline of {outline}, not {perimeter}"
    );
}

fn sides(corners: &[DVec3]) -> impl Iterator<Item = f64> {
    (0..corners.len()).map(|i| corners[i].distance(corners[(i + 1) % corners.len()]))
}

/// How far a point lies inside a convex polygon: its distance from the nearest side's line, negative outside.
pub fn depth(polygon: &[DVec3], point: DVec3, normal: DVec3) -> f64 {
    let n = polygon.len();
    let from_side = |i: usize| {
        let along = (polygon[(i + 1) % n] - polygon[i]).normalize();
        normal.cross(along).dot(point - polygon[i])
    };
    (0..n).map(from_side).fold(f64::INFINITY, f64::min)
}

/// The segment that two convex polygons have in common, unless their planes are parallel.
pub fn common(first: &[DVec3], second: &[DVec3]) -> Option<[DVec3; 2]> {
    let [m, n] = [first, second].map(|polygon| vector_area(polygon).normalize());
    if m.cross(n).length() < 1e-9 {
        return None;
    }
    let mut ends: Vec<DVec3> = Vec::new();
    for (edges, face) in [(first, second), (second, first)] {
        let normal = vector_area(face).normalize();
        for i in 0..edges.len() {
            let (a, b) = (edges[i], edges[(i + 1) % edges.len()]);
            let (from, to) = (normal.dot(a - face[0]), normal.dot(b - face[0]));
            if (from < 0.0) != (to < 0.0) {
                let point = a.lerp(b, from / (from - to));
                if depth(face, point, normal) >= 0.0 {
                    ends.push(point);
                }
            }
        }
    }
    let (a, b) = (*ends.first()?, *ends.last()?);
    let far = |p: DVec3| {
        ends.iter()
            .copied()
            .max_by(|x, y| x.distance(p).total_cmp(&y.distance(p)))
    };
    let first = far(a.midpoint(b))?;
    Some([first, far(first)?])
}

impl Pieces {
    /// Checks that no piece of a surface lies on both sides of a segment on it, closer than `within` to it.
    pub fn assert_split_along(
        &self,
        scene: &Scene,
        surface: usize,
        [a, b]: [DVec3; 2],
        within: f64,
    ) {
        let whole = corners(scene, surface);
        let normal = vector_area(&whole).normalize();
        if a.distance(b) < 4.0 * within {
            return;
        }
        let aside = normal.cross(b - a).normalize() * within;
        for step in 0..=20 {
            // Not so close to the ends that a point beside the segment may be beyond a neighbour of it.
            let margin = 2.0 * within / a.distance(b);
            let on = a.lerp(b, margin + (1.0 - 2.0 * margin) * f64::from(step) / 20.0);
            let both = [on + aside, on - aside];
            if both.iter().any(|p| depth(&whole, *p, normal) < within) {
                continue;
            }
            let shared = self.of[surface]
                .iter()
                .filter(|piece| both.iter().all(|p| depth(piece, *p, normal) > 0.0));
            assert_eq!(
                shared.count(),
                0,
                "surface {surface} is not split along {a} to {b}, near {on}"
            );
        }
    }

    /// Checks that every surface is split along every line in which another crosses it.
    pub fn assert_split_along_crossings(&self, scene: &Scene, within: f64) {
        let count = scene.surfaces.len();
        for first in 0..count {
            for second in (0..count).filter(|second| *second != first) {
                if let Some(line) = common(&corners(scene, first), &corners(scene, second)) {
                    self.assert_split_along(scene, first, line, within);
                }
            }
        }
    }

    /// Checks that no surface is split; those that are part of others have no pieces.
    pub fn assert_whole(&self) {
        assert!(
            self.of.iter().all(|pieces| pieces.len() <= 1),
            "{:?}",
            self.of
        );
        assert_eq!(self.mesh.unsplit_contacts, 0);
    }
}
