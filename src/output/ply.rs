//! The solution as a binary PLY file, for viewers and for baking.

use super::blocks::needs_double;
use super::{WriteError, write_atomically};
use crate::solution::{LitMesh, LitVertex};
use glam::{DVec3, Vec3};
use std::io::{self, Write};
use std::path::Path;

/// Writes the triangles as they are: one PLY vertex a [`LitVertex`], one face a triangle, in order.
///
/// Per vertex: position in scene units, unit normal, radiosity B and irradiance E (W/m², linear Rec. 709, float), and
/// `colour` of the vertex as 8-bit sRGB for viewers, which ignore the rest. Positions are `float`; only where that
/// would move a vertex by more than 1e-5 of the mesh's extent (a scene far from its origin) they are `double`.
/// Per face, where `errors` are given, one a triangle: the estimated RMS error of the irradiance (W/m², float).
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// If an index of the mesh is out of range, or `errors` has not one for each triangle.
pub fn write_ply(
    path: &Path,
    mesh: &LitMesh,
    errors: Option<&[f32]>,
    colour: impl Fn(&LitVertex) -> [u8; 3],
) -> Result<(), WriteError> {
    let double = needs_double(&mesh.positions);
    assert!(errors.is_none_or(|errors| errors.len() == mesh.triangles.len()));
    write_atomically(path, |out| {
        out.write_all(header(mesh, double, errors.is_some()).as_bytes())?;
        for vertex in &mesh.vertices {
            write_position(out, mesh.positions[vertex.position as usize], double)?;
            write_floats(out, vertex.normal)?;
            write_floats(out, vertex.radiosity)?;
            write_floats(out, vertex.irradiance)?;
            out.write_all(&colour(vertex))?;
        }
        for (number, triangle) in mesh.triangles.iter().enumerate() {
            out.write_all(&[3])?;
            for corner in triangle.vertices {
                out.write_all(&corner.to_le_bytes())?;
            }
            if let Some(errors) = errors {
                out.write_all(&errors[number].to_le_bytes())?;
            }
        }
        Ok(())
    })
}

fn header(mesh: &LitMesh, double: bool, errors: bool) -> String {
    let mut header = String::from(
        "ply\n\
         format binary_little_endian 1.0\n\
         comment radiosity: a view-independent diffuse solution\n\
         comment x y z in scene units, y up; n the unit normal of the radiating side\n\
         comment radiosity = emitted + reflected flux per area, W/m^2, linear Rec. 709; leaving radiance = radiosity / pi\n\
         comment irradiance = received flux per area, W/m^2, linear Rec. 709\n\
         comment red green blue = the radiosity tone-mapped to sRGB, for display only\n",
    );
    header += &format!("element vertex {}\n", mesh.vertices.len());
    let scalar = if double { "double" } else { "float" };
    for name in ["x", "y", "z"] {
        header += &format!("property {scalar} {name}\n");
    }
    for name in ["nx", "ny", "nz"] {
        header += &format!("property float {name}\n");
    }
    for quantity in ["radiosity", "irradiance"] {
        for channel in ["r", "g", "b"] {
            header += &format!("property float {quantity}_{channel}\n");
        }
    }
    for name in ["red", "green", "blue"] {
        header += &format!("property uchar {name}\n");
    }
    header += &format!("element face {}\n", mesh.triangles.len());
    header += "property list uchar uint vertex_indices\n";
    if errors {
        header += "property float irradiance_error\n";
    }
    header + "end_header\n"
}

fn write_position(out: &mut impl Write, position: DVec3, double: bool) -> io::Result<()> {
    if !double {
        return write_floats(out, position.as_vec3());
    }
    for coordinate in position.to_array() {
        out.write_all(&coordinate.to_le_bytes())?;
    }
    Ok(())
}

fn write_floats(out: &mut impl Write, values: Vec3) -> io::Result<()> {
    for value in values.to_array() {
        out.write_all(&value.to_le_bytes())?;
    }
    Ok(())
}
