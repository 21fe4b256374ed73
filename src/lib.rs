//! Progressive radiosity of polygonal diffuse scenes, after Lee & Chuang, *Effective Meshing and Form Factor Calculation
//! for Accurate Progressive Radiosity*.
//!
//! ```text
//! file ─scene→ Scene ─mesh→ Mesh ─solver(shoot ⇄ refine)→ Solution ─output/render→ files
//!                     └────── triangles ─→ Visibility ───────┘
//! ```
//!
//! [`solve`] goes from a [`scene::Scene`] to a [`solution::Solution`] in one call; the rooms below are its parts:
//!
//! * [`geometry`]: polygons, the frame of a solve; [`radiometry`]: the quantities and their units
//! * [`scene`]: what the file says; [`visibility`]: who sees whom, by Embree, obvhs or brute force
//! * [`form_factor`]: Eq. (1), Eq. (2), the five-times rule and the adaptively sampled source
//! * [`mesh`]: patches, quadtrees and the interpolant; [`solver`]: select, shoot, refine, account
//! * [`matrix`]: form factors between all surfaces, for exchange rather than pictures
//! * [`codec`]: base64, PNG and JPEG
//! * [`solution`]: the result, probing, its report and file; [`output`], [`render`]: files and pictures
//! * `viewer`: a window, with the feature of that name
//!
//! # Conventions
//!
//! Lengths are in scene units (metres unless the scene says otherwise), right-handed, y up; a polygon is counter-clockwise seen
//! from its front. Colour is linear Rec. 709. A mesh stores irradiance E; radiosity is B = M + ρE, radiance B/π.
//!
//! # Architecture invariants
//!
//! * Imports run one way, as each room's first paragraph says.
//! * The solver does no I/O and prints nothing; it speaks to a [`solver::Observer`].
//! * `unsafe` lives in the crates `embree4-sys`, `hangup` and `heap`, in [`visibility`] and in `simd` only.
//! * The same input, engine and instruction set give the same bits for any number of threads.
//!
//! `tests/tidy` and `tests/solve` hold them.
#![deny(missing_docs)]

pub mod cli;
pub mod codec;
pub mod form_factor;
pub mod geometry;
pub mod matrix;
pub mod mesh;
pub mod output;
mod pipeline;
pub mod radiometry;
pub mod render;
pub mod scene;
mod simd;
pub mod solution;
pub mod solver;
mod threads;
#[cfg(feature = "viewer")]
pub mod viewer;
pub mod visibility;
mod words;

pub use pipeline::{Run, Settings, SolveError, Target, irradiance_at, solve};
pub use threads::ThreadsError;
