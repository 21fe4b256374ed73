//! Cameras from the settings, judged; and one of the whole scene where there are none.

use super::settings::{CameraSettings, Settings, UpAxis};
use super::text::{TextFile, quote};
use super::{Camera, SceneError, limits};
use glam::DVec3;

pub(super) const DEFAULT_FOV: f64 = 45.0;
pub(super) const DEFAULT_SIZE: (u32, u32) = (1024, 768);

/// The cameras of a `scene.toml`.
pub(super) fn from_settings(
    file: &TextFile,
    settings: &Settings,
    axis: UpAxis,
) -> Result<Vec<Camera>, SceneError> {
    let mut cameras: Vec<Camera> = Vec::new();
    for described in &settings.camera {
        let camera = judge(described.get_ref(), axis)
            .and_then(
                |camera| match cameras.iter().any(|other| other.name == camera.name) {
                    true => Err((
                        "a second one of that name".to_owned(),
                        "names that differ".to_owned(),
                    )),
                    false => Ok(camera),
                },
            )
            .map_err(|(found, expected)| {
                let found = format!(
                    "the camera {} with {found}",
                    quote(&described.get_ref().name)
                );
                file.error(file.line_at(described.span().start), found, expected)
            })?;
        cameras.push(camera);
    }
    Ok(cameras)
}

fn judge(described: &CameraSettings, axis: UpAxis) -> Result<Camera, (String, String)> {
    let fault = |found: String, expected: &str| Err((found, expected.to_owned()));
    if !names_a_file(&described.name) {
        return fault(
            "such a name".to_owned(),
            "one for a folder beside the results: no path, none of their names, 255 bytes at most",
        );
    }
    let eye = point("eye", described.eye)?;
    let look_at = point("look_at", described.look_at)?;
    let vertical = match axis {
        UpAxis::Y => [0.0, 1.0, 0.0],
        UpAxis::Z => [0.0, 0.0, 1.0],
    };
    let up = point("up", described.up.unwrap_or(vertical))?;
    let sight = look_at - eye;
    // Distances that the coordinates can tell from none.
    if sight.length() <= 1e-12 * eye.abs().max_element() {
        return fault(
            "eye = look_at".to_owned(),
            "an eye at some distance from what it looks at",
        );
    }
    let sine = sight.normalize().cross(up.normalize_or_zero()).length();
    if sine < 1e-6 {
        return fault(format!("up = {up}"), "a direction other than that of sight");
    }
    let fov = described.horizontal_fov.unwrap_or(DEFAULT_FOV);
    if !(fov > 0.0 && fov < 180.0) {
        return fault(
            format!("horizontal_fov = {fov}"),
            "degrees between 0 and 180",
        );
    }
    if let Some(exposure) = described.exposure.filter(|exposure| !exposure.is_finite()) {
        return fault(format!("exposure = {exposure}"), "a finite number of stops");
    }
    let turned = |point| match axis {
        UpAxis::Y => point,
        UpAxis::Z => UpAxis::turned(point),
    };
    Ok(Camera {
        name: described.name.clone(),
        eye: turned(eye),
        look_at: turned(look_at),
        up: turned(up),
        horizontal_fov: fov,
        width: pixels("width", described.width, DEFAULT_SIZE.0)?,
        height: pixels("height", described.height, DEFAULT_SIZE.1)?,
        exposure: described.exposure,
    })
}

/// The longest name of a file, in bytes, that all common file systems take.
pub(super) const LONGEST_NAME: usize = 255;

/// Names of results, among which the folders of the cameras lie.
const RESULTS: [&str; 12] = [
    "solution.rad",
    "checkpoint.rad",
    "solution.glb",
    "solution.obj",
    "solution.ply",
    "solution.vtu",
    "report.json",
    "report.html",
    "shaded.exr",
    "shaded.png",
    "mesh.png",
    "wireframe.png",
];

/// Whether there can be a folder of that name for a camera's pictures, beside the other results.
pub(super) fn names_a_file(name: &str) -> bool {
    let forbidden = |c: char| c.is_control() || "/\\:*?\"<>|".contains(c);
    !name.trim().is_empty()
        && !name.starts_with('.')
        && !name.contains(forbidden)
        && name.len() <= LONGEST_NAME
        && !RESULTS.iter().any(|taken| taken.eq_ignore_ascii_case(name))
}

fn point(key: &str, coordinates: [f64; 3]) -> Result<DVec3, (String, String)> {
    let point = DVec3::from_array(coordinates);
    match point.abs().max_element() <= limits::COORDINATE && !point.is_nan() {
        true => Ok(point),
        false => Err((format!("{key} = {point}"), "finite coordinates".to_owned())),
    }
}

fn pixels(key: &str, stated: Option<i64>, default: u32) -> Result<u32, (String, String)> {
    let stated = stated.unwrap_or(i64::from(default));
    match u32::try_from(stated) {
        Ok(pixels @ 1..=limits::PIXELS) => Ok(pixels),
        _ => Err((
            format!("{key} = {stated}"),
            format!("1 to {} pixels", limits::PIXELS),
        )),
    }
}

/// A view of everything within the bounds, from the front, the right and above.
pub(super) fn overview((low, high): (DVec3, DVec3)) -> Camera {
    let centre = (low + high) / 2.0;
    let radius = (high - low).length() / 2.0;
    let (width, height) = DEFAULT_SIZE;
    // The sphere around the bounds touches the cone within the smaller, vertical field of view.
    let half_width = (DEFAULT_FOV / 2.0).to_radians().tan();
    let half_angle = (half_width * f64::from(height) / f64::from(width)).atan();
    let distance = radius / half_angle.sin();
    Camera {
        name: "overview".to_owned(),
        eye: centre + distance * DVec3::new(0.5, 0.45, 1.0).normalize(),
        look_at: centre,
        up: DVec3::Y,
        horizontal_fov: DEFAULT_FOV,
        width,
        height,
        exposure: None,
    }
}
