//! Halls of the same furniture, as large as one likes.

#[allow(dead_code, reason = "a hall is made of cuboids alone")]
#[path = "../../tests/common/shapes.rs"]
mod shapes;

use glam::DVec3;
use shapes::{CUBOID, cuboid_corner};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

/// Of a table and a ball on it.
const TRIANGLES: usize = 5 * 12 + 2 * AROUND * (DOWN - 1);
const AROUND: usize = 20;
const DOWN: usize = 12;

/// Side of the square that has a table, metres.
const SQUARE: f64 = 2.0;

/// Writes a hall with about so many triangles and says how many there are: floor, ceiling and walls, lamps below the ceiling, and on
/// each square a table with a ball on it.
pub fn write(file: &Path, triangles: usize) -> usize {
    let along = ((triangles as f64 / TRIANGLES as f64).sqrt().round() as usize).max(1);
    let size = along as f64 * SQUARE;
    let mut hall = Hall::default();
    hall.text += "mtllib hall.mtl\nusemtl wall\n";
    hall.cuboid([0.0; 3], [size, 3.0, size], true);
    for (i, j) in (0..along).flat_map(|i| (0..along).map(move |j| (i, j))) {
        let [x, z] = [i, j].map(|k| (k as f64 + 0.5) * SQUARE);
        hall.text += "usemtl wood\n";
        hall.cuboid([x - 0.6, 0.7, z - 0.4], [x + 0.6, 0.74, z + 0.4], false);
        for (u, v) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let (x, z) = (x + u * 0.55, z + v * 0.35);
            hall.cuboid(
                [x - 0.03, 0.01, z - 0.03],
                [x + 0.03, 0.69, z + 0.03],
                false,
            );
        }
        hall.text += "usemtl clay\n";
        hall.ball([x + 0.2, 1.0, z], 0.2);
        if i % 2 == 0 && j % 2 == 0 {
            hall.text += "usemtl lamp\n";
            hall.cuboid([x - 0.3, 2.8, z - 0.3], [x + 0.3, 2.85, z + 0.3], false);
        }
    }
    let materials = "newmtl wall\nKd 0.7 0.7 0.7\nnewmtl wood\nKd 0.5 0.35 0.2\nnewmtl clay\nKd 0.6 0.3 0.25\n\
                     newmtl lamp\nKd 0.5 0.5 0.5\nKe 20 19 17\n";
    std::fs::write(file, hall.text).expect("there is room for a file");
    std::fs::write(file.with_file_name("hall.mtl"), materials).expect("and for another");
    hall.triangles
}

#[derive(Default)]
struct Hall {
    text: String,
    vertices: usize,
    triangles: usize,
}

impl Hall {
    fn vertex(&mut self, [x, y, z]: [f64; 3]) -> usize {
        self.vertices += 1;
        writeln!(self.text, "v {x:.5} {y:.5} {z:.5}").expect("a string takes all");
        self.vertices
    }

    fn triangle(&mut self, [a, b, c]: [usize; 3]) {
        self.triangles += 1;
        writeln!(self.text, "f {a} {b} {c}").expect("a string takes all");
    }

    fn cuboid(&mut self, low: [f64; 3], high: [f64; 3], inwards: bool) {
        let ends = [low, high].map(DVec3::from);
        let corners: [usize; 8] =
            std::array::from_fn(|number| self.vertex(cuboid_corner(number, ends).to_array()));
        for [a, b, c, d] in CUBOID {
            for [a, b, c] in [[a, b, c], [a, c, d]] {
                let [b, c] = if inwards { [c, b] } else { [b, c] };
                self.triangle([a, b, c].map(|n| corners[n]));
            }
        }
    }

    fn ball(&mut self, [x, y, z]: [f64; 3], radius: f64) {
        let ring = |v: usize| {
            let b = PI * v as f64 / DOWN as f64;
            (radius * b.sin(), y + radius * b.cos())
        };
        let top = self.vertex([x, y + radius, z]);
        let first = self.vertices + 1;
        for (v, u) in (1..DOWN).flat_map(|v| (0..AROUND).map(move |u| (v, u))) {
            let (a, (r, y)) = (TAU * u as f64 / AROUND as f64, ring(v));
            self.vertex([x + r * a.sin(), y, z + r * a.cos()]);
        }
        let bottom = self.vertex([x, y - radius, z]);
        let at = |v: usize, u: usize| first + (v - 1) * AROUND + u % AROUND;
        for u in 0..AROUND {
            self.triangle([top, at(1, u), at(1, u + 1)]);
            self.triangle([bottom, at(DOWN - 1, u + 1), at(DOWN - 1, u)]);
            for v in 1..DOWN - 1 {
                self.triangle([at(v, u), at(v + 1, u), at(v + 1, u + 1)]);
                self.triangle([at(v, u), at(v + 1, u + 1), at(v, u + 1)]);
            }
        }
    }
}
