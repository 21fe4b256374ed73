//! Vertices buried in a solid: they see nothing that radiates, and take no part in the light around them.
//!
//! Where a box stands on a floor, the floor beneath it stays dark. Interpolating towards those vertices would let that
//! darkness leak out along the line of contact, and a shooting floor would lose the light of every cell that the box
//! covers in part. So buried vertices are not evaluated; light is continued to them from the open vertices around, and
//! they have no weight when it is integrated.

use super::{Mesh, NONE};
use crate::radiometry::Spectrum;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// How light is continued to the buried vertices of a mesh.
#[derive(Debug, Clone, Default)]
pub(super) struct Continuation {
    /// Buried vertices in the order of filling, each with its end in `sources`.
    steps: Vec<(u32, u32)>,
    /// The vertices whose mean each takes.
    sources: Vec<u32>,
}

impl Continuation {
    /// What of it fills vertices that are `wanted`.
    fn of(&self, wanted: impl Fn(u32) -> bool) -> Self {
        let mut part = Self::default();
        let mut begin = 0;
        for &(vertex, end) in &self.steps {
            if wanted(vertex) {
                let sources = &self.sources[begin as usize..end as usize];
                part.sources.extend_from_slice(sources);
                part.steps.push((vertex, part.sources.len() as u32));
            }
            begin = end;
        }
        part
    }
}

impl Mesh {
    /// Continues what `light` is of a value at each vertex from open to buried ones, nearest first, for vertices from `first` on.
    pub fn continue_to_buried<T>(
        &self,
        values: &mut [T],
        light: impl Fn(&mut T) -> &mut Spectrum,
        first: u32,
    ) {
        let mut begin = 0;
        for &(vertex, end) in &self.continuation.steps {
            let sources = &self.continuation.sources[begin as usize..end as usize];
            begin = end;
            if vertex >= first {
                let at = |v: &u32| *light(&mut values[*v as usize]);
                let sum: Spectrum = sources.iter().map(at).sum();
                *light(&mut values[vertex as usize]) = sum / sources.len() as f32;
            }
        }
    }

    /// Plans the continuation on some patches, given in order: ring by ring from the open vertices, along the edges of the fans.
    pub(super) fn plan_continuation(&mut self, patches: &[u32]) {
        let edges = self.edges_from_buried(patches);
        let is_open = |vertex: &u32| !self.buried[*vertex as usize];
        let beside = |vertex: u32| {
            let first = edges.partition_point(|(from, _)| *from < vertex);
            let edges = edges[first..].iter();
            let edges = edges.take_while(move |(from, _)| *from == vertex);
            edges.map(|(_, to)| *to)
        };
        let is_elsewhere = |vertex: u32| {
            let patch = self.vertices.patch_of(vertex);
            patches.binary_search(&patch).is_err()
        };
        let mut plan = self.continuation.of(is_elsewhere);
        let mut filled = FxHashSet::default();
        let outermost = edges.iter().filter(|(_, to)| is_open(to));
        let mut ring: Vec<u32> = outermost.map(|(from, _)| *from).collect();
        ring.dedup();
        while !ring.is_empty() {
            for vertex in &ring {
                let known = beside(*vertex).filter(|v| is_open(v) || filled.contains(v));
                plan.sources.extend(known);
                plan.steps.push((*vertex, plan.sources.len() as u32));
            }
            filled.extend(ring.iter().copied());
            let further = ring.iter().flat_map(|vertex| beside(*vertex));
            let mut further: Vec<u32> = further
                .filter(|v| !is_open(v) && !filled.contains(v))
                .collect();
            further.sort_unstable();
            further.dedup();
            ring = further;
        }
        self.continuation = plan;
    }

    /// The edges of the fans on some patches from their buried ends, in order.
    fn edges_from_buried(&self, patches: &[u32]) -> Vec<(u32, u32)> {
        let is_buried = |vertex: &u32| self.buried[*vertex as usize];
        let is_concerned = |patch: &u32| self.vertices_of(*patch).any(|v| is_buried(&v));
        let patches = patches.par_iter().copied().with_min_len(64);
        let patches: Vec<u32> = patches.filter(is_concerned).collect();
        let edges_of = |leaf: u32| {
            let edges = self
                .fan(leaf)
                .flat_map(|[centre, a, b]| [(centre, a), (a, b), (b, centre)]);
            edges
                .flat_map(|(from, to)| [(from, to), (to, from)])
                .filter(|(from, _)| is_buried(from))
        };
        let elements = self.elements_on(&patches).into_par_iter();
        let is_beside = |e: &u32| {
            let of = self.element(*e);
            let hanging = of.hanging.iter().filter(|v| **v != NONE);
            of.is_leaf() && of.vertices().chain(hanging.copied()).any(|v| is_buried(&v))
        };
        let leaves = elements.with_min_len(256).filter(is_beside);
        let edges = leaves.flat_map_iter(edges_of);
        let mut edges: Vec<(u32, u32)> = edges.collect();
        edges.par_sort_unstable();
        edges.dedup();
        edges
    }
}
