//! A scene of many patches: all that is unshot is shot at once, as clusters; a wave of light after the other.
//!
//! Direct light arrives at the vertices as a shot does, slice by slice, and refines the mesh as a shot does; so does the gathering at the
//! end, of what is reflected: the direct light stays as it is. What either takes is a cut through the tree of clusters for each
//! vertex, not a visit to each vertex for each patch. The waves in between arrive at neighbourhoods (`bounce.rs`).

use super::arrived::Arrived;
use super::course::{ALL, Bounce, Shot, Stage};
use super::descent::{Descent, WIDEST};
use super::escape::Lost;
use super::groups::{Groups, Member};
use super::light::Sign;
use super::observer::Phase;
use super::run::Solver;
use super::shoot::{Beam, Shooter, evaluate, receiver_at};
use super::tiling::Tiling;
use crate::form_factor::Gather;
use crate::mesh::{Mesh, Patch};
use crate::radiometry::{Power, Spectrum};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Vertices that a wave arrives at between two looks at the observer …
const SLICE: usize = 1 << 16;

/// … and about how many it arrives at for each element that it sets foot on.
const PER_ELEMENT: usize = 8;

/// After a bounce the gathering begins when no more than this many times the tolerance is unshot: what is to come of it is foreseen.
/// With ten times, `staircase2` came a fifth less near to its reference and saved a twentieth of its time.
pub(super) const EARLY: f64 = 4.0;

/// Light in a group may differ by this many times ε_d. In an element as small it may by more (see `size_exponent`), but that is flat.
/// With 1 a draft of `staircase2` takes a fifth longer for the same error, with 25 its error grows by a quarter.
const UNEVEN: f64 = 5.0;

/// A wave that has arrived at the first patches.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Wave {
    pub kind: Kind,
    /// What the tiles send; see [`Tiling::unshot`].
    pub cells: Vec<Spectrum>,
    /// As a fraction of the emitted power.
    pub power: f64,
    /// The first patch that it has not arrived at …
    pub next: u32,
    /// … and how many of the elements of that where it sets foot it has.
    pub within: u32,
    pub arrived: Arrived,
}

impl Wave {
    pub fn is_whole(&self) -> bool {
        matches!(self.kind, Kind::Whole(_))
    }

    /// What is done, for who watches.
    pub fn phase(&self, mesh: &Mesh) -> Phase {
        let (done, of) = (self.next, mesh.patches.len() as u32);
        match self.kind {
            Kind::Unshot(_) => Phase::Shooting,
            Kind::Whole(_) => Phase::Gathering { done, of },
        }
    }
}

/// What a wave carries.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) enum Kind {
    /// What is unshot, of one sign.
    Unshot(Sign),
    /// What is reflected once more, and so many times what is unshot for what is still to come of it; what is emitted too, unless
    /// the direct light is known.
    Whole(Spectrum),
}

impl<'a> Solver<'a> {
    /// Whether there are so many patches that they shoot as clusters.
    pub(super) fn is_clustered(&self) -> bool {
        self.options.clusters(&self.mesh)
    }

    /// All that is `unshot`, by sign, of the stronger one sets out.
    pub(super) fn begin_wave(&mut self, unshot: [Power; 2], after: Option<Bounce>) {
        let of = unshot.map(Power::element_sum);
        let stronger = if of[0] >= of[1] { 0 } else { 1 };
        let (sign, sent) = (Sign::ALL[stronger], unshot[stronger]);
        let tiling = self.tiling();
        let cells = tiling.unshot(&self.mesh, &self.light, sign);
        self.tiling = Some(tiling);
        if self.light.is_direct(sign) {
            // The mesh is refined: its neighbourhoods will be others.
            self.neighbourhoods = None;
            self.course.direct = None;
            let power = sent.element_sum() / self.emitted().element_sum();
            self.set_out(Kind::Unshot(sign), cells, power);
        } else {
            let unshot = unshot[0] - unshot[1];
            let ratio = after.map(|bounce| bounce.ratio_to(unshot));
            self.bounce(sign, &cells, sent, Bounce { unshot, ratio });
        }
    }

    pub(super) fn set_out(&mut self, kind: Kind, cells: Vec<Spectrum>, power: f64) {
        let arrived = match kind {
            Kind::Unshot(_) => Arrived::nothing(&self.mesh),
            Kind::Whole(_) => Arrived::nothing_unseen(&self.mesh),
        };
        self.course.stage = Stage::Waving(Wave {
            kind,
            cells,
            power,
            next: 0,
            within: 0,
            arrived,
        });
    }

    /// The tiles of the mesh, made if there are none yet.
    pub(super) fn tiling(&mut self) -> Tiling {
        let made = self.tiling.take();
        made.unwrap_or_else(|| Tiling::new(&self.mesh))
    }

    /// The tiles as they radiate.
    pub(super) fn radiating(&mut self, cells: &[Spectrum], settled: bool) -> Shooter {
        let kept = self.tiling.take();
        let mut tiling = kept.unwrap_or_else(|| Tiling::for_sent(&self.mesh, cells));
        tiling.radiate(cells, self.course.shots as u32);
        Shooter::All { tiling, settled }
    }

    /// The wave arrives at some more vertices.
    pub(super) fn wave(&mut self, mut wave: Wave) {
        let all = match self.radiated.take() {
            Some(all) => all,
            None => self.radiating(&wave.cells, wave.is_whole()),
        };
        let sampler = self.sampler();
        let beam = Beam {
            sampler: &sampler,
            shooter: &all,
            sign: match wave.kind {
                Kind::Unshot(sign) => sign,
                Kind::Whole(_) => Sign::Positive,
            },
        };
        let (elements, small) = self.next_slice(&mut wave);
        let arrived = &mut wave.arrived;
        let mut descent = Descent::new(&self.mesh, &self.light, beam, &self.options, arrived);
        descent.descend(elements);
        let traced = descent.rays + self.shoot_at_groups(beam, &small, arrived);
        self.course.rays += traced;
        self.radiated = Some(all);
        if wave.next as usize == self.mesh.patches.len() {
            self.arrive(wave);
        } else {
            self.course.stage = Stage::Waving(wave);
        }
    }

    /// The next elements and small patches that a wave arrives at.
    fn next_slice(&self, wave: &mut Wave) -> (Vec<u32>, Vec<u32>) {
        let (mut elements, mut small, mut vertices) = (Vec::new(), Vec::new(), 0);
        while (wave.next as usize) < self.mesh.patches.len() && vertices < SLICE {
            let patch = self.mesh.patch(wave.next);
            if self.mesh.is_small(&patch) {
                small.push(wave.next);
                vertices += self.mesh.vertex_count(wave.next);
            } else {
                let begins = self.begins(wave, &patch);
                let most = (SLICE - vertices).div_ceil(PER_ELEMENT);
                let some = begins.iter().skip(wave.within as usize).take(most);
                let before = elements.len();
                elements.extend(some);
                let taken = elements.len() - before;
                vertices += taken * PER_ELEMENT;
                wave.within += taken as u32;
                if (wave.within as usize) < begins.len() {
                    break;
                }
            }
            wave.next += 1;
            wave.within = 0;
        }
        (elements, small)
    }

    /// Where a wave sets foot on a patch that is not small: what is reflected goes down the quadtree from there as far as it is rough,
    /// shadows of emitters are nowhere foreseen.
    fn begins(&self, wave: &Wave, patch: &Patch) -> Vec<u32> {
        if wave.is_whole() && self.course.direct.is_some() {
            let widest = WIDEST * self.options.limits.min_size * self.mesh.frame.extent();
            return self.mesh.cut(patch, widest);
        }
        self.mesh.leaves_of(patch)
    }

    /// Evaluates `beam` at some of the vertices of small patches, from which the others take it. Returns the number of rays.
    fn shoot_at_groups(&self, beam: Beam, small: &[u32], arrived: &mut Arrived) -> u64 {
        let mesh = &self.mesh;
        let receives = |v: &u32| mesh.receives(*v) && !mesh.buried[*v as usize];
        let vertices = small.iter().flat_map(|patch| mesh.vertices_of(*patch));
        let receiving: Vec<u32> = vertices.filter(receives).collect();
        let mut rays = 0;
        let receive = |nodes: &[u32]| {
            let receiver = |v: &u32| receiver_at(mesh, &self.light, *v);
            let (gathers, traced) = evaluate(beam.sampler, beam.shooter, nodes, receiver);
            rays += traced;
            gathers
        };
        let scale = beam.sampler.thresholds.scale;
        let differ = |nodes: &[(Member, Gather)]| {
            let arrived = || nodes.iter().map(|(_, gather)| gather.irradiance);
            let low = arrived().fold(Spectrum::INFINITY, Spectrum::min);
            let high = arrived().fold(Spectrum::ZERO, Spectrum::max);
            let known = nodes
                .iter()
                .map(|(node, _)| self.light.irradiance[node.vertex as usize]);
            let local = known.fold(high, Spectrum::max).max_element();
            let unit = scale.at(f64::from(local));
            f64::from((high - low).max_element()) > UNEVEN * self.options.epsilon_d * unit
        };
        let found = Groups::new(mesh, &receiving).gather(receive, differ);
        for (vertex, mut gather) in found {
            gather.irradiance *= beam.sign.factor();
            arrived.set(vertex, gather);
        }
        rays
    }

    /// A wave has arrived everywhere.
    fn arrive(&mut self, mut wave: Wave) {
        wave.arrived.share(&self.mesh);
        wave.arrived.continue_to_buried(&self.mesh, 0);
        match wave.kind {
            Kind::Unshot(sign) => self.arrive_unshot(wave, sign),
            Kind::Whole(prospect) => self.arrive_whole(wave, prospect),
        }
    }

    fn arrive_unshot(&mut self, wave: Wave, sign: Sign) {
        self.light.take_all(sign);
        self.light
            .receive(wave.arrived.irradiance.par_iter().copied());
        let meshes = self.meshes(wave.power);
        let shot = self.arrived(wave, sign, meshes);
        if meshes {
            self.course.stage = Stage::Refining(shot);
        } else {
            self.end_shot(shot);
        }
    }

    /// A wave that has arrived at the vertices that there are; if it `meshes`, all elements are to be tested.
    pub(super) fn arrived(&mut self, wave: Wave, sign: Sign, meshes: bool) -> Shot {
        let may_split = |e: &u32| {
            let is_leaf = self.mesh.elements.is_leaf(*e);
            meshes && is_leaf && self.options.may_split(&self.mesh, *e)
        };
        let elements = (0..self.mesh.elements.len() as u32).into_par_iter();
        let candidates = elements.with_min_len(1024).filter(may_split);
        Shot {
            shooter: ALL,
            sign,
            power: wave.power,
            cells: wave.cells,
            candidates: candidates.collect(),
            feelers: Vec::new(),
            arrived: wave.arrived,
            lost: None,
            made: self.radiated.take(),
        }
    }

    /// What escapes of a fraction `power` of what is emitted.
    pub(super) fn escape_of_all(&self, all: &Shooter, power: f64) -> Lost {
        self.escape(ALL as usize, all, power, self.course.shots as u32)
    }

    /// Keeps the tiles for the next wave.
    pub(super) fn keep_tiling(&mut self, shooter: Shooter) {
        if let Shooter::All { tiling, .. } = shooter {
            self.tiling = Some(tiling);
        }
    }
}
