//! The rules, each a function from files to the places where it is broken.

use crate::code::{identifier, word_places};
use crate::tree::{File, dependencies};
use std::collections::BTreeMap;

/// What must hold, and how to find where it does not.
pub struct Rule {
    pub name: &'static str,
    pub says: &'static str,
    pub check: fn(&[File]) -> Vec<String>,
}

pub const RULES: [Rule; 9] = [
    Rule {
        name: "imports",
        says: "this room may not import that one",
        check: imports,
    },
    Rule {
        name: "crates",
        says: "this crate belongs to another room",
        check: crates,
    },
    Rule {
        name: "unsafe",
        says: "`unsafe` lives in src/visibility and src/simd.rs",
        check: unsafe_elsewhere,
    },
    Rule {
        name: "safety",
        says: "no comment `SAFETY:` says why this is sound",
        check: unsafe_without_reason,
    },
    Rule {
        name: "printing",
        says: "only src/cli and main.rs print",
        check: printing,
    },
    Rule {
        name: "files",
        says: "this room does no input or output",
        check: files_and_streams,
    },
    Rule {
        name: "panics",
        says: "say why it cannot fail (`expect`), or handle it",
        check: panics,
    },
    Rule {
        name: "unfinished",
        says: "no unfinished work on main",
        check: unfinished,
    },
    Rule {
        name: "introduction",
        says: "a file opens with what it is for (`//!`)",
        check: introduction,
    },
];

/// Which rooms a room may import, besides itself. A new room needs a line here; it may have several.
const IMPORTS: [(&str, &[&str]); 19] = [
    ("words", &[]),
    ("codec", &[]),
    ("geometry", &[]),
    ("radiometry", &[]),
    ("simd", &[]),
    ("threads", &[]),
    ("scene", &["codec", "geometry", "radiometry"]),
    ("visibility", &["simd", "words"]),
    (
        "form_factor",
        &["geometry", "radiometry", "simd", "visibility"],
    ),
    ("mesh", &["geometry", "radiometry", "scene"]),
    ("solver", SOLVER),
    ("matrix", SOLVER),
    ("matrix", &["threads"]),
    (
        "solution",
        &["geometry", "radiometry", "scene", "mesh", "solver"],
    ),
    (
        "output",
        &[
            "codec",
            "radiometry",
            "scene",
            "matrix",
            "solution",
            "words",
        ],
    ),
    (
        "render",
        &["geometry", "radiometry", "scene", "visibility", "solution"],
    ),
    ("viewer", VIEWER),
    (
        "pipeline",
        &[
            "radiometry",
            "scene",
            "threads",
            "visibility",
            "mesh",
            "solver",
            "solution",
            "words",
        ],
    ),
    ("cli", CLI),
];
const SOLVER: &[&str] = &[
    "geometry",
    "radiometry",
    "scene",
    "visibility",
    "form_factor",
    "mesh",
];
const VIEWER: &[&str] = &["radiometry", "scene", "visibility", "solution", "render"];
/// The command may use all that the library offers.
const CLI: &[&str] = &[
    "codec",
    "geometry",
    "radiometry",
    "scene",
    "threads",
    "visibility",
    "form_factor",
    "mesh",
    "matrix",
    "solver",
    "solution",
    "output",
    "render",
    "pipeline",
    "viewer",
    "words",
];

/// Crates that are the language we speak rather than a choice of one room: vectors, threads, derives, a hasher.
const EVERYWHERE: [&str; 7] = [
    "glam",
    "rayon",
    "rstar",
    "rustc_hash",
    "serde",
    "serde_json",
    "thiserror",
];

fn imports(files: &[File]) -> Vec<String> {
    let mut broken = Vec::new();
    for file in files {
        let Some(room) = file.room() else { continue };
        let allowed: Vec<&str> = IMPORTS
            .iter()
            .filter(|(name, _)| *name == room)
            .flat_map(|(_, allowed)| allowed.iter().copied())
            .collect();
        for (at, imported) in imported_rooms(file) {
            let known = IMPORTS.iter().any(|(name, _)| *name == imported);
            let fine = imported == room || allowed.contains(&imported);
            if known && !fine {
                broken.push(format!("{} ({room} → {imported})", file.place(at)));
            }
        }
    }
    broken
}

/// The names that follow the root of the crate in any path of a file.
fn imported_rooms(file: &File) -> Vec<(usize, &str)> {
    let roots = ["crate", "radiosity"];
    let from_root = roots
        .iter()
        .flat_map(|root| word_places(&file.code, root).map(|at| at + root.len()));
    let climbs = word_places(&file.code, "super").filter_map(|at| climbs_to_root(file, at));
    let paths: Vec<usize> = from_root.chain(climbs).collect();
    paths
        .into_iter()
        .flat_map(|at| first_names(&file.code, at))
        .collect()
}

/// Where a chain of `super::` that begins at `at` leaves the room, if it does.
fn climbs_to_root(file: &File, at: usize) -> Option<usize> {
    if file.code[..at].ends_with("super::") {
        return None;
    }
    let chain = &file.code[at..];
    let steps = chain
        .split("::")
        .take_while(|part| *part == "super")
        .count();
    (steps >= file.depth()).then(|| at + steps * "super::".len() - "::".len())
}

/// The names after a `::` at `at`: one, or those of a group in braces.
fn first_names(code: &str, at: usize) -> Vec<(usize, &str)> {
    let Some(rest) = code[at..].strip_prefix("::") else {
        return Vec::new();
    };
    let start = at + 2;
    if !rest.starts_with('{') {
        return vec![(start, identifier(rest))];
    }
    let (mut depth, mut names, mut begins) = (0, Vec::new(), false);
    for (i, c) in rest.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            break;
        }
        if begins && depth == 1 && c.is_alphabetic() {
            names.push((start + i, identifier(&rest[i..])));
            begins = false;
        }
        begins |= depth == 1 && (c == '{' || c == ',');
    }
    names
}

fn crates(files: &[File]) -> Vec<String> {
    let mut broken = Vec::new();
    for name in dependencies() {
        if EVERYWHERE.contains(&name.as_str()) {
            continue;
        }
        let mut users: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for file in files {
            let uses =
                word_places(&file.code, &name).filter(|at| names_a_crate(&file.code, *at, &name));
            let places = uses.map(|at| format!("{} ({name})", file.place(at)));
            users
                .entry(file.room().unwrap_or("the root"))
                .or_default()
                .extend(places);
        }
        users.retain(|_, places| !places.is_empty());
        let owner = owner_of(&name).or_else(|| users.keys().next().copied());
        broken.extend(
            users
                .into_iter()
                .filter(|(room, _)| Some(*room) != owner)
                .flat_map(|(_, places)| places),
        );
    }
    broken
}

/// The rooms that are known beforehand; of other crates, one room is as good as another.
fn owner_of(name: &str) -> Option<&'static str> {
    match name {
        "clap" | "clap_complete" | "clap_mangen" | "hangup" | "heap" | "indicatif" | "anyhow" => {
            Some("cli")
        }
        "obvhs" | "embree4_sys" => Some("visibility"),
        "tobj" | "toml" => Some("scene"),
        "softbuffer" | "winit" => Some("viewer"),
        _ => None,
    }
}

fn names_a_crate(code: &str, at: usize, name: &str) -> bool {
    let before = code[..at].trim_end();
    let in_path = before.ends_with("::")
        && before[..before.len() - 2].ends_with(|c: char| c.is_alphanumeric());
    let used = code[at + name.len()..].starts_with("::")
        || before.ends_with("use")
        || before.ends_with("extern crate");
    used && !in_path
}

fn unsafe_elsewhere(files: &[File]) -> Vec<String> {
    let outside = |file: &&File| !matches!(file.room(), Some("visibility" | "simd"));
    every_place(files, outside, &["unsafe"])
}

fn unsafe_without_reason(files: &[File]) -> Vec<String> {
    let reasonless = |file: &File, at: usize| {
        let line = file.code[..at].matches('\n').count();
        !has_reason(&file.text.lines().take(line + 1).collect::<Vec<_>>())
    };
    let of_file = |file: &File| -> Vec<String> {
        word_places(&file.code, "unsafe")
            .filter(|at| reasonless(file, *at))
            .map(|at| file.place(at))
            .collect()
    };
    files.iter().flat_map(of_file).collect()
}

/// Whether the last of `lines`, or the comments and the statement that lead to it, give the reason.
fn has_reason(lines: &[&str]) -> bool {
    let Some((last, above)) = lines.split_last() else {
        return false;
    };
    let leads_on = |line: &&&str| {
        let line = line.trim();
        let comment = line.starts_with("//") || line.starts_with("#[");
        comment || !(line.is_empty() || line.ends_with([';', '{', '}']))
    };
    let reason = |line: &&str| line.contains("SAFETY:") || line.contains("# Safety");
    reason(last) || above.iter().rev().take_while(leads_on).any(reason)
}

fn printing(files: &[File]) -> Vec<String> {
    let silent = |file: &&File| file.room() != Some("cli") && file.path != "src/main.rs";
    every_place(
        files,
        silent,
        &["println!", "eprintln!", "print!", "eprint!", "dbg!"],
    )
}

fn files_and_streams(files: &[File]) -> Vec<String> {
    let pure = [
        "geometry",
        "radiometry",
        "simd",
        "visibility",
        "form_factor",
        "mesh",
        "matrix",
        "solver",
    ];
    let is_pure = |file: &&File| file.room().is_some_and(|room| pure.contains(&room));
    every_place(
        files,
        is_pure,
        &["std::fs", "std::io", "std::net", "std::process"],
    )
}

fn panics(files: &[File]) -> Vec<String> {
    every_place(files, |_| true, &["unwrap()", "todo!", "unimplemented!"])
}

fn unfinished(files: &[File]) -> Vec<String> {
    let marks = ["TODO", "FIXME", "XXX"];
    let line = |(number, text): (usize, &str)| {
        marks
            .iter()
            .any(|mark| text.contains(mark))
            .then_some(number + 1)
    };
    let of_file = |file: &File| -> Vec<String> {
        file.text
            .lines()
            .enumerate()
            .filter_map(line)
            .map(|n| format!("{}:{n}", file.path))
            .collect()
    };
    files.iter().flat_map(of_file).collect()
}

fn introduction(files: &[File]) -> Vec<String> {
    let bare = |file: &&File| !file.is_test() && !file.text.starts_with("//!");
    files
        .iter()
        .filter(bare)
        .map(|file| file.path.clone())
        .collect()
}

/// All places of the given words in the files that `applies` to.
fn every_place(files: &[File], applies: impl Fn(&&File) -> bool, words: &[&str]) -> Vec<String> {
    let of_file = |file: &File| -> Vec<String> {
        words
            .iter()
            .flat_map(|word| word_places(&file.code, word))
            .map(|at| file.place(at))
            .collect()
    };
    files.iter().filter(applies).flat_map(of_file).collect()
}
