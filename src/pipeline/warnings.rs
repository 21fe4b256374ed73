//! What a report warns of: of the scene, of its mesh, and of how the solve ended.

use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::solution::Report;
use crate::solver::{FormFactorRule, MeshingEnd, Shooting, StopReason};
use crate::words::counted;

/// The share of the emitted power on sides that do not radiate from which on it is worth a word …
const ONTO_BACKS: f64 = 0.01;

/// … and that which falls on nothing. An open scene may well lose most of its light.
const INTO_THE_OPEN: f64 = 0.99;

/// How the warnings of the end begin, by which those of a session before are told from others.
const BACKS_SAY: &str = "light falls on the backs of surfaces";
const OPEN_SAYS: &str = "light leaves the scene";
const CLUSTERS_SAY: &str = "no effect on patches that shoot as clusters";
const NOTHING_EMITS: &str = "no surface emits light";
const SHOTS_ENDED: &str = "--max-shots ended the solve";
const TIME_ENDED: &str = "--time-limit ended the solve";
const ELEMENTS_ENDED: &str = "--max-elements ended the refinement";
const MEMORY_ENDED: &str = "--memory-limit ended the refinement";
const ERROR_MISSED: &str = "--target-error was not reached";
const OF_THE_END: [&str; 9] = [
    BACKS_SAY,
    OPEN_SAYS,
    CLUSTERS_SAY,
    NOTHING_EMITS,
    SHOTS_ENDED,
    TIME_ENDED,
    ELEMENTS_ENDED,
    MEMORY_ENDED,
    ERROR_MISSED,
];

/// Warns of what is known at the end of a session, and only of that: a session before may have ended with other warnings.
pub(super) fn warn_at_end(report: &mut Report, mesh: &Mesh) {
    forget_the_end(report);
    let ends = [end(report), end_of_meshing(report), target_missed(report)];
    report.warnings.extend(ends.into_iter().flatten());
    warn_of_options(report, mesh);
    warn_of_losses(report);
}

/// Takes out what was warned of when a session before had ended.
pub(super) fn forget_the_end(report: &mut Report) {
    let is_of_the_end = |known: &String| OF_THE_END.iter().any(|begin| known.starts_with(begin));
    report.warnings.retain(|known| !is_of_the_end(known));
}

/// An end before the light has converged that nobody has just asked for.
fn end(report: &Report) -> Option<String> {
    let begin = match report.stop_reason {
        StopReason::MaxShots => SHOTS_ENDED,
        StopReason::TimeLimit => TIME_ENDED,
        StopReason::NoEmitter => return Some(format!("{NOTHING_EMITS}; everything is black")),
        StopReason::Converged | StopReason::Interrupted => return None,
    };
    let unshot = 100.0 * (report.power.unshot / report.power.emitted).abs();
    Some(format!(
        "{begin} before it had converged, after {}: {unshot:.2}% of the emitted power is unshot",
        counted(report.shots, "shot", "shots")
    ))
}

fn end_of_meshing(report: &Report) -> Option<String> {
    let begin = match report.meshing_ended? {
        MeshingEnd::MaxElements => ELEMENTS_ENDED,
        MeshingEnd::MemoryLimit => MEMORY_ENDED,
    };
    Some(format!(
        "{begin} after {}, at {}",
        counted(report.meshing_shots, "shot", "shots"),
        counted(report.elements, "element", "elements")
    ))
}

fn target_missed(report: &Report) -> Option<String> {
    let target = report.target.as_ref().filter(|target| !target.reached)?;
    match report.stop_reason {
        StopReason::NoEmitter => None,
        StopReason::Converged => Some(format!(
            "{ERROR_MISSED}: the estimate is not below {}% after {}",
            100.0 * target.n_rms,
            counted(target.rounds, "solve", "solves")
        )),
        _ => Some(format!(
            "{ERROR_MISSED}: solve {} was cut short",
            target.rounds
        )),
    }
}

/// Warns of options that clusters pass over.
fn warn_of_options(report: &mut Report, mesh: &Mesh) {
    let options = &report.options;
    let idle = [
        (options.raw_form_factors, "raw_form_factors"),
        (options.shooting == Shooting::Mean, "shooting = mean"),
        (
            options.form_factor == FormFactorRule::Polygon,
            "form_factor = polygon",
        ),
    ];
    let idle: Vec<&str> = idle.iter().filter(|o| o.0).map(|o| o.1).collect();
    if options.clusters(mesh) && !idle.is_empty() {
        report.warnings.push(format!(
            "{CLUSTERS_SAY}, as all do with more than {} (cluster_from): {}",
            options.cluster_from,
            idle.join(", ")
        ));
    }
}

/// Warns where much of the light is lost: on the wrong side of surfaces, or as emitters look away from everything.
fn warn_of_losses(report: &mut Report) {
    let power = &report.power;
    let onto_backs = power.onto_backs / power.emitted;
    let into_the_open = (power.escaped - power.onto_backs) / power.emitted;
    if onto_backs > ONTO_BACKS {
        report.warnings.push(format!(
            "{BACKS_SAY} that radiate from the front only: {:.0}% of the emitted power is lost there. If they should be lit, turn them \
             round or say sides = \"both\" in the scene.toml",
            100.0 * onto_backs
        ));
    }
    if into_the_open > INTO_THE_OPEN {
        report.warnings.push(format!(
            "{OPEN_SAYS} without falling on anything: {:.1}% of the emitted power. Emitters radiate from the front: if these should \
             light the scene, turn them round",
            100.0 * into_the_open
        ));
    }
}

const SURFACES: (&str, &str) = ("surface", "surfaces");

/// What the reader found suspicious, and what could not be meshed as it should.
pub(super) fn warnings(scene: &Scene, mesh: &Mesh) -> Vec<String> {
    let mut warnings = scene.warnings.clone();
    for (count, (one, more), what) in [
        (
            mesh.unsplit_contacts,
            SURFACES,
            "not split where others meet: light may leak along the contacts",
        ),
        (
            mesh.uncut_gaps,
            SURFACES,
            "not cut below the rims of what is close in front: light may end there in teeth",
        ),
        (
            mesh.covered_sides,
            ("side", "sides"),
            "in the plane of another that faces the same way left out: light would be reflected there twice",
        ),
    ] {
        if count > 0 {
            warnings.push(format!("{} {what}", counted(count, one, more)));
        }
    }
    warnings
}
