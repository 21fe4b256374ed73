//! From where, which way up, with what field of view, how large and how bright: the flags of `render` and `view`.

use super::CliError;
use super::values::{degrees, finite};
use crate::scene::Camera;
use clap::Args;
use glam::DVec3;

#[derive(Debug, Args)]
pub(super) struct Viewpoint {
    /// A camera of the scene by name; if this is left out, `render` draws from all and `view` begins with the first
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Look from here instead (scene units)
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    eye: Option<DVec3>,
    /// Look at this point instead (scene units)
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
    /// This way is up instead, as (0,0,-1) is on a plan
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// Horizontal field of view, in degrees
    #[arg(long, value_name = "DEGREES", value_parser = degrees)]
    fov: Option<f64>,
    /// Width in pixels
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    width: Option<u32>,
    /// Height in pixels
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    height: Option<u32>,
    /// Exposure in stops; chosen from the picture if neither this nor the scene says
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = finite)]
    exposure: Option<f64>,
}

impl Viewpoint {
    /// The cameras that are asked for, as they are asked for; at least one.
    pub(super) fn of(&self, cameras: &[Camera]) -> Result<Vec<Camera>, CliError> {
        let named: Vec<&Camera> = cameras
            .iter()
            .filter(|c| self.camera.as_ref().is_none_or(|name| *name == c.name))
            .collect();
        if named.is_empty() {
            let known = cameras
                .iter()
                .map(|c| c.name.as_str())
                .collect::<Vec<_>>()
                .join(", ");
            let asked = self.camera.as_deref().unwrap_or_default();
            return Err(CliError::Usage(format!(
                "no camera is named `{asked}`; there are: {known}"
            )));
        }
        // A view of one's own is one view.
        let own = self.eye.is_some() || self.look_at.is_some();
        named
            .into_iter()
            .take(if own { 1 } else { usize::MAX })
            .map(|camera| self.adjusted(camera))
            .collect()
    }

    fn adjusted(&self, camera: &Camera) -> Result<Camera, CliError> {
        let adjusted = Camera {
            eye: self.eye.unwrap_or(camera.eye),
            look_at: self.look_at.unwrap_or(camera.look_at),
            up: self.up.unwrap_or(camera.up),
            horizontal_fov: self.fov.unwrap_or(camera.horizontal_fov),
            width: self.width.unwrap_or(camera.width),
            height: self.height.unwrap_or(camera.height),
            exposure: self.exposure.or(camera.exposure),
            ..camera.clone()
        };
        let sight = adjusted.look_at - adjusted.eye;
        if sight.cross(adjusted.up).length() <= 1e-9 * sight.length() * adjusted.up.length() {
            return Err(CliError::Usage(
                "the camera looks along its up direction (--up names another), or at its own eye"
                    .into(),
            ));
        }
        Ok(adjusted)
    }
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok([x, y, z]) if [x, y, z].iter().all(|n| n.is_finite()) => Ok(DVec3::new(*x, *y, *z)),
        _ => Err("expected three numbers, as in 1,2.5,-3".into()),
    }
}
