//! Which engine answers, and what can go wrong while it is built.

use super::{BruteForce, Isa, Obvhs, Triangles, Visibility};
use crate::words::size;
use glam::Vec3;
use std::fmt;
use std::str::FromStr;

/// Up to so many triangles our own traversal is the faster one: with the rays of whole solves it has 0.9 to 2.2 times the rate of
/// Embree in small scenes, 1.4 times at eight thousand triangles, 0.95 times at thirty-two thousand (`cargo bench --bench replay`).
/// Without AVX2 that is so for full fans only.
pub const FEW: usize = 20_000;

/// The engine asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum EngineChoice {
    /// Obvhs for at most [`FEW`] triangles where the processor has AVX2; else Embree if it was built in and its library gives a
    /// device, else obvhs. A fixed rule: nothing is timed, so the same machine always answers with the same engine.
    #[default]
    Auto,
    /// Intel Embree, or an error.
    Embree,
    /// The tree of obvhs with our own traversal: pure Rust, always there.
    Obvhs,
    /// Every triangle in double precision: slow, simple, the reference in tests.
    BruteForce,
}

impl EngineChoice {
    /// All choices, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Embree, Self::Obvhs, Self::BruteForce];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Embree => "embree",
            Self::Obvhs => "obvhs",
            Self::BruteForce => "brute-force",
        }
    }
}

impl fmt::Display for EngineChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for EngineChoice {
    type Err = UnknownEngine;

    fn from_str(name: &str) -> Result<Self, UnknownEngine> {
        Self::ALL
            .into_iter()
            .find(|choice| choice.name() == name)
            .ok_or_else(|| UnknownEngine(name.to_owned()))
    }
}

/// A name that is no engine's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown visibility engine `{0}`; there are auto, embree, obvhs and brute-force")]
pub struct UnknownEngine(pub String);

/// Why an engine could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VisibilityError {
    /// A vertex that single precision cannot work with.
    #[error("vertex {vertex} at {position} is not finite or exceeds ±{limit:e}")]
    Coordinate {
        /// Its index.
        vertex: usize,
        /// Where it is.
        position: Vec3,
        /// [`COORDINATE_LIMIT`](super::COORDINATE_LIMIT).
        limit: f32,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {index}, but there are {vertices}")]
    Index {
        /// Index of the triangle.
        triangle: usize,
        /// The index that it uses.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// More triangles than the engines can number.
    #[error("{0} triangles are more than can be traced (2³¹ - 1)")]
    TooManyTriangles(usize),
    /// The engine's structure does not fit into the memory that it may take.
    #[error(
        "tracing {triangles} triangles takes {}, where {} may be used (--memory-limit)",
        size(*.needed, *.limit),
        size(*.limit, *.limit)
    )]
    TooLarge {
        /// Their number.
        triangles: usize,
        /// What their structure takes, bytes.
        needed: u64,
        /// What it may take, bytes.
        limit: u64,
    },
    /// Embree was asked for, but the program was built without it.
    #[error(
        "this program was built without Embree: install Embree 4 or 3.13 and libclang (Debian, \
         Ubuntu: apt install libembree-dev libclang-dev gcc) and build again with the feature \
         `embree`, or use the engine `obvhs`"
    )]
    EmbreeNotBuilt,
    /// Embree refused.
    #[error("Embree cannot {step}: {reason}")]
    Embree {
        /// What it was to do.
        step: &'static str,
        /// What it answered.
        reason: String,
    },
}

/// Builds the chosen engine over `triangles`, on at most `threads` threads (0: all there are).
///
/// Not to be called from inside a rayon pool: Embree brings its own threads.
pub fn build(
    choice: EngineChoice,
    triangles: &Triangles,
    threads: usize,
) -> Result<Box<dyn Visibility>, VisibilityError> {
    build_within(choice, triangles, threads, None)
}

/// The same in at most `memory` bytes for the engine's own structures; more is an error.
pub fn build_within(
    choice: EngineChoice,
    triangles: &Triangles,
    threads: usize,
    memory: Option<u64>,
) -> Result<Box<dyn Visibility>, VisibilityError> {
    triangles.validate()?;
    match choice {
        EngineChoice::Auto => {
            let few = triangles.indices.len() <= FEW && Isa::widest() != Isa::Portable;
            let choice = if few || !embree_available(threads) {
                EngineChoice::Obvhs
            } else {
                EngineChoice::Embree
            };
            build_within(choice, triangles, threads, memory)
        }
        EngineChoice::Embree => build_embree(triangles, threads, memory),
        EngineChoice::Obvhs => build_obvhs(triangles, memory),
        EngineChoice::BruteForce => Ok(Box::new(BruteForce::new(triangles)?)),
    }
}

fn build_obvhs(
    triangles: &Triangles,
    memory: Option<u64>,
) -> Result<Box<dyn Visibility>, VisibilityError> {
    let count = triangles.indices.len();
    let needed = Obvhs::bytes_to_build(count);
    if let Some(limit) = memory.filter(|limit| needed > *limit) {
        return Err(VisibilityError::TooLarge {
            triangles: count,
            needed,
            limit,
        });
    }
    Ok(Box::new(Obvhs::new(triangles)?))
}

#[cfg(embree)]
fn embree_available(threads: usize) -> bool {
    super::Embree::is_available(threads)
}

#[cfg(embree)]
fn build_embree(
    triangles: &Triangles,
    threads: usize,
    memory: Option<u64>,
) -> Result<Box<dyn Visibility>, VisibilityError> {
    Ok(Box::new(super::Embree::new(triangles, threads, memory)?))
}

#[cfg(not(embree))]
fn embree_available(_threads: usize) -> bool {
    false
}

#[cfg(not(embree))]
fn build_embree(
    _: &Triangles,
    _: usize,
    _: Option<u64>,
) -> Result<Box<dyn Visibility>, VisibilityError> {
    Err(VisibilityError::EmbreeNotBuilt)
}
