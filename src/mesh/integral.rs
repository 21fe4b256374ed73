//! What a mesh receives: the weights with which values at vertices are integrated.

use super::{Element, Mesh, NONE};
use glam::DVec3;
use rayon::prelude::*;
use std::mem::take;

/// How much of its area a quadrilateral, and a triangle, gives to its centre beyond what the linear interpolant on its fan does, at
/// its corners' expense. Light is mostly curved one way over an element: the interpolant cuts its tops off, and each reflection would
/// lose as much again. With these the integral over a triangle or a parallelogram is exact for polynomials of second
/// degree: a third of the mean of the corners and two thirds of the centre, a quarter and three quarters.
const SAG: [f64; 2] = [1.0 / 3.0, 5.0 / 12.0];

impl Mesh {
    /// By how much the mean of light over a leaf exceeds that of its linear interpolant, as a multiple of how much the centre
    /// exceeds the mean of the corners.
    pub fn sag(&self, leaf: u32) -> f64 {
        SAG[usize::from(self.element(leaf).corners().len() == 3)]
    }

    /// Computes the weights of the vertices of some patches.
    pub(super) fn integrate(&mut self, patches: &[u32]) {
        let leaves = patches.par_iter().flat_map_iter(|patch| {
            let mut leaves = self.leaves_of(&self.patch(*patch));
            // Any way to the same mesh adds in the same order.
            leaves.sort_unstable();
            leaves
        });
        let leaves: Vec<u32> = leaves.collect();
        let triangles = |of: &Element| {
            let patch = self.patch(of.patch);
            let position = |vertex: u32| patch.position(self.lattice_of(vertex));
            let centre = position(of.centre);
            let arms = of.corners.map(|corner| match corner {
                NONE => DVec3::ZERO,
                corner => position(corner) - centre,
            });
            let count = of.corners().len();
            let area = |i: usize| arms[i].cross(arms[(i + 1) % count]).length() / 2.0;
            let mut areas = [0.0; 4];
            (0..count).for_each(|i| areas[i] = area(i));
            areas
        };
        let areas: Vec<[f64; 4]> = leaves
            .par_iter()
            .with_min_len(256)
            .map(|leaf| triangles(&self.element(*leaf)))
            .collect();
        let mut weights = take(&mut self.weights);
        let mut buried_weights = take(&mut self.buried_weights);
        let vertices = patches.iter().flat_map(|p| self.vertices_of(*p));
        weights.reserve(self.vertex_room() - weights.len());
        weights.resize(self.vertices.len(), 0.0);
        vertices.clone().for_each(|v| weights[v as usize] = 0.0);
        for (leaf, areas) in leaves.iter().zip(areas) {
            let of = self.element(*leaf);
            let corners = of.corners();
            let mut whole = 0.0;
            for (i, a, b) in of.sides() {
                let area = areas[i];
                for vertex in [of.centre, a, b] {
                    weights[vertex as usize] += area / 3.0;
                }
                whole += area;
            }
            let sag = whole * SAG[usize::from(corners.len() == 3)];
            weights[of.centre as usize] += sag;
            for corner in corners {
                weights[*corner as usize] -= sag / corners.len() as f64;
            }
        }
        for v in vertices {
            // No less than nothing, but for rounding.
            let weight = &mut weights[v as usize];
            *weight = weight.max(0.0);
            if self.buried[v as usize] {
                buried_weights.insert(v, take(weight));
            }
        }
        (self.weights, self.buried_weights) = (weights, buried_weights);
    }
}
