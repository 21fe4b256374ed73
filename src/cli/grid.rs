//! `radiosity probe --grid`: illuminance on a plane of work.

use super::progress::sign_of_life;
use super::values::{png, positive, threads};
use super::{CliError, say};
use crate::geometry;
use crate::irradiance_at;
use crate::output::{write_atomically, write_png};
use crate::radiometry::{Spectrum, WHITE_EFFICACY, photometric};
use crate::render::false_colours;
use crate::solution::{Levels, Plane, Solution};
use crate::visibility::EngineChoice;
use clap::Args;
use csv::WriterBuilder;
use glam::DVec3;
use indicatif::HumanCount;
use std::io::Write;
use std::path::{Path, PathBuf};

/// More points are a mistake in the spacing.
const MOST_POINTS: usize = 4_000_000;

const GRID: &str = "Grid";

#[derive(Debug, Args)]
pub(super) struct GridFlags {
    /// Measure on a plane instead of points: y=0.8m is 0.8 m above the origin and faces up, -y=2m faces down
    #[arg(long, value_name = "PLANE", allow_hyphen_values = true, help_heading = GRID)]
    pub(super) grid: Option<PlaneAt>,
    /// Distance of the points: a number of scene units, or with the unit m, cm, mm, in or ft
    #[arg(long, value_name = "LENGTH", default_value = "0.25m", value_parser = spacing, requires = "grid", conflicts_with = "points", help_heading = GRID)]
    spacing: Length,
    /// Only between two corners, in scene units: X,Z,X,Z on a plane across y, Z,Y,Z,Y across x, X,Y,X,Y across z; else the whole scene
    #[arg(long, value_name = "A,B,A,B", value_parser = region, allow_hyphen_values = true, requires = "grid", conflicts_with = "points", help_heading = GRID)]
    region: Option<[f64; 4]>,
    /// A picture in false colours with a legend (PNG)
    #[arg(long, value_name = "FILE", value_parser = png, requires = "grid", conflicts_with = "points", help_heading = GRID)]
    picture: Option<PathBuf>,
    /// Lumens per watt, for illuminance; 1 if the emitters were given in lumens
    #[arg(long, value_name = "LM/W", default_value_t = WHITE_EFFICACY, value_parser = positive, requires = "grid", conflicts_with = "points", help_heading = GRID)]
    efficacy: f64,
    /// Who traces the rays: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE", requires = "grid", conflicts_with = "points", help_heading = GRID)]
    engine: EngineChoice,
    /// Threads for a grid; 0 for as many as the machine has. A table of points takes one
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
}

impl GridFlags {
    /// The table of the grid; prints what it amounts to, where a table on standard output leaves room for it.
    pub(super) fn measure(
        &self,
        solution: &Solution,
        at: &PlaneAt,
        output: Option<&Path>,
    ) -> Result<(), CliError> {
        let plane = self.plane(solution, at)?;
        let normal = plane.normal();
        let places: Vec<(DVec3, DVec3)> = plane.points().map(|point| (point, normal)).collect();
        let sign = sign_of_life(format!(
            "measuring at {} points",
            HumanCount(places.len() as u64)
        ));
        let found = irradiance_at(solution, &places, self.engine, self.threads);
        sign.finish_and_clear();
        let found = found?;
        let lux: Vec<Option<f64>> = found
            .iter()
            .map(|irradiance| irradiance.map(|e| photometric(e, self.efficacy)))
            .collect();
        let table = table(&places, &found, &lux)?;
        let summary = summary(&plane, &lux);
        match output {
            Some(path) => {
                write_atomically(path, |out| out.write_all(&table))?;
                say::result(summary)?;
            }
            None => {
                say::result(&table)?;
                say::aside(summary.trim_end());
            }
        }
        if let Some(path) = &self.picture {
            let picture = false_colours(plane.columns, &upright(&plane, &lux), "lx");
            write_png(path, picture.width, picture.height, &picture.pixels)?;
        }
        Ok(())
    }

    fn plane(&self, solution: &Solution, at: &PlaneAt) -> Result<Plane, CliError> {
        let (mut low, mut high) = bounds(solution);
        let (a, b) = Plane::sides(at.axis);
        if let Some([from_a, from_b, to_a, to_b]) = self.region {
            (low[a], high[a]) = (from_a.min(to_a), from_a.max(to_a));
            (low[b], high[b]) = (from_b.min(to_b), from_b.max(to_b));
        }
        let [spacing, place] = [&self.spacing, &at.place].map(|l| l.in_units(solution));
        let plane = Plane::over((low, high), at.axis, place, at.along, spacing);
        match plane.rows.checked_mul(plane.columns) {
            Some(points) if points <= MOST_POINTS => Ok(plane),
            _ => {
                let (rows, columns) = (plane.rows, plane.columns);
                let found = format!("a grid of {columns} x {rows} points");
                Err(CliError::Usage(format!(
                    "{found}; expected {MOST_POINTS} at most: a larger --spacing or a --region"
                )))
            }
        }
    }
}

/// The box around a solution, in scene units.
fn bounds(solution: &Solution) -> (DVec3, DVec3) {
    let mesh = &solution.mesh;
    let corners = mesh
        .patches
        .iter()
        .flat_map(|patch| patch.corners().to_vec());
    let (low, high) = geometry::bounds(corners);
    (mesh.frame.leave(low), mesh.frame.leave(high))
}

/// Rows as they are seen: what is up at the top; on a level plane as on a plan, with z towards the reader.
fn upright(plane: &Plane, values: &[Option<f64>]) -> Vec<Option<f64>> {
    let rows = values.chunks(plane.columns);
    match plane.axis {
        1 => rows.flatten().copied().collect(),
        _ => rows.rev().flatten().copied().collect(),
    }
}

fn table(
    places: &[(DVec3, DVec3)],
    found: &[Option<Spectrum>],
    lux: &[Option<f64>],
) -> Result<Vec<u8>, CliError> {
    let broken = |e: String| CliError::System(format!("cannot make the table: {e}"));
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let header = "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,illuminance_lx";
    let mut write = |record: Vec<String>| {
        writer
            .write_record(record)
            .map_err(|e| broken(e.to_string()))
    };
    write(header.split(',').map(str::to_owned).collect())?;
    for (((point, normal), irradiance), lux) in places.iter().zip(found).zip(lux) {
        let place = [point, normal].map(|v| v.to_array());
        let mut record: Vec<String> = place.as_flattened().iter().map(f64::to_string).collect();
        match irradiance.zip(*lux) {
            Some((e, lux)) => {
                record.extend(e.to_array().map(|channel| channel.to_string()));
                record.push(format!("{lux:.6}"));
            }
            None => record.extend(std::iter::repeat_n(String::new(), 4)),
        }
        write(record)?;
    }
    writer.into_inner().map_err(|e| broken(e.to_string()))
}

fn summary(plane: &Plane, lux: &[Option<f64>]) -> String {
    let (columns, rows) = (plane.columns, plane.rows);
    let Some(levels) = Levels::of(lux.iter().flatten().copied()) else {
        return format!(
            "{columns} x {rows} points, all of them inside solids or outside of rooms\n"
        );
    };
    let inside = lux.len() - levels.points;
    let left_out = match inside {
        0 => String::new(),
        n => format!(", {n} of them inside solids or outside of rooms and left out"),
    };
    format!(
        "{columns} x {rows} points{left_out}\n\
         illuminance: minimum {:.4} lx, mean {:.4} lx, maximum {:.4} lx\n\
         uniformity: minimum/mean {:.4}, minimum/maximum {:.4}\n",
        levels.least,
        levels.mean,
        levels.most,
        levels.uniformity(),
        levels.diversity()
    )
}

/// A plane across an axis.
#[derive(Debug, Clone)]
pub(super) struct PlaneAt {
    axis: usize,
    along: bool,
    place: Length,
}

impl std::str::FromStr for PlaneAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected an axis and a place on it, such as y=0.8m or -y=2m".to_owned();
        let (axis, place) = text.split_once('=').ok_or_else(expected)?;
        let (along, axis) = match axis.trim().strip_prefix('-') {
            Some(axis) => (false, axis),
            None => (true, axis.trim().trim_start_matches('+')),
        };
        let axis = ["x", "y", "z"].iter().position(|name| *name == axis);
        Ok(Self {
            axis: axis.ok_or_else(expected)?,
            along,
            place: place.parse().map_err(|_| expected())?,
        })
    }
}

/// A length in metres, or in scene units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Length {
    number: f64,
    metres: Option<f64>,
}

impl Length {
    fn in_units(&self, solution: &Solution) -> f64 {
        let metres = self.metres.unwrap_or(solution.metres_per_unit);
        self.number * metres / solution.metres_per_unit
    }
}

impl std::str::FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let units = [
            ("cm", 0.01),
            ("mm", 0.001),
            ("in", 0.0254),
            ("ft", 0.3048),
            ("m", 1.0),
        ];
        let unit = units.iter().find(|(name, _)| text.ends_with(name));
        let digits = unit.map_or(text, |(name, _)| &text[..text.len() - name.len()]);
        let number = digits.trim().parse::<f64>().ok().filter(|n| n.is_finite());
        Ok(Self {
            number: number.ok_or("expected a length such as 0.25m")?,
            metres: unit.map(|(_, metres)| *metres),
        })
    }
}

fn spacing(text: &str) -> Result<Length, String> {
    let length: Length = text.parse()?;
    match length.number > 0.0 {
        true => Ok(length),
        false => Err("expected a length such as 0.25m".into()),
    }
}

fn region(text: &str) -> Result<[f64; 4], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(&[a, b, c, d]) if [a, b, c, d].iter().all(|n| n.is_finite()) && a != c && b != d => {
            Ok([a, b, c, d])
        }
        _ => Err("expected four numbers that span an area, as in 0,0,4,3".into()),
    }
}
