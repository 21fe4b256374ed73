//! Turns what `embree4-sys` found into `cfg(embree)`, and tells programs where the library is.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(embree)");
    // Without the feature `embree` the crate is no dependency and says nothing.
    if std::env::var("DEP_EMBREE4_FOUND").is_ok_and(|found| found == "1") {
        println!("cargo::rustc-cfg=embree");
    }
    // Link arguments of a dependency do not reach our binaries, so the search path is set here.
    if let Ok(folder) = std::env::var("DEP_EMBREE4_RPATH") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
}
