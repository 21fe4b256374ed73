//! Temperatures in, radiosity and net flux out.

use super::table::{column, open, place_of, unreadable};
use super::{CliError, say};
use crate::matrix::{Balance, Matrix, Row};
use crate::output::write_atomically;
use crate::radiometry::Power;
use csv::{StringRecord, WriterBuilder};
use rustc_hash::FxHashMap;
use std::io::Write;
use std::path::Path;

/// Stefan–Boltzmann constant, W m⁻² K⁻⁴ (exact in the SI of 2019, to these digits).
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// Temperatures of rows.
pub(super) struct Heat {
    file: String,
    zones: Vec<Zone>,
}

/// The temperature of a row.
#[derive(Debug)]
pub(super) struct Zone {
    label: String,
    temperature: f64,
    emissivity: Option<f64>,
    line: u64,
}

const COLUMNS: [&str; 3] = ["label", "temperature_K", "emissivity"];

/// Reads a table with the columns label, temperature_K and perhaps emissivity.
pub(super) fn read(path: &Path) -> Result<Heat, CliError> {
    let broken = |e: csv::Error| unreadable(path, &e);
    let mut reader = open(path)?;
    let header = reader.headers().map_err(broken)?.clone();
    let [label, temperature, emissivity] = COLUMNS;
    let columns = (
        column(&header, path, label)?,
        column(&header, path, temperature)?,
        place_of(&header, emissivity),
    );
    warn_of_others(&header, path);
    let mut zones = Vec::new();
    for record in reader.records() {
        zones.push(zone(&record.map_err(broken)?, columns, path)?);
    }
    let file = path.display().to_string();
    Ok(Heat { file, zones })
}

/// Who misspells the emissivity is told that it was not read.
fn warn_of_others(header: &StringRecord, path: &Path) {
    let is_known = |name: &&str| COLUMNS.contains(&name.trim_start_matches('\u{feff}'));
    let others: Vec<&str> = header.iter().filter(|name| !is_known(name)).collect();
    if !others.is_empty() {
        say::warning(&format!(
            "{}:1: columns that are not read: `{}`; those that are: {}",
            path.display(),
            others.join("`, `"),
            COLUMNS.join(", ")
        ));
    }
}

fn zone(
    record: &StringRecord,
    (label, temperature, emissivity): (usize, usize, Option<usize>),
    path: &Path,
) -> Result<Zone, CliError> {
    let line = record.position().map_or(0, csv::Position::line);
    let number = |what: &str, text: &str, expected: &str, allowed: fn(&f64) -> bool| {
        let number = text.parse().ok().filter(allowed);
        number.ok_or_else(|| {
            let (file, found) = (path.display(), format!("the {what} `{text}`"));
            CliError::Input(format!("{file}:{line}: found {found}; expected {expected}"))
        })
    };
    let emissivity = emissivity.map(|column| &record[column]);
    let emissivity = emissivity.filter(|text| !text.is_empty()).map(|text| {
        number("emissivity", text, "0 < emissivity <= 1", |e| {
            *e > 0.0 && *e <= 1.0
        })
    });
    Ok(Zone {
        label: record[label].to_owned(),
        temperature: number(
            "temperature",
            &record[temperature],
            "kelvins, 0 or more",
            |t| t.is_finite() && *t >= 0.0,
        )?,
        emissivity: emissivity.transpose()?,
        line,
    })
}

impl Heat {
    /// The temperature of each row; refuses labels that no row has or that are there twice, and rows without a temperature.
    pub fn of_rows(self, rows: &[Row]) -> Result<Vec<Zone>, CliError> {
        let numbers = rows.iter().zip(0..).map(|(row, k)| (row.label.as_str(), k));
        let numbers: FxHashMap<&str, usize> = numbers.collect();
        let file = &self.file;
        let mut known: Vec<Option<Zone>> = rows.iter().map(|_| None).collect();
        for zone in self.zones {
            let Some(row) = numbers.get(zone.label.as_str()) else {
                let (line, label) = (zone.line, &zone.label);
                return Err(CliError::Input(format!(
                    "{file}:{line}: found the label `{label}`; expected one of the matrix's rows"
                )));
            };
            if let Some(first) = &known[*row] {
                let (line, label, first) = (zone.line, &zone.label, first.line);
                return Err(CliError::Input(format!(
                    "{file}:{line}: found the label `{label}` again, after line {first}; expected each once"
                )));
            }
            known[*row] = Some(zone);
        }
        let of_row = |(zone, row): (Option<Zone>, &Row)| {
            zone.ok_or_else(|| {
                let found = format!("found no temperature of `{}`", row.label);
                CliError::Input(format!("{file}: {found}; expected one for every row"))
            })
        };
        known.into_iter().zip(rows).map(of_row).collect()
    }
}

/// Writes radiosity, irradiance and net flux of every row: three channels of light, or one of heat.
pub(super) fn write_radiosity(
    path: &Path,
    matrix: &Matrix,
    zones: Option<&[Zone]>,
) -> Result<(), CliError> {
    let table = match zones {
        None => light_table(matrix),
        Some(zones) => heat_table(matrix, zones),
    };
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let broken = |e: csv::Error| CliError::System(format!("cannot make the table: {e}"));
    for record in &table {
        writer.write_record(record).map_err(broken)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|e| CliError::System(format!("cannot make the table: {e}")))?;
    write_atomically(path, |out| out.write_all(&bytes))?;
    Ok(())
}

fn light_table(matrix: &Matrix) -> Vec<Vec<String>> {
    let quantities = ["exitance", "radiosity", "irradiance", "net_flux"];
    let units = ["W_m2", "W_m2", "W_m2", "W"];
    let mut header = vec!["label".to_owned(), "area_m2".to_owned()];
    for (quantity, unit) in quantities.iter().zip(units) {
        header.extend(["r", "g", "b"].map(|channel| format!("{quantity}_{channel}_{unit}")));
    }
    let lines = matrix
        .rows
        .iter()
        .zip(matrix.balance())
        .map(|(row, balance)| {
            let Balance {
                radiosity,
                irradiance,
                net_flux,
            } = balance;
            let values =
                [row.exitance, radiosity, irradiance, net_flux].map(|power| power.to_array());
            let head = [row.label.clone(), row.area.to_string()];
            head.into_iter()
                .chain(values.as_flattened().iter().map(f64::to_string))
                .collect()
        });
    std::iter::once(header).chain(lines).collect()
}

fn heat_table(matrix: &Matrix, zones: &[Zone]) -> Vec<Vec<String>> {
    let (mut reflectance, mut exitance) = (Vec::new(), Vec::new());
    let mut lines = Vec::new();
    for (row, zone) in matrix.rows.iter().zip(zones) {
        let emissivity = zone
            .emissivity
            .unwrap_or(1.0 - row.reflectance.element_sum() / 3.0);
        let emitted = emissivity * STEFAN_BOLTZMANN * zone.temperature.powi(4);
        reflectance.push(Power::splat(1.0 - emissivity));
        exitance.push(Power::splat(emitted));
        lines.push(vec![
            row.label.clone(),
            row.area.to_string(),
            zone.temperature.to_string(),
            emissivity.to_string(),
            emitted.to_string(),
        ]);
    }
    for (line, balance) in lines
        .iter_mut()
        .zip(matrix.balance_of(&reflectance, &exitance))
    {
        line.extend(
            [
                balance.radiosity.x,
                balance.irradiance.x,
                balance.net_flux.x,
            ]
            .map(|value| value.to_string()),
        );
    }
    let header = [
        "label",
        "area_m2",
        "temperature_K",
        "emissivity",
        "exitance_W_m2",
        "radiosity_W_m2",
        "irradiance_W_m2",
        "net_flux_W",
    ];
    std::iter::once(header.map(str::to_owned).to_vec())
        .chain(lines)
        .collect()
}
