//! PLY: polygons of scanners and CAD, in text or binary of either byte order.
//!
//! A reader of our own: the crates for it make a map of names out of every vertex, and bring a parser generator along.
//! Positions and faces are read, everything else is skipped; a PLY file has no materials, so all is `default`.

mod body;
mod header;

use super::geometry::Geometry;
use super::mtl::{DEFAULT_NAME, Entry, Library};
use super::polygons::Polygons;
use super::warnings::Tally;
use super::weld::Welder;
use super::{SceneError, limits};
use body::Body;
use glam::DVec3;
use header::{Element, Header, Property, Shape};
use std::path::Path;

/// Reads a PLY file.
pub(super) fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Geometry, SceneError> {
    let bytes = std::fs::read(path).map_err(|error| {
        let found = format!("an unreadable file ({error})");
        SceneError::new(path, None, found, "a .ply file")
    })?;
    let (header, body) = Header::parse(path, &bytes)?;
    let mut reader = Reader {
        path,
        body: Body::new(body, header.format),
        positions: Vec::new(),
        welded: Vec::new(),
        welder: Welder::default(),
        polygons: Polygons::default(),
    };
    for element in &header.elements {
        reader.element(element)?;
    }
    let colours = header
        .elements
        .iter()
        .any(|e| e.has("red") && e.name == "vertex");
    if colours {
        let path = path.display();
        warnings.push(format!("{path}: colours of the vertices ignored"));
    }
    let mut polygons = Tally::default();
    (0..reader.polygons.len()).for_each(|_| polygons.add(0));
    let default = Entry {
        name: DEFAULT_NAME.to_owned(),
        reflectance: None,
        emitted_radiance: None,
        polygons,
        defined: false,
        sides: None,
    };
    let group_of = vec![None; reader.polygons.len()];
    reader.polygons.positions = reader.welder.into_positions();
    Ok(Geometry {
        polygons: reader.polygons,
        library: Library::new(vec![default], Some(0)),
        group_of,
        ..Geometry::default()
    })
}

/// What is wrong with an item.
struct Fault {
    found: String,
    expected: String,
}

impl From<String> for Fault {
    /// Something that cannot be read as the header has it.
    fn from(found: String) -> Self {
        let expected = "what the header says".to_owned();
        Self { found, expected }
    }
}

struct Reader<'a> {
    path: &'a Path,
    body: Body<'a>,
    positions: Vec<DVec3>,
    /// Number of each vertex among the distinct positions, given when a face uses it.
    welded: Vec<Option<u32>>,
    welder: Welder,
    polygons: Polygons,
}

impl Reader<'_> {
    fn element(&mut self, element: &Element) -> Result<(), SceneError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        for number in 0..element.count {
            let read = match element.name.as_str() {
                "vertex" => self.vertex(&element.properties),
                "face" => self.face(&element.properties),
                _ => self.skip(&element.properties),
            };
            read.map_err(|Fault { found, expected }| {
                let found = format!("{found} in {} {number} of {}", element.name, element.count);
                SceneError::new(self.path, None, found, expected)
            })?;
        }
        Ok(())
    }

    fn vertex(&mut self, properties: &[Property]) -> Result<(), Fault> {
        let mut place = DVec3::ZERO;
        for property in properties {
            match (property.name.as_str(), property.shape) {
                ("x", Shape::Number(kind)) => place.x = self.body.number(kind)?,
                ("y", Shape::Number(kind)) => place.y = self.body.number(kind)?,
                ("z", Shape::Number(kind)) => place.z = self.body.number(kind)?,
                (_, shape) => self.body.skip(shape)?,
            }
        }
        if place.is_nan() || place.abs().max_element() > limits::COORDINATE {
            return Err(Fault {
                found: format!("the position {place}"),
                expected: format!("finite coordinates, at most {:e}", limits::COORDINATE),
            });
        }
        self.positions.push(place);
        self.welded.push(None);
        Ok(())
    }

    fn face(&mut self, properties: &[Property]) -> Result<(), Fault> {
        for property in properties {
            let corners = match property.shape {
                Shape::List(count, item) if property.is_corners() => (count, item),
                shape => {
                    self.body.skip(shape)?;
                    continue;
                }
            };
            let count = self.body.whole(corners.0)?;
            if !(3..=limits::CORNERS).contains(&count) {
                return Err(Fault {
                    found: format!("a polygon with {count} corners"),
                    expected: format!("3 to {} corners", limits::CORNERS),
                });
            }
            let mut polygon = Vec::with_capacity(count);
            for _ in 0..count {
                let vertex = self.body.whole(corners.1)?;
                polygon.push(self.corner(vertex)?);
            }
            self.polygons.push(polygon, 0);
        }
        Ok(())
    }

    fn corner(&mut self, vertex: usize) -> Result<u32, String> {
        let count = self.positions.len();
        let place = self.positions.get(vertex);
        let place = place.ok_or_else(|| format!("vertex {vertex} of {count}"))?;
        Ok(*self.welded[vertex].get_or_insert_with(|| self.welder.index(*place)))
    }

    fn skip(&mut self, properties: &[Property]) -> Result<(), Fault> {
        for property in properties {
            self.body.skip(property.shape)?;
        }
        Ok(())
    }
}
