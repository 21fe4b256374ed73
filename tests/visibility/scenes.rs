//! Scenes made by procedure, in double precision, and the way they come to an engine.

use crate::random::Random;
use glam::{DVec3, dvec3};
use radiosity::visibility::Triangles;

/// What a file would hold.
pub struct Scene {
    pub name: &'static str,
    pub vertices: Vec<DVec3>,
    pub indices: Vec<[u32; 3]>,
}

/// The extent that engines see: between 64 and 128 they have the finest steps for their size.
pub const EXTENT: f64 = 100.0;

impl Scene {
    fn new(name: &'static str) -> Self {
        Self {
            name,
            vertices: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// Triangles without order, small and large.
    pub fn soup(triangles: usize) -> Self {
        let (mut scene, mut random) = (Self::new("soup"), Random::new(1));
        for _ in 0..triangles {
            let (centre, size) = (random.in_cube(), 0.5 * random.unit().powi(3));
            let first = scene.vertices.len() as u32;
            scene
                .vertices
                .extend((0..3).map(|_| centre + size * random.in_cube()));
            scene.indices.push([first, first + 1, first + 2]);
        }
        scene
    }

    /// A closed room, its walls divided into `cells` × `cells`, with boxes that stand on its floor and touch each other.
    pub fn room(boxes: usize, cells: usize) -> Self {
        let (mut scene, mut random) = (Self::new("room"), Random::new(2));
        scene.cuboid(DVec3::ZERO, dvec3(10.0, 3.0, 8.0), cells);
        let mut x = 0.5;
        for k in 0..boxes {
            let size = dvec3(random.between(0.2, 0.8), random.between(0.2, 2.0), 0.6);
            if k % 3 == 0 {
                x = random.between(0.0, 9.0);
            }
            let z = random.between(0.0, 7.0);
            scene.cuboid(dvec3(x, 0.0, z), dvec3(x, 0.0, z) + size, 1);
            x += size.x;
        }
        scene
    }

    #[allow(dead_code, reason = "for the bench of occlusion")]
    /// A room with `balls` × `balls` balls of `rings` rings hanging in it.
    pub fn hall(balls: usize, rings: usize) -> Self {
        let mut scene = Self::new("hall");
        scene.cuboid(DVec3::ZERO, dvec3(10.0, 5.0, 10.0), 1);
        let ball = Self::sphere(rings);
        for k in 0..balls * balls {
            let pitch = 10.0 / balls as f64;
            let (row, column) = ((k / balls) as f64 + 0.5, (k % balls) as f64 + 0.5);
            let centre = dvec3(
                pitch * row,
                1.0 + 2.0 * ((k * 7) % 5) as f64 / 5.0,
                pitch * column,
            );
            let first = scene.vertices.len() as u32;
            scene
                .vertices
                .extend(ball.vertices.iter().map(|v| centre + 0.4 * pitch * *v));
            scene.indices.extend(
                ball.indices
                    .iter()
                    .map(|corners| corners.map(|i| first + i)),
            );
        }
        scene
    }

    /// Hills on a square grid with `cells` cells a side.
    pub fn terrain(cells: usize) -> Self {
        let mut scene = Self::new("terrain");
        scene.grid(cells, cells, |u, v| {
            let height = (9.0 * u).sin() * (7.0 * v).cos() + 0.3 * (40.0 * u + 23.0 * v).sin();
            dvec3(10.0 * u, 0.5 * height, 10.0 * v)
        });
        scene
    }

    /// A ball of `rings` rings, with poles where many triangles meet.
    pub fn sphere(rings: usize) -> Self {
        let mut scene = Self::new("sphere");
        let sides = 2 * rings;
        scene.vertices.push(DVec3::Y);
        for ring in 1..rings {
            let (sin, cos) = (std::f64::consts::PI * ring as f64 / rings as f64).sin_cos();
            scene.vertices.extend((0..sides).map(|side| {
                let (z, x) = (std::f64::consts::TAU * side as f64 / sides as f64).sin_cos();
                dvec3(x * sin, cos, z * sin)
            }));
        }
        scene.vertices.push(-DVec3::Y);
        let last = scene.vertices.len() as u32 - 1;
        let sides = sides as u32;
        let at = |ring: u32, side: u32| 1 + ring * sides + side % sides;
        for side in 0..sides {
            scene.indices.push([0, at(0, side + 1), at(0, side)]);
            let bottom = rings as u32 - 2;
            scene
                .indices
                .push([last, at(bottom, side), at(bottom, side + 1)]);
            for ring in 0..bottom {
                let [a, b] = [at(ring, side), at(ring, side + 1)];
                let [c, d] = [at(ring + 1, side), at(ring + 1, side + 1)];
                scene.indices.extend([[a, b, c], [b, d, c]]);
            }
        }
        scene
    }

    /// The six sides of a box, each a grid.
    fn cuboid(&mut self, low: DVec3, high: DVec3, cells: usize) {
        let at = |u: f64, v: f64, w: f64| low + (high - low) * dvec3(u, v, w);
        for end in [0.0, 1.0] {
            self.grid(cells, cells, |u, v| at(u, v, end));
            self.grid(cells, cells, |u, v| at(v, end, u));
            self.grid(cells, cells, |u, v| at(end, u, v));
        }
    }

    fn grid(&mut self, columns: usize, rows: usize, at: impl Fn(f64, f64) -> DVec3) {
        let first = self.vertices.len();
        for row in 0..=rows {
            for column in 0..=columns {
                let (u, v) = (column as f64 / columns as f64, row as f64 / rows as f64);
                self.vertices.push(at(u, v));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = (first + row * (columns + 1) + column) as u32;
                let [b, c] = [a + 1, a + columns as u32 + 1];
                self.indices.extend([[a, c, b], [b, c, c + 1]]);
            }
        }
    }

    /// The same scene in other units and in another place, as a file may hold it.
    pub fn moved(&self, scale: f64, offset: DVec3) -> Self {
        let vertices = self.vertices.iter().map(|v| scale * *v + offset).collect();
        Self {
            name: self.name,
            vertices,
            indices: self.indices.clone(),
        }
    }

    /// Recentres and scales to [`EXTENT`], rounds to single precision.
    pub fn triangles(&self) -> Triangles {
        let low = self
            .vertices
            .iter()
            .copied()
            .reduce(DVec3::min)
            .expect("a vertex");
        let high = self
            .vertices
            .iter()
            .copied()
            .reduce(DVec3::max)
            .expect("a vertex");
        let scale = EXTENT / (high - low).max_element();
        let centre = 0.5 * (low + high);
        let vertices = self
            .vertices
            .iter()
            .map(|v| (scale * (*v - centre)).as_vec3())
            .collect();
        Triangles {
            vertices,
            indices: self.indices.clone(),
        }
    }
}
