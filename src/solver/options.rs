//! Every threshold of the method, and three presets.

use crate::form_factor::{DEEPEST, Formula, SourceThresholds, ToleranceScale};
use crate::mesh::{FINEST, Mesh, MeshLimits};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// What a shooting patch gives to a source cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shooting {
    /// The unshot radiosity interpolated there: converges to the true solution.
    Interpolated,
    /// The mean over the patch, as in the paper.
    Mean,
}

/// What ε_d and ε_r are differences of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Irradiance: dark materials are meshed as finely as bright ones.
    Irradiance,
    /// Radiosity, as in the paper.
    Radiosity,
}

/// Which formula gives the form factor of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FormFactorRule {
    /// Eq. (1) beyond the five-times distance, Eq. (2) within.
    Hybrid,
    /// Eq. (1) everywhere.
    Disk,
    /// Eq. (2) everywhere.
    Polygon,
}

/// All options of a solve. Thresholds marked *relative* are multiples of an irradiance between the scene's reference (emitted
/// power over the area of all patches) and the local one; see `local_share`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Test 1, relative: an element is split while its corners differ by more (ε_d).
    pub epsilon_d: f64,
    /// Test 2, relative: … while computed and interpolated light at its centre differ by more (ε_r).
    pub epsilon_r: f64,
    /// Test 3, absolute: … while visibility indices at corners, middles of sides and centre differ by this much (ε_v).
    pub epsilon_v: f64,
    /// Test 3 is asked where the shot, unoccluded, would give more than this; relative.
    pub visibility_significance: f64,
    /// How far relative thresholds follow the light that is there: multiples of reference^(1 - share) · local^share.
    pub local_share: f64,
    /// How the tolerance of tests 1 and 2 grows as elements shrink below the first size h₀: by (h₀/h)^exponent. 0, as in the paper,
    /// bounds the error at every point; 1 shares out the squared error evenly over the area, so that a shadow edge
    /// is followed no further than it matters.
    pub size_exponent: f64,
    /// What tests 1 and 2 compare.
    pub quantity: Quantity,
    /// Where refinement starts and ends.
    pub limits: MeshLimits,
    /// Meshing ends when a shot carries less than this fraction of the emitted power; of emitters that each have less, as many test the
    /// mesh as there are such fractions in what they emit.
    pub meshing_power: f64,
    /// A cell of the source is split while its estimate differs from its sub-cells' by more (ε_fd); relative, or a form
    /// factor with `raw_form_factors`.
    pub epsilon_fd: f64,
    /// … or while its estimate exceeds this (ε_fe); as above.
    pub epsilon_fe: f64,
    /// No cell is split into parts below this fraction of the shooter's area (ε_A).
    pub epsilon_area: f64,
    /// ε_fd and ε_fe are form factors, as in the paper; clusters pass it over.
    pub raw_form_factors: bool,
    /// The formula for form factors; clusters take Eq. (2) where they come down to a single tile, unless it is Eq. (1).
    pub form_factor: FormFactorRule,
    /// The factor of the five-times rule; clusters follow ε_fd in its place.
    pub distance_factor: f64,
    /// What a patch shoots; clusters pass it over.
    pub shooting: Shooting,
    /// The solve is converged when unshot over emitted power falls below this.
    pub tolerance: f64,
    /// After the last shot, light every vertex of the finished mesh once more by every patch.
    pub regather: bool,
    /// Points at which the error is estimated at the end; 0 for no estimate.
    pub audit_points: usize,
    /// With more patches than this, all shoot at once as clusters instead of one after the other.
    #[serde(default = "cluster_from")]
    pub cluster_from: usize,
    /// At most this many shots.
    pub max_shots: Option<u64>,
    /// At most this long.
    pub time_limit: Option<Duration>,
    /// Refinement ends when there are this many leaves; balancing may add a few.
    #[serde(default)]
    pub max_elements: Option<usize>,
    /// Refinement ends when the process, with all results written, would need about this much memory, bytes.
    #[serde(default)]
    pub memory_limit: Option<u64>,
}

/// [`Options::cluster_from`] of all presets.
const fn cluster_from() -> usize {
    2000
}

/// Named sets of options.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// For a look: seconds become tenths.
    Draft,
    /// For pictures and baking.
    Standard,
    /// For references.
    Accurate,
}

impl Preset {
    /// The options of the preset.
    pub const fn options(self) -> Options {
        let standard = Options {
            epsilon_d: 0.14,
            epsilon_r: 0.02,
            epsilon_v: 0.5,
            visibility_significance: 0.5,
            local_share: 0.6,
            size_exponent: 1.0,
            quantity: Quantity::Irradiance,
            limits: MeshLimits {
                initial_size: 0.06,
                max_depth: 10,
                min_size: 0.004,
            },
            meshing_power: 0.003,
            epsilon_fd: 0.004,
            epsilon_fe: 0.02,
            epsilon_area: 1.0 / 1024.0,
            raw_form_factors: false,
            form_factor: FormFactorRule::Hybrid,
            distance_factor: 5.0,
            shooting: Shooting::Interpolated,
            tolerance: 0.002,
            regather: true,
            audit_points: 256,
            cluster_from: cluster_from(),
            max_shots: None,
            time_limit: None,
            max_elements: None,
            memory_limit: None,
        };
        match self {
            Preset::Draft => Options {
                epsilon_d: 0.17,
                epsilon_r: 0.04,
                local_share: 0.5,
                visibility_significance: 1.0,
                limits: MeshLimits {
                    initial_size: 0.25,
                    max_depth: 8,
                    min_size: 0.005,
                },
                meshing_power: 0.004,
                epsilon_fd: 0.008,
                epsilon_fe: 0.04,
                tolerance: 0.006,
                audit_points: 512,
                ..standard
            },
            Preset::Standard => standard,
            Preset::Accurate => Options {
                epsilon_d: 0.045,
                epsilon_r: 0.005,
                epsilon_v: 0.3,
                visibility_significance: 0.2,
                limits: MeshLimits {
                    initial_size: 0.045,
                    max_depth: 12,
                    min_size: 0.001,
                },
                meshing_power: 0.0005,
                epsilon_fd: 0.0005,
                epsilon_fe: 0.004,
                distance_factor: 20.0,
                tolerance: 0.0005,
                ..standard
            },
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Preset::Standard.options()
    }
}

/// Options by name, in JSON; those of `limits` by their own names.
pub type Changes = serde_json::Map<String, serde_json::Value>;

impl Options {
    /// These options with some replaced.
    ///
    /// # Errors
    /// Names an option that does not exist, or a value of the wrong kind.
    pub fn with(&self, changes: &Changes) -> Result<Self, String> {
        let mut all = serde_json::to_value(self).map_err(|e| e.to_string())?;
        for (name, value) in changes {
            let within = match all["limits"].get(name) {
                Some(_) => &mut all["limits"],
                None => &mut all,
            };
            let place = within.get_mut(name);
            *place.ok_or_else(|| format!("there is no option `{name}`"))? = value.clone();
        }
        serde_json::from_value(all).map_err(|e| e.to_string())
    }

    /// Options between the presets and beyond: 0 is draft, 1 standard, 2 accurate, -1 the loosest that are worth their time; in
    /// geometric steps.
    pub fn at(strictness: f64) -> Self {
        let steps = [
            Self::rough(),
            Preset::Draft.options(),
            Preset::Standard.options(),
            Preset::Accurate.options(),
        ];
        let below = (strictness + 1.0).clamp(0.0, 2.0).floor();
        let way = strictness + 1.0 - below;
        let [low, high] = [0, 1].map(|i| &steps[below as usize + i]);
        let between = |of: fn(&Options) -> f64| of(low) * (of(high) / of(low)).powf(way);
        let depth = |of: &Options| f64::from(of.limits.max_depth);
        let nearer = if way < 0.5 { low } else { high };
        Options {
            epsilon_d: between(|o| o.epsilon_d),
            epsilon_r: between(|o| o.epsilon_r),
            epsilon_v: between(|o| o.epsilon_v),
            visibility_significance: between(|o| o.visibility_significance),
            local_share: between(|o| o.local_share),
            limits: MeshLimits {
                initial_size: between(|o| o.limits.initial_size),
                max_depth: (depth(low) + (depth(high) - depth(low)) * way).round() as u32,
                min_size: between(|o| o.limits.min_size),
            },
            meshing_power: between(|o| o.meshing_power),
            epsilon_fd: between(|o| o.epsilon_fd),
            epsilon_fe: between(|o| o.epsilon_fe),
            distance_factor: between(|o| o.distance_factor),
            tolerance: between(|o| o.tolerance),
            ..nearer.clone()
        }
    }

    /// A step below draft.
    const fn rough() -> Self {
        let draft = Preset::Draft.options();
        Self {
            epsilon_d: 0.28,
            epsilon_r: 0.08,
            limits: MeshLimits {
                initial_size: 0.35,
                max_depth: 7,
                min_size: 0.02,
            },
            epsilon_fd: 0.032,
            epsilon_fe: 0.16,
            epsilon_area: 1.0 / 256.0,
            tolerance: 0.008,
            audit_points: 256,
            ..draft
        }
    }

    /// The formula that the options name.
    pub fn formula(&self) -> Formula {
        match self.form_factor {
            FormFactorRule::Hybrid => Formula::Hybrid(self.distance_factor),
            FormFactorRule::Disk => Formula::Disk,
            FormFactorRule::Polygon => Formula::Polygon,
        }
    }

    /// The thresholds for sources; relative ones are multiples of `reference` and of what is there.
    pub(super) fn source_thresholds(&self, reference: f64) -> SourceThresholds {
        SourceThresholds {
            difference: self.epsilon_fd,
            estimate: self.epsilon_fe,
            raw: self.raw_form_factors,
            scale: ToleranceScale {
                reference,
                local_share: self.local_share,
            },
        }
    }

    /// How many times looser tests 1 and 2 are on an element whose longest side is this fraction of the scene's extent.
    pub(super) fn growth(&self, side: f64) -> f64 {
        let shrunk = (self.limits.initial_size / side).max(1.0);
        match self.size_exponent {
            0.0 => 1.0,
            1.0 => shrunk,
            exponent => shrunk.powf(exponent),
        }
    }

    /// Whether the limits allow an element to be split. Many patches are small by the least size of an element, and receive in groups; elements
    /// of the others may be a few times smaller, where the tolerance that grows as they shrink still asks for it.
    pub(super) fn may_split(&self, mesh: &Mesh, element: u32) -> bool {
        let finest = FINEST * self.limits.min_size;
        let is_small = || mesh.is_small(&mesh.patch(mesh.elements.patch_of(element)));
        mesh.may_split(element)
            || self.clusters(mesh) && mesh.may_split_above(element, finest) && !is_small()
    }

    /// Whether a mesh has so many patches that they shoot as clusters.
    pub fn clusters(&self, mesh: &Mesh) -> bool {
        mesh.patches.len() > self.cluster_from
    }

    /// Levels of the source pyramid: the deepest whose cells are not below ε_A, at least one.
    pub fn source_levels(&self) -> u32 {
        let levels = (1.0 / self.epsilon_area).log(4.0) + 1e-9;
        levels.clamp(1.0, f64::from(DEEPEST)) as u32
    }
}
