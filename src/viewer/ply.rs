//! A lit mesh from the `solution.ply` that a solve wrote, where the solution itself is not at hand.

use crate::radiometry::Spectrum;
use crate::solution::{LitMesh, LitTriangle, LitVertex, SolutionError};
use glam::{DVec3, Vec3};
use std::path::Path;

/// Reads the triangles of a solution's PLY file with radiosity and irradiance; polygons are not known in it.
///
/// # Errors
/// When the file cannot be read, or is not what `radiosity solve` writes.
pub fn read_ply(path: &Path) -> Result<LitMesh, SolutionError> {
    let bytes = std::fs::read(path).map_err(|source| SolutionError::Unreadable {
        path: path.into(),
        source,
    })?;
    decode(&bytes).map_err(|found| SolutionError::Damaged {
        path: path.into(),
        found,
    })
}

fn decode(bytes: &[u8]) -> Result<LitMesh, String> {
    let (vertices, faces, body) = header(bytes)?;
    let places = ["x", "y", "z"].map(|name| vertices.find(name));
    let [x, y, z] = all(places)?;
    let vector = |names: [&str; 3]| all(names.map(|name| vertices.find(name)));
    let normal = vector(["nx", "ny", "nz"])?;
    let radiosity = vector(["radiosity_r", "radiosity_g", "radiosity_b"])?;
    let irradiance = vector(["irradiance_r", "irradiance_g", "irradiance_b"])?;
    let (vertex_bytes, face_bytes) = (vertices.bytes(), faces.bytes());
    let (Some(vertex_bytes), Some(face_bytes)) = (vertex_bytes, face_bytes) else {
        return Err("more vertices or faces than a file can hold".into());
    };
    if body.len() < vertex_bytes || body.len() - vertex_bytes < face_bytes {
        return Err(format!(
            "{} bytes of vertices and faces: the file is cut short",
            body.len()
        ));
    }
    let (vertex_body, face_body) = body.split_at(vertex_bytes);
    let mut lit = LitMesh::default();
    for (number, row) in vertex_body.chunks_exact(vertices.stride).enumerate() {
        let floats = |at: [Field; 3]| -> Vec3 { DVec3::from(at.map(|f| f.read(row))).as_vec3() };
        let (received, left): (Spectrum, Spectrum) = (floats(irradiance), floats(radiosity));
        let position = DVec3::from([x, y, z].map(|field| field.read(row)));
        if !(position.is_finite() && received.is_finite() && left.is_finite()) {
            return Err(format!("vertex {number} with something that is no number"));
        }
        lit.positions.push(position);
        lit.vertices.push(LitVertex {
            position: number as u32,
            normal: floats(normal),
            irradiance: received,
            radiosity: left,
        });
    }
    for (number, row) in face_body.chunks_exact(faces.stride).enumerate() {
        lit.triangles
            .push(triangle(number, row, lit.vertices.len())?);
    }
    Ok(lit)
}

/// An element is the triangles around its centre, which is the first corner of each.
fn triangle(number: usize, row: &[u8], vertices: usize) -> Result<LitTriangle, String> {
    let index = |corner: usize| {
        let at = 1 + 4 * corner;
        u32::from_le_bytes([row[at], row[at + 1], row[at + 2], row[at + 3]])
    };
    let corners = [0, 1, 2].map(index);
    if row[0] != 3 || corners.iter().any(|corner| *corner as usize >= vertices) {
        return Err(format!(
            "face {number} with {} corners {corners:?}, of {vertices} vertices",
            row[0]
        ));
    }
    Ok(LitTriangle {
        vertices: corners,
        element: corners[0],
        polygon: 0,
        on_border: false,
    })
}

/// Rows of numbers of fixed types.
#[derive(Default)]
struct Rows {
    count: usize,
    /// Bytes of a row.
    stride: usize,
    fields: Vec<(String, Field)>,
}

/// Where in a row a number is.
#[derive(Clone, Copy)]
struct Field {
    at: usize,
    double: bool,
}

impl Field {
    fn read(self, row: &[u8]) -> f64 {
        let mut bytes = [0; 8];
        let length = if self.double { 8 } else { 4 };
        bytes[..length].copy_from_slice(&row[self.at..self.at + length]);
        match self.double {
            true => f64::from_le_bytes(bytes),
            false => f64::from(f32::from_bits(u64::from_le_bytes(bytes) as u32)),
        }
    }
}

impl Rows {
    fn find(&self, name: &str) -> Result<Field, String> {
        let found = self.fields.iter().find(|(own, _)| own == name);
        let found = found.map(|(_, field)| *field);
        found.ok_or_else(|| format!("vertices without `{name}`"))
    }

    fn bytes(&self) -> Option<usize> {
        self.count.checked_mul(self.stride)
    }

    /// Takes up a property; false if it is of another type than those that are written.
    fn add(&mut self, words: &[&str]) -> bool {
        let size = match words {
            ["list", "uchar", "uint", "vertex_indices"] if self.stride == 0 => 13,
            ["uchar", _] => 1,
            ["float", _] => 4,
            ["double", _] => 8,
            _ => return false,
        };
        if let ["float" | "double", name] = words {
            let field = Field {
                at: self.stride,
                double: size == 8,
            };
            self.fields.push(((*name).to_owned(), field));
        }
        self.stride += size;
        true
    }
}

fn all(fields: [Result<Field, String>; 3]) -> Result<[Field; 3], String> {
    let [a, b, c] = fields;
    Ok([a?, b?, c?])
}

/// Vertices, faces, and what follows the header.
fn header(bytes: &[u8]) -> Result<(Rows, Rows, &[u8]), String> {
    let mut rest = bytes;
    let mut elements: Vec<(String, Rows)> = Vec::new();
    for number in 1.. {
        let end = rest.iter().take(1000).position(|byte| *byte == b'\n');
        let Some(end) = end else {
            return Err(format!("line {number}: no end of a header"));
        };
        let line = String::from_utf8_lossy(&rest[..end]).into_owned();
        rest = &rest[end + 1..];
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let known = match (number, words.as_slice()) {
            (1, words) => words == ["ply"],
            (2, words) => words == ["format", "binary_little_endian", "1.0"],
            (_, ["comment", ..]) => true,
            (_, ["end_header"]) => break,
            (_, ["element", name, count]) => {
                let count = count
                    .parse()
                    .ok()
                    .filter(|count| *count <= u32::MAX as usize);
                let rows = count.map(|count| Rows {
                    count,
                    ..Rows::default()
                });
                elements.extend(rows.map(|rows| ((*name).to_owned(), rows)));
                count.is_some()
            }
            (_, ["property", words @ ..]) => {
                let rows = elements.last_mut();
                rows.is_some_and(|(_, rows)| rows.add(words))
            }
            _ => false,
        };
        if !known {
            return Err(format!("line {number}: `{}`", line.escape_debug()));
        }
    }
    let mut elements = elements.into_iter();
    match (elements.next(), elements.next(), elements.next()) {
        (Some((vertex, vertices)), Some((face, faces)), None)
            if vertex == "vertex" && face == "face" && faces.stride >= 13 =>
        {
            Ok((vertices, faces, rest))
        }
        _ => Err("a header with other elements than vertices and faces".into()),
    }
}
