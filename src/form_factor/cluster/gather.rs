//! What a block of points receives from all clusters: for each point a cut through the tree, one ray a cluster.

use super::found::Found;
use super::view::{LANES, Mask};
use super::walk::Walk;
use super::{Cluster, Clusters};
use crate::form_factor::hybrid::Receiver;
use crate::form_factor::{Gather, Sampler};
use crate::geometry::lift;
use crate::simd::Isa;
use crate::visibility::{Fans, MAX_FAN};

/// Memory of a thread, reused between blocks.
#[derive(Default)]
pub struct ClusterScratch {
    /// What points walk the tree with.
    pub(super) isa: Isa,
    pending: Vec<(Cluster, Mask)>,
    points: Vec<Found>,
    fans: Fans,
    masks: Vec<u64>,
}

impl Sampler<'_> {
    /// Evaluates `clusters` at each receiver into `gathers`, which are as many; returns the number of rays. With `settled`, neighbours send their rays
    /// to the same places, so that what they find differs by little; else each draws its own, so that the mean of many is right.
    pub fn gather_clusters(
        &self,
        clusters: &Clusters,
        receivers: &[(Receiver, u32)],
        settled: bool,
        scratch: &mut ClusterScratch,
        gathers: &mut [Gather],
    ) -> u64 {
        let ClusterScratch {
            isa,
            pending,
            points,
            fans,
            masks,
        } = scratch;
        if points.len() < receivers.len() {
            points.resize_with(receivers.len(), Found::default);
        }
        let points = &mut points[..receivers.len()];
        for (receivers, points) in receivers.chunks(LANES).zip(points.chunks_mut(LANES)) {
            isa.run(Walk {
                sampler: self,
                clusters,
                receivers,
                settled,
                pending,
                points,
            });
        }
        fans.clear();
        for ((receiver, _), found) in receivers.iter().zip(&*points) {
            let origin = lift(receiver.point, receiver.normal, self.extent).as_vec3();
            for targets in found.targets().chunks(MAX_FAN) {
                fans.begin(origin);
                fans.extend(targets.iter().copied());
            }
        }
        self.visibility.occluded(fans, masks);
        let mut masks = masks.iter().copied();
        for (gather, found) in gathers.iter_mut().zip(points) {
            *gather = found.sum(&mut masks);
        }
        fans.segments() as u64
    }
}
