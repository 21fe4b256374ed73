//! `radiosity render`.

use super::CliError;
use super::error::Code;
use super::pictures::draw;
use super::progress::leave_nothing_on_interrupt;
use super::results::{folder_of, picture_folder, read_solution};
use super::viewpoint::Viewpoint;
use crate::visibility::EngineChoice;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The folder that `solve` wrote, or the solution.rad in it
    solution: PathBuf,
    #[command(flatten)]
    viewpoint: Viewpoint,
    /// Folder for the pictures; the solution's own if this is left out, where they replace those that are there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Who traces the rays: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    engine: EngineChoice,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    leave_nothing_on_interrupt();
    let solution = read_solution(&arguments.solution)?;
    let cameras = arguments.viewpoint.of(&solution.cameras)?;
    let lit = solution.lit_mesh();
    let beside = || folder_of(&arguments.solution);
    let folder = arguments.output.clone().unwrap_or_else(beside);
    // Beside the solution a camera keeps the place that it had in the solve.
    let order = match arguments.output {
        Some(_) => &cameras,
        None => &solution.cameras,
    };
    for camera in &cameras {
        let number = order.iter().position(|known| known.name == camera.name);
        let into = picture_folder(&folder, number.unwrap_or(0), camera);
        draw(&lit, camera, (arguments.engine, 0), &into, &|| true)?;
    }
    Ok(Code::Success)
}
