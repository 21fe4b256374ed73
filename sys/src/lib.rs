//! Raw bindings to Intel Embree 4 and 3.13.
//!
//! What is here is what the installed header says, plus the functions `shim_*` that hide where the two
//! major versions differ. Nothing is safe and nothing is clever: the safe face is
//! `radiosity::visibility::embree`. Without Embree on the build machine the crate is empty; the build
//! script of the dependent crate learns that from `DEP_EMBREE4_FOUND`.

#[cfg(embree)]
#[allow(
    missing_docs,
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals
)]
#[allow(clippy::all)]
mod bindings {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

#[cfg(embree)]
pub use bindings::*;

/// `RTC_INVALID_GEOMETRY_ID`, the geometry ID of a ray that hit nothing: a macro with a cast, which
/// cannot be translated. The shim asserts its value.
#[cfg(embree)]
pub const INVALID_GEOMETRY_ID: u32 = u32::MAX;
