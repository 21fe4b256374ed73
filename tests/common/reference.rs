//! Tables of reference irradiance, and how far a solution is from them.

use super::closed_form::emission_floor;
use super::scene_folder;
use csv::{ReaderBuilder, StringRecord};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::{Prober, Solution};
use std::error::Error;
use std::path::Path;

/// The irradiance at a point, as somebody else knows it.
#[derive(Clone, Copy)]
pub struct Sample {
    /// In scene units.
    pub point: DVec3,
    /// Unit normal of the side that receives.
    pub normal: DVec3,
    /// Irradiance E, W/m².
    pub irradiance: DVec3,
    /// Its standard error; 0 for an exact value.
    pub standard_error: DVec3,
}

/// Reads a table with the columns x,y,z,nx,ny,nz,E_r,E_g,E_b,se_r,se_g,se_b.
pub fn read(path: &Path) -> Result<Vec<Sample>, Box<dyn Error>> {
    let mut reader = ReaderBuilder::new().comment(Some(b'#')).from_path(path)?;
    let header = reader.headers()?.clone();
    let vector = |record: &StringRecord, names: [&str; 3]| -> Result<DVec3, Box<dyn Error>> {
        let mut numbers = [0.0; 3];
        for (number, name) in numbers.iter_mut().zip(names) {
            let column = header.iter().position(|h| h == name);
            *number = record[column.ok_or_else(|| format!("no column {name}"))?].parse()?;
        }
        Ok(DVec3::from_array(numbers))
    };
    let sample = |record: Result<StringRecord, csv::Error>| {
        let record = record?;
        Ok(Sample {
            point: vector(&record, ["x", "y", "z"])?,
            normal: vector(&record, ["nx", "ny", "nz"])?,
            irradiance: vector(&record, ["E_r", "E_g", "E_b"])?,
            standard_error: vector(&record, ["se_r", "se_g", "se_b"])?,
        })
    };
    reader.into_records().map(sample).collect()
}

/// A table of the tests.
pub fn table(name: &str) -> Vec<Sample> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name);
    read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A scene and what is known of it.
pub type Known = (Scene, Vec<Sample>);

/// The bundled scenes: Emission with its exact floor, the others with their path-traced tables.
pub fn bundled() -> Vec<Known> {
    let scene = |name: &str| {
        Scene::load(&scene_folder(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    let traced = ["shadow", "huge", "secondary", "geometry", "cornell-box"].map(|name| {
        let table_name = format!("{}_irradiance.csv", name.trim_end_matches("-box"));
        (scene(name), table(&table_name))
    });
    let exact = (scene("emission"), emission_floor());
    std::iter::once(exact).chain(traced).collect()
}

/// Relative errors are asked of samples above this fraction of the mean reference: in an umbra that only third
/// reflections reach, a ten-thousandth of the mean is an error that nobody sees, yet a hundred times what is there.
pub const DIM: f64 = 0.01;

/// How far a solution is from a table, all channels pooled. The noise of the table is taken out: its mean square is
/// subtracted from that of the differences.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Samples that lie on no surface of the solution.
    pub missed: usize,
    /// Root mean square of the error over the mean of the reference.
    pub n_rms: f64,
    /// Root mean square of the relative error, which counts the dim places as much as the bright ones; of samples above
    /// [`DIM`] alone.
    pub rms_rel: f64,
    /// Mean error over the mean of the reference.
    pub bias: f64,
    /// Largest relative error, of the same samples.
    pub max_rel: f64,
}

impl Deviation {
    /// Of `solution` from `samples`.
    pub fn of(solution: &Solution, samples: &[Sample]) -> Self {
        let prober = Prober::new(solution);
        let mean = samples
            .iter()
            .map(|s| s.irradiance.element_sum() / 3.0)
            .sum::<f64>()
            / samples.len() as f64;
        let (mut absolute, mut relative) = (Moments::default(), Moments::default());
        let (mut missed, mut max_rel) = (0, 0f64);
        for sample in samples {
            let Some(probe) = prober.probe(sample.point, sample.normal) else {
                missed += 1;
                continue;
            };
            let errors = probe.irradiance.as_dvec3() - sample.irradiance;
            for channel in 0..3 {
                let (reference, error, noise) = (
                    sample.irradiance[channel],
                    errors[channel],
                    sample.standard_error[channel],
                );
                absolute.add(error, noise);
                if reference > DIM * mean {
                    relative.add(error / reference, noise / reference);
                    max_rel = max_rel.max((error / reference).abs());
                }
            }
        }
        Self {
            missed,
            n_rms: absolute.rms() / mean,
            rms_rel: relative.rms(),
            bias: absolute.mean() / mean,
            max_rel,
        }
    }
}

/// Sums of errors and of their squares, less the squares of the noise.
#[derive(Default)]
struct Moments {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, error: f64, noise: f64) {
        self.count += 1.0;
        self.sum += error;
        self.squares += error * error - noise * noise;
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn rms(&self) -> f64 {
        (self.squares.max(0.0) / self.count).sqrt()
    }
}
