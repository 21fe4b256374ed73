//! The files of the tree.

use crate::code::{code_of, without_tests};
use std::fs;
use std::path::{Path, PathBuf};

/// A source file, or a snippet that pretends to be one.
pub struct File {
    /// Path from the root, with `/`.
    pub path: String,
    /// All of it.
    pub text: String,
    /// What is compiled into the program: no comments, no contents of literals, no tests.
    pub code: String,
}

impl File {
    /// A file with the given contents. A file of tests has no code.
    pub fn new(path: &str, text: &str) -> Self {
        let mut file = Self {
            path: path.to_owned(),
            text: text.to_owned(),
            code: String::new(),
        };
        if !file.is_test() {
            file.code = without_tests(&code_of(text));
        }
        file
    }

    /// Whether it is the file of a test module.
    pub fn is_test(&self) -> bool {
        self.path.ends_with("/tests.rs") || self.path.contains("/tests/")
    }

    /// The folder or file below `src` that it belongs to; nothing for `lib.rs` and `main.rs`.
    pub fn room(&self) -> Option<&str> {
        let below = self.path.strip_prefix("src/")?;
        let room = below.split('/').next()?;
        let room = room.strip_suffix(".rs").unwrap_or(room);
        (!["lib", "main"].contains(&room)).then_some(room)
    }

    /// How many `super` lead to the root of the crate.
    pub fn depth(&self) -> usize {
        let own_name = usize::from(!self.path.ends_with("/mod.rs"));
        self.path.matches('/').count() - 1 + own_name
    }

    /// `path:line` of a byte of the code.
    pub fn place(&self, at: usize) -> String {
        format!(
            "{}:{}",
            self.path,
            1 + self.code[..at].matches('\n').count()
        )
    }
}

/// All Rust files below the given folders of the root that exist, in order of their paths.
pub fn files_under(folders: &[&str]) -> Vec<File> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    for folder in folders {
        collect(&root.join(folder), &mut paths);
    }
    paths.sort();
    let read = |path: &PathBuf| {
        let text = fs::read_to_string(path).expect("a source file is UTF-8");
        let below = path.strip_prefix(root).expect("below the root");
        File::new(&below.to_string_lossy().replace('\\', "/"), &text)
    };
    paths.iter().map(read).collect()
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for path in entries.map(|entry| entry.expect("a readable folder").path()) {
        if path.is_dir() {
            collect(&path, paths);
        } else if path.extension().is_some_and(|e| e == "rs") {
            paths.push(path);
        }
    }
}

/// The crates of `[dependencies]` as they are named in code.
pub fn dependencies() -> Vec<String> {
    let manifest = include_str!("../../Cargo.toml");
    let section = manifest
        .split("\n[")
        .find_map(|part| part.strip_prefix("dependencies]"));
    let lines = section.expect("a section of dependencies").lines();
    let name = |line: &str| {
        Some(
            line.split_once('=')?
                .0
                .trim()
                .split('.')
                .next()?
                .replace('-', "_"),
        )
    };
    lines
        .filter(|line| !line.starts_with('#'))
        .filter_map(name)
        .collect()
}
