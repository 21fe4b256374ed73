//! Solution files of format 1, as the first versions wrote them: the report in fields of fixed order, nothing to go on from.

use super::file::undecodable;
use super::{EngineReport, PowerReport, Report, Seconds, Solution, TargetReport};
use crate::mesh::{MeshLimits, StoredMesh};
use crate::radiometry::Spectrum;
use crate::scene::Camera;
use crate::solver::{
    Audit, Changes, FormFactorRule, Light, Options, Quantity, Shooting, StopReason,
};
use serde::Deserialize;
use std::time::Duration;

#[derive(Deserialize)]
struct SolutionThen {
    report: ReportThen,
    cameras: Vec<Camera>,
    metres_per_unit: f64,
    mesh: StoredMesh,
    light: LightThen,
}

#[derive(Deserialize)]
struct LightThen {
    irradiance: Vec<Spectrum>,
    unshot: Vec<Spectrum>,
    exitance_unshot: Vec<bool>,
}

#[derive(Deserialize)]
struct ReportThen {
    scene: String,
    engine: EngineReport,
    threads: usize,
    input_patches: usize,
    patches: usize,
    shots: u64,
    meshing_shots: u64,
    max_depth: u32,
    elements: usize,
    vertices: usize,
    buried_vertices: usize,
    rays: u64,
    seconds: SecondsThen,
    stop_reason: StopReason,
    reference_irradiance: f64,
    power: PowerThen<f64>,
    power_rgb: PowerThen<[f64; 3]>,
    audit: Option<Audit>,
    target: Option<TargetThen>,
    options: OptionsThen,
    warnings: Vec<String>,
}

#[derive(Deserialize)]
struct SecondsThen {
    load: f64,
    build: f64,
    solve: f64,
    write: f64,
}

#[derive(Deserialize)]
struct PowerThen<T> {
    emitted: T,
    absorbed: T,
    escaped: T,
    unshot: T,
    residual: T,
}

#[derive(Deserialize)]
struct TargetThen {
    n_rms: f64,
    reached: bool,
    rounds: usize,
}

#[derive(Deserialize)]
struct OptionsThen {
    epsilon_d: f64,
    epsilon_r: f64,
    epsilon_v: f64,
    visibility_significance: f64,
    local_share: f64,
    size_exponent: f64,
    quantity: Quantity,
    limits: MeshLimits,
    meshing_power: f64,
    epsilon_fd: f64,
    epsilon_fe: f64,
    epsilon_area: f64,
    raw_form_factors: bool,
    form_factor: FormFactorRule,
    distance_factor: f64,
    shooting: Shooting,
    tolerance: f64,
    regather: bool,
    audit_points: usize,
    max_shots: Option<u64>,
    time_limit: Option<Duration>,
}

/// Decodes the payload; the parts are not held against each other yet.
pub(super) fn decode(payload: &[u8]) -> Result<Solution, String> {
    let then: SolutionThen = postcard::from_bytes(payload).map_err(undecodable)?;
    let mesh = then.mesh.restored(&[])?;
    let exitance = |(unshot, patch): (&bool, crate::mesh::Patch)| {
        if *unshot {
            patch.exitance
        } else {
            Spectrum::ZERO
        }
    };
    let patches = mesh.patches.iter();
    let exitance_unshot = then.light.exitance_unshot.iter().zip(patches).map(exitance);
    Ok(Solution {
        report: then.report.into(),
        cameras: then.cameras,
        metres_per_unit: then.metres_per_unit,
        light: Light {
            exitance_unshot: exitance_unshot.collect(),
            irradiance: then.light.irradiance,
            unshot: then.light.unshot,
        },
        mesh,
        continuation: None,
    })
}

impl From<ReportThen> for Report {
    fn from(then: ReportThen) -> Self {
        Self {
            scene: then.scene,
            scene_file: None,
            engine: then.engine,
            threads: then.threads,
            input_patches: then.input_patches,
            patches: then.patches,
            shots: then.shots,
            meshing_shots: then.meshing_shots,
            meshing_ended: None,
            max_depth: then.max_depth,
            elements: then.elements,
            vertices: then.vertices,
            buried_vertices: then.buried_vertices,
            rays: then.rays,
            seconds: then.seconds.into(),
            peak_memory: None,
            stop_reason: then.stop_reason,
            reference_irradiance: then.reference_irradiance,
            power: then.power.into(),
            power_rgb: then.power_rgb.into(),
            audit: then.audit,
            target: then.target.map(TargetReport::from),
            options: then.options.into(),
            resumed_with: Vec::new(),
            warnings: then.warnings,
        }
    }
}

impl From<SecondsThen> for Seconds {
    fn from(then: SecondsThen) -> Self {
        Self {
            load: then.load,
            build: then.build,
            solve: then.solve,
            write: then.write,
            ..Self::default()
        }
    }
}

impl<T: Default> From<PowerThen<T>> for PowerReport<T> {
    fn from(then: PowerThen<T>) -> Self {
        Self {
            emitted: then.emitted,
            absorbed: then.absorbed,
            escaped: then.escaped,
            onto_backs: T::default(),
            unshot: then.unshot,
            residual: then.residual,
        }
    }
}

impl From<TargetThen> for TargetReport {
    fn from(then: TargetThen) -> Self {
        Self {
            n_rms: then.n_rms,
            reached: then.reached,
            rounds: then.rounds,
            strictness: 0.0,
            inherited: false,
            fixed: Changes::new(),
        }
    }
}

impl From<OptionsThen> for Options {
    fn from(then: OptionsThen) -> Self {
        Self {
            epsilon_d: then.epsilon_d,
            epsilon_r: then.epsilon_r,
            epsilon_v: then.epsilon_v,
            visibility_significance: then.visibility_significance,
            local_share: then.local_share,
            size_exponent: then.size_exponent,
            quantity: then.quantity,
            limits: then.limits,
            meshing_power: then.meshing_power,
            epsilon_fd: then.epsilon_fd,
            epsilon_fe: then.epsilon_fe,
            epsilon_area: then.epsilon_area,
            raw_form_factors: then.raw_form_factors,
            form_factor: then.form_factor,
            distance_factor: then.distance_factor,
            shooting: then.shooting,
            tolerance: then.tolerance,
            regather: then.regather,
            audit_points: then.audit_points,
            cluster_from: usize::MAX,
            max_shots: then.max_shots,
            time_limit: then.time_limit,
            max_elements: None,
            memory_limit: None,
        }
    }
}
