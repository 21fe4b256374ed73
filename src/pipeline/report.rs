//! The report of a run.

use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::solution::{EngineReport, PowerReport, Report, Seconds};
use crate::solver::{FormFactorRule, Ledger, Light, Options, Outcome, Shooting, StopReason};
use crate::visibility::Visibility;

/// The report before anything was shot.
pub(super) fn blank(
    scene: &Scene,
    mesh: &Mesh,
    visibility: &dyn Visibility,
    options: Options,
    threads: usize,
) -> Report {
    let engine = visibility.info();
    let nothing = Ledger::default();
    Report {
        scene: scene.name.clone(),
        scene_file: None,
        engine: EngineReport {
            name: engine.name.to_owned(),
            version: engine.version,
            isa: engine.isa,
            packet_width: engine.packet_width,
        },
        threads,
        input_patches: scene.input_polygons,
        patches: mesh.patches.len(),
        shots: 0,
        meshing_shots: 0,
        meshing_ended: None,
        max_depth: mesh.depth(),
        elements: mesh.leaves().count(),
        vertices: mesh.vertices.len(),
        buried_vertices: 0,
        rays: 0,
        seconds: Seconds::default(),
        peak_memory: None,
        stop_reason: StopReason::Interrupted,
        reference_irradiance: 0.0,
        power: PowerReport::new(&nothing, |p| p.element_sum()),
        power_rgb: PowerReport::new(&nothing, |p| p.to_array()),
        audit: None,
        target: None,
        options,
        warnings: warnings(scene, mesh),
    }
}

/// Takes in what a solve has come to; gives back what it takes to go on.
pub(super) fn take_in(
    report: &mut Report,
    outcome: Outcome,
) -> (Mesh, Light, crate::solver::Course) {
    let Outcome {
        mesh,
        light,
        course,
        ledger,
        ..
    } = outcome;
    report.shots = course.shots;
    report.meshing_shots = course.meshing_shots;
    report.meshing_ended = course.meshing_ended;
    report.max_depth = mesh.depth();
    report.elements = mesh.leaves().count();
    report.vertices = mesh.vertices.len();
    report.buried_vertices = mesh.buried.iter().filter(|b| **b).count();
    report.rays = course.rays;
    report.stop_reason = outcome.stop_reason;
    report.reference_irradiance = outcome.reference_irradiance;
    report.power = PowerReport::new(&ledger, |p| p.element_sum());
    report.power_rgb = PowerReport::new(&ledger, |p| p.to_array());
    report.audit = outcome.audit;
    report.seconds.parts += outcome.parts;
    (mesh, light, course)
}

/// The share of the emitted power on sides that do not radiate from which on it is worth a word …
const ONTO_BACKS: f64 = 0.01;

/// … and that which falls on nothing. An open scene may well lose most of its light.
const INTO_THE_OPEN: f64 = 0.99;

/// How the warnings of them begin.
const BACKS_SAY: &str = "light falls on the backs of surfaces";
const OPEN_SAYS: &str = "light leaves the scene";

/// How the warning of options that clusters pass over begins.
const CLUSTERS_SAY: &str = "no effect on patches that shoot as clusters";

/// Warns of what is known at the end of a session, and only of that: a session before may have ended with other warnings.
pub(super) fn warn_at_end(report: &mut Report, mesh: &Mesh) {
    let begins = [BACKS_SAY, OPEN_SAYS, CLUSTERS_SAY];
    let is_of_before = |known: &String| begins.iter().any(|begin| known.starts_with(begin));
    report.warnings.retain(|known| !is_of_before(known));
    warn_of_options(report, mesh);
    warn_of_losses(report);
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

/// What the reader found suspicious, and what could not be meshed as it should.
fn warnings(scene: &Scene, mesh: &Mesh) -> Vec<String> {
    let mut warnings = scene.warnings.clone();
    for (count, of, what) in [
        (
            mesh.unsplit_contacts,
            "surface",
            "not split where others meet: light may leak along the contacts",
        ),
        (
            mesh.uncut_gaps,
            "surface",
            "not cut below the rims of what is close in front: light may end there in teeth",
        ),
        (
            mesh.covered_sides,
            "side",
            "in the plane of another that faces the same way left out: light would be reflected there twice",
        ),
    ] {
        if count > 0 {
            let plural = if count == 1 { "" } else { "s" };
            warnings.push(format!("{count} {of}{plural} {what}"));
        }
    }
    warnings
}
