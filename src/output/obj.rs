//! The solution as a Wavefront OBJ file with vertex colours: the plainest thing that other programs read.

use super::{WriteError, write_atomically};
use crate::solution::{LitMesh, LitVertex};
use glam::Vec3;
use std::io::Write;
use std::path::Path;

/// Writes the triangles in order, one `v` line with a colour for each [`LitVertex`].
///
/// `v` holds the position in scene units and `colour` of the vertex, sRGB from 0 to 1, as most programs read it.
/// Radiosity has no place in this format; see [`super::write_ply`].
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// If an index of the mesh is out of range.
pub fn write_obj(
    path: &Path,
    mesh: &LitMesh,
    colour: impl Fn(&LitVertex) -> Vec3,
) -> Result<(), WriteError> {
    write_atomically(path, |out| {
        writeln!(
            out,
            "# radiosity: x y z in scene units, y up, and the tone-mapped radiosity as sRGB, for display only"
        )?;
        for vertex in &mesh.vertices {
            let at = mesh.positions[vertex.position as usize];
            let colour = colour(vertex);
            writeln!(
                out,
                "v {} {} {} {:.4} {:.4} {:.4}",
                at.x, at.y, at.z, colour.x, colour.y, colour.z
            )?;
        }
        for Vec3 { x, y, z } in mesh.vertices.iter().map(|vertex| vertex.normal) {
            writeln!(out, "vn {x:.5} {y:.5} {z:.5}")?;
        }
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.vertices.map(|vertex| vertex + 1);
            writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}")?;
        }
        Ok(())
    })
}
