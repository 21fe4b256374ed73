//! The rules of the tree that no compiler holds: who may import whom, where `unsafe` and output may be, and how long a
//! file may get. Each rule is tried on a snippet that breaks it, so that it can fail.

mod code;
mod rules;
mod tree;

use rules::{RULES, Rule};
use tree::{File, dependencies, files_under};

/// Where a rule is broken.
fn violations(rule: &Rule, files: &[File]) -> Vec<String> {
    (rule.check)(files)
        .iter()
        .map(|place| format!("{place}: {}", rule.says))
        .collect()
}

#[test]
fn every_rule_holds() {
    let files = files_under(&["src"]);
    assert!(files.len() > 20, "the sources are found");
    let broken: Vec<String> = RULES
        .iter()
        .flat_map(|rule| violations(rule, &files))
        .collect();
    assert!(broken.is_empty(), "\n{}\n", broken.join("\n"));
}

#[test]
fn no_file_is_longer_than_400_lines() {
    for file in files_under(&["src", "sys", "tests", "benches", "examples"]) {
        let lines = file.text.lines().count();
        assert!(lines <= 400, "{}: {lines} lines", file.path);
    }
}

#[test]
fn dependencies_are_about_a_dozen_and_the_list_is_read() {
    let names = dependencies();
    // What a window takes is built for who asks for one, and three are our own.
    let is_counted = |name: &&String| {
        let other = ["softbuffer", "winit", "embree4_sys", "hangup", "heap"];
        !other.contains(&name.as_str())
    };
    let count = names.iter().filter(is_counted).count();
    assert!((8..=24).contains(&count), "{names:?}");
    for known in ["glam", "rayon", "obvhs", "embree4_sys"] {
        assert!(
            names.iter().any(|name| name == known),
            "{known} in {names:?}"
        );
    }
}

/// A rule, a file that breaks it, and how often.
const BREAKING: [(&str, &str, &str, usize); 16] = [
    (
        "imports",
        "src/geometry/a.rs",
        "use crate::radiometry::Spectrum;",
        1,
    ),
    (
        "imports",
        "src/visibility/a.rs",
        "use crate::{simd::Isa, mesh::{Mesh, Patch}};",
        1,
    ),
    (
        "imports",
        "src/mesh/a.rs",
        "fn f() -> crate::solver::Options { radiosity::output::f() }",
        2,
    ),
    (
        "imports",
        "src/mesh/mod.rs",
        "use super::solver::Options;",
        1,
    ),
    ("imports", "src/mesh/a.rs", "use super::super::render;", 1),
    ("imports", "src/novel/a.rs", "use crate::geometry::lift;", 1),
    ("crates", "src/solver/a.rs", "use obvhs::ray::Ray;", 1),
    (
        "crates",
        "src/mesh/a.rs",
        "fn f() { ::clap::f(); embree4_sys::g() }",
        2,
    ),
    (
        "unsafe",
        "src/mesh/a.rs",
        "fn f() {\n// SAFETY: no reason is enough here\nunsafe { g() } }",
        1,
    ),
    (
        "safety",
        "src/visibility/a.rs",
        "fn f() {\n    let x = 1;\n    unsafe { g() };\n}",
        1,
    ),
    (
        "safety",
        "src/visibility/a.rs",
        "// SAFETY: of f\nfn f() {}\nunsafe impl Send for A {}",
        1,
    ),
    (
        "printing",
        "src/solver/a.rs",
        "fn f() { println!(\"a\"); eprint!(\"b\"); dbg!(1); }",
        3,
    ),
    (
        "files",
        "src/solver/a.rs",
        "use std::fs::File; fn f(x: &mut dyn std::io::Write) {}",
        2,
    ),
    (
        "panics",
        "src/mesh/a.rs",
        "fn f() { x.unwrap(); todo!() }",
        2,
    ),
    (
        "unfinished",
        "src/mesh/a.rs",
        "//! A.\n// TODO: the rest\n/* FIXME */",
        2,
    ),
    ("introduction", "src/mesh/a.rs", "use std::fmt;", 1),
];

#[test]
fn every_rule_can_fail() {
    for (rule, path, text, times) in BREAKING {
        let rule = RULES
            .iter()
            .find(|r| r.name == rule)
            .expect("a rule of that name");
        let found = violations(rule, &[File::new(path, text)]);
        assert_eq!(found.len(), times, "{} on {text:?}: {found:?}", rule.name);
    }
    let tried = |rule: &&Rule| BREAKING.iter().any(|(name, ..)| *name == rule.name);
    assert_eq!(
        RULES.iter().filter(tried).count(),
        RULES.len(),
        "every rule is tried"
    );
}

#[test]
fn comments_strings_and_tests_break_no_rule() {
    let text = r##"//! Uses crate::solver in words, and "unsafe" too.
/// See [`crate::render`].
fn f<'a>(quote: char, text: &'a str) -> bool {
    let _ = ('"', '\'', b'"', "crate::cli \" println!(", r#"unsafe { "x".unwrap() }"#);
    /* crate::output /* nested */ x.unwrap() */
    quote == '\u{7b}' && text.is_empty()
}
#[cfg(test)]
mod tests {
    use crate::solver::Options;
    fn g() { println!("{}", None::<u32>.unwrap()); }
}
"##;
    let file = File::new("src/geometry/a.rs", text);
    for rule in &RULES {
        let found = violations(rule, std::slice::from_ref(&file));
        assert!(found.is_empty(), "{found:?}\n{}", file.code);
    }
    let after = File::new("src/geometry/a.rs", &format!("{text}use crate::solver;\n"));
    assert_eq!(
        violations(&RULES[0], &[after]).len(),
        1,
        "what follows a test module is read"
    );
}
