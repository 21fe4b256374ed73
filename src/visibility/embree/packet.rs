//! Packets of rays: filling them from fans, tracing them, reading the answer.
//!
//! Targets lie in three arrays, so a packet is filled by whole rows. Fans follow each other in a
//! packet without a gap (4 vertices with 4 samples each make one packet of 16), and what never
//! changes is written once a call.

use super::scene::CommittedScene;
use crate::visibility::{COORDINATE_LIMIT, Fans, Hit, Ray, T_FAR, T_NEAR, in_range, traceable};
use embree4_sys as sys;
use glam::Vec3;
use std::mem::offset_of;

/// The rows of `RTCRay4`, `RTCRay8` and `RTCRay16`, and with one lane of `RTCRay`.
#[repr(C, align(64))]
pub struct Rays<const W: usize> {
    org: [[f32; W]; 3],
    tnear: [f32; W],
    dir: [[f32; W]; 3],
    time: [f32; W],
    tfar: [f32; W],
    mask: [u32; W],
    id: [u32; W],
    flags: [u32; W],
}

/// Rays, and which lanes are in use: -1 or 0, as Embree wants it.
#[repr(C, align(64))]
pub struct Packet<const W: usize> {
    valid: [i32; W],
    rays: Rays<W>,
}

/// Packets of a width that Embree has a function for.
pub trait Trace {
    /// Sets `tfar` of every valid lane that is occluded to minus infinity.
    fn trace(&mut self, scene: &CommittedScene);
}

macro_rules! trace_packets {
    ($($width:literal, $rays:ident, $function:ident;)*) => {$(
        const _: () = {
            assert!(offset_of!(Rays<$width>, org) == offset_of!(sys::$rays, org_x));
            assert!(offset_of!(Rays<$width>, tnear) == offset_of!(sys::$rays, tnear));
            assert!(offset_of!(Rays<$width>, dir) == offset_of!(sys::$rays, dir_x));
            assert!(offset_of!(Rays<$width>, time) == offset_of!(sys::$rays, time));
            assert!(offset_of!(Rays<$width>, tfar) == offset_of!(sys::$rays, tfar));
            assert!(offset_of!(Rays<$width>, mask) == offset_of!(sys::$rays, mask));
            assert!(offset_of!(Rays<$width>, flags) == offset_of!(sys::$rays, flags));
            assert!(size_of::<Rays<$width>>() == size_of::<sys::$rays>());
        };

        impl Trace for Packet<$width> {
            fn trace(&mut self, scene: &CommittedScene) {
                let rays = (&raw mut self.rays).cast::<sys::$rays>();
                // SAFETY: the layouts are the same (checked above), both pointers are aligned to 64
                // bytes and exclusive, the scene is committed, and valid lanes hold finite rays.
                unsafe { sys::$function(self.valid.as_ptr(), scene.raw(), rays, true) }
            }
        }
    )*};
}

trace_packets! {
    16, RTCRay16, shim_occluded16;
    8, RTCRay8, shim_occluded8;
    4, RTCRay4, shim_occluded4;
}

impl Trace for Packet<1> {
    fn trace(&mut self, scene: &CommittedScene) {
        const {
            assert!(offset_of!(Rays<1>, dir) == offset_of!(sys::RTCRay, dir_x));
            assert!(offset_of!(Rays<1>, tfar) == offset_of!(sys::RTCRay, tfar));
            assert!(size_of::<Rays<1>>() >= size_of::<sys::RTCRay>());
        }
        if self.valid[0] != 0 {
            // SAFETY: `RTCRay` has the same fields in the same order and less alignment.
            unsafe { sys::shim_occluded1(scene.raw(), (&raw mut self.rays).cast()) }
        }
    }
}

impl<const W: usize> Packet<W> {
    /// All lanes unused, all constants in place.
    pub fn new() -> Self {
        Self {
            valid: [0; W],
            rays: Rays {
                org: [[0.0; W]; 3],
                tnear: [T_NEAR; W],
                dir: [[0.0; W]; 3],
                time: [0.0; W],
                tfar: [T_FAR; W],
                mask: [u32::MAX; W],
                id: [0; W],
                flags: [0; W],
            },
        }
    }

    /// Puts the segments from `origin` to `targets` (equally long) into the lanes from `lane` on.
    #[inline(always)]
    fn fill(&mut self, lane: usize, origin: Vec3, targets: [&[f32]; 3]) {
        let count = targets[0].len();
        if lane == 0 && count == W {
            self.fill_lanes(0, W, origin, targets); // a constant length unrolls
        } else {
            self.fill_lanes(lane, count, origin, targets);
        }
    }

    #[inline(always)]
    fn fill_lanes(&mut self, lane: usize, count: usize, origin: Vec3, targets: [&[f32]; 3]) {
        let lanes = lane..lane + count;
        for axis in 0..3 {
            self.rays.org[axis][lanes.clone()].fill(origin[axis]);
            let directions = &mut self.rays.dir[axis][lanes.clone()];
            for (direction, target) in directions.iter_mut().zip(&targets[axis][..count]) {
                *direction = target - origin[axis];
            }
        }
        self.rays.tfar[lanes.clone()].fill(T_FAR);
        let origin_in_range = in_range(origin);
        let [x, y, z] = self.rays.dir.each_ref().map(|row| &row[lanes.clone()]);
        for (i, valid) in self.valid[lanes.clone()].iter_mut().enumerate() {
            // A comparison with NaN is false.
            let traceable = (x[i].abs() <= COORDINATE_LIMIT)
                & (y[i].abs() <= COORDINATE_LIMIT)
                & (z[i].abs() <= COORDINATE_LIMIT)
                & origin_in_range;
            *valid = -i32::from(traceable);
        }
    }

    /// Lanes found occluded, one bit each.
    #[inline(always)]
    fn hits(&self) -> u64 {
        let lanes = self.rays.tfar.iter().enumerate();
        lanes.fold(0, |bits, (lane, &tfar)| {
            bits | u64::from(tfar < 0.0) << lane
        })
    }
}

/// Neighbouring lanes that hold targets of one fan.
#[derive(Clone, Copy, Default)]
struct Run {
    fan: usize,
    /// Of the first target in its fan.
    target: usize,
    lane: usize,
    count: usize,
}

/// Sets the bit of every occluded segment in `masks`, which holds a 0 for each fan.
pub fn occluded<const W: usize>(scene: &CommittedScene, fans: &Fans, masks: &mut [u64])
where
    Packet<W>: Trace,
{
    let mut packet = Packet::<W>::new();
    let mut runs = [Run::default(); W];
    let (mut lane, mut open) = (0, 0);
    for (fan, &origin) in fans.origins.iter().enumerate() {
        let targets = fans.range(fan);
        let mut next = targets.start;
        while next < targets.end {
            let count = (targets.end - next).min(W - lane);
            let part = next..next + count;
            let rows = [&fans.x[part.clone()], &fans.y[part.clone()], &fans.z[part]];
            packet.fill(lane, origin, rows);
            runs[open] = Run {
                fan,
                target: next - targets.start,
                lane,
                count,
            };
            (lane, open, next) = (lane + count, open + 1, next + count);
            if lane == W {
                flush(&mut packet, scene, &runs[..open], masks);
                (lane, open) = (0, 0);
            }
        }
    }
    if lane > 0 {
        packet.valid[lane..].fill(0);
        flush(&mut packet, scene, &runs[..open], masks);
    }
}

/// Traces a packet and hands its answers to the fans in it.
#[inline(always)]
fn flush<const W: usize>(
    packet: &mut Packet<W>,
    scene: &CommittedScene,
    runs: &[Run],
    masks: &mut [u64],
) where
    Packet<W>: Trace,
{
    packet.trace(scene);
    let hits = packet.hits();
    for run in runs {
        let answers = hits >> run.lane & ((1 << run.count) - 1);
        masks[run.fan] |= answers << run.target;
    }
}

/// The nearest hit of a single ray with t > 0.
pub fn nearest(scene: &CommittedScene, ray: &Ray) -> Option<Hit> {
    if !traceable(ray.origin, ray.direction) {
        return None;
    }
    let mut query = sys::RTCRayHit {
        ray: sys::RTCRay {
            org_x: ray.origin.x,
            org_y: ray.origin.y,
            org_z: ray.origin.z,
            tnear: 0.0,
            dir_x: ray.direction.x,
            dir_y: ray.direction.y,
            dir_z: ray.direction.z,
            time: 0.0,
            tfar: f32::INFINITY,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        },
        hit: sys::RTCHit {
            geomID: sys::INVALID_GEOMETRY_ID,
            ..Default::default()
        },
    };
    // SAFETY: the query is exclusive and aligned by its type, the ray is finite, the scene committed.
    unsafe { sys::shim_intersect1(scene.raw(), &raw mut query) };
    (query.hit.geomID != sys::INVALID_GEOMETRY_ID).then_some(Hit {
        t: query.ray.tfar,
        triangle: query.hit.primID,
        u: query.hit.u,
        v: query.hit.v,
    })
}
