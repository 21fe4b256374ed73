//! What can go wrong, and the exit code it gives.

use crate::SolveError;
use crate::matrix::{EnforceError, MatrixError};
use crate::output::WriteError;
use crate::scene::SceneError;
use crate::solution::SolutionError;
use crate::visibility::VisibilityError;
use std::process::ExitCode;
use thiserror::Error;

#[cfg(feature = "viewer")]
use crate::viewer::WindowError;

/// How the process ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Code {
    Success = 0,
    Failure = 1,
    Usage = 2,
    BadInput = 3,
    Interrupted = 130,
}

impl From<Code> for ExitCode {
    fn from(code: Code) -> Self {
        ExitCode::from(code as u8)
    }
}

#[derive(Debug, Error)]
pub(super) enum CliError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Solution(#[from] SolutionError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    #[error(transparent)]
    Enforce(#[from] EnforceError),
    #[error(transparent)]
    Visibility(#[from] VisibilityError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[cfg(feature = "viewer")]
    #[error(transparent)]
    Window(#[from] WindowError),
    /// Flags that cannot be meant, alone or of this input.
    #[error("{0}")]
    Usage(String),
    /// An input that is not what it should be.
    #[error("{0}")]
    Input(String),
    /// Something else that the system refused.
    #[error("{0}")]
    System(String),
}

impl CliError {
    pub(super) fn code(&self) -> Code {
        match self {
            CliError::Scene(_)
            | CliError::Solution(_)
            | CliError::Input(_)
            | CliError::Enforce(_)
            | CliError::Matrix(MatrixError::NothingRadiates | MatrixError::TooLarge { .. })
            | CliError::Solve(
                SolveError::NotKept | SolveError::OtherScene(_) | SolveError::Scene(_),
            ) => Code::BadInput,
            CliError::Usage(_) => Code::Usage,
            _ => Code::Failure,
        }
    }
}
