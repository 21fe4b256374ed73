//! The window of `radiosity view` and of `--watch`.

use super::CliError;
use super::error::Code;
use super::names::names_of;
use super::progress::{Look, is_interrupted};
use super::results::read_solution;
use super::say::{self, is_quiet};
use super::session::{Audience, Session};
use super::view::Arguments;
use crate::Run;
use crate::radiometry::WHITE_EFFICACY;
use crate::scene::{Camera, Names};
use crate::solution::Solution;
use crate::viewer::{Exhibit, Hooks, Labels, Reading, Screen, Viewer, Window, read_ply};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) fn view(arguments: &Arguments) -> Result<Code, CliError> {
    let window = Window::new()?;
    let shown = Shown::read(&arguments.solution, arguments.efficacy)?;
    let chosen = arguments.viewpoint.of(&shown.cameras)?;
    let mut cameras: Vec<Camera> = chosen.into_iter().take(1).collect();
    let others = shown.cameras.into_iter();
    cameras.extend(
        others
            .filter(|camera| camera.name != cameras[0].name)
            .collect::<Vec<_>>(),
    );
    let viewer = Viewer::new(cameras, 0, shown.exhibit.extent());
    let hooks = Hooks {
        read: &mut |reading: &Reading| say::line(reading),
        is_over: &|| false,
    };
    window.run(&shown.name, viewer, shown.exhibit, arguments.engine, hooks)?;
    Ok(Code::Success)
}

/// What is looked at, and from where.
struct Shown {
    name: String,
    exhibit: Exhibit,
    cameras: Vec<Camera>,
}

impl Shown {
    fn read(path: &Path, efficacy: f64) -> Result<Self, CliError> {
        if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("ply"))
        {
            let exhibit = Exhibit::new(read_ply(path)?, Labels::default(), efficacy);
            return Ok(Self {
                name: path.display().to_string(),
                cameras: vec![exhibit.camera()],
                exhibit,
            });
        }
        let solution = read_solution(path)?;
        let labels = Labels::of(&solution, names_of(&solution));
        Ok(Self {
            name: solution.report.scene.clone(),
            exhibit: Exhibit::new(solution.lit_mesh(), labels, efficacy),
            cameras: solution.cameras,
        })
    }
}

/// The window of `--watch`, not open yet.
pub(super) struct Watching(Window);

impl Watching {
    /// Finds the display.
    pub fn new() -> Result<Self, CliError> {
        Ok(Self(Window::new()?))
    }

    /// Solves in a thread beside the window, as windows belong to the main thread; ends when both have.
    pub fn around(self, session: &Session, run: Run) -> Result<Code, CliError> {
        let solution = run.solution();
        let (title, cameras) = (solution.report.scene.clone(), solution.cameras.clone());
        let first = exhibit(solution);
        let viewer = Viewer::new(cameras, 0, first.extent());
        let engine = session.how.engine.unwrap_or_default();
        let (screen, failed) = (self.0.screen(), AtomicBool::new(false));
        let silent = is_quiet() || session.how.progress == Look::Json;
        let mut read = |reading: &Reading| {
            if !silent {
                say::line(reading);
            }
        };
        let hooks = Hooks {
            read: &mut read,
            is_over: &|| is_interrupted() || failed.load(Ordering::SeqCst),
        };
        std::thread::scope(|scope| {
            let solver = scope.spawn(|| {
                let result = session.finish(run, Some(&screen));
                failed.store(result.is_err(), Ordering::SeqCst);
                result
            });
            if let Err(error) = self.0.run(&title, viewer, first, engine, hooks) {
                say::warning(&format!("{error}; the solve goes on"));
            }
            let solved = solver.join();
            solved.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    }
}

impl Audience for Screen {
    fn is_there(&self) -> bool {
        self.is_open()
    }

    fn see(&self, so_far: &Solution) {
        self.show(exhibit(so_far));
    }
}

fn exhibit(solution: &Solution) -> Exhibit {
    let labels = Labels::of(solution, Names::default());
    Exhibit::new(solution.lit_mesh(), labels, WHITE_EFFICACY)
}
