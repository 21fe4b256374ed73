//! `--profile`: where the time of a solve went.

use crate::solution::Report;
use crate::words::counted;

/// A line for each part, with its share of all.
pub(super) fn profile(report: &Report) -> String {
    let seconds = &report.seconds;
    let parts = &seconds.parts;
    let lines = [
        ("load", seconds.load),
        ("build mesh", seconds.build - seconds.engine),
        ("build engine", seconds.engine),
        ("select", parts.selecting),
        ("shoot", parts.shooting),
        ("refine", parts.refining),
        ("gather", parts.gathering),
        ("estimate error", parts.estimating),
        ("write", seconds.write),
    ];
    let all: f64 = lines.iter().map(|(_, seconds)| seconds).sum();
    let share = |part: f64, whole: f64| 100.0 * part / whole.max(1e-9);
    let line = |(name, seconds): &(&str, f64)| {
        let share = share(*seconds, all);
        format!("{name:<15} {seconds:>9.2} s {share:>5.1}%\n")
    };
    let lines: String = lines.iter().map(line).collect();
    let processors = seconds.solve * report.threads as f64;
    let threads = counted(report.threads, "thread", "threads");
    format!(
        "{lines}of {processors:.2} s on {threads} between the first shot and the end, rays took {:.2} s ({:.1}%); form factors, \
         meshing and waiting the rest\n",
        parts.rays,
        share(parts.rays, processors),
    )
}
