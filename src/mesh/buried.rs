//! Vertices buried in a solid: they see nothing that radiates, and take no part in the light around them.
//!
//! Where a box stands on a floor, the floor beneath it stays dark. Interpolating towards those vertices would let that
//! darkness leak out along the line of contact, and a shooting floor would lose the light of every cell that the box
//! covers in part. So buried vertices are not evaluated; light is continued to them from the open vertices around, and
//! they have no weight when it is integrated.

use super::{Mesh, NONE};
use crate::radiometry::Spectrum;
use rayon::prelude::*;

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
        self.continuation = Continuation::default();
        if !self.buried.contains(&true) {
            return;
        }
        let is_buried = |vertex: &u32| self.buried[*vertex as usize];
        let edges_of = |leaf: u32| {
            let of = &self.elements[leaf as usize];
            let hanging = of.hanging.iter().filter(|v| **v != NONE);
            let any = of.vertices().any(|v| is_buried(&v)) || hanging.clone().any(is_buried);
            let fan = any.then(|| self.fan(leaf)).into_iter().flatten();
            fan.flat_map(|[centre, a, b]| [(centre, a), (a, b), (b, centre)])
                .flat_map(|(from, to)| [(from, to), (to, from)])
                .filter(|(from, _)| is_buried(from))
        };
        let mut edges: Vec<(u32, u32)> = (0..self.elements.len() as u32)
            .into_par_iter()
            .with_min_len(1024)
            .filter(|e| self.elements[*e as usize].is_leaf())
            .flat_map_iter(edges_of)
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut ring: Vec<u32> = self
            .buried
            .iter()
            .map(|buried| if *buried { NONE } else { 0 })
            .collect();
        for current in 1.. {
            let before = self.continuation.steps.len();
            for group in edges.chunk_by(|a, b| a.0 == b.0) {
                let vertex = group[0].0;
                if ring[vertex as usize] == NONE {
                    let known = group
                        .iter()
                        .map(|(_, other)| *other)
                        .filter(|other| ring[*other as usize] < current);
                    let count = self.continuation.sources.len();
                    self.continuation.sources.extend(known);
                    if self.continuation.sources.len() > count {
                        ring[vertex as usize] = current;
                        self.continuation
                            .steps
                            .push((vertex, self.continuation.sources.len() as u32));
                    }
                }
            }
            if self.continuation.steps.len() == before {
                return;
            }
        }
    }
}
