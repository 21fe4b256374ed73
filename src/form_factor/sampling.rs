//! What a block of points receives from one source: adaptive source sampling with occlusion rays.
//!
//! 1. For each point, split the cells of the source, without a ray, until the estimate of each is small and would not
//!    change by splitting it once more (`partition.rs`).
//! 2. Send one ray to each cell, jittered inside it. All points of the block go level by level, so rays fill packets.
//! 3. Where some rays arrive and some do not, split the cells that disagree with a neighbour (`disagreement.rs`) and go to 2.

use super::disagreement::State;
use super::hybrid::{Formula, Receiver, above_horizon, point_in_cut};
use super::partition::{Limits, SourceThresholds};
use super::source::{CellIndex, DEEPEST, Source};
use crate::geometry::{jitter, lift};
use crate::radiometry::Spectrum;
use crate::visibility::{Fans, MAX_FAN, Visibility};

/// What a point receives from one source.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Gather {
    /// Irradiance that arrives.
    pub irradiance: Spectrum,
    /// Irradiance that would arrive if nothing were in between.
    pub unoccluded: Spectrum,
    /// Visibility index: the fraction of the source, above the horizon and from in front, that is seen; `None` where nothing is
    /// above the horizon.
    pub visibility: Option<f32>,
}

impl Gather {
    /// The mean of what some points receive.
    pub fn mean(of: &[Self]) -> Self {
        let indices = of.iter().filter_map(|g| g.visibility);
        let known = indices.clone().count();
        let count = of.len() as f32;
        Self {
            irradiance: of.iter().map(|g| g.irradiance).sum::<Spectrum>() / count,
            unoccluded: of.iter().map(|g| g.unoccluded).sum::<Spectrum>() / count,
            visibility: (known > 0).then(|| indices.sum::<f32>() / known as f32),
        }
    }
}

/// Evaluates sources at points.
pub struct Sampler<'a> {
    /// Who answers the rays.
    pub visibility: &'a dyn Visibility,
    /// Extent of the scene, for the offset of ray ends.
    pub extent: f64,
    /// Which form factor.
    pub formula: Formula,
    /// When cells are split.
    pub thresholds: SourceThresholds,
}

/// A cell that is not split for one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaf {
    pub(super) cell: CellIndex,
    /// Irradiance from the cell if it is seen.
    pub(super) contribution: Spectrum,
    /// What is compared with the thresholds.
    pub(super) measure: f32,
    /// Area above the horizon.
    pub(super) area: f32,
    /// Whether the horizon cuts the cell.
    pub(super) cut: bool,
    pub(super) seen: bool,
}

/// Memory of a thread, reused between blocks.
pub struct Scratch {
    leaves: Vec<Vec<Leaf>>,
    limits: Vec<Limits>,
    pending: Vec<CellIndex>,
    fresh: Vec<usize>,
    state: Vec<State>,
    fans: Fans,
    owners: Vec<(u32, u32)>,
    masks: Vec<u64>,
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            leaves: Vec::new(),
            limits: Vec::new(),
            pending: Vec::new(),
            fresh: Vec::new(),
            state: vec![State::Outside; (1 << (2 * (DEEPEST + 1))) / 3],
            fans: Fans::default(),
            owners: Vec::new(),
            masks: Vec::new(),
        }
    }
}

impl Sampler<'_> {
    /// Evaluates `source` at each receiver into `gathers`; returns the number of rays. Keys seed the jitter of each receiver.
    pub fn gather(
        &self,
        source: &Source,
        receivers: &[(Receiver, u32)],
        scratch: &mut Scratch,
        gathers: &mut Vec<Gather>,
    ) -> u64 {
        scratch
            .leaves
            .resize_with(receivers.len().max(scratch.leaves.len()), Vec::new);
        scratch.fresh.clear();
        scratch.limits.clear();
        for (i, (receiver, _)) in receivers.iter().enumerate() {
            scratch.leaves[i].clear();
            let limits = self.limits(source, *receiver);
            self.partition(
                source,
                *receiver,
                limits,
                &mut scratch.pending,
                &mut scratch.leaves[i],
            );
            scratch.limits.push(limits);
            scratch.fresh.push(0);
        }
        let mut rays = 0;
        loop {
            let traced = self.trace(source, receivers, scratch);
            rays += traced;
            if traced == 0 {
                break;
            }
            for (i, (receiver, _)) in receivers.iter().enumerate() {
                let Scratch {
                    leaves,
                    limits,
                    fresh,
                    state,
                    ..
                } = scratch;
                fresh[i] =
                    self.split_disagreeing(source, *receiver, limits[i], &mut leaves[i], state);
            }
        }
        gathers.clear();
        let leaves = scratch.leaves[..receivers.len()].iter();
        gathers.extend(
            receivers
                .iter()
                .zip(leaves)
                .map(|((_, key), leaves)| sum(source, *key, leaves)),
        );
        rays
    }

    /// Step 2: a ray to each fresh leaf of each point.
    fn trace(&self, source: &Source, receivers: &[(Receiver, u32)], scratch: &mut Scratch) -> u64 {
        let Scratch {
            leaves,
            fresh,
            fans,
            owners,
            masks,
            ..
        } = scratch;
        fans.clear();
        owners.clear();
        for (i, (receiver, key)) in receivers.iter().enumerate() {
            let origin = lift(receiver.point, receiver.normal, self.extent).as_vec3();
            for (n, leaf) in leaves[i][fresh[i]..].iter().enumerate() {
                if n % MAX_FAN == 0 {
                    fans.begin(origin);
                    owners.push((i as u32, (fresh[i] + n) as u32));
                }
                fans.push(self.target(source, *receiver, *key, leaf));
            }
        }
        self.visibility.occluded(fans, masks);
        for (fan, (owner, first)) in owners.iter().enumerate() {
            for k in 0..fans.range(fan).len() {
                leaves[*owner as usize][*first as usize + k].seen = masks[fan] >> k & 1 == 0;
            }
        }
        fans.segments() as u64
    }

    /// Aims the ray of a leaf.
    fn target(&self, source: &Source, receiver: Receiver, key: u32, leaf: &Leaf) -> glam::Vec3 {
        let [s, t] = place_in(leaf, key);
        let cell = source.cell(leaf.cell);
        // A cell cut by the horizon is rare: clip it again rather than carry the cut along.
        let point = if leaf.cut {
            receiver.point + point_in_cut(&above_horizon(receiver, cell.outline()), s, t)
        } else {
            cell.at(s, t)
        };
        lift(point, source.normal(), self.extent).as_vec3()
    }
}

/// Where in its cell the ray of a leaf is aimed.
fn place_in(leaf: &Leaf, key: u32) -> [f64; 2] {
    jitter(key, leaf.cell).map(|j| 0.05 + 0.9 * j)
}

/// The contribution of a leaf with the radiosity where its ray is aimed instead of the cell's mean.
fn aimed(source: &Source, key: u32, leaf: &Leaf) -> Spectrum {
    let cell = source.cell(leaf.cell);
    if leaf.cut || cell.variation == 0.0 {
        return leaf.contribution;
    }
    let [s, t] = place_in(leaf, key);
    let mean = cell.radiosity.max(Spectrum::splat(f32::MIN_POSITIVE));
    leaf.contribution * (source.radiosity_at(leaf.cell, s, t) / mean)
}

/// Adds up the leaves of a point.
///
/// Where all rays arrive, the cells' means are exact. Where some do not, what is hidden from the point tends to be what is hidden
/// from the light, so the mean of a cell times its visibility would lose light; the radiosity where the ray was aimed does not.
fn sum(source: &Source, key: u32, leaves: &[Leaf]) -> Gather {
    let all = leaves.iter().all(|leaf| leaf.seen);
    let mut gather = Gather::default();
    let (mut seen, mut area) = (0.0, 0.0);
    for leaf in leaves {
        gather.unoccluded += leaf.contribution;
        area += leaf.area;
        if leaf.seen {
            gather.irradiance += if all {
                leaf.contribution
            } else {
                aimed(source, key, leaf)
            };
            seen += leaf.area;
        }
    }
    gather.visibility = (area > 0.0).then(|| seen / area);
    gather
}
