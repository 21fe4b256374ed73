//! Every option of a solve as a flag, over a preset.

use crate::solver::{FormFactorRule, Options, Preset, Quantity, Shooting};
use clap::Args;
use serde::de::DeserializeOwned;
use std::time::Duration;

/// The flags of a solve. What is not given comes from the preset.
#[derive(Debug, Args)]
pub(super) struct SolveFlags {
    /// Starting point for all options: draft, standard or accurate
    #[arg(long, default_value = "standard", value_parser = named::<Preset>)]
    preset: Preset,
    /// ε_d: split an element while its corners differ by more than this times the tolerance scale
    #[arg(long, value_name = "RELATIVE", value_parser = positive, help_heading = MESHING)]
    eps_d: Option<f64>,
    /// ε_r: … while computed and interpolated light at its centre differ by more
    #[arg(long, value_name = "RELATIVE", value_parser = positive, help_heading = MESHING)]
    eps_r: Option<f64>,
    /// ε_v: … while visibility indices at its corners, middles of sides and centre differ by this much
    #[arg(long, value_name = "0..1", value_parser = positive, help_heading = MESHING)]
    eps_v: Option<f64>,
    /// Ask for visibility where a shot, unoccluded, would give more than this
    #[arg(long, value_name = "RELATIVE", value_parser = positive, help_heading = MESHING)]
    significance: Option<f64>,
    /// How far tolerances follow the local light (1) rather than the scene's reference (0)
    #[arg(long, value_name = "0..1", value_parser = fraction, help_heading = MESHING)]
    local_share: Option<f64>,
    /// Tolerances grow as elements shrink, by (h₀/h)^this; 0 as in the paper
    #[arg(long, value_name = "EXPONENT", value_parser = not_negative, help_heading = MESHING)]
    size_exponent: Option<f64>,
    /// What ε_d and ε_r compare: irradiance, or radiosity as in the paper
    #[arg(long, value_parser = named::<Quantity>, help_heading = MESHING)]
    quantity: Option<Quantity>,
    /// First elements are no longer than this fraction of the scene's extent
    #[arg(long, value_name = "FRACTION", value_parser = positive, help_heading = MESHING)]
    initial_size: Option<f64>,
    /// Elements below this fraction of the scene's extent are not split
    #[arg(long, value_name = "FRACTION", value_parser = positive, help_heading = MESHING)]
    min_size: Option<f64>,
    /// Deepest level of a quadtree
    #[arg(long, value_name = "LEVEL", value_parser = clap::value_parser!(u32).range(0..=17), help_heading = MESHING)]
    max_depth: Option<u32>,
    /// Meshing ends when a shot carries less than this fraction of the emitted power
    #[arg(long, value_name = "FRACTION", value_parser = not_negative, help_heading = MESHING)]
    meshing_power: Option<f64>,
    /// ε_fd: split a cell of the source while it differs from its four parts by more
    #[arg(long, value_name = "RELATIVE", value_parser = positive, help_heading = FORM_FACTORS)]
    eps_fd: Option<f64>,
    /// ε_fe: … or while it gives more than this
    #[arg(long, value_name = "RELATIVE", value_parser = positive, help_heading = FORM_FACTORS)]
    eps_fe: Option<f64>,
    /// ε_A: no cell of the source is smaller than this fraction of the shooter (1/1024 at least)
    #[arg(long, value_name = "FRACTION", value_parser = positive, help_heading = FORM_FACTORS)]
    eps_area: Option<f64>,
    /// Take ε_fd and ε_fe for form factors, as in the paper, rather than irradiances
    #[arg(long, help_heading = FORM_FACTORS)]
    raw_form_factors: bool,
    /// Formula: hybrid, disk (Eq. 1) or polygon (Eq. 2)
    #[arg(long, value_parser = named::<FormFactorRule>, help_heading = FORM_FACTORS)]
    form_factor: Option<FormFactorRule>,
    /// The factor of the five-times rule
    #[arg(long, value_name = "FACTOR", value_parser = positive, help_heading = FORM_FACTORS)]
    distance_factor: Option<f64>,
    /// What a patch shoots: interpolated, or its mean as in the paper
    #[arg(long, value_parser = named::<Shooting>, help_heading = PROGRESS)]
    shooting: Option<Shooting>,
    /// Converged when unshot over emitted power falls below this
    #[arg(long, value_name = "FRACTION", value_parser = not_negative, help_heading = PROGRESS)]
    tolerance: Option<f64>,
    /// Choose the thresholds, in place of a preset, so that the estimated nRMS error of the irradiance is below this
    #[arg(long, value_name = "PERCENT%|FRACTION", value_parser = error, help_heading = PROGRESS)]
    pub(super) target_error: Option<f64>,
    /// After the last shot, light every vertex of the finished mesh once more by every patch
    #[arg(long, value_name = "true|false", help_heading = PROGRESS)]
    regather: Option<bool>,
    /// Points at which the error is estimated at the end; 0 for no estimate
    #[arg(long, value_name = "N", help_heading = PROGRESS)]
    audit_points: Option<usize>,
    /// Stop after this many shots
    #[arg(long, value_name = "N", help_heading = PROGRESS)]
    max_shots: Option<u64>,
    /// Stop after this many seconds and keep what there is
    #[arg(long, value_name = "SECONDS", value_parser = positive, help_heading = PROGRESS)]
    time_limit: Option<f64>,
}

const MESHING: &str = "Meshing";
const FORM_FACTORS: &str = "Form factors";
const PROGRESS: &str = "Shooting";

impl SolveFlags {
    /// The options in force.
    pub(super) fn options(&self) -> Options {
        self.over(self.preset.options())
    }

    /// The flags that are given, over options that come from elsewhere.
    pub(super) fn over(&self, preset: Options) -> Options {
        let or = |flag: Option<f64>, preset: f64| flag.unwrap_or(preset);
        Options {
            epsilon_d: or(self.eps_d, preset.epsilon_d),
            epsilon_r: or(self.eps_r, preset.epsilon_r),
            epsilon_v: or(self.eps_v, preset.epsilon_v),
            visibility_significance: or(self.significance, preset.visibility_significance),
            local_share: or(self.local_share, preset.local_share),
            size_exponent: or(self.size_exponent, preset.size_exponent),
            quantity: self.quantity.unwrap_or(preset.quantity),
            limits: crate::mesh::MeshLimits {
                initial_size: or(self.initial_size, preset.limits.initial_size),
                min_size: or(self.min_size, preset.limits.min_size),
                max_depth: self.max_depth.unwrap_or(preset.limits.max_depth),
            },
            meshing_power: or(self.meshing_power, preset.meshing_power),
            epsilon_fd: or(self.eps_fd, preset.epsilon_fd),
            epsilon_fe: or(self.eps_fe, preset.epsilon_fe),
            epsilon_area: or(self.eps_area, preset.epsilon_area),
            raw_form_factors: self.raw_form_factors || preset.raw_form_factors,
            form_factor: self.form_factor.unwrap_or(preset.form_factor),
            distance_factor: or(self.distance_factor, preset.distance_factor),
            shooting: self.shooting.unwrap_or(preset.shooting),
            tolerance: or(self.tolerance, preset.tolerance),
            regather: self.regather.unwrap_or(preset.regather),
            audit_points: self.audit_points.unwrap_or(preset.audit_points),
            max_shots: self.max_shots.or(preset.max_shots),
            time_limit: self
                .time_limit
                .map(Duration::from_secs_f64)
                .or(preset.time_limit),
        }
    }
}

/// A value by the name under which reports show it.
pub(super) fn named<T: DeserializeOwned>(name: &str) -> Result<T, String> {
    serde_json::from_value(name.into()).map_err(|e| e.to_string())
}

/// A fraction, or a percentage with its sign.
fn error(text: &str) -> Result<f64, String> {
    let expected = "an error such as 1% or 0.01";
    let allowed = |x: f64| x > 0.0;
    match text.strip_suffix('%') {
        Some(percent) => number(percent.trim_end(), allowed, expected).map(|x| x / 100.0),
        None => number(text, allowed, expected),
    }
}

fn number(text: &str, allowed: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("expected {expected}"))?;
    if value.is_finite() && allowed(value) {
        Ok(value)
    } else {
        Err(format!("expected {expected}"))
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v < 1e9, "a positive number")
}

pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |v| v >= 0.0, "a number, 0 or more")
}

fn fraction(text: &str) -> Result<f64, String> {
    number(text, |v| (0.0..=1.0).contains(&v), "a number from 0 to 1")
}
