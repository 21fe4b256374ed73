//! `radiosity view`.

use super::CliError;
use super::error::Code;
use super::values::positive;
use super::viewpoint::Viewpoint;
use crate::radiometry::WHITE_EFFICACY;
use crate::visibility::EngineChoice;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The folder that `solve` wrote, the solution.rad in it, or a solution.ply from anywhere
    pub solution: PathBuf,
    #[command(flatten)]
    pub viewpoint: Viewpoint,
    /// Lumens per watt, for illuminance; 1 if the emitters were given in lumens
    #[arg(long, value_name = "LM/W", default_value_t = WHITE_EFFICACY, value_parser = positive)]
    pub efficacy: f64,
    /// Who traces the rays: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    pub engine: EngineChoice,
}

#[cfg(feature = "viewer")]
pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    super::window::view(arguments)
}

#[cfg(not(feature = "viewer"))]
pub(super) fn run(_: &Arguments) -> Result<Code, CliError> {
    Err(without_window())
}

/// What a program that was built without the feature says.
#[cfg(not(feature = "viewer"))]
pub(super) fn without_window() -> CliError {
    CliError::System(
        "this program was built without a window; `cargo install --path . --features viewer` in a clone builds one that has it".into(),
    )
}
