//! A scene of many patches: all that is unshot is shot at once, as clusters; a wave of light after the other.
//!
//! Direct light arrives at the vertices as a shot does, slice by slice, and refines the mesh as a shot does; so does the gathering at the
//! end. What either takes is a cut through the tree of clusters for each vertex, not a visit to each vertex for each
//! patch. The waves in between arrive at neighbourhoods (`bounce.rs`).

use super::audit::Span;
use super::course::{ALL, Bounce, Shot, Stage};
use super::escape::Lost;
use super::groups::Groups;
use super::light::{Light, Sign};
use super::observer::Phase;
use super::run::{Solver, by_sign};
use super::shoot::{Beam, Shooter, evaluate, receiver_at, shoot_at};
use super::tiling::Tiling;
use crate::form_factor::Gather;
use crate::mesh::Mesh;
use crate::radiometry::{Power, Spectrum};
use rayon::iter::repeat_n;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Vertices that a wave arrives at between two looks at the observer.
const SLICE: usize = 1 << 16;

/// After a bounce the gathering begins when no more than this many times the tolerance is unshot: what is to come of it is foreseen.
/// With ten times, `staircase2` came a fifth less near to its reference and saved a twentieth of its time.
pub(super) const EARLY: f64 = 4.0;

/// A bounce is taken to be no stronger than this part of the one before it.
const MOST_RATIO: f64 = 0.95;

/// How much the ratio of a bounce to the one before it still grows, in units of how much it has grown last.
const STILL_TO_GROW: f32 = 1.5;

/// Light in a group may differ by this many times ε_d. In an element as small it may by more (see `size_exponent`), but that is flat.
/// With 1 a draft of `staircase2` takes a seventh longer for the same error, with 25 its error grows by a third.
const UNEVEN: f64 = 5.0;

/// A wave that has arrived at the first vertices.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Wave {
    pub kind: Kind,
    /// Radiosity of the tiles.
    pub cells: Vec<Spectrum>,
    /// As a fraction of the emitted power.
    pub power: f64,
    /// The first vertex that it has not arrived at.
    pub next: u32,
    pub arrived: Vec<Gather>,
}

impl Bounce {
    /// What is `unshot` after it over what was before it.
    fn ratio_to(&self, unshot: Power) -> Spectrum {
        let before = self.unshot.abs().max(Power::splat(f64::MIN_POSITIVE));
        let ratio = (unshot.abs() / before).min(Power::splat(MOST_RATIO));
        ratio.as_vec3()
    }
}

impl Wave {
    pub fn is_whole(&self) -> bool {
        matches!(self.kind, Kind::Whole(_))
    }

    /// What is done, for who watches.
    pub fn phase(&self, mesh: &Mesh) -> Phase {
        let (done, of) = (self.next, mesh.vertices.len() as u32);
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
    /// All light once more, and so many times what is unshot for what is still to come of it.
    Whole(Spectrum),
}

impl<'a> Solver<'a> {
    /// Whether there are so many patches that they shoot as clusters.
    pub(super) fn is_clustered(&self) -> bool {
        self.options.clusters(&self.mesh)
    }

    /// All that is unshot of the stronger sign sets out.
    pub(super) fn begin_wave(&mut self, powers: &[Power], after: Option<Bounce>) {
        let unshot = by_sign(powers);
        let of = unshot.map(Power::element_sum);
        let sign = if of[0] >= of[1] { 0 } else { 1 };
        let power = of[sign] / self.emitted().element_sum();
        let sign = Sign::ALL[sign];
        let tiling = self.tiling();
        let cells = tiling.unshot(&self.mesh, &self.light, sign);
        self.tiling = Some(tiling);
        if self.light.is_direct(sign) {
            // The mesh is refined: its neighbourhoods will be others.
            self.neighbourhoods = None;
            self.set_out(Kind::Unshot(sign), cells, power);
        } else {
            let unshot = unshot[0] - unshot[1];
            let ratio = after.map(|bounce| bounce.ratio_to(unshot));
            self.bounce(sign, &cells, power, Bounce { unshot, ratio });
        }
    }

    /// All light sets out once more.
    pub(super) fn begin_gathering(&mut self, bounce: Option<Bounce>) {
        let prospect = self.prospect(bounce);
        let whole = self.foreseen(prospect);
        let tiling = self.tiling();
        let cells = tiling.unshot(&self.mesh, &whole, Sign::Positive);
        self.tiling = Some(tiling);
        self.set_out(Kind::Whole(prospect), cells, 1.0);
    }

    /// How many times what is unshot is still to come: λ + λ² + … = λ / (1 - λ), were all that follow like a bounce that leaves λ times
    /// what it shot. The first ones leave less than those after them, as what is bright for its neighbourhood goes first; the
    /// ratios approach that of what lasts longest like a geometric series.
    fn prospect(&self, bounce: Option<Bounce>) -> Spectrum {
        let Some(bounce) = bounce else {
            return Spectrum::ZERO;
        };
        let ratio = bounce.ratio_to(self.unshot());
        let growth = bounce.ratio.map_or(Spectrum::ZERO, |before| ratio - before);
        let ratio = (ratio + STILL_TO_GROW * growth.max(Spectrum::ZERO))
            .min(Spectrum::splat(MOST_RATIO as f32));
        ratio / (Spectrum::ONE - ratio)
    }

    /// All light with nothing shot yet, `prospect` times what is unshot as if it had arrived.
    fn foreseen(&self, prospect: Spectrum) -> Light {
        let light = self.light.irradiance.par_iter().zip(&self.light.unshot);
        let foreseen = |(arrived, unshot): (&Spectrum, &Spectrum)| {
            (*arrived + *unshot * prospect).max(Spectrum::ZERO)
        };
        Light {
            unshot: light.map(foreseen).collect(),
            ..Light::new(&self.mesh)
        }
    }

    fn set_out(&mut self, kind: Kind, cells: Vec<Spectrum>, power: f64) {
        self.course.stage = Stage::Waving(Wave {
            kind,
            cells,
            power,
            next: 0,
            arrived: repeat_n(Gather::default(), self.mesh.vertices.len()).collect(),
        });
    }

    /// The tiles of the mesh, made if there are none yet.
    pub(super) fn tiling(&mut self) -> Tiling {
        let made = self.tiling.take();
        made.unwrap_or_else(|| Tiling::new(&self.mesh))
    }

    /// The tiles as they radiate.
    pub(super) fn radiating(&mut self, cells: &[Spectrum], settled: bool) -> Shooter {
        let mut tiling = self.tiling();
        tiling
            .clusters
            .radiate(cells.to_vec(), self.course.shots as u32);
        Shooter::All { tiling, settled }
    }

    /// The wave arrives at some more vertices.
    pub(super) fn wave(&mut self, mut wave: Wave) {
        let settled = matches!(wave.kind, Kind::Whole(_));
        let all = match self.radiated.take() {
            Some(all) => all,
            None => self.radiating(&wave.cells, settled),
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
        let end = (wave.next as usize + SLICE).min(self.mesh.vertices.len());
        let open = |v: &u32| !self.mesh.buried[*v as usize];
        let slice = (wave.next..end as u32).filter(open);
        let (small, others): (Vec<u32>, Vec<u32>) = slice.partition(|v| self.is_of_small(*v));
        self.course.rays += shoot_at(&self.mesh, &self.light, beam, &others, &mut wave.arrived);
        self.course.rays += self.shoot_at_groups(beam, &small, &mut wave.arrived);
        wave.next = end as u32;
        self.radiated = Some(all);
        if end == self.mesh.vertices.len() {
            self.arrive(wave);
        } else {
            self.course.stage = Stage::Waving(wave);
        }
    }

    /// Whether a vertex belongs to a patch that is smaller than elements may be.
    fn is_of_small(&self, vertex: u32) -> bool {
        let patch = self.mesh.vertices[vertex as usize].patch;
        self.mesh.is_small(&self.mesh.patches[patch as usize])
    }

    /// [`shoot_at`] for vertices of small patches: not all of them receive. Returns the number of rays.
    fn shoot_at_groups(&self, beam: Beam, vertices: &[u32], arrived: &mut [Gather]) -> u64 {
        let mesh = &self.mesh;
        let receiving = vertices.iter().copied().filter(|v| mesh.receives(*v));
        let receiving: Vec<u32> = receiving.collect();
        let mut rays = 0;
        let receive = |nodes: &[u32]| {
            let receivers = nodes.iter().map(|v| receiver_at(mesh, &self.light, *v));
            let receivers: Vec<_> = receivers.collect();
            let (gathers, traced) = evaluate(beam.sampler, beam.shooter, &receivers);
            rays += traced;
            gathers
        };
        let scale = beam.sampler.thresholds.scale;
        let differ = |light: &[Gather]| {
            let low = light.iter().map(|g| g.irradiance).reduce(Spectrum::min);
            let high = light.iter().map(|g| g.irradiance).reduce(Spectrum::max);
            let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
            let unit = scale.at(f64::from(high.max_element()));
            f64::from((high - low).max_element()) > UNEVEN * self.options.epsilon_d * unit
        };
        let found = Groups::new(mesh, &receiving).gather(receive, differ);
        for (vertex, mut gather) in found {
            gather.irradiance *= beam.sign.factor();
            arrived[vertex as usize] = gather;
        }
        rays
    }

    /// A wave has arrived everywhere.
    fn arrive(&mut self, mut wave: Wave) {
        self.mesh.share(&mut wave.arrived, Gather::mean);
        self.mesh
            .continue_to_buried(&mut wave.arrived, |g| &mut g.irradiance, 0);
        match wave.kind {
            Kind::Unshot(sign) => self.arrive_unshot(wave, sign),
            Kind::Whole(prospect) => self.arrive_whole(wave, prospect),
        }
    }

    fn arrive_unshot(&mut self, wave: Wave, sign: Sign) {
        self.light.take_all(sign);
        self.light
            .receive(wave.arrived.par_iter().map(|g| g.irradiance));
        let meshes = self.meshes(wave.power);
        let shot = self.arrived(wave, sign, meshes);
        if meshes {
            self.course.stage = Stage::Refining(shot);
        } else {
            self.end_shot(shot);
        }
    }

    fn arrive_whole(&mut self, wave: Wave, prospect: Spectrum) {
        let whole = self.foreseen(prospect);
        let Some(all) = &self.radiated else {
            return;
        };
        let lost = self.escape_of_all(all, wave.power);
        let irradiance = wave.arrived.iter().map(|g| g.irradiance).collect();
        self.take_over(irradiance, &whole, lost, Vec::new());
        let shot = self.arrived(wave, Sign::Positive, self.course.meshing_ended.is_none());
        self.course.stage = Stage::Settling(shot);
    }

    /// A wave that has arrived at the vertices that there are; if it `meshes`, all elements are to be tested.
    fn arrived(&mut self, wave: Wave, sign: Sign, meshes: bool) -> Shot {
        let candidates = self
            .mesh
            .leaves()
            .filter(|e| meshes && self.mesh.may_split(*e));
        Shot {
            shooter: ALL,
            sign,
            power: wave.power,
            cells: wave.cells,
            candidates: candidates.collect(),
            feelers: Vec::new(),
            arrived: wave.arrived,
            made: self.radiated.take(),
        }
    }

    /// One pass of refinement for what was gathered of all light. The solve ends when there is nothing to split.
    pub(super) fn settle(&mut self, mut shot: Shot) {
        let all = self.made(&mut shot, true);
        let sampler = self.sampler();
        self.pass(&mut shot, &sampler, &all);
        if shot.candidates.is_empty() {
            self.course.sent_sum = self.sent_sum(&shot.arrived, &all);
            self.keep_tiling(all);
            self.course.stage = Stage::Finished;
        } else {
            shot.made = Some(all);
            self.course.stage = Stage::Settling(shot);
        }
    }

    /// What arrived and what escaped over what was sent.
    fn sent_sum(&self, arrived: &[Gather], all: &Shooter) -> Option<Span> {
        let Shooter::All { tiling, .. } = all else {
            return None;
        };
        let weighted = arrived.iter().zip(&self.mesh.weights);
        let received: Power = weighted.map(|(g, w)| g.irradiance.as_dvec3() * *w).sum();
        let sent = tiling.power().element_sum();
        let arrived = (received + self.course.lost.all).element_sum();
        Span::of(std::iter::once((arrived / sent, sent)))
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
