//! The header of a PLY file.

use crate::scene::SceneError;
use crate::scene::text::quote;
use std::path::Path;

/// How the numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Kind::I8,
            "uchar" | "uint8" => Kind::U8,
            "short" | "int16" => Kind::I16,
            "ushort" | "uint16" => Kind::U16,
            "int" | "int32" => Kind::I32,
            "uint" | "uint32" => Kind::U32,
            "float" | "float32" => Kind::F32,
            "double" | "float64" => Kind::F64,
            _ => return None,
        })
    }
}

/// A number, or a list with the type of its length and of its items.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Number(Kind),
    List(Kind, Kind),
}

pub(super) struct Property {
    pub name: String,
    pub shape: Shape,
}

impl Property {
    /// Whether it may be the list of a face's corners.
    pub fn is_corners(&self) -> bool {
        matches!(self.name.as_str(), "vertex_indices" | "vertex_index")
    }
}

pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

impl Element {
    pub fn has(&self, property: &str) -> bool {
        self.properties.iter().any(|own| own.name == property)
    }
}

pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
}

impl Header {
    /// The header, and the bytes after it.
    pub fn parse<'a>(path: &Path, bytes: &'a [u8]) -> Result<(Self, &'a [u8]), SceneError> {
        let mut rest = bytes;
        let mut format = None;
        let mut elements: Vec<Element> = Vec::new();
        for number in 1.. {
            let fault =
                |found: String, expected: &str| SceneError::new(path, number, found, expected);
            let Some(end) = rest.iter().take(1 << 16).position(|b| *b == b'\n') else {
                return Err(fault("the end of the file".into(), "`end_header`"));
            };
            let line = String::from_utf8_lossy(&rest[..end]).into_owned();
            rest = &rest[end + 1..];
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match (number, words.as_slice()) {
                (1, ["ply"]) => {}
                (1, _) => return Err(fault(quote(&line), "`ply`")),
                (_, ["end_header"]) => break,
                (_, ["comment" | "obj_info", ..] | []) => {}
                (_, ["format", name, "1.0"]) => {
                    format = Some(Format::of(name).map_err(|()| {
                        fault(
                            quote(name),
                            "ascii, binary_little_endian or binary_big_endian",
                        )
                    })?)
                }
                (_, ["element", name, count]) => elements.push(Element {
                    name: (*name).to_owned(),
                    count: count.parse().map_err(|_| fault(quote(count), "a count"))?,
                    properties: Vec::new(),
                }),
                (_, ["property", words @ ..]) => {
                    let property = property(words);
                    let element = elements.last_mut();
                    let (property, element) = property
                        .zip(element)
                        .ok_or_else(|| fault(quote(&line), "a property of an element"))?;
                    element.properties.push(property);
                }
                _ => return Err(fault(quote(&line), "a line of a PLY header")),
            }
        }
        let missing = |found: &str, expected: &str| SceneError::new(path, None, found, expected);
        let format = format.ok_or_else(|| missing("no `format`", "one in the header"))?;
        let header = Self { format, elements };
        header
            .judge()
            .map_err(|(found, expected)| missing(found, expected))?;
        Ok((header, rest))
    }

    /// Whether there is what a polygonal scene needs, vertices first.
    fn judge(&self) -> Result<(), (&'static str, &'static str)> {
        let place = |name: &str| self.elements.iter().position(|e| e.name == name);
        let vertex = place("vertex").ok_or(("no `element vertex`", "vertices"))?;
        let number = |axis| {
            let mut properties = self.elements[vertex].properties.iter();
            properties.any(|p| p.name == axis && matches!(p.shape, Shape::Number(_)))
        };
        if !["x", "y", "z"].into_iter().all(number) {
            return Err(("vertices without a place", "the properties x, y and z"));
        }
        let face = place("face").ok_or(("no `element face`", "faces: points are no surface"))?;
        if face < vertex {
            return Err(("faces before vertices", "vertices first"));
        }
        let corners = &self.elements[face].properties;
        let list = |p: &Property| p.is_corners() && matches!(p.shape, Shape::List(..));
        match corners.iter().any(list) {
            true => Ok(()),
            false => Err(("faces without corners", "the list `vertex_indices`")),
        }
    }
}

impl Format {
    fn of(name: &str) -> Result<Self, ()> {
        match name {
            "ascii" => Ok(Format::Text),
            "binary_little_endian" => Ok(Format::LittleEndian),
            "binary_big_endian" => Ok(Format::BigEndian),
            _ => Err(()),
        }
    }
}

fn property(words: &[&str]) -> Option<Property> {
    let (name, shape) = match *words {
        ["list", count, item, name] => (name, Shape::List(Kind::of(count)?, Kind::of(item)?)),
        [kind, name] => (name, Shape::Number(Kind::of(kind)?)),
        _ => return None,
    };
    Some(Property {
        name: name.to_owned(),
        shape,
    })
}
