//! The result: a mesh with light on it, its conforming triangulation, probing, and the report.
//!
//! Imports `radiometry` and `mesh`.

mod lit_mesh;

pub use lit_mesh::{LitMesh, LitTriangle, LitVertex};
