//! An observer of one's own: it prints a line whenever unshot power has halved, and stops the solve after twenty million rays.
//!
//! ```text
//! cargo run --release --example own_observer -- scenes/cornell-box
//! ```

use radiosity::scene::Scene;
use radiosity::solver::{Control, Observer, Phase, Progress};
use radiosity::{Settings, solve};
use std::error::Error;
use std::path::PathBuf;

/// Half of what was unshot when it last spoke.
struct Halving(f64);

impl Observer for Halving {
    fn progress(&mut self, now: &Progress) -> Control {
        let unshot = now.unshot.element_sum() / now.emitted.element_sum();
        if now.phase == Phase::Shooting && unshot <= self.0 {
            println!("{:6} shots: {:.3} % unshot", now.shots, 100.0 * unshot);
            self.0 = unshot / 2.0;
        }
        match now.rays < 20_000_000 {
            true => Control::Continue,
            // What there is so far becomes the solution.
            false => Control::Stop,
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = std::env::args_os().nth(1).map(PathBuf::from);
    let scene = Scene::load(&scene.unwrap_or_else(|| "scenes/cornell-box".into()))?;
    let solution = solve(&scene, &Settings::default(), &mut Halving(1.0))?;
    let report = &solution.report;
    println!("{:?} after {} rays", report.stop_reason, report.rays);
    Ok(())
}
