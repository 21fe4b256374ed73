//! What a block of points receives from one source: adaptive source sampling with occlusion rays.
//!
//! 1. For each point, split the cells of the source, without a ray, until the estimate of each is small and would not
//!    change by splitting it once more.
//! 2. Send one ray to each cell, jittered inside it. All points of the block go level by level, so rays fill packets.
//! 3. Where some rays arrive and some do not, split the cells that disagree with a neighbour and go to 2.

use super::disk::point_to_disk;
use super::hybrid::{Formula, Receiver, Sight, above_horizon, point_in_cut};
use super::source::{CellIndex, DEEPEST, Source};
use crate::geometry::polygon::vector_area;
use crate::geometry::{jitter, lift};
use crate::radiometry::Spectrum;
use crate::visibility::{Fans, MAX_FAN, Visibility};

/// When a cell of the source is split; see the paper, section 4.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SourceThresholds {
    /// Split while cell and sub-cells differ by more (ε_fd).
    pub difference: f64,
    /// Split while the estimate exceeds this (ε_fe).
    pub estimate: f64,
    /// Whether the thresholds are form factors, as in the paper, rather than multiples of an irradiance (F · ΔB, largest channel).
    pub raw: bool,
    /// That irradiance.
    pub scale: ToleranceScale,
}

/// The irradiance that relative thresholds are multiples of: between the scene's reference and what is there,
/// `reference^(1 - share) · local^share`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToleranceScale {
    /// The scene's reference irradiance.
    pub reference: f64,
    /// 0 for the reference alone, 1 for the local irradiance alone.
    pub local_share: f64,
}

impl ToleranceScale {
    /// The scale where the irradiance is `local`.
    pub fn at(&self, local: f64) -> f64 {
        if self.local_share == 0.0 {
            self.reference
        } else {
            self.reference * (local / self.reference).powf(self.local_share)
        }
    }
}

/// The thresholds in force at one point, in the unit of what they are compared with.
#[derive(Debug, Clone, Copy, Default)]
struct Limits {
    difference: f64,
    estimate: f64,
}

/// What a point receives from one source.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gather {
    /// Irradiance that arrives.
    pub irradiance: Spectrum,
    /// Irradiance that would arrive if nothing were in between.
    pub unoccluded: Spectrum,
    /// Visibility index: the fraction of the source, above the horizon and from in front, that is seen; `None` where nothing is
    /// above the horizon.
    pub visibility: Option<f32>,
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

/// A difference this much below the threshold is not looked for.
const NEGLIGIBLE: f64 = 1.0 / 16.0;

/// What the four parts of a cell give together.
struct Parts {
    contribution: Spectrum,
    /// How far that is from the cell's own estimate, as the thresholds measure it.
    difference: f64,
}

/// A cell that is not split for one point.
#[derive(Debug, Clone, Copy)]
struct Leaf {
    cell: CellIndex,
    /// Irradiance from the cell if it is seen.
    contribution: Spectrum,
    /// The same with the radiosity where the ray is aimed instead of the cell's mean.
    aimed: Spectrum,
    /// What is compared with the thresholds.
    measure: f32,
    /// Area above the horizon.
    area: f32,
    /// Whether the horizon cuts the cell.
    cut: bool,
    seen: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Outside,
    Split,
    Seen,
    Occluded,
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
        gathers.extend(
            scratch.leaves[..receivers.len()]
                .iter()
                .map(|leaves| sum(leaves)),
        );
        rays
    }

    /// The thresholds at one point: they follow what it has, or what the source would give it if that is more.
    fn limits(&self, source: &Source, receiver: Receiver) -> Limits {
        let SourceThresholds {
            difference,
            estimate,
            raw,
            scale,
        } = self.thresholds;
        if raw {
            return Limits {
                difference,
                estimate,
            };
        }
        let from = |cell| {
            let of = source.cell(cell);
            let factor = point_to_disk(
                receiver.normal,
                of.centroid - receiver.point,
                source.normal(),
                of.area,
            );
            f64::from(of.radiosity.max_element()) * factor
        };
        let unit = scale.at(children(0)
            .map(from)
            .sum::<f64>()
            .max(f64::from(receiver.irradiance)));
        Limits {
            difference: difference * unit,
            estimate: estimate * unit,
        }
    }

    /// Step 1: the cells for one point, found without rays.
    fn partition(
        &self,
        source: &Source,
        receiver: Receiver,
        limits: Limits,
        pending: &mut Vec<CellIndex>,
        leaves: &mut Vec<Leaf>,
    ) {
        pending.clear();
        pending.extend((1..=4).rev());
        while let Some(cell) = pending.pop() {
            let sight = self
                .formula
                .sight(receiver, source.cell(cell), source.normal());
            if sight.form_factor <= 0.0 {
                continue;
            }
            let mut leaf = self.leaf(source, receiver, cell, &sight);
            if source.has_children(cell) {
                if f64::from(leaf.measure) > limits.estimate {
                    pending.extend(children(cell).rev());
                    continue;
                }
                if let Some(parts) = self.parts(source, receiver, limits, &leaf, &sight) {
                    if parts.difference > limits.difference {
                        pending.extend(children(cell).rev());
                        continue;
                    }
                    // The finer estimate is at hand, and a third of the difference is left of its second-order error.
                    let change = parts.contribution - leaf.contribution;
                    leaf.contribution =
                        (leaf.contribution + change * (4.0 / 3.0)).max(Spectrum::ZERO);
                    leaf.aimed = leaf.contribution;
                }
            }
            leaves.push(leaf);
        }
    }

    fn leaf(&self, source: &Source, receiver: Receiver, cell: CellIndex, sight: &Sight) -> Leaf {
        let of = source.cell(cell);
        let contribution = of.radiosity * sight.form_factor as f32;
        let measure = if self.thresholds.raw {
            sight.form_factor as f32
        } else {
            contribution.max_element()
        };
        let area = if sight.cut {
            vector_area(above_horizon(receiver, of).corners()).length()
        } else {
            of.area
        };
        Leaf {
            cell,
            contribution,
            aimed: contribution,
            measure,
            area: area as f32,
            cut: sight.cut,
            seen: false,
        }
    }

    /// The estimate from the four parts of a cell; `None` where a bound shows that it is the cell's own.
    fn parts(
        &self,
        source: &Source,
        receiver: Receiver,
        limits: Limits,
        leaf: &Leaf,
        sight: &Sight,
    ) -> Option<Parts> {
        let cell = source.cell(leaf.cell);
        let variation = if self.thresholds.raw {
            0.0
        } else {
            f64::from(cell.variation) * sight.form_factor
        };
        if f64::from(leaf.measure) * sight.uncertainty + variation <= NEGLIGIBLE * limits.difference
        {
            return None;
        }
        let (mut contribution, mut sum) = (Spectrum::ZERO, 0.0);
        for child in children(leaf.cell) {
            let part = source.cell(child);
            // Eq. (2) has the whole right already; how the parts share it, their centres tell well enough.
            let factor = if sight.uncertainty > 0.0 {
                self.formula
                    .sight(receiver, part, source.normal())
                    .form_factor
            } else {
                point_to_disk(
                    receiver.normal,
                    part.centroid - receiver.point,
                    source.normal(),
                    part.area,
                )
            };
            contribution += part.radiosity * factor as f32;
            sum += factor;
        }
        if sight.uncertainty == 0.0 && sum > 0.0 {
            contribution *= (sight.form_factor / sum) as f32;
            sum = sight.form_factor;
        }
        let difference = if self.thresholds.raw {
            (sum - sight.form_factor).abs()
        } else {
            f64::from((contribution - leaf.contribution).abs().max_element())
        };
        Some(Parts {
            contribution,
            difference,
        })
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
            for (n, leaf) in leaves[i][fresh[i]..].iter_mut().enumerate() {
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
    fn target(&self, source: &Source, receiver: Receiver, key: u32, leaf: &mut Leaf) -> glam::Vec3 {
        let [s, t] = jitter(key, leaf.cell).map(|j| 0.05 + 0.9 * j);
        let cell = source.cell(leaf.cell);
        if !leaf.cut && cell.variation > 0.0 {
            let mean = cell.radiosity.max(Spectrum::splat(f32::MIN_POSITIVE));
            leaf.aimed = leaf.contribution * (source.radiosity_at(leaf.cell, s, t) / mean);
        }
        // A cell cut by the horizon is rare: clip it again rather than carry the cut along.
        let point = if leaf.cut {
            receiver.point + point_in_cut(&above_horizon(receiver, cell), s, t)
        } else {
            cell.at(s, t)
        };
        lift(point, source.normal(), self.extent).as_vec3()
    }

    /// Step 3: replaces leaves that disagree with a neighbour by their children, at the end; gives where those begin.
    fn split_disagreeing(
        &self,
        source: &Source,
        receiver: Receiver,
        limits: Limits,
        leaves: &mut Vec<Leaf>,
        state: &mut [State],
    ) -> usize {
        let seen = leaves.iter().filter(|leaf| leaf.seen).count();
        if seen == 0 || seen == leaves.len() {
            return leaves.len();
        }
        for leaf in leaves.iter() {
            state[leaf.cell as usize] = if leaf.seen {
                State::Seen
            } else {
                State::Occluded
            };
            mark_ancestors(leaf.cell, state, State::Split);
        }
        let splits = |leaf: &Leaf| {
            f64::from(leaf.measure) > limits.difference
                && source.has_children(leaf.cell)
                && source
                    .neighbours(leaf.cell)
                    .iter()
                    .flatten()
                    .any(|n| disagrees(*n, state[leaf.cell as usize], state))
        };
        let split: Vec<Leaf> = leaves.iter().copied().filter(splits).collect();
        for leaf in leaves.iter() {
            state[leaf.cell as usize] = State::Outside;
            mark_ancestors(leaf.cell, state, State::Outside);
        }
        if split.is_empty() {
            return leaves.len();
        }
        let mut next = split.iter().map(|leaf| leaf.cell).peekable();
        leaves.retain(|leaf| next.next_if_eq(&leaf.cell).is_none());
        let fresh = leaves.len();
        for cell in split.iter().flat_map(|leaf| children(leaf.cell)) {
            let sight = self
                .formula
                .sight(receiver, source.cell(cell), source.normal());
            if sight.form_factor > 0.0 {
                leaves.push(self.leaf(source, receiver, cell, &sight));
            }
        }
        fresh
    }
}

fn children(cell: CellIndex) -> impl DoubleEndedIterator<Item = CellIndex> + Clone {
    4 * cell + 1..=4 * cell + 4
}

fn mark_ancestors(mut cell: CellIndex, state: &mut [State], mark: State) {
    while cell > 0 {
        cell = (cell - 1) / 4;
        if state[cell as usize] == mark {
            return;
        }
        state[cell as usize] = mark;
    }
}

/// Whether the leaf that covers `cell`, or any leaf inside it, is in another state than `own`.
fn disagrees(cell: CellIndex, own: State, state: &[State]) -> bool {
    match state[cell as usize] {
        State::Split => children(cell).any(|child| {
            state
                .get(child as usize)
                .is_some_and(|s| *s != State::Outside)
                && disagrees(child, own, state)
        }),
        State::Outside => {
            let mut above = cell;
            while above > 0 {
                above = (above - 1) / 4;
                match state[above as usize] {
                    State::Outside => {}
                    State::Split => return false,
                    other => return other != own,
                }
            }
            false
        }
        other => other != own,
    }
}

/// Adds up the leaves of a point.
///
/// Where all rays arrive, the cells' means are exact. Where some do not, what is hidden from the point tends to be what is hidden
/// from the light, so the mean of a cell times its visibility would lose light; the radiosity where the ray was aimed does not.
fn sum(leaves: &[Leaf]) -> Gather {
    let all = leaves.iter().all(|leaf| leaf.seen);
    let mut gather = Gather::default();
    let (mut seen, mut area) = (0.0, 0.0);
    for leaf in leaves {
        gather.unoccluded += leaf.contribution;
        area += leaf.area;
        if leaf.seen {
            gather.irradiance += if all { leaf.contribution } else { leaf.aimed };
            seen += leaf.area;
        }
    }
    gather.visibility = (area > 0.0).then(|| seen / area);
    gather
}
