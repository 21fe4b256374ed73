//! Builds the bindings in named steps: locate, probe, bind, compile, publish.
//!
//! Where Embree, libclang or a C compiler is missing, the crate is built empty and says so in one
//! warning, because `radiosity` has another engine. Two variables change that:
//!
//! * `EMBREE_DIR` is the prefix to look in, and in no other place; `none` builds without Embree;
//! * `RADIOSITY_REQUIRE_EMBREE=1` makes a missing piece an error.
//!
//! The crate that depends on us reads what was found from `DEP_EMBREE4_*` (see [`publish`]).

mod bind;
mod locate;
mod shim;

use locate::Embree;

/// Why there are no bindings.
pub enum Missing {
    /// `EMBREE_DIR=none`.
    Unwanted,
    /// Something is not installed: what, and what the tool said.
    NotInstalled(String),
}

/// What to type on a machine without Embree.
const HOW_TO_GET_IT: &str = "install it (Debian, Ubuntu: apt install libembree-dev libclang-dev gcc; \
     elsewhere: set EMBREE_DIR to its prefix), then run `cargo clean -p embree4-sys`";

fn main() {
    declare_inputs();
    match build() {
        Ok(embree) => publish(&embree),
        Err(missing) => publish_absence(&missing),
    }
}

/// Every variable that changes what is found. `cc` and `bindgen` declare their own.
fn declare_inputs() {
    println!("cargo::rustc-check-cfg=cfg(embree)");
    for directory in ["build", "shim"] {
        println!("cargo::rerun-if-changed={directory}");
    }
    for variable in [
        "EMBREE_DIR",
        "RADIOSITY_REQUIRE_EMBREE",
        "CMAKE_PREFIX_PATH",
        "PKG_CONFIG",
        "PKG_CONFIG_PATH",
        "LIBCLANG_PATH",
        "LLVM_CONFIG_PATH",
        "CLANG_PATH",
    ] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
}

fn build() -> Result<Embree, Missing> {
    let embree = locate::embree()?;
    bind::probe_libclang()?;
    bind::generate(&embree)?;
    shim::compile(&embree)?;
    Ok(embree)
}

/// Links the library, turns the bindings on and tells the dependent crate:
/// `DEP_EMBREE4_FOUND=1`, `DEP_EMBREE4_VERSION`, `DEP_EMBREE4_LIB_DIR`, and `DEP_EMBREE4_RPATH` if
/// the dynamic linker does not look there by itself.
fn publish(embree: &Embree) {
    let lib_dir = embree.lib_dir.display();
    println!(
        "cargo::rerun-if-changed={}",
        embree.config_header().display()
    );
    println!("cargo::rustc-cfg=embree");
    println!("cargo::rustc-link-search=native={lib_dir}");
    println!("cargo::rustc-link-lib=dylib=embree{}", embree.major);
    println!("cargo::metadata=found=1");
    println!("cargo::metadata=version={}", embree.version);
    println!("cargo::metadata=lib_dir={lib_dir}");
    if embree.needs_rpath() {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{lib_dir}");
        println!("cargo::metadata=rpath={lib_dir}");
    }
}

fn publish_absence(missing: &Missing) {
    let required = std::env::var("RADIOSITY_REQUIRE_EMBREE").is_ok_and(|v| v == "1");
    let (reason, by_choice) = match missing {
        Missing::Unwanted => ("EMBREE_DIR=none".to_owned(), true),
        Missing::NotInstalled(what) => (what.replace('\n', " "), false),
    };
    if required {
        println!(
            "cargo::error=RADIOSITY_REQUIRE_EMBREE=1, but there is no Embree: {reason}; {HOW_TO_GET_IT}"
        );
        std::process::exit(1);
    }
    if !by_choice {
        println!("cargo::warning=building without Embree: {reason}; {HOW_TO_GET_IT}");
    }
    println!("cargo::metadata=found=0");
}
