//! What shoots, evaluated at many vertices.

use super::arrived::Arrived;
use super::fineness::{halved, most_halvings};
use super::light::{Light, Sign};
use super::tiling::Tiling;
use crate::form_factor::{ClusterScratch, Gather, Receiver, Sampler, Scratch, Source};
use crate::geometry::{along_curve, facing};
use crate::mesh::{Mesh, Patch};
use rayon::prelude::*;
use std::cell::RefCell;

/// Points that are evaluated together: enough to fill packets on every level of the source …
const BLOCK: usize = 32;

/// … but of a short list fewer, down to these, so that there are as many blocks as this to share out.
const LEAST_BLOCK: usize = 8;
const SHARES: usize = 32;

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
    static CLUSTER_SCRATCH: RefCell<ClusterScratch> = RefCell::default();
}

/// What shoots.
#[derive(Debug, Clone)]
pub(super) enum Shooter {
    /// One patch.
    Patch(Source),
    /// All patches as clusters; see [`Sampler::gather_clusters`] for `settled`.
    All { tiling: Tiling, settled: bool },
}

/// A shooter as it is sampled, and whether it adds light or takes some away.
#[derive(Clone, Copy)]
pub(super) struct Beam<'a> {
    pub sampler: &'a Sampler<'a>,
    pub shooter: &'a Shooter,
    pub sign: Sign,
}

/// Evaluates `shooter` where `receiver` says that each of `list` receives, and with which seed (of what shoots alone neighbours should follow one
/// another, so that their rays share packets); one result for each, and the number of rays. The same for any number of threads: blocks depend on
/// the list alone.
pub(super) fn evaluate<T: Sync>(
    sampler: &Sampler,
    shooter: &Shooter,
    list: &[T],
    receiver: impl Fn(&T) -> (Receiver, u32) + Sync + Send,
) -> (Vec<Gather>, u64) {
    match shooter {
        Shooter::Patch(source) => block_by_block(list, receiver, |points, gathers| {
            SCRATCH.with_borrow_mut(|scratch| sampler.gather(source, points, scratch, gathers))
        }),
        Shooter::All { tiling, settled } => {
            let points = list.par_iter().with_min_len(256).map(receiver);
            let points: Vec<_> = points.collect();
            let order = side_by_side(&points, sampler.extent);
            let point = |n: &u32| points[*n as usize];
            let (found, rays) = block_by_block(&order, point, |points, gathers| {
                CLUSTER_SCRATCH.with_borrow_mut(|scratch| {
                    sampler.gather_clusters(&tiling.clusters, points, *settled, scratch, gathers)
                })
            });
            let mut gathers = vec![Gather::default(); points.len()];
            for (n, gather) in order.into_iter().zip(found) {
                gathers[n as usize] = gather;
            }
            (gathers, rays)
        }
    }
}

/// The points in an order in which those go through the clusters together that take much the same way: who face alike, along a curve through
/// space.
fn side_by_side(points: &[(Receiver, u32)], extent: f64) -> Vec<u32> {
    let points = points.par_iter().enumerate().with_min_len(1024);
    let mut keyed: Vec<(usize, u64, u32)> = points
        .map(|(n, (of, _))| (facing(of.normal), along_curve(of.point / extent), n as u32))
        .collect();
    keyed.par_sort_unstable();
    keyed.into_iter().map(|(_, _, n)| n).collect()
}

/// What `evaluated` says of all points of a list.
fn block_by_block<T: Sync>(
    list: &[T],
    point: impl Fn(&T) -> (Receiver, u32) + Sync,
    evaluated: impl Fn(&[(Receiver, u32)], &mut [Gather]) -> u64 + Sync,
) -> (Vec<Gather>, u64) {
    let block = (list.len() / SHARES).clamp(LEAST_BLOCK, BLOCK);
    let mut gathers = vec![Gather::default(); list.len()];
    // Each block a task of its own: of several together, one thread would still be at the last ones when nothing is left for the others.
    let blocks = list.par_chunks(block).zip(gathers.par_chunks_mut(block));
    let rays = blocks.with_max_len(1).map(|(list, gathers)| {
        let points: Vec<_> = list.iter().map(&point).collect();
        evaluated(&points, gathers)
    });
    let rays = rays.sum();
    (gathers, rays)
}

/// Evaluates `beam` at the given vertices of `mesh`, each with how often thresholds are halved for it, into `arrived`, which has a place for
/// every vertex; returns the number of rays.
pub(super) fn shoot_at(
    mesh: &Mesh,
    light: &Light,
    beam: Beam,
    vertices: &[(u32, u32)],
    arrived: &mut Arrived,
) -> u64 {
    let mut rays = 0;
    for times in 0..=most_halvings(beam.shooter) {
        let asked = vertices
            .iter()
            .filter(|(v, of)| *of == times && mesh.receives(*v));
        let asked: Vec<u32> = asked.map(|(v, _)| *v).collect();
        let sampler = Sampler {
            thresholds: halved(beam.sampler.thresholds, times),
            ..*beam.sampler
        };
        let receiver = |v: &u32| receiver_at(mesh, light, *v);
        let (gathers, traced) = evaluate(&sampler, beam.shooter, &asked, receiver);
        rays += traced;
        for (vertex, mut gather) in asked.iter().zip(gathers) {
            gather.irradiance *= beam.sign.factor();
            arrived.set(*vertex, gather);
        }
    }
    rays
}

/// A vertex as a receiver.
pub(super) fn receiver_at(mesh: &Mesh, light: &Light, vertex: u32) -> (Receiver, u32) {
    let (point, normal) = mesh.receiver(vertex);
    let irradiance = light.irradiance[vertex as usize].max_element();
    (
        Receiver {
            point,
            normal,
            irradiance,
        },
        vertex,
    )
}

/// Whether any part of `patch` can see any part of the source, planes alone considered.
pub(super) fn faces(patch: &Patch, source: &Source, extent: f64) -> bool {
    let hair = 1e-9 * extent;
    let origin = source.corners()[0];
    let in_front_of_source = patch
        .corners()
        .iter()
        .any(|c| source.normal().dot(*c - origin) > hair);
    let in_front_of_patch = source
        .corners()
        .iter()
        .any(|c| patch.normal.dot(*c - patch.corners()[0]) > hair);
    in_front_of_source && in_front_of_patch
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radiometry::Spectrum;
    use crate::solver::options::Preset;
    use crate::solver::trial::{Trial, all_light, as_clusters};

    #[test]
    fn what_clusters_give_to_a_point_does_not_depend_on_the_others_of_the_list() {
        let trial = Trial::after(1, as_clusters(Preset::Draft));
        let solver = trial.solver();
        let (mesh, light, sampler) = (&solver.mesh, &solver.light, solver.sampler());
        let shooter = all_light(&solver);
        let vertices = 0..mesh.vertices.len() as u32;
        let points: Vec<_> = vertices.map(|v| receiver_at(mesh, light, v)).collect();
        let of = |points: &[(Receiver, u32)]| evaluate(&sampler, &shooter, points, |of| *of);
        let (expected, rays) = of(&points);
        assert!(expected.iter().any(|g| g.irradiance != Spectrum::ZERO));

        let reversed: Vec<_> = points.iter().rev().copied().collect();
        let (mut found, rays_reversed) = of(&reversed);
        found.reverse();
        assert!(found == expected && rays_reversed == rays);
        let third: Vec<_> = points.iter().step_by(3).copied().collect();
        let found = of(&third).0;
        assert!(found.iter().eq(expected.iter().step_by(3)));
    }
}
