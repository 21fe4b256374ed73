//! Every option of a solve as a flag, over a preset.

use super::CliError;
use super::values::{
    bytes, duration, error, fraction, index, named, not_negative, points, positive,
};
use crate::Target;
use crate::solver::{Changes, FormFactorRule, Options, Preset, Quantity, Shooting};
use clap::Args;
use serde::Serialize;
use serde_json::Value;
use std::time::Duration;

/// The flags of a solve, by the names of the options that they replace. What is not given comes from the preset.
#[derive(Debug, Args, Serialize)]
pub(super) struct SolveFlags {
    /// Starting point for all options: draft, standard (the default) or accurate
    #[arg(long, value_parser = named::<Preset>, conflicts_with = "target_error")]
    #[serde(skip)]
    preset: Option<Preset>,
    /// ε_d: split an element while its corners differ by more than this times the tolerance scale
    #[arg(long = "eps-d", value_name = "RELATIVE", value_parser = positive, help_heading = MESHING)]
    epsilon_d: Option<f64>,
    /// ε_r: … while computed and interpolated light at its centre differ by more
    #[arg(long = "eps-r", value_name = "RELATIVE", value_parser = positive, help_heading = MESHING)]
    epsilon_r: Option<f64>,
    /// ε_v: … while visibility indices at its corners, middles of sides and centre differ by this much
    #[arg(long = "eps-v", value_name = "0..1", value_parser = index, help_heading = MESHING)]
    epsilon_v: Option<f64>,
    /// Ask for visibility where a shot, unoccluded, would give more than this
    #[arg(long = "significance", value_name = "RELATIVE", value_parser = positive, help_heading = MESHING)]
    visibility_significance: Option<f64>,
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
    /// Elements below this fraction of the scene's extent are not split; of patches that shoot as clusters, those below it receive in
    /// groups, and elements of the others may be a fifth as small
    #[arg(long, value_name = "FRACTION", value_parser = positive, help_heading = MESHING)]
    min_size: Option<f64>,
    /// Deepest level of a quadtree
    #[arg(long, value_name = "LEVEL", value_parser = clap::value_parser!(u32).range(0..=17), help_heading = MESHING)]
    max_depth: Option<u32>,
    /// Meshing ends when a shot carries less than this fraction of the emitted power; weaker emitters take turns
    #[arg(long, value_name = "FRACTION", value_parser = not_negative, help_heading = MESHING)]
    meshing_power: Option<f64>,
    /// ε_fd: split a cell of the source while it differs from its four parts by more
    #[arg(long = "eps-fd", value_name = "RELATIVE", value_parser = positive, help_heading = FORM_FACTORS)]
    epsilon_fd: Option<f64>,
    /// ε_fe: … or while it gives more than this
    #[arg(long = "eps-fe", value_name = "RELATIVE", value_parser = positive, help_heading = FORM_FACTORS)]
    epsilon_fe: Option<f64>,
    /// ε_A: no cell of the source is smaller than this fraction of the shooter (1/1024 at least)
    #[arg(long = "eps-area", value_name = "FRACTION", value_parser = positive, help_heading = FORM_FACTORS)]
    epsilon_area: Option<f64>,
    /// Take ε_fd and ε_fe for form factors, as in the paper, rather than irradiances; clusters do not
    #[arg(long, help_heading = FORM_FACTORS)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    raw_form_factors: bool,
    /// Formula: hybrid, disk (Eq. 1) or polygon (Eq. 2)
    #[arg(long, value_parser = named::<FormFactorRule>, help_heading = FORM_FACTORS)]
    form_factor: Option<FormFactorRule>,
    /// The factor of the five-times rule; clusters have a rule of their own
    #[arg(long, value_name = "FACTOR", value_parser = positive, help_heading = FORM_FACTORS)]
    distance_factor: Option<f64>,
    /// What a patch shoots: interpolated, or its mean as in the paper; clusters shoot what is interpolated
    #[arg(long, value_parser = named::<Shooting>, help_heading = PROGRESS)]
    shooting: Option<Shooting>,
    /// Converged when unshot over emitted power falls below this
    #[arg(long, value_name = "FRACTION", value_parser = fraction, help_heading = PROGRESS)]
    tolerance: Option<f64>,
    /// Choose the thresholds, in place of a preset, so that the estimated nRMS error of the irradiance is below this
    #[arg(long, value_name = "PERCENT%|FRACTION", value_parser = error, help_heading = PROGRESS)]
    #[serde(skip)]
    target_error: Option<f64>,
    /// After the last shot, light every vertex of the finished mesh once more by every patch
    #[arg(long, value_name = "true|false", help_heading = PROGRESS)]
    regather: Option<bool>,
    /// Points at which the error is estimated at the end; 0 for no estimate. With --target-error 256 at least
    #[arg(long, value_name = "N", value_parser = points, help_heading = PROGRESS)]
    audit_points: Option<usize>,
    /// With more patches than this, all shoot at once as clusters instead of one after the other
    #[arg(long, value_name = "PATCHES", help_heading = PROGRESS)]
    cluster_from: Option<usize>,
    /// Stop after this many shots
    #[arg(long, value_name = "N", help_heading = PROGRESS)]
    max_shots: Option<u64>,
    /// Stop after this time (seconds, or with s, m or h) and keep what there is
    #[arg(long, value_name = "TIME", value_parser = duration, help_heading = PROGRESS)]
    time_limit: Option<Duration>,
    /// Refine no further when there are this many elements
    #[arg(long, value_name = "N", help_heading = MESHING)]
    max_elements: Option<usize>,
    /// Refine no further when the process would need more memory than this (bytes, or with a unit from KB to TB or KiB to TiB); the largest picture counts
    #[arg(long, value_name = "SIZE", value_parser = bytes, help_heading = MESHING)]
    memory_limit: Option<u64>,
}

const MESHING: &str = "Meshing";
const FORM_FACTORS: &str = "Form factors";
const PROGRESS: &str = "Shooting";

impl SolveFlags {
    /// The options of a solve that starts from a preset.
    pub(super) fn options(&self) -> Result<Options, CliError> {
        self.over(Preset::Standard.options())
    }

    /// Whether the options start from a preset that is named.
    pub(super) fn names_preset(&self) -> bool {
        self.preset.is_some()
    }

    /// The options of a solve that starts from others, unless a preset is named.
    pub(super) fn over(&self, options: Options) -> Result<Options, CliError> {
        let start = self.preset.map_or(options, Preset::options);
        start.with(&self.changes()?).map_err(CliError::System)
    }

    /// The error to be reached, if one is named.
    pub(super) fn target(&self) -> Result<Option<Target>, CliError> {
        let fixed = self.changes()?;
        self.with_estimate(self.target_error.map(|n_rms| Target { n_rms, fixed }))
    }

    /// The target, unless the estimate that it takes is to be left out.
    pub(super) fn with_estimate(&self, of: Option<Target>) -> Result<Option<Target>, CliError> {
        match of.is_some() && self.audit_points == Some(0) {
            false => Ok(of),
            true => Err(CliError::Usage(
                "--audit-points 0 leaves out the estimate by which --target-error is reached; give one of the two".into(),
            )),
        }
    }

    /// The options that are given.
    pub(super) fn changes(&self) -> Result<Changes, CliError> {
        match serde_json::to_value(self) {
            Ok(Value::Object(mut given)) => {
                given.retain(|_, value| !value.is_null());
                Ok(given)
            }
            other => Err(CliError::System(format!(
                "flags that are no options: {other:?}"
            ))),
        }
    }
}
