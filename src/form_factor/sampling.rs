//! What a block of points receives from one source: adaptive source sampling with occlusion rays.
//!
//! 1. For each point, split the cells of the source, without a ray, until the estimate of each is small and would not
//!    change by splitting it once more.
//! 2. Send one ray to each cell, jittered inside it. All points of the block go level by level, so rays fill packets.
//! 3. Where some rays arrive and some do not, split the cells that disagree with a neighbour and go to 2.

use super::hybrid::{Formula, Receiver, Sight, point_in_cut};
use super::source::{CellIndex, DEEPEST, Source};
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
    /// Whether the thresholds are form factors, as in the paper, rather than irradiances (F · ΔB, largest channel).
    pub raw: bool,
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

const GATE: f64 = 0.05;
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
    pub fn gather(&self, source: &Source, receivers: &[(Receiver, u32)], scratch: &mut Scratch, gathers: &mut Vec<Gather>) -> u64 {
        scratch.leaves.resize_with(receivers.len().max(scratch.leaves.len()), Vec::new);
        scratch.fresh.clear();
        for (i, (receiver, _)) in receivers.iter().enumerate() {
            scratch.leaves[i].clear();
            self.partition(source, *receiver, &mut scratch.leaves[i]);
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
                let Scratch { leaves, fresh, state, .. } = scratch;
                fresh[i] = self.split_disagreeing(source, *receiver, &mut leaves[i], state);
            }
        }
        gathers.clear();
        gathers.extend(scratch.leaves[..receivers.len()].iter().map(|leaves| sum(leaves)));
        rays
    }

    /// Step 1: the cells for one point, found without rays.
    fn partition(&self, source: &Source, receiver: Receiver, leaves: &mut Vec<Leaf>) {
        let mut pending: Vec<(CellIndex, Sight)> = Vec::with_capacity(64);
        let look = |cell| (cell, self.formula.sight(receiver, source.cell(cell), source.normal()));
        pending.extend((1..=4).rev().map(look));
        while let Some((cell, sight)) = pending.pop() {
            if sight.form_factor <= 0.0 {
                continue;
            }
            let mut leaf = self.leaf(source, cell, &sight);
            if source.has_children(cell) {
                if f64::from(leaf.measure) > self.thresholds.estimate {
                    pending.extend(children(cell).rev().map(look));
                    continue;
                }
                if self.may_differ(source, &leaf, &sight) {
                    let parts = children(cell).map(look);
                    let refined: Spectrum = parts.clone().map(|(c, s)| source.cell(c).radiosity * s.form_factor as f32).sum();
                    let factor: f64 = parts.clone().map(|(_, s)| s.form_factor).sum();
                    let difference = if self.thresholds.raw {
                        (factor - sight.form_factor).abs()
                    } else {
                        f64::from((refined - leaf.contribution).abs().max_element())
                    };
                    if difference > self.thresholds.difference {
                        pending.extend(parts.rev());
                        continue;
                    }
                    // The finer estimate is at hand, and what is left of its second-order error is a third of the difference.
                    leaf.contribution = (refined + (refined - leaf.contribution) / 3.0).max(Spectrum::ZERO);
                    leaf.aimed = leaf.contribution;
                }
            }
            leaves.push(leaf);
        }
    }

    fn leaf(&self, source: &Source, cell: CellIndex, sight: &Sight) -> Leaf {
        let of = source.cell(cell);
        let contribution = of.radiosity * sight.form_factor as f32;
        let measure = if self.thresholds.raw { sight.form_factor as f32 } else { contribution.max_element() };
        let area = sight.cut.as_ref().map_or(of.area, |cut| crate::geometry::polygon::vector_area(cut.corners()).length());
        Leaf { cell, contribution, aimed: contribution, measure, area: area as f32, seen: false }
    }

    /// Whether a bound on the difference between a cell and its sub-cells leaves the paper's first test open.
    fn may_differ(&self, source: &Source, leaf: &Leaf, sight: &Sight) -> bool {
        let of = source.cell(leaf.cell);
        let variation = if self.thresholds.raw { 0.0 } else { f64::from(of.variation) * sight.form_factor };
        f64::from(leaf.measure) * sight.uncertainty + variation > self.thresholds.difference * GATE
    }

    /// Step 2: a ray to each fresh leaf of each point.
    fn trace(&self, source: &Source, receivers: &[(Receiver, u32)], scratch: &mut Scratch) -> u64 {
        let Scratch { leaves, fresh, fans, owners, masks, .. } = scratch;
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
        // A cell cut by the horizon is rare: clip it again rather than carry the cut along.
        let whole = leaf.area >= cell.area as f32;
        let cut = (!whole).then(|| self.formula.sight(receiver, cell, source.normal()).cut).flatten();
        if whole && cell.variation > 0.0 {
            let mean = cell.radiosity.max(Spectrum::splat(f32::MIN_POSITIVE));
            leaf.aimed = leaf.contribution * (source.radiosity_at(leaf.cell, s, t) / mean);
        }
        let point = cut.map_or_else(|| cell.at(s, t), |cut| receiver.point + point_in_cut(&cut, s, t));
        lift(point, source.normal(), self.extent).as_vec3()
    }

    /// Step 3: replaces leaves that disagree with a neighbour by their children, at the end; gives where those begin.
    fn split_disagreeing(&self, source: &Source, receiver: Receiver, leaves: &mut Vec<Leaf>, state: &mut [State]) -> usize {
        let seen = leaves.iter().filter(|leaf| leaf.seen).count();
        if seen == 0 || seen == leaves.len() {
            return leaves.len();
        }
        for leaf in leaves.iter() {
            state[leaf.cell as usize] = if leaf.seen { State::Seen } else { State::Occluded };
            mark_ancestors(leaf.cell, state, State::Split);
        }
        let splits = |leaf: &Leaf| {
            f64::from(leaf.measure) > self.thresholds.difference
                && source.has_children(leaf.cell)
                && source.neighbours(leaf.cell).iter().flatten().any(|n| disagrees(*n, state[leaf.cell as usize], state))
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
            let sight = self.formula.sight(receiver, source.cell(cell), source.normal());
            if sight.form_factor > 0.0 {
                leaves.push(self.leaf(source, cell, &sight));
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
        State::Split => children(cell).any(|child| state.get(child as usize).is_some_and(|s| *s != State::Outside) && disagrees(child, own, state)),
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
