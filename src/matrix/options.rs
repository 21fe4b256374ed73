//! What a matrix is made of, and how accurately.

use crate::visibility::EngineChoice;
use serde::{Deserialize, Serialize};

/// What one row of the matrix stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// A side of a polygon of the file, or of a part of it where [`Options::max_area`] divides it.
    #[default]
    Surface,
    /// All sides of the polygons below one `g` or `o` name, or in glTF nodes of one name, front and back apart; polygons without one are rows of their own.
    Group,
    /// All sides with materials of one name, front and back apart.
    Material,
}

/// How a matrix is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// What one row stands for.
    pub by: By,
    /// Surfaces are divided until no part is larger (m²).
    pub max_area: Option<f64>,
    /// Estimated error that a row may have: the root of the sum of the squares of its entries' errors, so that no entry is off by
    /// more either. In a closed scene that is relative to a row sum of 1.
    pub tolerance: f64,
    /// Who traces rays, where there is too much between two surfaces to cut its shadows out exactly.
    pub engine: EngineChoice,
    /// Threads; 0 for as many as the machine has.
    pub threads: usize,
}

impl Options {
    /// Rows for surfaces, undivided, to 1e-4.
    pub const fn standard() -> Self {
        Self {
            by: By::Surface,
            max_area: None,
            tolerance: 1e-4,
            engine: EngineChoice::Auto,
            threads: 0,
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::standard()
    }
}
