//! The solution as a VTK unstructured grid, for ParaView and other programs that analyse fields.

use super::blocks::{Block, doubles, floats, indices, needs_double};
use super::{WriteError, write_atomically};
use crate::radiometry::photometric;
use crate::solution::LitMesh;
use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;

/// VTK's number of a triangle.
const TRIANGLE: u8 = 5;

/// What the file says besides the mesh.
#[derive(Debug, Clone, Copy)]
pub struct VtuFacts<'a> {
    /// Length of one scene unit in metres: points are in metres.
    pub metres_per_unit: f64,
    /// Lumens per watt; see [`crate::radiometry::WHITE_EFFICACY`].
    pub efficacy: f64,
    /// Level of each triangle's element in its quadtree.
    pub levels: &'a [u8],
    /// The estimated RMS error of the irradiance (W/m²) on each triangle's element, if the solve was audited.
    pub errors: Option<&'a [f32]>,
}

/// Writes the triangles in order as `appended` raw binary (little-endian, 64-bit headers): no larger than the numbers.
///
/// Point fields: `radiosity (W/m2)` and `irradiance (W/m2)`, linear Rec. 709; `illuminance (lx)`; `normal`. Cell fields:
/// `element level`, `element`, `polygon` (of the input, from 0) and, where known, `irradiance error (W/m2)`. Points are in
/// metres, as doubles only where single precision would move one by more than 1e-5 of the extent. The field data
/// `luminous efficacy (lm/W)` and `metres per scene unit` are single numbers.
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// If an index of the mesh is out of range, or `levels` or `errors` have not one entry for each triangle.
pub fn write_vtu(path: &Path, mesh: &LitMesh, facts: &VtuFacts) -> Result<(), WriteError> {
    assert_eq!(facts.levels.len(), mesh.triangles.len());
    assert!(
        facts
            .errors
            .is_none_or(|errors| errors.len() == mesh.triangles.len())
    );
    let arrays = arrays(mesh, facts);
    let text = header(mesh, facts, &arrays);
    write_atomically(path, |out| {
        out.write_all(text.as_bytes())?;
        for (_, block) in &arrays {
            out.write_all(&block.bytes.to_le_bytes())?;
            block.write(out)?;
        }
        out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    })
}

/// Where an array stands.
#[derive(Clone, Copy, PartialEq)]
enum Section {
    Points,
    Cells,
    PointData,
    CellData,
}

struct Heading {
    section: Section,
    name: &'static str,
    kind: &'static str,
    components: u32,
}

fn arrays<'a>(mesh: &'a LitMesh, facts: &'a VtuFacts) -> Vec<(Heading, Block<'a>)> {
    let mut arrays = vec![points(mesh, facts.metres_per_unit)];
    arrays.extend(cells(mesh));
    arrays.extend(point_data(mesh, facts.efficacy));
    arrays.extend(cell_data(mesh, facts));
    arrays
}

fn heading(section: Section, name: &'static str, kind: &'static str, components: u32) -> Heading {
    Heading {
        section,
        name,
        kind,
        components,
    }
}

fn points(mesh: &LitMesh, metres: f64) -> (Heading, Block<'_>) {
    let place = move |index: u32| mesh.positions[index as usize] * metres;
    let (places, count) = (
        move || mesh.vertices.iter().map(move |v| place(v.position)),
        mesh.vertices.len(),
    );
    if needs_double(&mesh.positions) {
        let block = Block::new(count, move || places().map(doubles));
        (heading(Section::Points, "position", "Float64", 3), block)
    } else {
        let block = Block::new(count, move || places().map(|p| floats(p.as_vec3())));
        (heading(Section::Points, "position", "Float32", 3), block)
    }
}

fn cells(mesh: &LitMesh) -> [(Heading, Block<'_>); 3] {
    let (triangles, count) = (|| mesh.triangles.iter(), mesh.triangles.len());
    [
        (
            heading(Section::Cells, "connectivity", "UInt32", 1),
            Block::new(count, move || triangles().map(|t| indices(t.vertices))),
        ),
        (
            heading(Section::Cells, "offsets", "Int64", 1),
            Block::new(count, move || {
                (1..=count).map(|n| (3 * n as i64).to_le_bytes())
            }),
        ),
        (
            heading(Section::Cells, "types", "UInt8", 1),
            Block::new(count, move || triangles().map(|_| [TRIANGLE])),
        ),
    ]
}

fn point_data(mesh: &LitMesh, efficacy: f64) -> [(Heading, Block<'_>); 4] {
    let (vertices, count) = (|| mesh.vertices.iter(), mesh.vertices.len());
    let field = |name, components| heading(Section::PointData, name, "Float32", components);
    [
        (
            field("radiosity (W/m2)", 3),
            Block::new(count, move || vertices().map(|v| floats(v.radiosity))),
        ),
        (
            field("irradiance (W/m2)", 3),
            Block::new(count, move || vertices().map(|v| floats(v.irradiance))),
        ),
        (
            field("illuminance (lx)", 1),
            Block::new(count, move || {
                vertices().map(move |v| (photometric(v.irradiance, efficacy) as f32).to_le_bytes())
            }),
        ),
        (
            field("normal", 3),
            Block::new(count, move || vertices().map(|v| floats(v.normal))),
        ),
    ]
}

fn cell_data<'a>(mesh: &'a LitMesh, facts: &'a VtuFacts) -> Vec<(Heading, Block<'a>)> {
    let (triangles, count) = (|| mesh.triangles.iter(), mesh.triangles.len());
    let field = |name, kind| heading(Section::CellData, name, kind, 1);
    let mut fields = vec![
        (
            field("element level", "UInt8"),
            Block::new(count, move || facts.levels.iter().map(|level| [*level])),
        ),
        (
            field("element", "UInt32"),
            Block::new(count, move || triangles().map(|t| t.element.to_le_bytes())),
        ),
        (
            field("polygon", "UInt32"),
            Block::new(count, move || triangles().map(|t| t.polygon.to_le_bytes())),
        ),
    ];
    if let Some(errors) = facts.errors {
        fields.push((
            field("irradiance error (W/m2)", "Float32"),
            Block::new(count, move || errors.iter().map(|e| e.to_le_bytes())),
        ));
    }
    fields
}

fn header(mesh: &LitMesh, facts: &VtuFacts, arrays: &[(Heading, Block)]) -> String {
    let mut at = 0;
    let mut lines: Vec<(Section, String)> = Vec::new();
    for (heading, block) in arrays {
        let Heading {
            section,
            name,
            kind,
            components,
        } = heading;
        lines.push((
            *section,
            format!(
                "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{at}\"/>\n"
            ),
        ));
        at += size_of::<u64>() as u64 + block.bytes;
    }
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n\
         <!-- radiosity: points in metres, y up; colours are linear Rec. 709 -->\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  \
         <UnstructuredGrid>\n    <FieldData>\n{}{}    </FieldData>\n    \
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        single("metres per scene unit", facts.metres_per_unit),
        single("luminous efficacy (lm/W)", facts.efficacy),
        mesh.vertices.len(),
        mesh.triangles.len()
    );
    for (section, tag, attributes) in [
        (Section::Points, "Points", ""),
        (Section::Cells, "Cells", ""),
        (
            Section::PointData,
            "PointData",
            " Vectors=\"radiosity (W/m2)\"",
        ),
        (Section::CellData, "CellData", ""),
    ] {
        let inside = lines.iter().filter(|(of, _)| *of == section);
        let inside: String = inside.map(|(_, line)| line.as_str()).collect();
        let _ = write!(text, "      <{tag}{attributes}>\n{inside}      </{tag}>\n");
    }
    text + "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_"
}

/// A number that holds for the whole file.
fn single(name: &str, value: f64) -> String {
    format!(
        "      <DataArray type=\"Float64\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{value}</DataArray>\n"
    )
}
