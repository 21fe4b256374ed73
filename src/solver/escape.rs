//! What leaves the scene: cosine-distributed rays from the shooter that meet nothing, or a side that does not radiate.

use super::behind::Behind;
use crate::geometry::{cosine_direction, jitter, lift};
use crate::radiometry::{Power, Spectrum};
use crate::visibility::{Hit, Ray, Visibility};
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul};

/// Whether a ray has ended on a side that does not radiate.
pub(super) fn is_dark(hit: &Hit, ray: &Ray, backing: &dyn Behind) -> bool {
    let direction = ray.direction.as_dvec3();
    backing.at(hit.triangle, direction).is_dark(direction)
}

/// Power that surfaces do not get, W times the square of the frame's scale.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Lost {
    /// All that leaves: to the open, and onto sides that do not radiate.
    pub all: Power,
    /// The second part of it.
    pub onto_backs: Power,
}

impl AddAssign for Lost {
    fn add_assign(&mut self, other: Self) {
        self.all += other.all;
        self.onto_backs += other.onto_backs;
    }
}

impl Add for Lost {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Mul<Power> for Lost {
    type Output = Self;

    fn mul(self, factor: Power) -> Self {
        Self {
            all: self.all * factor,
            onto_backs: self.onto_backs * factor,
        }
    }
}

impl Mul<f64> for Lost {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self * Power::splat(factor)
    }
}

/// With how many rays what is lost of a shot is estimated; `power` is a fraction of what is emitted. The square root shares the rays so that
/// each shot adds its part to the error of the whole.
pub(super) fn rays_for(power: f64) -> f64 {
    (16384.0 * power.sqrt()).clamp(256.0, 16384.0).floor()
}

/// The part of a shot's power that is lost, estimated with `count` rays. Points of patches that `is_open` denies give nothing:
/// what is buried has received nothing either.
pub(super) fn escaped(
    draws: Vec<Draw>,
    visibility: &dyn Visibility,
    backing: &dyn Behind,
    is_open: impl Fn(u32, DVec3) -> bool + Sync,
    extent: f64,
) -> Lost {
    draws
        .par_chunks(256)
        .map(|chunk| {
            let open: Vec<&Draw> = chunk
                .iter()
                .filter(|draw| is_open(draw.patch, draw.point))
                .collect();
            let rays: Vec<Ray> = open.iter().map(|d| ray(d, extent)).collect();
            let mut hits = Vec::new();
            visibility.nearest(&rays, &mut hits);
            let mut lost = Lost::default();
            for ((draw, hit), ray) in open.iter().zip(&hits).zip(&rays) {
                let onto_back = hit.as_ref().is_some_and(|hit| is_dark(hit, ray, backing));
                if onto_back {
                    lost.onto_backs += draw.power;
                }
                if onto_back || hit.is_none() {
                    lost.all += draw.power;
                }
            }
            lost
        })
        .collect::<Vec<_>>()
        .into_iter()
        .fold(Lost::default(), |mut sum, lost| {
            sum += lost;
            sum
        })
}

/// A point of a shooter, a direction on the unit square, and the power that goes there.
pub(super) struct Draw {
    patch: u32,
    point: DVec3,
    normal: DVec3,
    direction: [f64; 2],
    power: Power,
}

/// A part of a shooter that draws are taken from: its patch, its normal, its power, and its point at (s, t) of the unit square.
pub(super) struct Part<P> {
    pub patch: u32,
    pub normal: DVec3,
    pub power: Spectrum,
    pub at: P,
}

/// `count` points in proportion to power, by systematic sampling over the parts.
pub(super) fn draw<P: Fn(f64, f64) -> DVec3>(
    parts: impl Iterator<Item = Part<P>> + Clone,
    count: usize,
    seed: u32,
) -> Vec<Draw> {
    // There may be millions of parts all over the memory: each is looked at once, and again only if a point is drawn from it.
    let sums: Vec<f32> = parts.clone().map(|part| part.power.element_sum()).collect();
    let total: f64 = sums.iter().map(|sum| f64::from(*sum)).sum();
    let step = total / count as f64;
    let mut draws = Vec::with_capacity(count);
    let (mut passed, mut next) = (0.0, 0.5 * step);
    for (part, sum) in parts.zip(sums) {
        let sum = f64::from(sum);
        passed += sum;
        while next < passed && draws.len() < count {
            let number = draws.len() as u32;
            let [s, t] = jitter(seed, 2 * number);
            let share: Spectrum = part.power / sum as f32;
            draws.push(Draw {
                patch: part.patch,
                point: (part.at)(s, t),
                normal: part.normal,
                direction: spread(number, seed),
                power: share.as_dvec3() * step,
            });
            next += step;
        }
    }
    draws
}

/// The plastic-number sequence, shifted by the seed: evenly spread for any count.
fn spread(number: u32, seed: u32) -> [f64; 2] {
    let shift = jitter(seed, u32::MAX);
    let turn = |step: f64, shift: f64| (f64::from(number) * step + shift).fract();
    [
        turn(0.754_877_666_246_692_7, shift[0]),
        turn(0.569_840_290_998_053_3, shift[1]),
    ]
}

fn ray(draw: &Draw, extent: f64) -> Ray {
    let direction = cosine_direction(draw.normal, draw.direction);
    Ray {
        origin: lift(draw.point, draw.normal, extent).as_vec3(),
        direction: direction.as_vec3(),
    }
}
