//! Progressive radiosity of polygonal diffuse scenes.
#![deny(missing_docs)]

pub mod radiometry;
pub mod scene;
pub mod solution;
pub mod visibility;
