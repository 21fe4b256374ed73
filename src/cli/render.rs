//! `radiosity render`.

use super::CliError;
use super::error::Code;
use super::pictures::draw;
use super::solve::SOLUTION;
use super::viewpoint::Viewpoint;
use crate::render::RenderOptions;
use crate::solution::Solution;
use crate::visibility::EngineChoice;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The folder that `solve` wrote
    solution: PathBuf,
    #[command(flatten)]
    viewpoint: Viewpoint,
    /// Folder for the pictures; the solution's own if this is left out
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Who traces the rays: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    engine: EngineChoice,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let solution = Solution::read(&arguments.solution.join(SOLUTION))?;
    let cameras = arguments.viewpoint.of(&solution.cameras)?;
    let lit = solution.lit_mesh();
    let folder = arguments.output.as_ref().unwrap_or(&arguments.solution);
    let several = cameras.len() > 1;
    for (number, camera) in cameras.iter().enumerate() {
        let into = if several && number > 0 {
            folder.join(&camera.name)
        } else {
            folder.clone()
        };
        draw(
            &lit,
            camera,
            &RenderOptions::standard(),
            arguments.engine,
            0,
            &into,
        )?;
    }
    Ok(Code::Success)
}
