//! Vertices buried in a solid: they see nothing that radiates, and take no part in the light around them.
//!
//! Where a box stands on a floor, the floor beneath it stays dark. Interpolating towards those vertices would let that
//! darkness leak out along the line of contact, and a shooting floor would lose the light of every cell that the box
//! covers in part. So buried vertices are not evaluated; light is continued to them from the open vertices around, and
//! they have no weight when it is integrated.

use super::Mesh;
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

    /// Plans the continuation: ring by ring from the open vertices, along the edges of the fans.
    pub(super) fn plan_continuation(&mut self) {
        let edges = self.edges_from_buried();
        let is_open = |vertex: &u32| !self.buried[*vertex as usize];
        let beside = |vertex: u32| {
            let first = edges.partition_point(|(from, _)| *from < vertex);
            let edges = edges[first..].iter();
            let edges = edges.take_while(move |(from, _)| *from == vertex);
            edges.map(|(_, to)| *to)
        };
        let mut plan = Continuation::default();
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

    /// The edges of all fans from their buried ends, in order.
    fn edges_from_buried(&self) -> Vec<(u32, u32)> {
        let is_buried = |vertex: &u32| self.buried[*vertex as usize];
        let buried = (0..self.vertices.len() as u32).filter(is_buried);
        let mut patches: Vec<u32> = buried.map(|v| self.vertices.patch_of(v)).collect();
        patches.sort_unstable();
        patches.dedup();
        let edges_of = |leaf: u32| {
            let edges = self
                .fan(leaf)
                .flat_map(|[centre, a, b]| [(centre, a), (a, b), (b, centre)]);
            edges
                .flat_map(|(from, to)| [(from, to), (to, from)])
                .filter(|(from, _)| is_buried(from))
        };
        let elements = self.elements_on(&patches).into_par_iter();
        let is_leaf = |e: &u32| self.elements.is_leaf(*e);
        let leaves = elements.with_min_len(256).filter(is_leaf);
        let edges = leaves.flat_map_iter(edges_of);
        let mut edges: Vec<(u32, u32)> = edges.collect();
        edges.par_sort_unstable();
        edges.dedup();
        edges
    }
}
