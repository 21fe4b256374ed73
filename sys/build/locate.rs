//! Step 1: where Embree is, which version, and whether the linker finds it by itself.
//!
//! Search order: `EMBREE_DIR` (and then nothing else), pkg-config, `CMAKE_PREFIX_PATH`, the default
//! prefixes with their Debian multiarch folders. In each place version 4 comes before version 3.

use crate::Missing;
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Major versions that the shim speaks, the preferred one first.
const MAJORS: [u32; 2] = [4, 3];
/// The oldest version whose calls and flags are the ones we use.
const OLDEST: (u32, u32) = (3, 13);

/// An installed Embree.
pub struct Embree {
    /// The folder that contains `embree4/rtcore.h`.
    pub include_dir: PathBuf,
    /// The folder that contains the library.
    pub lib_dir: PathBuf,
    /// 3 or 4.
    pub major: u32,
    /// As the header says, e.g. `4.3.3`.
    pub version: String,
    /// Whether the library lies where every linker looks.
    in_default_place: bool,
}

impl Embree {
    /// The header that states the version; it changes when Embree is upgraded.
    pub fn config_header(&self) -> PathBuf {
        config_header(&self.include_dir, self.major)
    }

    /// Whether programs must be told at link time where the library is.
    pub fn needs_rpath(&self) -> bool {
        !self.in_default_place && env::var("CARGO_CFG_UNIX").is_ok()
    }
}

/// Looks in all places, in order.
pub fn embree() -> Result<Embree, Missing> {
    if let Some(chosen) = env::var_os("EMBREE_DIR").filter(|v| !v.is_empty()) {
        if chosen == "none" {
            return Err(Missing::Unwanted);
        }
        return in_chosen_prefix(Path::new(&chosen));
    }
    from_pkg_config()
        .or_else(from_cmake_prefixes)
        .or_else(from_default_prefixes)
        .ok_or_else(|| Missing::NotInstalled("no Embree 4 or 3.13 found".into()))
}

/// A prefix that the user names has to be right: anything else would be silently ignored.
fn in_chosen_prefix(prefix: &Path) -> Result<Embree, Missing> {
    in_prefix(prefix, false).ok_or_else(|| {
        println!(
            "cargo::error=EMBREE_DIR={}: no include/embree4 or embree3 with its library there \
             (EMBREE_DIR=none builds without Embree)",
            prefix.display()
        );
        std::process::exit(1)
    })
}

/// Distributions ship no `.pc` file today; others may.
fn from_pkg_config() -> Option<Embree> {
    let program = env::var_os("PKG_CONFIG").unwrap_or_else(|| "pkg-config".into());
    let variable = |package: &str, name: &str| {
        let output = Command::new(&program)
            .arg(format!("--variable={name}"))
            .arg(package)
            .output()
            .ok()
            .filter(|o| o.status.success())?;
        let text = String::from_utf8(output.stdout).ok()?;
        Some(PathBuf::from(text.trim())).filter(|p| p.is_dir())
    };
    ["embree4", "embree", "embree3"].iter().find_map(|package| {
        let include_dir = variable(package, "includedir")?;
        let lib_dir = variable(package, "libdir")?;
        in_folders(&include_dir, &[lib_dir], false)
    })
}

/// The variable that CMake users set; Embree's own packages install their CMake files below it.
fn from_cmake_prefixes() -> Option<Embree> {
    let prefixes = env::var_os("CMAKE_PREFIX_PATH")?;
    env::split_paths(&prefixes).find_map(|prefix| in_prefix(&prefix, false))
}

/// Only for native builds: what lies there is for this machine.
fn from_default_prefixes() -> Option<Embree> {
    if env::var("HOST") != env::var("TARGET") {
        return None;
    }
    let prefixes = [
        ("/usr/local", true),
        ("/usr", true),
        ("/opt/homebrew", false),
    ];
    prefixes
        .iter()
        .find_map(|&(prefix, default)| in_prefix(Path::new(prefix), default))
}

fn in_prefix(prefix: &Path, in_default_place: bool) -> Option<Embree> {
    let lib = prefix.join("lib");
    let lib_dirs = [lib.join(multiarch()), prefix.join("lib64"), lib];
    in_folders(&prefix.join("include"), &lib_dirs, in_default_place)
}

/// Debian's name of the target, e.g. `x86_64-linux-gnu`.
fn multiarch() -> String {
    let target = env::var("TARGET").unwrap_or_default();
    target.replace("-unknown-", "-").replace("-pc-", "-")
}

fn in_folders(include_dir: &Path, lib_dirs: &[PathBuf], in_default_place: bool) -> Option<Embree> {
    MAJORS.iter().find_map(|&major| {
        let version = version_in(&config_header(include_dir, major))?;
        let lib_dir = lib_dirs.iter().find(|dir| has_library(dir, major))?;
        Some(Embree {
            include_dir: include_dir.to_owned(),
            lib_dir: lib_dir.clone(),
            major,
            version,
            in_default_place,
        })
    })
}

fn config_header(include_dir: &Path, major: u32) -> PathBuf {
    include_dir.join(format!("embree{major}/rtcore_config.h"))
}

fn has_library(dir: &Path, major: u32) -> bool {
    [
        format!("libembree{major}.so"),
        format!("libembree{major}.dylib"),
        format!("embree{major}.lib"),
    ]
    .iter()
    .any(|name| dir.join(name).exists())
}

/// `4.3.3` from `#define RTC_VERSION_STRING "4.3.3"`, unless it is too old.
fn version_in(header: &Path) -> Option<String> {
    let text = std::fs::read_to_string(header).ok()?;
    let line = text
        .lines()
        .find(|line| line.contains("RTC_VERSION_STRING"))?;
    let version = line.split('"').nth(1)?;
    let mut numbers = version
        .split('.')
        .map_while(|part| part.parse::<u32>().ok());
    let release = (numbers.next()?, numbers.next()?);
    (release >= OLDEST).then(|| version.to_owned())
}
