//! The light of a solution at points: on a surface as it was solved for, and in the open as it is gathered there.
//!
//! ```text
//! cargo run --release --example probe
//! ```

use glam::DVec3;
use radiosity::radiometry::{WHITE_EFFICACY, photometric};
use radiosity::scene::Scene;
use radiosity::solution::Prober;
use radiosity::solver::{Preset, Silent};
use radiosity::visibility::EngineChoice;
use radiosity::{Settings, irradiance_at, solve};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::load(Path::new("scenes/cornell-box"))?;
    let settings = Settings {
        options: Preset::Draft.options(),
        ..Settings::default()
    };
    let solution = solve(&scene, &settings, &mut Silent)?;

    let floor = DVec3::new(150.0, 0.0, 400.0);
    let probe = Prober::new(&solution).probe(floor, DVec3::Y);
    let probe = probe.ok_or("there is no surface")?;
    println!(
        "on the floor: E = {:.4} W/m², B = {:.4} W/m²",
        probe.irradiance, probe.radiosity
    );

    let above = floor + 85.0 * DVec3::Y;
    let places = [(above, DVec3::Y), (above, DVec3::NEG_Y)];
    let found = irradiance_at(&solution, &places, EngineChoice::Auto, 0)?;
    for ((_, normal), irradiance) in places.iter().zip(found) {
        let irradiance = irradiance.ok_or("inside a solid")?;
        let lux = photometric(irradiance, WHITE_EFFICACY);
        println!("85 mm above, facing {normal}: {irradiance:.4} W/m², {lux:.2} lx");
    }
    Ok(())
}
