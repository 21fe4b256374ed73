//! Why there is no matrix.

use super::Options;
use crate::threads::ThreadsError;
use crate::visibility::VisibilityError;
use thiserror::Error;

/// Why a scene could not be made ready.
#[derive(Debug, Error)]
pub enum MatrixError {
    /// The visibility engine could not be built.
    #[error(transparent)]
    Visibility(#[from] VisibilityError),
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The scene was built in code, and makes no sense: see [`Scene::check`](crate::scene::Scene::check).
    #[error("the scene has {0}")]
    Scene(String),
    /// There is no surface.
    #[error("no surface radiates: there is nothing to compute form factors of")]
    NothingRadiates,
    /// More pieces than pairs can be worked out of.
    #[error(
        "the scene has {pieces} pieces of surfaces; expected at most {most}, since every pair of them is worked out{hint}"
    )]
    TooLarge {
        /// How many there would be.
        pieces: u64,
        /// How many there may be.
        most: u64,
        /// What may help.
        hint: &'static str,
    },
    /// An option that cannot be met.
    #[error("{name} is {found}; expected {expected}")]
    Option {
        /// Which.
        name: &'static str,
        /// What it is.
        found: f64,
        /// What it may be.
        expected: &'static str,
    },
}

impl Options {
    pub(super) fn check(&self) -> Result<(), MatrixError> {
        let positive = |name, found: f64| match found.is_finite() && found > 0.0 {
            true => Ok(()),
            false => Err(MatrixError::Option {
                name,
                found,
                expected: "a positive number",
            }),
        };
        positive("tolerance", self.tolerance)?;
        self.max_area
            .map_or(Ok(()), |area| positive("max_area", area))
    }
}
