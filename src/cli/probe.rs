//! `radiosity probe`.

use super::error::Code;
use super::grid::GridFlags;
use super::results::read_solution;
use super::table::{column, open, unreadable};
use super::{CliError, say};
use crate::output::write_atomically;
use crate::solution::{Probe, Prober, Solution};
use clap::Args;
use csv::{StringRecord, WriterBuilder};
use glam::DVec3;
use std::io::Write;
use std::path::{Path, PathBuf};

const PLACE: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];
const LIGHT: [&str; 6] = [
    "radiosity_r",
    "radiosity_g",
    "radiosity_b",
    "irradiance_r",
    "irradiance_g",
    "irradiance_b",
];

/// What clap makes of the flags that exclude each other is a command that there is not.
const USAGE: &str = "radiosity probe [OPTIONS] <SOLUTION> <POINTS>
       radiosity probe [OPTIONS] <SOLUTION> --grid <PLANE>";

#[derive(Debug, Args)]
#[command(override_usage = USAGE)]
pub(super) struct Arguments {
    /// The folder that `solve` wrote, or the solution.rad in it
    solution: PathBuf,
    /// A table with the columns x,y,z,nx,ny,nz (scene units); other columns are kept, but for the light of an earlier probe
    #[arg(required_unless_present = "grid", conflicts_with = "grid")]
    points: Option<PathBuf>,
    /// Where the table goes, with radiosity and irradiance added; standard output if this is left out
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    grid: GridFlags,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let solution = read_solution(&arguments.solution)?;
    if let Some(plane) = &arguments.grid.grid {
        let output = arguments.output.as_deref();
        arguments.grid.measure(&solution, plane, output)?;
    }
    match &arguments.points {
        Some(points) => probe(&solution, points, arguments),
        None => Ok(Code::Success),
    }
}

fn probe(solution: &Solution, points: &Path, arguments: &Arguments) -> Result<Code, CliError> {
    let (table, missed) = probe_table(solution, points)?;
    match &arguments.output {
        Some(path) => write_atomically(path, |out| out.write_all(&table))?,
        None => say::result(&table)?,
    }
    if missed > 0 {
        let lie = if missed == 1 {
            "point lies"
        } else {
            "points lie"
        };
        say::aside(format_args!(
            "{missed} {lie} on no surface that faces that way: left empty"
        ));
    }
    Ok(Code::Success)
}

/// The table of points with the light added, and how many points met no surface.
fn probe_table(solution: &Solution, path: &Path) -> Result<(Vec<u8>, usize), CliError> {
    let unreadable = |e: csv::Error| unreadable(path, &e);
    let mut reader = open(path)?;
    let header = reader.headers().map_err(unreadable)?.clone();
    let columns = place_columns(&header, path)?;
    let prober = Prober::new(solution);
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let broken = |e: csv::Error| CliError::System(format!("cannot make the table: {e}"));
    let is_kept = |(_, name): &(usize, &str)| !LIGHT.contains(name);
    let kept: Vec<usize> = header
        .iter()
        .enumerate()
        .filter(is_kept)
        .map(|(at, _)| at)
        .collect();
    writer
        .write_record(kept.iter().map(|at| &header[*at]).chain(LIGHT))
        .map_err(broken)?;
    let mut missed = 0;
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let [point, normal] = place(&record, &columns, path)?;
        let light = prober.probe(point, normal);
        missed += usize::from(light.is_none());
        let cells = light.map_or_else(|| vec![String::new(); LIGHT.len()], |probe| cells(&probe));
        writer
            .write_record(kept.iter().map(|at| record[*at].to_owned()).chain(cells))
            .map_err(broken)?;
    }
    let table = writer
        .into_inner()
        .map_err(|e| CliError::System(format!("cannot make the table: {e}")))?;
    Ok((table, missed))
}

fn place_columns(header: &StringRecord, path: &Path) -> Result<[usize; 6], CliError> {
    let mut columns = [0; 6];
    for (place, name) in columns.iter_mut().zip(PLACE) {
        *place = column(header, path, name)?;
    }
    Ok(columns)
}

fn place(record: &StringRecord, columns: &[usize; 6], path: &Path) -> Result<[DVec3; 2], CliError> {
    let line = record.position().map_or(0, csv::Position::line);
    let mut numbers = [0.0; 6];
    for (number, (column, name)) in numbers.iter_mut().zip(columns.iter().zip(PLACE)) {
        let text = &record[*column];
        let parsed = text.parse::<f64>().ok().filter(|n| n.is_finite());
        *number = parsed.ok_or_else(|| {
            CliError::Input(format!(
                "{}:{line}: found `{text}` in column {name}, expected a number",
                path.display()
            ))
        })?;
    }
    let [x, y, z, nx, ny, nz] = numbers;
    if [nx, ny, nz] == [0.0; 3] {
        return Err(CliError::Input(format!(
            "{}:{line}: found the normal 0,0,0, expected a direction in which the point faces",
            path.display()
        )));
    }
    Ok([DVec3::new(x, y, z), DVec3::new(nx, ny, nz)])
}

fn cells(probe: &Probe) -> Vec<String> {
    let values = [probe.radiosity, probe.irradiance].map(|s| s.to_array());
    values
        .iter()
        .flatten()
        .map(|value| value.to_string())
        .collect()
}
