//! `radiosity render`.

use super::CliError;
use super::error::Code;
use super::pictures::draw;
use super::solve::SOLUTION;
use crate::render::RenderOptions;
use crate::scene::Camera;
use crate::solution::Solution;
use crate::visibility::EngineChoice;
use clap::Args;
use glam::DVec3;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The folder that `solve` wrote
    solution: PathBuf,
    /// A camera of the scene by name; all of them if this is left out
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Look from here instead (scene units)
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    eye: Option<DVec3>,
    /// Look at this point instead (scene units)
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
    /// Horizontal field of view, in degrees
    #[arg(long, value_name = "DEGREES")]
    fov: Option<f64>,
    /// Width in pixels
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    width: Option<u32>,
    /// Height in pixels
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    height: Option<u32>,
    /// Exposure in stops; chosen from the picture if neither this nor the scene says
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    exposure: Option<f64>,
    /// Folder for the pictures; the solution's own if this is left out
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Who traces the rays: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    engine: EngineChoice,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let solution = Solution::read(&arguments.solution.join(SOLUTION))?;
    let cameras = chosen(&solution.cameras, arguments)?;
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

fn chosen(cameras: &[Camera], arguments: &Arguments) -> Result<Vec<Camera>, CliError> {
    let named: Vec<&Camera> = cameras
        .iter()
        .filter(|c| arguments.camera.as_ref().is_none_or(|name| *name == c.name))
        .collect();
    if named.is_empty() {
        let known = cameras
            .iter()
            .map(|c| c.name.as_str())
            .collect::<Vec<_>>()
            .join(", ");
        let asked = arguments.camera.as_deref().unwrap_or_default();
        return Err(CliError::Input(format!(
            "no camera is named `{asked}`; there are: {known}"
        )));
    }
    // A view of one's own is one view.
    let own = arguments.eye.is_some() || arguments.look_at.is_some();
    named
        .into_iter()
        .take(if own { 1 } else { usize::MAX })
        .map(|camera| adjusted(camera, arguments))
        .collect()
}

fn adjusted(camera: &Camera, arguments: &Arguments) -> Result<Camera, CliError> {
    let adjusted = Camera {
        eye: arguments.eye.unwrap_or(camera.eye),
        look_at: arguments.look_at.unwrap_or(camera.look_at),
        horizontal_fov: arguments.fov.unwrap_or(camera.horizontal_fov),
        width: arguments.width.unwrap_or(camera.width),
        height: arguments.height.unwrap_or(camera.height),
        exposure: arguments.exposure.or(camera.exposure),
        ..camera.clone()
    };
    let sight = adjusted.look_at - adjusted.eye;
    if !(adjusted.horizontal_fov > 0.0 && adjusted.horizontal_fov < 180.0) {
        return Err(CliError::Input(format!(
            "a field of view of {} degrees; expected one between 0 and 180",
            adjusted.horizontal_fov
        )));
    }
    if sight.cross(adjusted.up).length() <= 1e-9 * sight.length() * adjusted.up.length() {
        return Err(CliError::Input(
            "the camera looks along its up direction, or at its own eye".into(),
        ));
    }
    Ok(adjusted)
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok([x, y, z]) if [x, y, z].iter().all(|n| n.is_finite()) => Ok(DVec3::new(*x, *y, *z)),
        _ => Err("expected three numbers, as in 1,2.5,-3".into()),
    }
}
