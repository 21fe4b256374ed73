//! Who sees whom: occlusion of segments and nearest hits of rays among triangles.
//!
//! One trait, three engines: `embree` (packets of occlusion rays through our own FFI crate), `bvh`
//! (pure Rust over obvhs) and `brute_force` (every triangle, in double precision: the reference).
//! Visibility knows triangles and nothing of patches or light. Imports `simd` only.
//!
//! [`build`] chooses an engine by a fixed rule and hands it the triangles. All engines agree on what
//! is asked: an open segment, either side of a triangle, an edge or corner counts as hit, and what
//! single precision cannot trace (an origin or direction that is not finite, or is beyond
//! [`COORDINATE_LIMIT`]) meets nothing. They do not agree on the last bit; callers keep the ends of their segments off surfaces.

mod brute_force;
mod bvh;
mod choice;
mod clocked;
#[cfg(embree)]
mod embree;
mod triangles;

pub use crate::simd::Isa;
pub use brute_force::BruteForce;
pub use bvh::Obvhs;
pub use choice::{EngineChoice, FEW, UnknownEngine, VisibilityError, build, build_within};
pub use clocked::Clocked;
#[cfg(embree)]
pub use embree::Embree;
pub use triangles::Triangles;

use glam::Vec3;

/// Segments are tested on the open interval (`T_NEAR`, `T_FAR`) of their unnormalised direction.
pub const T_NEAR: f32 = 1e-5;
/// See [`T_NEAR`].
pub const T_FAR: f32 = 1.0 - 1e-5;
/// Most targets of one fan: a mask has one bit for each.
pub const MAX_FAN: usize = 64;

/// The largest coordinate that is traced. Engines compare volumes, products of three lengths of which each is at most twice as long; the sums
/// of these are still single-precision numbers. So are the errors of such volumes where the lengths are 1e-10 or more: nothing smaller and
/// as near should be traced. Callers scale what they trace; a solve to an extent of 64 to 128.
pub const COORDINATE_LIMIT: f32 = 1e12;

/// Fans of segments: each from one origin (a receiving point) to at most [`MAX_FAN`] targets (sample
/// points on one shooter). Filled by the caller, reused between queries; targets lie in three arrays.
#[derive(Debug, Clone, Default)]
pub struct Fans {
    pub(crate) origins: Vec<Vec3>,
    pub(crate) starts: Vec<u32>,
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
    pub(crate) z: Vec<f32>,
}

impl Fans {
    /// Removes all fans, keeps the memory.
    pub fn clear(&mut self) {
        self.origins.clear();
        self.starts.clear();
        self.x.clear();
        self.y.clear();
        self.z.clear();
    }

    /// Opens a new fan; the targets pushed next belong to it.
    pub fn begin(&mut self, origin: Vec3) {
        self.origins.push(origin);
        self.starts.push(self.x.len() as u32);
    }

    /// Adds a target to the fan that was opened last.
    pub fn push(&mut self, target: Vec3) {
        debug_assert!(
            self.x.len() - (*self.starts.last().expect("a fan is open") as usize) < MAX_FAN
        );
        self.x.push(target.x);
        self.y.push(target.y);
        self.z.push(target.z);
    }

    /// Adds targets to the fan that was opened last.
    pub fn extend(&mut self, targets: impl ExactSizeIterator<Item = Vec3>) {
        let first = self.x.len();
        let end = first + targets.len();
        debug_assert!(end - (*self.starts.last().expect("a fan is open") as usize) <= MAX_FAN);
        for list in [&mut self.x, &mut self.y, &mut self.z] {
            list.resize(end, 0.0);
        }
        let (x, y, z) = (
            &mut self.x[first..],
            &mut self.y[first..],
            &mut self.z[first..],
        );
        for (((x, y), z), target) in x.iter_mut().zip(y).zip(z).zip(targets) {
            [*x, *y, *z] = target.to_array();
        }
    }

    /// Number of fans.
    pub fn len(&self) -> usize {
        self.origins.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.origins.is_empty()
    }

    /// Number of segments in all fans.
    pub fn segments(&self) -> usize {
        self.x.len()
    }

    /// Origin and targets of fan `i`.
    pub fn fan(&self, i: usize) -> (Vec3, impl ExactSizeIterator<Item = Vec3> + '_) {
        let targets = self
            .range(i)
            .map(|k| Vec3::new(self.x[k], self.y[k], self.z[k]));
        (self.origins[i], targets)
    }

    /// The range of fan `i` in the target arrays; a mask has room for it.
    pub(crate) fn range(&self, i: usize) -> std::ops::Range<usize> {
        let end = self.starts.get(i + 1).map_or(self.x.len(), |&s| s as usize);
        let range = self.starts[i] as usize..end;
        assert!(
            range.len() <= MAX_FAN,
            "a fan has at most {MAX_FAN} targets"
        );
        range
    }
}

/// A ray for [`Visibility::nearest`]; the direction need not be normalised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes; t counts in its length.
    pub direction: Vec3,
}

/// The nearest triangle on a ray, either side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction, > 0.
    pub t: f32,
    /// Index into [`Triangles::indices`].
    pub triangle: u32,
    /// Barycentric weight of the triangle's second corner.
    pub u: f32,
    /// Barycentric weight of the triangle's third corner.
    pub v: f32,
}

/// What answered the queries, for reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EngineInfo {
    /// `embree`, `obvhs` or `brute_force`.
    pub name: &'static str,
    /// Version of the library behind it.
    pub version: String,
    /// Instruction set in use, e.g. `AVX2`.
    pub isa: String,
    /// Rays traced together.
    pub packet_width: u32,
    /// Memory that the engine holds.
    pub bytes: u64,
}

/// Answers visibility queries about one fixed set of triangles; shared between threads.
pub trait Visibility: Send + Sync {
    /// What this engine is.
    fn info(&self) -> EngineInfo;

    /// For each fan, the mask of its *occluded* segments: bit k is set if some triangle crosses the open
    /// segment from the origin to target k, whatever its side. Clears `masks` first; one mask a fan.
    /// The answer to a segment does not depend on its companions.
    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>);

    /// For each ray its nearest hit with t > 0, either side. Clears `hits` first; one entry a ray.
    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>);
}

/// Whether single precision can trace from `origin` along `direction`; false if anything is NaN.
fn traceable(origin: Vec3, direction: Vec3) -> bool {
    in_range(origin) && in_range(direction)
}

/// Whether all coordinates are numbers within [`COORDINATE_LIMIT`].
fn in_range(v: Vec3) -> bool {
    v.abs().cmple(Vec3::splat(COORDINATE_LIMIT)).all()
}

#[cfg(test)]
mod tests;
