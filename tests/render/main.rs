//! Pictures of small solutions whose every pixel is known.

mod light;
mod lines;
mod robustness;
mod setup;
