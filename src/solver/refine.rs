//! The three tests, in order of cost, on the elements that a shot has reached.

use super::arrived::Arrived;
use super::behind::Behind;
use super::burial::buried;
use super::feelers::Feeler;
use super::fineness::halvings;
use super::light::Light;
use super::options::{Options, Quantity};
use super::shoot::{Beam, Shooter, evaluate, shoot_at};
use crate::form_factor::Receiver;
use crate::mesh::{Lattice, Mesh, NONE};
use crate::radiometry::Spectrum;
use rayon::iter::Either;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

/// One shot in the middle of its refinement.
pub(super) struct Refinement<'a> {
    pub mesh: &'a mut Mesh,
    pub light: &'a mut Light,
    /// What the shot gave to each vertex so far.
    pub arrived: &'a mut Arrived,
    pub beam: Beam<'a>,
    pub options: &'a Options,
    pub backing: &'a dyn Behind,
    pub feelers: &'a [Feeler],
    /// Elements that may be split.
    pub room: usize,
    pub rays: u64,
}

impl Refinement<'_> {
    /// Tests `candidates` (leaves), splits those that fail and computes the shot at the new vertices; returns the new
    /// leaves, which are to be tested next. Empty when all passed.
    pub fn pass(&mut self, candidates: &[u32]) -> Vec<u32> {
        let may_split =
            |e: &u32| self.mesh.elements.is_leaf(*e) && self.options.may_split(self.mesh, *e);
        let fails = |e: &u32| {
            let scale = self.scale(*e);
            self.nodal_difference(*e, scale) || self.residual(*e, scale)
        };
        let (mut failed, passed): (Vec<u32>, Vec<u32>) = candidates
            .par_iter()
            .with_min_len(64)
            .filter(|e| may_split(e))
            .partition_map(|e| {
                if fails(e) {
                    Either::Left(*e)
                } else {
                    Either::Right(*e)
                }
            });
        if !matches!(self.beam.shooter, Shooter::All { settled: true, .. }) {
            // What hides a part of all light together is a shadow of none.
            failed.extend(self.visibility_differs(&passed));
        }
        failed.extend(self.overlooked());
        failed.sort_unstable();
        failed.dedup();
        if failed.len() > self.room {
            self.keep_largest(&mut failed);
        }
        self.split(failed)
    }

    /// Where there is not room for all, large elements are worth more.
    fn keep_largest(&self, failed: &mut Vec<u32>) {
        let side = |element: &u32| self.mesh.longest_side(*element);
        failed.sort_by(|a, b| side(b).total_cmp(&side(a)));
        failed.truncate(self.room);
        failed.sort_unstable();
    }

    /// Test 1: corners differ by more than ε_d.
    fn nodal_difference(&self, element: u32, scale: f64) -> bool {
        let of = self.mesh.element(element);
        let values = of.corners().iter().map(|v| self.tested(*v));
        let low = values.clone().fold(Spectrum::INFINITY, Spectrum::min);
        let high = values.fold(Spectrum::NEG_INFINITY, Spectrum::max);
        self.exceeds(element, high - low, (self.options.epsilon_d, scale))
    }

    /// Test 2: at the centre, computed and interpolated light differ by more than ε_r. Both are sums over all shots since
    /// the element was made (before that the centre was interpolated), so small lights add up.
    fn residual(&self, element: u32, scale: f64) -> bool {
        let of = self.mesh.element(element);
        let residual = of.residual(|v| self.tested(v));
        self.exceeds(element, residual, (self.options.epsilon_r, scale))
    }

    /// What tests 1 and 2 compare at a vertex: all light, but of a last gathering what that has brought.
    fn tested(&self, vertex: u32) -> Spectrum {
        match self.beam.shooter {
            Shooter::All { settled: true, .. } => self.arrived.irradiance[vertex as usize],
            _ => self.light.irradiance[vertex as usize],
        }
    }

    /// A difference of irradiances on an element in the quantity that is tested, largest channel.
    fn size(&self, element: u32, difference: Spectrum) -> f64 {
        let of = self.mesh.element(element);
        let weight = match self.options.quantity {
            Quantity::Irradiance => Spectrum::ONE,
            Quantity::Radiosity => self.mesh.patch(of.patch).reflectance,
        };
        f64::from((difference * weight).max_element())
    }

    /// Whether a difference on an element is more than `epsilon` times its unit, which is no less than its scale.
    fn exceeds(&self, element: u32, difference: Spectrum, (epsilon, scale): (f64, f64)) -> bool {
        let size = self.size(element, difference);
        size > epsilon * scale
            && size > epsilon * (scale * growth(self.mesh, self.options, element))
    }

    fn scale(&self, element: u32) -> f64 {
        scale(self.mesh, self.light, &self.beam, element)
    }

    /// Test 3: visibility indices at corners, centre and middles of sides differ by ε_v or more.
    fn visibility_differs(&mut self, elements: &[u32]) -> Vec<u32> {
        let matters = |e: &u32| {
            let of = self.mesh.element(*e);
            let threshold = self.options.visibility_significance * self.scale(*e);
            let known = || of.vertices().map(|v| self.arrived.at(v));
            let matters = known().any(|g| f64::from(g.unoccluded.max_element()) > threshold);
            matters.then(|| (*e, Range::of(known().map(|g| g.visibility))))
        };
        let (mut failed, open): (Vec<u32>, Vec<(u32, Range)>) = elements
            .par_iter()
            .with_min_len(64)
            .filter_map(matters)
            .partition_map(|(e, range)| {
                if range.width() >= self.options.epsilon_v {
                    Either::Left(e)
                } else {
                    Either::Right((e, range))
                }
            });
        if let Shooter::All { .. } = self.beam.shooter {
            // The index is of all light together: as the middles of sides would cost as much as splitting does, tests 1 and 2 have
            // to find what is there.
            return failed;
        }
        let middles = self.middles(&open);
        failed.extend(
            open.iter()
                .filter(|(element, range)| {
                    let of = self.mesh.element(*element);
                    let all = of.sides().fold(*range, |range, (side, a, b)| {
                        let known = match of.hanging[side] {
                            NONE => middles
                                .get(&(of.patch, self.middle(a, b)))
                                .copied()
                                .flatten(),
                            vertex => self.arrived.at(vertex).visibility,
                        };
                        range.with(known)
                    });
                    all.width() >= self.options.epsilon_v
                })
                .map(|(element, _)| *element),
        );
        failed
    }

    /// Elements on which a small surface casts a shadow that their vertices know nothing of.
    fn overlooked(&self) -> Vec<u32> {
        let leaf_of = |feeler: &Feeler| self.mesh.leaf_at(feeler.patch, feeler.at.0, feeler.at.1);
        let knows = |feeler: &Feeler, leaf: u32| {
            let arrived = |v: u32| self.arrived.irradiance[v as usize];
            let interpolated = self.mesh.interpolated(leaf, feeler.point, arrived);
            let difference = (feeler.irradiance - interpolated).abs();
            let scale = self.scale(leaf);
            !self.exceeds(leaf, difference, (self.options.epsilon_r, scale))
        };
        let feelers = self.feelers.iter().map(|f| (f, leaf_of(f)));
        feelers
            .filter(|(f, leaf)| {
                self.options.may_split(self.mesh, *leaf)
                    && f.width < self.mesh.longest_side(*leaf)
                    && !knows(f, *leaf)
            })
            .map(|(_, leaf)| leaf)
            .collect()
    }

    fn middle(&self, a: u32, b: u32) -> Lattice {
        let [a, b] = [a, b].map(|v| self.mesh.lattice_of(v));
        a.midpoint(b)
    }

    /// Visibility indices in the middles of the sides, each computed once for both neighbours.
    fn middles(&mut self, elements: &[(u32, Range)]) -> FxHashMap<(u32, Lattice), Option<f32>> {
        let mut middles = Vec::new();
        let mut seen = FxHashSet::default();
        for (element, _) in elements {
            let of = self.mesh.element(*element);
            for (side, a, b) in of.sides() {
                let key = (of.patch, self.middle(a, b));
                if of.hanging[side] == NONE && seen.insert(key) {
                    middles.push((key, [a, b]));
                }
            }
        }
        let receiver = |&((patch, at), ends): &((u32, Lattice), [u32; 2])| {
            let [a, b] = ends.map(|v| self.mesh.point(v));
            let [lit, also] = ends.map(|v| self.light.irradiance[v as usize]);
            let receiver = Receiver {
                point: (a + b) * 0.5,
                normal: self.mesh.patch(patch).normal,
                irradiance: lit.max(also).max_element(),
            };
            // A seed of its own: from the place, as no vertex number is there yet.
            let seed = at.u.wrapping_mul(0x9e37_79b1) ^ at.v.rotate_left(15);
            (receiver, seed ^ patch.rotate_left(7))
        };
        let Beam {
            sampler, shooter, ..
        } = self.beam;
        let (gathers, rays) = evaluate(sampler, shooter, &middles, receiver);
        self.rays += rays;
        let keys = middles.iter().map(|(key, _)| *key);
        keys.zip(gathers.iter().map(|g| g.visibility)).collect()
    }

    /// Splits, then splits more until the quadtree is balanced; new vertices get everything before this shot interpolated
    /// and this shot computed.
    fn split(&mut self, mut elements: Vec<u32>) -> Vec<u32> {
        let first_vertex = self.mesh.vertices.len();
        let mut fresh = Vec::new();
        while !elements.is_empty() {
            for element in elements {
                let first = self.mesh.split(element);
                fresh.extend(first..first + 4);
                self.interpolate_past(element, first);
            }
            elements = self.mesh.unbalanced();
        }
        if fresh.is_empty() {
            return fresh;
        }
        let first = first_vertex as u32;
        let buried = buried(self.mesh, self.beam.sampler.visibility, self.backing, first);
        self.mesh.finish_topology(first, &buried);
        let open: Vec<(u32, u32)> = (first..)
            .zip(self.halvings_around(first, &fresh))
            .filter(|(v, _)| !self.mesh.buried[*v as usize])
            .collect();
        self.rays += shoot_at(self.mesh, self.light, self.beam, &open, self.arrived);
        self.arrived.continue_to_buried(self.mesh, first);
        let arrived = self.arrived.irradiance.iter().enumerate();
        for (vertex, arrived) in arrived.skip(first_vertex) {
            self.light.irradiance[vertex] += *arrived;
            self.light.unshot[vertex] += *arrived;
        }
        fresh.retain(|e| self.mesh.elements.is_leaf(*e));
        fresh
    }

    /// For each vertex from `first` on, how often thresholds are halved for the longest of `elements` around it.
    fn halvings_around(&self, first: u32, elements: &[u32]) -> Vec<u32> {
        let mut most = vec![0; self.mesh.vertices.len() - first as usize];
        for element in elements {
            let side = || self.mesh.longest_side(*element) / self.mesh.frame.extent();
            let times = halvings(self.beam.shooter, side);
            let of = self.mesh.element(*element);
            for vertex in of.vertices().filter(|v| *v >= first) {
                let most = &mut most[(vertex - first) as usize];
                *most = times.max(*most);
            }
        }
        most
    }

    /// Gives the new vertices of a split element what its fan had before this shot.
    fn interpolate_past(&mut self, parent: u32, first_child: u32) {
        let known = self.light.irradiance.len() as u32;
        let count = self.mesh.vertices.len();
        self.light.irradiance.resize(count, Spectrum::ZERO);
        self.light.unshot.resize(count, Spectrum::ZERO);
        self.arrived.grow(count);
        for vertex in known..count as u32 {
            let weighted = self.mesh.interpolate(parent, self.mesh.position(vertex));
            let past = |now: &[Spectrum]| -> Spectrum {
                weighted
                    .iter()
                    .map(|(v, w)| (now[*v as usize] - self.arrived.irradiance[*v as usize]) * *w)
                    .sum()
            };
            let (irradiance, unshot) = (past(&self.light.irradiance), past(&self.light.unshot));
            self.light.irradiance[vertex as usize] = irradiance;
            self.light.unshot[vertex as usize] = unshot;
        }
        debug_assert!(self.mesh.element(parent).children == first_child);
    }
}

/// What ε_d and ε_r are multiples of on an element.
pub(super) fn unit(
    mesh: &Mesh,
    light: &Light,
    beam: &Beam,
    options: &Options,
    element: u32,
) -> f64 {
    scale(mesh, light, beam, element) * growth(mesh, options, element)
}

/// How many times that is the scale.
fn growth(mesh: &Mesh, options: &Options, element: u32) -> f64 {
    options.growth(mesh.longest_side(element) / mesh.frame.extent())
}

/// The irradiance that relative thresholds are multiples of on an element.
pub(super) fn scale(mesh: &Mesh, light: &Light, beam: &Beam, element: u32) -> f64 {
    let of = mesh.element(element);
    let local = of
        .vertices()
        .map(|v| light.irradiance[v as usize].max_element());
    let local = local.fold(0.0, f32::max);
    beam.sampler.thresholds.scale.at(f64::from(local))
}

/// The range of the visibility indices of an element.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    low: f32,
    high: f32,
}

impl Range {
    const EMPTY: Range = Range {
        low: f32::INFINITY,
        high: f32::NEG_INFINITY,
    };

    pub fn of(indices: impl Iterator<Item = Option<f32>>) -> Self {
        indices.fold(Self::EMPTY, Self::with)
    }

    /// A point with nothing of the source above its horizon is left out.
    fn with(self, index: Option<f32>) -> Self {
        index.map_or(self, |v| Range {
            low: self.low.min(v),
            high: self.high.max(v),
        })
    }

    pub fn width(self) -> f64 {
        f64::from(self.high - self.low).max(0.0)
    }
}
