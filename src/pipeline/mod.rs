//! From a scene to its solution: mesh, visibility, solve, report. [`solve`] does it in one call, a [`Run`] in as many as one likes.
//!
//! Imports `radiometry`, `scene`, `threads`, `visibility`, `mesh`, `solver`, `solution` and `words`.

mod measure;
mod report;
mod run;
mod target;
mod warnings;

pub use measure::irradiance_at;
pub use run::Run;
pub use target::Target;

use crate::scene::Scene;
use crate::solution::Solution;
use crate::solver::{Observer, Options};
use crate::threads::ThreadsError;
use crate::visibility::{EngineChoice, VisibilityError};
use crate::words::size;
use thiserror::Error;

/// How a scene is solved.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Settings {
    /// Thresholds and limits; with a target, what it does not fix comes from there.
    pub options: Options,
    /// The error to be reached, in place of thresholds.
    pub target: Option<Target>,
    /// Who traces the rays.
    pub engine: EngineChoice,
    /// Threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// Why a scene could not be solved.
#[derive(Debug, Error)]
pub enum SolveError {
    /// The visibility engine could not be built.
    #[error(transparent)]
    Visibility(#[from] VisibilityError),
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The scene was built in code, and cannot be solved: see [`Scene::check`].
    #[error("the scene has {0}")]
    Scene(String),
    /// The solution is of an older format, which did not keep what it takes to go on.
    #[error("this solution was written by an earlier version and cannot be continued, only shown")]
    NotKept,
    /// The scene is not the one that was solved, but for what its surfaces emit.
    #[error("a solve can go on with other emitters, not with another scene: {0}")]
    OtherScene(String),
    /// Already the coarsest mesh, with what is to be drawn of it, exceeds the memory limit.
    #[error(
        "{elements} elements before any refinement{} need about {}, where {} may be used (--memory-limit)",
        drawn(*.pictures, *.limit),
        size(*.needed, *.limit),
        size(*.limit, *.limit)
    )]
    TooLarge {
        /// Leaves of the coarsest mesh.
        elements: usize,
        /// The part of the pictures, bytes.
        pictures: u64,
        /// What the run would take, bytes.
        needed: u64,
        /// What it may take, bytes.
        limit: u64,
    },
    /// An option that does not exist, or that no solve could end with: see [`Options::check`].
    #[error("{0}")]
    Option(String),
}

fn drawn(pictures: u64, limit: u64) -> String {
    match pictures {
        0 => String::new(),
        _ => format!(" and a picture of {}", size(pictures, limit)),
    }
}

/// Solves `scene`; `observer` hears of the progress and may stop it. The same settings on the same instruction set give the same
/// solution, bit for bit, for any number of threads.
///
/// # Errors
/// When the scene or an option makes no sense, the engine or the threads cannot be started, or the coarsest mesh is beyond the memory limit.
/// A scene that does not emit is none, nor is a solve that was stopped: the report has its `stop_reason`.
///
/// # Examples
/// ```
/// use glam::{DVec3, Vec3};
/// use radiosity::scene::{Corners, Material, Scene, Sides, Surface};
/// use radiosity::solution::Prober;
/// use radiosity::solver::{Preset, Silent};
/// use radiosity::{Settings, solve};
///
/// // A lamp of 1 m² looks down on a floor of 1 m², 1 m below it.
/// let level = |y| [(0., 0.), (0., 1.), (1., 1.), (1., 0.)].map(|(x, z)| DVec3::new(x, y, z));
/// let material = |name: &str, reflectance, radiance| Material {
///     name: name.into(),
///     reflectance: Vec3::splat(reflectance),
///     emitted_radiance: Vec3::splat(radiance),
/// };
/// let surface = |corners, number| Surface {
///     corners: Corners::Quad(corners),
///     material: number,
///     polygon: number,
///     sides: Sides::Both,
/// };
/// let scene = Scene {
///     name: "lamp".into(),
///     metres_per_unit: 1.0,
///     vertices: [level(0.), level(1.)].concat(),
///     surfaces: vec![surface([0, 1, 2, 3], 0), surface([7, 6, 5, 4], 1)],
///     materials: vec![material("floor", 0.5, 0.0), material("lamp", 0.0, 100.0)],
///     cameras: Vec::new(),
///     input_polygons: 2,
///     warnings: Vec::new(),
/// };
/// let settings = Settings {
///     options: Preset::Draft.options(),
///     ..Settings::default()
/// };
/// let solution = solve(&scene, &settings, &mut Silent)?;
/// let middle = Prober::new(&solution).probe(DVec3::new(0.5, 0., 0.5), DVec3::Y);
/// let light = middle.expect("the floor is there").irradiance;
/// // π L F, the form factor being 0.2395 from a point below the middle of a square.
/// assert!((light.x - 75.24).abs() < 1.0, "{light}");
/// # Ok::<(), radiosity::SolveError>(())
/// ```
pub fn solve(
    scene: &Scene,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Solution, SolveError> {
    let mut run = Run::new(scene.clone(), settings.clone())?;
    run.go(observer)?;
    Ok(run.finish())
}
