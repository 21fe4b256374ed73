//! Down the quadtree: a shot arrives at the vertices of the coarsest elements, and at those of their parts where it turns out to be rough.
//!
//! Most elements are small because of the shadows of emitters. What other patches reflect onto them is smooth, and where an
//! element's own vertices say so, those of its parts get the interpolant of its fan in place of another look at the source.

use super::arrived::Arrived;
use super::fineness::halvings;
use super::light::Light;
use super::options::Options;
use super::refine::{Range, scale, unit};
use super::shoot::{Beam, Shooter, shoot_at};
use crate::form_factor::{Gather, Source};
use crate::geometry::polygon;
use crate::mesh::{Element, Mesh};
use rayon::prelude::*;

/// A shot is smooth on an element if at its centre it differs from the mean of the corners by no more than this times ε_r …
const RESIDUAL: f64 = 0.5;

/// … and its visibility index by no more than this times ε_v between any two of these: both times what the shot gives there …
const INDEX: f64 = 0.5;

/// … with this part of the scale of all thresholds added, so that what hardly matters is smooth. As tolerances follow what each
/// shot gives, those of all shots add up to the same part of the whole.
const FLOOR: f64 = 0.1;

/// It is taken for rough if the source is not this many times its longest side away.
const NEAR: f64 = 1.0;

/// What all patches reflect together comes from everywhere, also from what is near: it sets out on its way down from elements no longer
/// than this many of the smallest.
pub(super) const WIDEST: f64 = 4.0;

/// One shot on its way down.
pub(super) struct Descent<'a> {
    mesh: &'a Mesh,
    light: &'a Light,
    beam: Beam<'a>,
    options: &'a Options,
    /// What the shot gives to each vertex.
    arrived: &'a mut Arrived,
    is_known: Vec<bool>,
    pub rays: u64,
}

/// What arrives at the corners and the centre of an element.
#[derive(Clone, Copy, Default)]
struct Fan {
    corners: [Gather; 4],
    centre: Gather,
}

impl<'a> Descent<'a> {
    /// Nothing has arrived yet; nothing will at buried vertices.
    pub fn new(
        mesh: &'a Mesh,
        light: &'a Light,
        beam: Beam<'a>,
        options: &'a Options,
        arrived: &'a mut Arrived,
    ) -> Self {
        Self {
            mesh,
            light,
            beam,
            options,
            arrived,
            is_known: mesh.buried.clone(),
            rays: 0,
        }
    }

    /// Evaluates the shot at the vertices of `roots`, level by level at those of rough elements' parts, and lets the rest follow.
    pub fn descend(&mut self, roots: Vec<u32>) {
        let mut smooth = Vec::new();
        let mut level = roots;
        while !level.is_empty() {
            self.evaluate(&level);
            let is_split = |e: &u32| !self.mesh.elements.is_leaf(*e);
            let (rough, rest): (Vec<u32>, Vec<u32>) = level
                .into_par_iter()
                .with_min_len(64)
                .filter(is_split)
                .partition(|e| self.is_rough(*e));
            smooth.extend(rest);
            let parts = |e: u32| self.mesh.element(e).parts();
            level = rough.into_iter().flat_map(parts).collect();
        }
        // The finest last: along a side that it shares with a coarser one, its values are the nearer ones.
        for element in smooth {
            let whole = self.mesh.element(element);
            self.follow(&whole, self.fan(element));
        }
    }

    /// What has arrived at the vertices of an element.
    fn fan(&self, element: u32) -> Fan {
        let of = self.mesh.element(element);
        let mut corners = [Gather::default(); 4];
        for (corner, vertex) in corners.iter_mut().zip(of.corners()) {
            *corner = self.at(*vertex);
        }
        let centre = self.at(of.centre);
        Fan { corners, centre }
    }

    fn at(&self, vertex: u32) -> Gather {
        self.arrived.at(self.mesh.receiver_for(vertex))
    }

    /// Evaluates the shot at those vertices of elements that it has not arrived at.
    fn evaluate(&mut self, elements: &[u32]) {
        let mut fresh = Vec::new();
        for element in elements {
            let side = || self.mesh.longest_side(*element) / self.mesh.frame.extent();
            let times = halvings(self.beam.shooter, side);
            for vertex in self.mesh.element(*element).vertices() {
                if !std::mem::replace(&mut self.is_known[vertex as usize], true) {
                    fresh.push((vertex, times));
                }
            }
        }
        self.rays += shoot_at(self.mesh, self.light, self.beam, &fresh, self.arrived);
    }

    fn is_rough(&self, element: u32) -> bool {
        let of = self.mesh.element(element);
        if of.vertices().any(|v| self.mesh.buried[v as usize]) {
            return true;
        }
        let residual = of.residual(|v| self.at(v).irradiance);
        let residual = f64::from(residual.max_element());
        let Shooter::Patch(source) = self.beam.shooter else {
            // No other shot adds its part to the error of this one.
            let unit = unit(self.mesh, self.light, &self.beam, self.options, element);
            return residual > RESIDUAL * self.options.epsilon_r * unit;
        };
        let arrived = || of.vertices().map(|v| self.arrived.at(v));
        let given = arrived().map(|g| g.irradiance.abs().max_element());
        let given = f64::from(given.fold(0.0, f32::max));
        let tolerance = given + FLOOR * scale(self.mesh, self.light, &self.beam, element);

        if residual > RESIDUAL * self.options.epsilon_r * tolerance {
            return true;
        }
        let unoccluded = arrived().map(|g| g.unoccluded.max_element());
        let unoccluded = f64::from(unoccluded.fold(0.0, f32::max));
        let indices = Range::of(arrived().map(|g| g.visibility));
        indices.width() * unoccluded > INDEX * self.options.epsilon_v * tolerance
            || self.is_near(source, element)
    }

    /// Whether the source is so near that five points may miss where most of its light falls.
    fn is_near(&self, source: &Source, element: u32) -> bool {
        let centre = self.mesh.element(element).centre;
        let centre = self.mesh.position(centre);
        let distance = polygon::distance(centre, source.corners(), source.normal());
        distance < NEAR * self.mesh.longest_side(element)
    }

    /// Gives the vertices of an element's parts what its fan has there: a corner of a part is a corner of the whole, its centre, or
    /// halfway between two corners; the centre of a part is halfway between the whole's and a corner, or the whole's. No leaf is asked.
    /// One thread does that for all: values that go to and fro between two take longer than that.
    fn follow(&mut self, whole: &Element, fan: Fan) {
        let (is_known, arrived) = (&self.is_known, &mut *self.arrived);
        let mut halfway = |vertex: u32, ends: [Gather; 2]| {
            if is_known[vertex as usize] {
                return arrived.at(vertex);
            }
            let gather = Gather::mean(&ends);
            arrived.set(vertex, gather);
            gather
        };
        let count = whole.corners().len();
        let after = |i: usize| (i + 1) % count;
        let before = |i: usize| (i + count - 1) % count;
        let parts = self.mesh.elements.children(whole);
        let mut middles = [Gather::default(); 4];
        // A triangle's fourth part has the whole's own centre.
        let mut centres = [fan.centre; 4];
        for i in 0..count {
            let side = [fan.corners[i], fan.corners[after(i)]];
            middles[i] = halfway(parts[i].corners[after(i)], side);
            centres[i] = halfway(parts[i].centre, [fan.corners[i], fan.centre]);
        }
        for i in (0..4).filter(|i| !parts[*i].is_leaf()) {
            let mut corners = [fan.centre; 4];
            if i < count {
                corners[i] = fan.corners[i];
                corners[after(i)] = middles[i];
                corners[before(i)] = middles[before(i)];
            } else {
                corners[..3].copy_from_slice(&[middles[1], middles[2], middles[0]]);
            }
            let centre = centres[i];
            self.follow(&parts[i], Fan { corners, centre });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::light::Sign;
    use crate::solver::options::Preset;
    use crate::solver::trial::Trial;

    /// What all patches reflect in the box, gathered down the quadtree and at every vertex of a mesh that its emitter has refined.
    #[test]
    fn what_follows_is_what_is_there_to_half_of_the_threshold() {
        let options = Preset::Standard.options();
        let trial = Trial::after(1, options.clone());
        let solver = trial.solver();
        let (mesh, light) = (&solver.mesh, &solver.light);
        let sampler = solver.sampler();
        let (mut followed, mut known) = (
            vec![0.0; mesh.vertices.len()],
            vec![0.0; mesh.vertices.len()],
        );
        let (mut rays_down, mut rays_everywhere) = (0, 0);
        for patch in 0..mesh.patches.len() {
            if mesh.patches.at(patch).exitance.max_element() > 0.0 {
                continue;
            }
            let source = solver.source_of(light, (patch, Sign::Positive), &sampler.thresholds);
            let shooter = Shooter::Patch(source);
            let beam = Beam {
                sampler: &sampler,
                shooter: &shooter,
                sign: Sign::Positive,
            };
            let mut arrived = [0, 1].map(|_| Arrived::nothing(mesh));
            let [below, at] = &mut arrived;
            let mut down = Descent::new(mesh, light, beam, &options, below);
            down.descend(mesh.patches.iter().flat_map(|p| p.roots.clone()).collect());
            let mut everywhere = Descent::new(mesh, light, beam, &options, at);
            everywhere.descend(mesh.leaves().collect());
            rays_down += down.rays;
            rays_everywhere += everywhere.rays;
            for vertex in 0..mesh.vertices.len() {
                followed[vertex] += f64::from(below.irradiance[vertex].max_element());
                known[vertex] += f64::from(at.irradiance[vertex].max_element());
            }
        }
        let squares = |of: &dyn Fn(usize) -> f64| {
            (0..mesh.vertices.len())
                .map(|v| mesh.weights[v] * of(v).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let direct = |v: usize| f64::from(light.irradiance[v].max_element());
        let difference = squares(&|v| followed[v] - known[v]) / squares(&|v| direct(v) + known[v]);
        assert!(
            difference <= RESIDUAL * options.epsilon_r,
            "off by {difference}"
        );
        assert!(
            difference > 0.0 && 3 * rays_down < 2 * rays_everywhere,
            "{rays_down} of {rays_everywhere} rays"
        );
    }
}
