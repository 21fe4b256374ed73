//! Progressive radiosity of polygonal diffuse scenes.
#![deny(missing_docs)]

pub mod form_factor;
pub mod geometry;
pub mod mesh;
pub mod output;
pub mod radiometry;
pub mod render;
pub mod scene;
pub mod solution;
pub mod solver;
pub mod visibility;
