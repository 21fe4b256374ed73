//! A scan of an OBJ file ahead of `tobj`, which knows no line numbers and trusts what it reads.
//!
//! The scan checks every line that matters and writes the same polygons again in the plainest form:
//! finite `v x y z`, `usemtl NAME`, and `f` with absolute, valid position indices. What `tobj` then reads
//! cannot go wrong, and its n-th polygon is the n-th `f` line here.

use super::text::{TextFile, quote};
use super::warnings::Tally;
use super::{SceneError, limits};
use rustc_hash::FxHashMap;

/// A checked OBJ file.
#[derive(Default)]
pub(super) struct CheckedObj {
    /// The `v` lines, in plain form.
    pub vertex_lines: String,
    /// The `usemtl` and `f` lines, in plain form.
    pub face_lines: String,
    /// For every polygon the line where it stands.
    pub polygon_lines: Vec<u32>,
    /// The names that `g` and `o` give, in order of appearance.
    pub groups: Vec<String>,
    /// For every polygon the last of them before it.
    pub polygon_groups: Vec<Option<u32>>,
    /// What each `mtllib` says, with its line.
    pub libraries: Vec<(usize, String)>,
    /// Every material named by `usemtl` and followed by polygons, in order of appearance.
    pub used_materials: Vec<UsedMaterial>,
    /// Polygons before the first `usemtl`.
    pub without_material: Tally,
    /// Lines that begin with a word this reader does not know.
    pub unknown: Tally,
    /// How many vertices it has …
    pub vertices: i64,
    /// … and how many corners of polygons.
    pub corners: usize,
    forward: Vec<(usize, i64)>,
    current_material: Option<usize>,
    current_group: Option<u32>,
    group_numbers: FxHashMap<String, u32>,
    material_numbers: FxHashMap<String, usize>,
}

/// A material that polygons of an OBJ file name.
pub(super) struct UsedMaterial {
    /// The name in the file.
    pub name: String,
    /// Polygons with this material.
    pub polygons: Tally,
}

/// Checks the whole file.
pub(super) fn check(file: &TextFile) -> Result<CheckedObj, SceneError> {
    let mut obj = CheckedObj::with_room(file);
    for (number, line) in file.lines() {
        let mut words = line
            .split_ascii_whitespace()
            .take_while(|word| !word.starts_with('#'));
        let Some(keyword) = words.next() else {
            continue;
        };
        let checked = match keyword {
            "v" => obj.vertex(words),
            "f" => obj.face(words, number),
            "usemtl" => obj.material(name_of(&line, keyword)),
            "mtllib" => obj.library(rest_of(&line, keyword), number),
            "o" | "g" => {
                obj.group(name_of(&line, keyword));
                Ok(())
            }
            "vn" | "vt" | "vp" | "s" | "l" | "p" | "mg" | "lod" | "bevel" | "c_interp"
            | "d_interp" | "shadow_obj" | "trace_obj" => Ok(()),
            _ => {
                obj.unknown.add(number);
                Ok(())
            }
        };
        checked.map_err(|(found, expected)| file.error(number, found, expected))?;
    }
    // A face may name vertices that follow it; only now is it known whether they do.
    match obj.forward.iter().find(|(_, index)| *index > obj.vertices) {
        Some(&(line, index)) => Err(file.error(
            line,
            format!("the vertex index {index}"),
            index_range(obj.vertices),
        )),
        None => Ok(obj),
    }
}

/// What is wrong with a line: found and expected.
type Fault = (String, String);

impl CheckedObj {
    /// Nothing yet, with room for all that a file may have: what is not written to takes no memory, but what grows leaves holes.
    fn with_room(file: &TextFile) -> Self {
        let (bytes, lines) = (file.text.len(), file.line_at(file.text.len()));
        Self {
            vertex_lines: String::with_capacity(bytes),
            face_lines: String::with_capacity(bytes),
            polygon_lines: Vec::with_capacity(lines),
            polygon_groups: Vec::with_capacity(lines),
            ..Self::default()
        }
    }

    fn vertex<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), Fault> {
        self.vertex_lines.push('v');
        let mut coordinates = 0;
        for word in words {
            let value: f64 = word
                .parse()
                .map_err(|_| (quote(word), "a number".to_owned()))?;
            // What follows x, y and z is a weight or a colour, and neither belongs to a polygonal scene.
            if coordinates < 3 {
                if value.is_nan() || value.abs() > limits::COORDINATE {
                    let expected = format!("a finite coordinate, at most {:e}", limits::COORDINATE);
                    return Err((format!("the coordinate {}", quote(word)), expected));
                }
                self.vertex_lines.push(' ');
                self.vertex_lines.push_str(word);
            }
            coordinates += 1;
        }
        if coordinates < 3 {
            return Err((
                format!("a vertex with {coordinates} coordinates"),
                "`v x y z`".to_owned(),
            ));
        }
        if self.vertices >= i64::from(u32::MAX) {
            return Err((
                "one vertex too many".to_owned(),
                format!("at most {} vertices", u32::MAX),
            ));
        }
        self.vertex_lines.push('\n');
        self.vertices += 1;
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>, line: usize) -> Result<(), Fault> {
        self.face_lines.push('f');
        let mut corners = 0;
        let mut largest = 0;
        for word in words {
            let index = self.corner(word)?;
            largest = index.max(largest);
            self.face_lines.push(' ');
            match word.bytes().all(|byte| byte.is_ascii_digit()) {
                // Nearly always; a million polygons are written faster without formatting numbers.
                true => self.face_lines.push_str(word),
                false => self.face_lines.push_str(&index.to_string()),
            }
            corners += 1;
        }
        self.face_lines.push('\n');
        self.corners += corners;
        if !(3..=limits::CORNERS).contains(&corners) {
            let expected = format!("3 to {} corners", limits::CORNERS);
            return Err((format!("a polygon with {corners} corners"), expected));
        }
        if largest > self.vertices {
            self.forward.push((line, largest));
        }
        let line_in_u32 = u32::try_from(line);
        self.polygon_lines
            .push(line_in_u32.map_err(|_| too_long())?);
        self.polygon_groups.push(self.current_group);
        match self.current_material {
            Some(used) => self.used_materials[used].polygons.add(line),
            None => self.without_material.add(line),
        }
        Ok(())
    }

    /// The position index, counted from 1, of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &str) -> Result<i64, Fault> {
        let malformed = || {
            (
                quote(word),
                "a corner `v`, `v/vt`, `v//vn` or `v/vt/vn` of whole numbers".to_owned(),
            )
        };
        let mut parts = word.split('/');
        let position: i64 = parts
            .next()
            .unwrap_or("")
            .parse()
            .map_err(|_| malformed())?;
        let mut others = 0;
        for part in parts {
            others += 1;
            if others > 2 || !(part.is_empty() || part.parse::<i64>().is_ok()) {
                return Err(malformed());
            }
        }
        match position {
            1.. => Ok(position),
            // Relative to the vertices so far: -1 is the last one.
            ..=-1 if position + self.vertices >= 0 => Ok(position + self.vertices + 1),
            _ => Err((
                format!("the vertex index {position}"),
                index_range(self.vertices),
            )),
        }
    }

    /// A name may come again; `g` without one ends the group.
    fn group(&mut self, name: &str) {
        if name.is_empty() {
            self.current_group = None;
            return;
        }
        let next = self.groups.len() as u32;
        let number = *self.group_numbers.entry(name.to_owned()).or_insert(next);
        if number == next {
            self.groups.push(name.to_owned());
        }
        self.current_group = Some(number);
    }

    fn material(&mut self, name: &str) -> Result<(), Fault> {
        if name.is_empty() {
            return Err((
                "`usemtl` without a name".to_owned(),
                "the name of a material".to_owned(),
            ));
        }
        let next = self.used_materials.len();
        let number = *self.material_numbers.entry(name.to_owned()).or_insert(next);
        if number == next {
            self.used_materials.push(UsedMaterial {
                name: name.to_owned(),
                polygons: Tally::default(),
            });
        }
        self.current_material = Some(number);
        self.face_lines.extend(["usemtl ", name, "\n"]);
        Ok(())
    }

    fn library(&mut self, name: &str, line: usize) -> Result<(), Fault> {
        if name.is_empty() {
            return Err((
                "`mtllib` without a name".to_owned(),
                "the path of an .mtl file".to_owned(),
            ));
        }
        self.libraries.push((line, name.to_owned()));
        Ok(())
    }
}

/// What follows the keyword, spaces inside it included: names may hold any.
fn rest_of<'a>(line: &'a str, keyword: &str) -> &'a str {
    let line = line.trim_start();
    line.strip_prefix(keyword).unwrap_or(line).trim()
}

/// The name that follows the keyword, without a comment: programs number materials as in `Material #2`, so a `#` is part of the name
/// where no space follows it.
pub(super) fn name_of<'a>(line: &'a str, keyword: &str) -> &'a str {
    without_comment(rest_of(line, keyword), |word| word == "#")
}

/// What comes before the first word with which a comment begins.
pub(super) fn without_comment(text: &str, begins: impl Fn(&str) -> bool) -> &str {
    let place = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
    let comment = text.split_ascii_whitespace().find(|word| begins(word));
    text[..comment.map_or(text.len(), place)].trim_end()
}

fn index_range(vertices: i64) -> String {
    match vertices {
        0 => "a vertex to refer to".to_owned(),
        n => format!("1 to {n}, or -{n} to -1"),
    }
}

fn too_long() -> Fault {
    (
        "one line too many".to_owned(),
        format!("at most {} lines", u32::MAX),
    )
}
