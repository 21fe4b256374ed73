//! What a solve says of itself, on one page: `report.html`, with pictures and curves inside, no script and nothing to fetch.

use super::markup::{escaped, header, row};
use super::plot::Plot;
use super::{WriteError, write_atomically};
use crate::codec::base64;
use crate::solution::{PowerReport, Report};
use crate::words::{counted, rounded};
use serde_json::Value;
use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;

/// A moment of a solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Rounds that were complete, on the way to a target.
    pub round: usize,
    /// Shots that were complete.
    pub shots: u64,
    /// Seconds since the start.
    pub seconds: f64,
    /// Unshot over emitted power.
    pub unshot: f64,
    /// Elements of the mesh.
    pub elements: usize,
}

/// An estimate of the error, and when it was made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// Shots that were complete.
    pub shots: u64,
    /// Seconds since the start.
    pub seconds: f64,
    /// Estimated RMS error of the irradiance over its mean.
    pub n_rms: f64,
}

/// How a solve went. Where several rounds led to a target, one follows the other, and their shots are added up.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// In order; may be empty.
    pub moments: Vec<Moment>,
    /// In order; may be empty.
    pub estimates: Vec<Estimated>,
}

/// What the page shows.
#[derive(Debug, Clone, Copy)]
pub struct Page<'a> {
    /// The facts.
    pub report: &'a Report,
    /// How the solve went.
    pub history: &'a History,
    /// PNG files with their captions.
    pub pictures: &'a [(String, Vec<u8>)],
    /// Files that were written beside the page.
    pub files: &'a [String],
}

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fff}\
h1{font-size:1.6rem}h2{font-size:1.15rem;margin-top:2rem;border-bottom:1px solid #ddd}\
table{border-collapse:collapse;margin:.5rem 0}td,th{padding:.15rem .9rem .15rem 0;text-align:left;vertical-align:top}\
td.n,th.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}figure{margin:1rem 0}img{max-width:100%;height:auto}\
figcaption{color:#666}.plots{display:flex;flex-wrap:wrap;gap:1rem}.plots svg{width:28rem;max-width:100%}\
svg text{font:11px sans-serif;fill:#444}svg .grid{stroke:#e4e4e4}svg .curve{fill:none;stroke:#21618c;stroke-width:2}\
svg .marks{fill:none;stroke:#b03a2e;stroke-dasharray:5 4}svg circle.mark,svg text.mark{fill:#b03a2e}svg text.mark{paint-order:stroke;stroke:#fff;stroke-width:3px}.warning{color:#8a4b00}";

/// Writes the page. It is well-formed XML, too.
///
/// # Errors
/// When the file cannot be written.
pub fn write_html(path: &Path, page: &Page) -> Result<(), WriteError> {
    let html = page.html();
    write_atomically(path, |out| out.write_all(html.as_bytes()))
}

impl Page<'_> {
    fn html(&self) -> String {
        let report = self.report;
        let title = escaped(&report.scene);
        let mut html = format!(
            "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
             <title>{title}: radiosity</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
        );
        html += &self.summary();
        html += &self.warnings();
        html += &self.pictures();
        html += &self.energy();
        html += &self.convergence();
        html += &self.quality();
        html += &self.options();
        let _ = write!(
            html,
            "<p>radiosity {}</p>\n</body>\n</html>\n",
            env!("CARGO_PKG_VERSION")
        );
        html
    }

    fn summary(&self) -> String {
        let report = self.report;
        let seconds = &report.seconds;
        let engine = &report.engine;
        let rate = report.rays as f64 / 1e6 / seconds.solve.max(1e-9);
        let rows = [
            ("ended", report.ended().to_owned()),
            (
                "shots",
                format!(
                    "{}, of which {} refined the mesh",
                    report.shots, report.meshing_shots
                ),
            ),
            (
                "mesh",
                format!(
                    "{}, {}, {} to level {}, {}",
                    counted(report.input_patches, "input polygon", "input polygons"),
                    counted(report.patches, "patch", "patches"),
                    counted(report.elements, "element", "elements"),
                    report.max_depth,
                    counted(report.vertices, "vertex", "vertices")
                ),
            ),
            (
                "time",
                format!(
                    "{:.2} s solving (shooting {:.2}, refining {:.2}, gathering {:.2}, estimating {:.2}), {:.2} s reading, \
                     {:.2} s building, on {}",
                    seconds.solve,
                    seconds.parts.shooting,
                    seconds.parts.refining,
                    seconds.parts.gathering,
                    seconds.parts.estimating,
                    seconds.load,
                    seconds.build,
                    counted(report.threads, "thread", "threads")
                ),
            ),
            (
                "rays",
                format!(
                    "{:.3} million, {rate:.2} million a second by {} {} ({}, {} wide)",
                    report.rays as f64 / 1e6,
                    engine.name,
                    engine.version,
                    engine.isa,
                    engine.packet_width
                ),
            ),
            ("taken up again with", report.resumed_with.join(", ")),
            ("files", self.files.join(", ")),
        ];
        let rows = rows.iter().filter(|(_, value)| !value.is_empty());
        let rows = rows.map(|(name, value)| row(&[name, value], &[]));
        format!("<table>\n{}</table>\n", rows.collect::<String>())
    }

    fn warnings(&self) -> String {
        let warnings = &self.report.warnings;
        if warnings.is_empty() {
            return String::new();
        }
        let items = warnings
            .iter()
            .map(|warning| format!("<li class=\"warning\">{}</li>\n", escaped(warning)));
        format!(
            "<h2>Warnings ({})</h2>\n<ul>\n{}</ul>\n",
            warnings.len(),
            items.collect::<String>()
        )
    }

    fn pictures(&self) -> String {
        let mut html = String::new();
        for (caption, png) in self.pictures {
            let (caption, data) = (escaped(caption), base64(png));
            let _ = writeln!(
                html,
                "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{data}\"/><figcaption>{caption}</figcaption></figure>"
            );
        }
        match html.is_empty() {
            true => html,
            false => format!("<h2>Pictures</h2>\n{html}"),
        }
    }

    fn energy(&self) -> String {
        let (sum, channels) = (&self.report.power, &self.report.power_rgb);
        let mut html = format!(
            "<h2>Energy</h2>\n<table>\n{}",
            header(&["", "W", "share", "red W", "green W", "blue W"])
        );
        for (name, of) in PARTS {
            let share = 100.0 * of(sum) / sum.emitted.max(f64::MIN_POSITIVE);
            let channel = |number: usize| {
                let one = PowerReport {
                    emitted: channels.emitted[number],
                    absorbed: channels.absorbed[number],
                    escaped: channels.escaped[number],
                    onto_backs: channels.onto_backs[number],
                    unshot: channels.unshot[number],
                    residual: channels.residual[number],
                };
                rounded(of(&one), 6)
            };
            let [watts, share] = [rounded(of(sum), 6), rounded(share, 2) + " %"];
            let [r, g, b] = [0, 1, 2].map(channel);
            html += &row(&[name, &watts, &share, &r, &g, &b], &[1, 2, 3, 4, 5]);
        }
        html + "</table>\n"
    }

    fn convergence(&self) -> String {
        let History { moments, estimates } = self.history;
        let rounds: Vec<Vec<&Moment>> = moments
            .chunk_by(|a, b| a.round == b.round)
            .map(thinned)
            .collect();
        let curves = |x: fn(&Moment) -> f64| {
            let curve = |round: &Vec<&Moment>| round.iter().map(|m| (x(m), m.unshot)).collect();
            rounds.iter().map(curve).collect()
        };
        let shots = Plot {
            across: "shots",
            up: "unshot power",
            curves: curves(|m| m.shots as f64),
            marks: estimates
                .iter()
                .map(|e| (e.shots as f64, e.n_rms))
                .collect(),
            name: "estimated error",
        };
        let seconds = Plot {
            across: "seconds",
            curves: curves(|m| m.seconds),
            marks: estimates.iter().map(|e| (e.seconds, e.n_rms)).collect(),
            ..shots.clone()
        };
        let plots = shots.svg() + &seconds.svg();
        match plots.is_empty() {
            true => plots,
            false => format!("<h2>Convergence</h2>\n<div class=\"plots\">\n{plots}</div>\n"),
        }
    }

    fn quality(&self) -> String {
        let Some(audit) = self.report.audit else {
            return String::new();
        };
        let span =
            |least: f64, mean: f64, most: f64| format!("{least:.4} to {most:.4}, mean {mean:.4}");
        let received = &audit.received_sum;
        let mut rows = vec![
            (
                "estimated error of the irradiance",
                format!(
                    "{:.2} % nRMS, of it {:+.2} % bias, at {}",
                    100.0 * audit.n_rms,
                    100.0 * audit.bias,
                    counted(audit.points, "point", "points")
                ),
            ),
            (
                "mean irradiance",
                format!("{:.6} W/m² a channel", audit.mean_irradiance),
            ),
            (
                "form factors from a point to all (1 in a closed scene)",
                span(received.least, received.mean, received.most),
            ),
        ];
        if let Some(sent) = &audit.sent_sum {
            rows.push((
                "arrived and escaped over sent, by patch (1)",
                span(sent.least, sent.mean, sent.most),
            ));
        }
        if let Some(target) = &self.report.target {
            let reached = if target.reached {
                "reached"
            } else {
                "not reached"
            };
            let text = format!(
                "{:.2} %, {reached} in {}",
                100.0 * target.n_rms,
                counted(target.rounds, "solve", "solves")
            );
            rows.push(("error asked for", text));
        }
        let rows = rows.iter().map(|(name, value)| row(&[name, value], &[]));
        format!(
            "<h2>Accuracy</h2>\n<table>\n{}</table>\n",
            rows.collect::<String>()
        )
    }

    fn options(&self) -> String {
        let options = serde_json::to_value(&self.report.options).unwrap_or_default();
        let mut rows = String::new();
        for (name, value) in options.as_object().into_iter().flatten() {
            if let (Some(inner), None) = (value.as_object(), seconds(value)) {
                for (name, value) in inner {
                    rows += &row(&[name, &plain(value)], &[1]);
                }
            } else {
                rows += &row(&[name, &plain(value)], &[1]);
            }
        }
        format!("<h2>Options</h2>\n<table>\n{rows}</table>\n")
    }
}

/// A line of the ledger.
type Part = (&'static str, fn(&PowerReport<f64>) -> f64);

const PARTS: [Part; 6] = [
    ("emitted", |power| power.emitted),
    ("absorbed by surfaces", |power| power.absorbed),
    ("escaped", |power| power.escaped),
    ("… of it onto dark backs", |power| power.onto_backs),
    ("unshot", |power| power.unshot),
    ("left over (error of the discretisation)", |power| {
        power.residual
    }),
];

/// At most some hundred moments, the first and the last among them.
fn thinned(history: &[Moment]) -> Vec<&Moment> {
    const MOST: usize = 400;
    let step = history.len().div_ceil(MOST).max(1);
    let mut kept: Vec<&Moment> = history.iter().step_by(step).collect();
    kept.extend(history.last().filter(|last| kept.last() != Some(last)));
    kept
}

/// What a duration is in JSON.
fn seconds(value: &Value) -> Option<f64> {
    let (whole, nanos) = (value.get("secs")?.as_f64()?, value.get("nanos")?.as_f64()?);
    Some(whole + 1e-9 * nanos)
}

fn plain(value: &Value) -> String {
    if let Some(seconds) = seconds(value) {
        return format!("{seconds} s");
    }
    match value {
        Value::Null => "none".into(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
