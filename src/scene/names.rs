//! What a file calls its polygons: for results that are told by surface or group.

use super::Scene;
use std::path::PathBuf;

/// A scene with the names of its polygons.
#[derive(Debug, Clone)]
pub struct NamedScene {
    /// The scene.
    pub scene: Scene,
    /// What its file calls the polygons.
    pub names: Names,
}

/// Names and places of the polygons in a file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names {
    /// The file with the polygons.
    pub file: PathBuf,
    /// The names that `g` and `o` lines, or nodes, give, each once.
    pub groups: Vec<String>,
    /// For every input polygon the last of them before it; indexed by [`Surface::polygon`](super::Surface::polygon).
    pub group_of: Vec<Option<u32>>,
    /// For every input polygon the line where it stands, counted from 1.
    pub lines: Vec<u32>,
}

impl From<Scene> for NamedScene {
    /// A scene that was not read from a file: its polygons are known by their numbers.
    fn from(scene: Scene) -> Self {
        Self {
            scene,
            names: Names::default(),
        }
    }
}

impl Names {
    /// The group of a polygon, if it has one.
    pub fn group(&self, polygon: u32) -> Option<&str> {
        let group = (*self.group_of.get(polygon as usize)?)?;
        self.groups.get(group as usize).map(String::as_str)
    }

    /// `FILE:LINE` of a polygon, or its number where there is no file.
    pub fn place(&self, polygon: u32) -> String {
        match self.lines.get(polygon as usize) {
            Some(line) => format!("{}:{line}", self.file.display()),
            None => format!("polygon {}", polygon + 1),
        }
    }
}
