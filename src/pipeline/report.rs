//! The report of a run.

use super::warnings::warnings;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::solution::{EngineReport, PowerReport, Report, Seconds};
use crate::solver::{Ledger, Light, Options, Outcome, StopReason};
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
        resumed_with: Vec::new(),
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
