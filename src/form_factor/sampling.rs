//! What a block of points receives from one source: adaptive source sampling with occlusion rays.
//!
//! 1. For each point, split the cells of the source, without a ray, until the estimate of each is small and would not
//!    change by splitting it once more (`partition.rs`).
//! 2. Send one ray to each cell, jittered inside it. All points of the block go level by level, so rays fill packets.
//! 3. Where some rays arrive and some do not, split the cells that disagree with a neighbour (`disagreement.rs`) and go to 2.

use super::disagreement::Marks;
use super::hybrid::{Formula, Receiver, above_horizon, point_in_cut};
use super::partition::{Pairing, SourceThresholds, Split};
use super::source::{CellIndex, Source};
use crate::geometry::{jitter, lift};
use crate::radiometry::Spectrum;
use crate::simd::{Isa, Kernel};
use crate::visibility::{Fans, MAX_FAN, Visibility};
use glam::{DVec3, Vec3};

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
    /// Where in the cell its ray was aimed; see [`Source::point_at`].
    pub(super) place: [f32; 2],
}

/// Memory of a thread, reused between blocks.
#[derive(Default)]
pub struct Scratch {
    isa: Isa,
    leaves: Vec<Vec<Leaf>>,
    fresh: Vec<usize>,
    pending: Vec<Split>,
    split: Vec<CellIndex>,
    marks: Marks,
    fans: Fans,
    masks: Vec<u64>,
}

/// Step 1 for a block of points.
struct Partition<'a, 'b> {
    sampler: &'a Sampler<'a>,
    source: &'a Source,
    receivers: &'a [(Receiver, u32)],
    scratch: &'b mut Scratch,
    pairings: &'b mut Vec<Pairing<'a>>,
}

impl Kernel for Partition<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<const WIDTH: usize>(self) {
        let Scratch {
            leaves, pending, ..
        } = self.scratch;
        for ((receiver, _), leaves) in self.receivers.iter().zip(leaves) {
            let pairing = self.sampler.pairing(self.source, *receiver);
            leaves.clear();
            pairing.partition(pending, leaves);
            self.pairings.push(pairing);
        }
    }
}

/// Step 2 for a block of points, but for its rays.
struct Aiming<'a, 'b> {
    sampler: &'a Sampler<'a>,
    source: &'a Source,
    receivers: &'a [(Receiver, u32)],
    scratch: &'b mut Scratch,
}

impl Kernel for Aiming<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<const WIDTH: usize>(self) {
        let Self {
            source, receivers, ..
        } = self;
        let extent = self.sampler.extent;
        let Scratch {
            leaves,
            fresh,
            fans,
            ..
        } = self.scratch;
        let offset = lift(DVec3::ZERO, source.normal(), extent).as_vec3();
        fans.clear();
        let points = receivers.iter().zip(leaves).zip(fresh);
        for (((receiver, key), leaves), fresh) in points {
            let origin = lift(receiver.point, receiver.normal, extent).as_vec3();
            for fan in leaves[*fresh..].chunks_mut(MAX_FAN) {
                aim(fan, *key);
                fans.begin(origin);
                let targets = fan.iter().map(|leaf| target(source, *receiver, leaf));
                fans.extend(targets.map(|target| target + offset));
            }
        }
    }
}

/// Step 3 for a block of points.
struct Splitting<'a, 'b> {
    pairings: &'b [Pairing<'a>],
    scratch: &'b mut Scratch,
}

impl Kernel for Splitting<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<const WIDTH: usize>(self) {
        let Scratch {
            leaves,
            fresh,
            split,
            marks,
            ..
        } = self.scratch;
        let points = self.pairings.iter().zip(leaves).zip(fresh);
        // Where the last round has split nothing, there is nothing left to split.
        let open = points.filter(|((_, leaves), fresh)| **fresh < leaves.len());
        for ((pairing, leaves), fresh) in open {
            *fresh = pairing.split_disagreeing(leaves, marks, split);
        }
    }
}

impl Sampler<'_> {
    /// Evaluates `source` at each receiver into `gathers`, which are as many; returns the number of rays. Keys seed the jitter of each receiver.
    pub fn gather(
        &self,
        source: &Source,
        receivers: &[(Receiver, u32)],
        scratch: &mut Scratch,
        gathers: &mut [Gather],
    ) -> u64 {
        let mut rays = self.gather_from(source, receivers, scratch, gathers);
        for core in source.cores() {
            let mut more = vec![Gather::default(); receivers.len()];
            rays += self.gather_from(core, receivers, scratch, &mut more);
            for (gather, of_core) in gathers.iter_mut().zip(more) {
                gather.irradiance += of_core.irradiance;
                gather.unoccluded += of_core.unoccluded;
            }
        }
        rays
    }

    /// The same of one pyramid.
    fn gather_from(
        &self,
        source: &Source,
        receivers: &[(Receiver, u32)],
        scratch: &mut Scratch,
        gathers: &mut [Gather],
    ) -> u64 {
        let isa = scratch.isa;
        let most = receivers.len().max(scratch.leaves.len());
        scratch.leaves.resize_with(most, Vec::new);
        let mut pairings = Vec::with_capacity(receivers.len());
        isa.run(Partition {
            sampler: self,
            source,
            receivers,
            scratch,
            pairings: &mut pairings,
        });
        scratch.fresh.clear();
        scratch.fresh.resize(receivers.len(), 0);
        let mut rays = 0;
        loop {
            let traced = self.trace(source, receivers, scratch);
            rays += traced;
            if traced == 0 {
                break;
            }
            isa.run(Splitting {
                pairings: &pairings,
                scratch,
            });
        }
        for (gather, leaves) in gathers.iter_mut().zip(&scratch.leaves) {
            *gather = sum(source, leaves);
        }
        rays
    }

    /// Step 2: a ray to each fresh leaf of each point.
    fn trace(&self, source: &Source, receivers: &[(Receiver, u32)], scratch: &mut Scratch) -> u64 {
        scratch.isa.run(Aiming {
            sampler: self,
            source,
            receivers,
            scratch,
        });
        let Scratch {
            leaves,
            fresh,
            fans,
            masks,
            ..
        } = scratch;
        self.visibility.occluded(fans, masks);
        let mut masks = masks.iter();
        for (leaves, fresh) in leaves.iter_mut().zip(&*fresh) {
            for (fan, mask) in leaves[*fresh..].chunks_mut(MAX_FAN).zip(&mut masks) {
                for (k, leaf) in fan.iter_mut().enumerate() {
                    leaf.seen = mask >> k & 1 == 0;
                }
            }
        }
        fans.segments() as u64
    }
}

/// Finds where in the cells of a fan the rays to them are aimed.
#[inline(always)]
fn aim(fan: &mut [Leaf], key: u32) {
    let mut cells = [0; MAX_FAN];
    let mut places = [[0.0; 2]; MAX_FAN];
    for (cell, leaf) in cells.iter_mut().zip(&*fan) {
        *cell = leaf.cell;
    }
    for (place, cell) in places.iter_mut().zip(&cells[..fan.len()]) {
        *place = jitter(key, *cell).map(|j| 0.05 + 0.9 * j as f32);
    }
    for (leaf, place) in fan.iter_mut().zip(places) {
        leaf.place = place;
    }
}

/// The point that the ray to a leaf is aimed at.
#[inline(always)]
fn target(source: &Source, receiver: Receiver, leaf: &Leaf) -> Vec3 {
    let [s, t] = leaf.place;
    if !leaf.cut {
        return source.point_at(leaf.cell, s, t);
    }
    // A cell cut by the horizon is rare: clip it again rather than carry the cut along.
    let cut = above_horizon(receiver, source.cell(leaf.cell).outline());
    (receiver.point + point_in_cut(&cut, f64::from(s), f64::from(t))).as_vec3()
}

/// The contribution of a leaf with the radiosity where its ray is aimed instead of the cell's mean.
fn aimed(source: &Source, leaf: &Leaf) -> Spectrum {
    let cell = source.cell(leaf.cell);
    if leaf.cut || cell.variation == 0.0 {
        return leaf.contribution;
    }
    let [s, t] = leaf.place;
    let mean = cell.radiosity.max(Spectrum::splat(f32::MIN_POSITIVE));
    leaf.contribution * (source.radiosity_at(leaf.cell, s, t) / mean)
}

/// Adds up the leaves of a point.
///
/// Where all rays arrive, the cells' means are exact. Where some do not, what is hidden from the point tends to be what is hidden
/// from the light, so the mean of a cell times its visibility would lose light; the radiosity where the ray was aimed does not.
fn sum(source: &Source, leaves: &[Leaf]) -> Gather {
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
                aimed(source, leaf)
            };
            seen += leaf.area;
        }
    }
    gather.visibility = (area > 0.0).then(|| seen / area);
    gather
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form_factor::ToleranceScale;
    use crate::visibility::{Obvhs, Triangles};

    /// A source that is not constant, half hidden, over points that are near and far and see all or a part of it above their horizon.
    #[test]
    fn all_instruction_sets_give_the_same_bits() {
        let corners = [DVec3::ZERO, DVec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::X];
        let finest: Vec<Spectrum> = (0..1024)
            .map(|i| Spectrum::new(i as f32, 1.0, 9.0))
            .collect();
        let blocker = Triangles {
            vertices: [[0.4, -9.0, -0.2], [9.0, 0.5, -0.2], [0.4, 9.0, -0.2]]
                .map(Vec3::from)
                .to_vec(),
            indices: vec![[0, 1, 2]],
        };
        let sampler = Sampler {
            visibility: &Obvhs::new(&blocker).expect("one triangle is enough"),
            extent: 8.0,
            formula: Formula::Hybrid(5.0),
            thresholds: SourceThresholds {
                difference: 1e-3,
                estimate: 1e-2,
                raw: false,
                scale: ToleranceScale {
                    reference: 10.0,
                    local_share: 0.5,
                },
            },
        };
        let receivers: Vec<(Receiver, u32)> = (0..200)
            .map(|i| {
                let [[x, y], [z, a]] = [0, 1].map(|k| jitter(i, k));
                let receiver = Receiver {
                    point: DVec3::new(3.0 * x - 1.0, 3.0 * y - 1.0, -3.0 * z * z),
                    normal: DVec3::new(a - 0.5, 0.3, 1.0 - a).normalize(),
                    irradiance: 0.0,
                };
                (receiver, i)
            })
            .collect();
        for corners in [&corners[..], &corners[..3]] {
            let source = Source::new(corners, DVec3::NEG_Z, 5, &finest);
            let with = |isa: Isa| {
                let mut scratch = Scratch {
                    isa,
                    ..Scratch::default()
                };
                let mut gathers = vec![Gather::default(); receivers.len()];
                let rays = sampler.gather(&source, &receivers, &mut scratch, &mut gathers);
                (rays, gathers)
            };
            let expected = with(Isa::Portable);
            let partly = |g: &Gather| g.visibility.is_some_and(|v| v > 0.0 && v < 1.0);
            assert!(expected.1.iter().filter(|g| partly(g)).count() > 10);
            for isa in Isa::available() {
                assert!(with(isa) == expected, "{isa:?}");
            }
        }
    }
}
