//! `radiosity export`.

use super::CliError;
use super::error::Code;
use super::meshes::{Exporter, MeshFormat};
use super::results::read_solution;
use super::values::{finite, positive};
use crate::radiometry::WHITE_EFFICACY;
use crate::render::Tone;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The folder that `solve` wrote, or the solution.rad in it
    solution: PathBuf,
    /// The file to write; its ending says how: .glb, .obj, .ply or .vtu
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Exposure of the colours in stops; chosen from the solution if this is left out
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = finite)]
    exposure: Option<f64>,
    /// Lumens per watt, for illuminance; 1 if the emitters were given in lumens
    #[arg(long, value_name = "LM/W", default_value_t = WHITE_EFFICACY, value_parser = positive)]
    efficacy: f64,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let format = MeshFormat::of(&arguments.output)?;
    let solution = read_solution(&arguments.solution)?;
    let lit = solution.lit_mesh();
    let exporter = Exporter {
        solution: &solution,
        lit: &lit,
        tone: arguments
            .exposure
            .map_or_else(|| Tone::for_mesh(&lit), Tone::new),
        efficacy: arguments.efficacy,
    };
    exporter.write(format, &arguments.output)?;
    Ok(Code::Success)
}
