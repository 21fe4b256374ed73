//! `radiosity form-factors`.

use super::CliError;
use super::error::Code;
use super::heat::{self, Zone, write_radiosity};
use super::progress::leave_nothing_on_interrupt;
use super::say;
use super::values::{cut_off, named, positive, threads};
use crate::matrix::{By, Certificate, Correction, Enclosure, FormFactors, Options, Row};
use crate::output::{
    Dropped, MatrixTable, Sink, check_writable, remove_abandoned, write_atomically,
    write_matrix_csv, write_matrix_market, write_npz,
};
use crate::scene::NamedScene;
use crate::visibility::EngineChoice;
use crate::words::counted;
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A folder with a scene.toml, a .toml, or an .obj, .glb, .gltf or .ply; materials are not needed
    scene: PathBuf,
    /// The matrix: .csv (dense table), .npz (NumPy) or .mtx (sparse, Matrix Market); what is known of its accuracy goes beside it, into FILE.certificate.json (without FILE's own ending)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// What a row stands for: surface (a polygon, or a part of it), group (below one g, o or name of a glTF node) or material
    #[arg(long, default_value = "surface", value_parser = named::<By>)]
    by: By,
    /// Divide surfaces until no part is larger (m²)
    #[arg(long, value_name = "M2", value_parser = positive)]
    max_area: Option<f64>,
    /// Estimated error that a row may have (root of the sum of its entries' squared errors), and so any entry
    #[arg(long, default_value_t = 1e-4, value_name = "ERROR", value_parser = positive)]
    tolerance: f64,
    /// Change the matrix so that this holds exactly, by least squares; says by how much
    #[arg(long, value_name = "LAW")]
    enforce: Option<Law>,
    /// Solve for radiosity and net flux with the materials' reflectance and emission, into FILE.radiosity.csv
    #[arg(long)]
    solve: bool,
    /// The same for heat, in place of light: a table with the columns label, temperature_K and, if it is not 1 - reflectance, emissivity
    #[arg(long, value_name = "FILE", conflicts_with = "solve")]
    temperatures: Option<PathBuf>,
    /// Leave entries below this out of an .mtx; says what share of the flux they carry
    #[arg(long, default_value_t = 0.0, value_name = "F", value_parser = cut_off)]
    cut_off: f64,
    /// Who traces rays where there is too much between two surfaces: auto, embree, obvhs or brute-force
    #[arg(long, default_value = "auto", value_name = "ENGINE")]
    engine: EngineChoice,
    /// Threads; 0 for as many as the machine has
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
}

impl Arguments {
    fn options(&self) -> Options {
        Options {
            by: self.by,
            max_area: self.max_area,
            tolerance: self.tolerance,
            engine: self.engine,
            threads: self.threads,
        }
    }
}

/// Rows named in a warning.
const NAMED: usize = 5;

/// What can be enforced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Law {
    /// A_i F_ij = A_j F_ji
    Reciprocity,
    /// Row sums of 1 (with reciprocity), in a closed scene
    Closure,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Csv,
    Npz,
    MatrixMarket,
}

/// The file beside the matrix.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    options: BTreeMap<&'static str, String>,
    closed: bool,
    certificate: &'a Certificate,
    #[serde(skip_serializing_if = "Option::is_none")]
    correction: Option<Correction>,
    #[serde(skip_serializing_if = "Option::is_none")]
    dropped: Option<Dropped>,
    labels: Vec<&'a str>,
    areas_m2: Vec<f64>,
    covered_m2: Vec<f64>,
    warnings: &'a [String],
    seconds: f64,
}

pub(super) fn run(arguments: &Arguments) -> Result<Code, CliError> {
    let format = format_of(&arguments.output)?;
    if arguments.cut_off > 0.0 && format != Format::MatrixMarket {
        return Err(CliError::Usage(format!(
            "--cut-off is for a sparse matrix (.mtx); {} has all entries",
            arguments.output.display()
        )));
    }
    leave_nothing_on_interrupt();
    check_writable(&arguments.output)?;
    let folder = arguments.output.parent().filter(|it| *it != Path::new(""));
    remove_abandoned(folder.unwrap_or(Path::new(".")));
    let named = NamedScene::load(&arguments.scene)?;
    let heat = arguments
        .temperatures
        .as_deref()
        .map(heat::read)
        .transpose()?;
    let started = Instant::now();
    let enclosure = Enclosure::new(&named, &arguments.options())?;
    for warning in enclosure.warnings() {
        say::warning(warning);
    }
    // Before the work begins: who misspelt a label is told at once, and finds no matrix that was left behind.
    let zones = heat
        .map(|heat| heat.of_rows(enclosure.rows()))
        .transpose()?;
    let notes = notes(arguments, &enclosure);
    let table = MatrixTable {
        scene: &named.scene.name,
        rows: enclosure.rows(),
        notes: &notes,
    };
    let made = make(format, arguments, &enclosure, &table, zones.as_deref())?;
    let mut warnings = enclosure.warnings().to_vec();
    warnings.extend(blindness(&made.certificate, table.rows));
    warnings.extend(excess(&made.certificate, table.rows));
    for warning in &warnings[enclosure.warnings().len()..] {
        say::warning(warning);
    }
    let report = Report {
        scene: table.scene,
        options: described(arguments).into(),
        closed: made.certificate.is_closed(),
        certificate: &made.certificate,
        correction: made.correction,
        dropped: made.dropped,
        labels: table.rows.iter().map(|row| row.label.as_str()).collect(),
        areas_m2: table.rows.iter().map(|row| row.area).collect(),
        covered_m2: table.rows.iter().map(|row| row.covered).collect(),
        warnings: &warnings,
        seconds: started.elapsed().as_secs_f64(),
    };
    let text = serde_json::to_vec_pretty(&report).map_err(|e| CliError::System(e.to_string()))?;
    write_atomically(&beside(&arguments.output, "certificate.json"), |out| {
        out.write_all(&text)
    })?;
    say::result(summary(&report))?;
    Ok(Code::Success)
}

/// What is known of a matrix that was written.
struct Made {
    certificate: Certificate,
    dropped: Option<Dropped>,
    correction: Option<Correction>,
}

/// Computes and writes the matrix: row by row, or, where what was asked for takes all of them, as a whole; with the radiosity of `zones`, or
/// of the materials if that was asked for.
fn make(
    format: Format,
    arguments: &Arguments,
    enclosure: &Enclosure,
    table: &MatrixTable<'_>,
    zones: Option<&[Zone]>,
) -> Result<Made, CliError> {
    let is_solved = arguments.solve || zones.is_some();
    if arguments.enforce.is_none() && !is_solved {
        let feed = |sink: &mut Sink<'_>| enclosure.each_row(|row: &FormFactors<'_>| sink(row));
        let (certificate, dropped) = write(format, arguments, table, feed)?;
        return Ok(Made {
            certificate,
            dropped,
            correction: None,
        });
    }
    check_memory(enclosure.rows().len())?;
    let mut matrix = enclosure.matrix();
    let correction = match arguments.enforce {
        Some(Law::Closure) => Some(matrix.enforce_closure()?),
        Some(Law::Reciprocity) => Some(matrix.enforce_reciprocity()),
        None => None,
    };
    let feed = |sink: &mut Sink<'_>| matrix.each_row(sink).map(|()| matrix.certificate.clone());
    let (certificate, dropped) = write(format, arguments, table, feed)?;
    if is_solved {
        let path = beside(&arguments.output, "radiosity.csv");
        write_radiosity(&path, &matrix, zones)?;
    }
    Ok(Made {
        certificate,
        dropped,
        correction,
    })
}

/// Refuses a matrix for which there is no memory, 8 n² bytes, before it has been worked out.
fn check_memory(rows: usize) -> Result<(), CliError> {
    let room = Vec::<f64>::new().try_reserve_exact(rows.saturating_mul(rows));
    room.map_err(|_| {
        CliError::System(format!(
            "no memory for all {rows} x {rows} entries at once ({:.1} GiB), which --enforce, --solve and --temperatures need",
            8.0 * (rows as f64).powi(2) / f64::from(1 << 30)
        ))
    })
}

/// Rows that see nothing, though nothing covers them, are most often turned the wrong way.
fn blindness(certificate: &Certificate, rows: &[Row]) -> Option<String> {
    let blind: Vec<&str> = certificate
        .blind_rows()
        .map(|row| rows[row].label.as_str())
        .collect();
    let what = match blind.len() {
        0 => return None,
        count if count == rows.len() => "no row sees any other".to_owned(),
        count => {
            let named = first_of(&blind);
            format!("{count} of {} rows see no other ({named})", rows.len())
        }
    };
    Some(format!(
        "{what}: surfaces radiate from the side from which their corners run counter-clockwise; if that is the wrong one, turn them or say sides = \"both\" in the scene.toml"
    ))
}

/// Rows of which it is known that they are less accurate than was estimated.
fn excess(certificate: &Certificate, rows: &[Row]) -> Option<String> {
    let rows: Vec<&str> = (certificate.exceeding.iter())
        .map(|row| rows[*row as usize].label.as_str())
        .collect();
    let which = match rows.len() {
        0 => return None,
        1 => format!("row {} sums", first_of(&rows)),
        count => format!("{count} rows ({}) sum", first_of(&rows)),
    };
    Some(format!(
        "{which} up to more than 1 by more than the errors that were estimated: what is above 1 is stated as the error"
    ))
}

/// The first few of some labels.
fn first_of(labels: &[&str]) -> String {
    let first = labels[..labels.len().min(NAMED)].join("`, `");
    let others = if labels.len() > NAMED { ", …" } else { "" };
    format!("`{first}`{others}")
}

fn format_of(path: &Path) -> Result<Format, CliError> {
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    match extension.as_str() {
        "csv" => Ok(Format::Csv),
        "npz" => Ok(Format::Npz),
        "mtx" => Ok(Format::MatrixMarket),
        _ => Err(CliError::Usage(format!(
            "cannot write {}: found the ending `{extension}`, expected .csv, .npz or .mtx",
            path.display()
        ))),
    }
}

/// `F.csv` → `F.WHAT`.
fn beside(path: &Path, what: &str) -> PathBuf {
    path.with_extension(what)
}

fn write(
    format: Format,
    arguments: &Arguments,
    table: &MatrixTable<'_>,
    feed: impl FnOnce(&mut Sink<'_>) -> io::Result<Certificate>,
) -> Result<(Certificate, Option<Dropped>), CliError> {
    let path = &arguments.output;
    Ok(match format {
        Format::Csv => (write_matrix_csv(path, table, feed)?, None),
        Format::Npz => (write_npz(path, table, feed)?, None),
        Format::MatrixMarket => {
            let (certificate, dropped) = write_matrix_market(path, table, arguments.cut_off, feed)?;
            (certificate, Some(dropped))
        }
    })
}

fn described(arguments: &Arguments) -> [(&'static str, String); 4] {
    let max_area = arguments
        .max_area
        .map_or("none".to_owned(), |area| format!("{area} m^2"));
    let enforced = match arguments.enforce {
        None => "nothing",
        Some(Law::Reciprocity) => "reciprocity",
        Some(Law::Closure) => "closure",
    };
    [
        ("by", format!("{:?}", arguments.by).to_lowercase()),
        ("max_area", max_area),
        ("tolerance", arguments.tolerance.to_string()),
        ("enforced", enforced.to_owned()),
    ]
}

fn notes(arguments: &Arguments, enclosure: &Enclosure) -> Vec<String> {
    let options = described(arguments)
        .map(|(name, value)| format!("{name} = {value}"))
        .join(", ");
    let engine = enclosure.engine();
    let certificate = beside(&arguments.output, "certificate.json");
    vec![
        format!(
            "{} rows; {options}; rays, if any, by {} {}",
            enclosure.rows().len(),
            engine.name,
            engine.version
        ),
        format!(
            "row sums, errors and limits: {}",
            certificate
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
        ),
    ]
}

/// What the row sums tell.
fn balance(certificate: &Certificate) -> String {
    let escaped = 100.0 * certificate.escaped;
    if certificate.is_closed() {
        "closed".to_owned()
    } else if escaped > 0.0 {
        format!("open, {escaped:.4} % of the flux escapes")
    } else {
        format!("too large, {:.4} % more flux arrives than leaves", -escaped)
    }
}

fn summary(report: &Report<'_>) -> String {
    let certificate = report.certificate;
    let pairs = &certificate.pairs;
    let (low, high) = certificate.sum_range();
    let mut text = format!(
        "{} in {:.2} s; row sums {low:.6} to {high:.6}: {}\n\
         largest error of a row {:.1e}; {} at the limit of refinement\n\
         pairs of flat pieces: {} exchange nothing, {} unhindered, {} with shadows cut out, {} sampled with {} rays\n",
        counted(report.labels.len(), "row", "rows"),
        report.seconds,
        balance(certificate),
        certificate.largest_error(),
        counted(certificate.limited.len(), "entry", "entries"),
        pairs.nothing,
        pairs.unhindered,
        pairs.cut + pairs.limited,
        pairs.sampled,
        pairs.rays,
    );
    let covered = report.covered_m2.iter().filter(|area| **area > 0.0);
    if covered.clone().count() > 0 {
        text += &format!(
            "covered: {:.4} m^2 in {} of the rows, on which something stands or which lies in a solid: that area does not count\n",
            covered.clone().sum::<f64>(),
            covered.count(),
        );
    }
    if let Some(correction) = &report.correction {
        text += &format!(
            "enforced: entries changed by {:.1e} at most, {:.1e} rms; row sums within {:.1e} of 1\n",
            correction.largest, correction.rms, correction.residual
        );
    }
    if let Some(dropped) = &report.dropped {
        text += &format!(
            "left out: {} with {:.3e} of the flux\n",
            counted(dropped.entries, "entry", "entries"),
            dropped.share
        );
    }
    text
}
