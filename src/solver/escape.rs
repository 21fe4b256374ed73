//! What leaves the scene: cosine-distributed rays from the shooter that meet nothing, or a side that does not radiate.

use crate::form_factor::Source;
use crate::geometry::{cosine_direction, jitter, lift};
use crate::radiometry::{Power, Spectrum};
use crate::scene::Sides;
use crate::visibility::{Hit, Ray, Visibility};
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::{AddAssign, Mul};

/// What stands behind a triangle of the visibility scene.
#[derive(Debug, Clone, Copy)]
pub(super) struct Backing {
    /// Unit normal of the front.
    pub normal: DVec3,
    /// The sides that radiate.
    pub sides: Sides,
    /// Index into `Scene::surfaces`.
    pub surface: u32,
}

/// Whether a ray has ended on a side that does not radiate.
pub(super) fn is_dark(hit: &Hit, ray: &Ray, backing: &[Backing]) -> bool {
    let Backing { normal, sides, .. } = backing[hit.triangle as usize];
    sides == Sides::Front && normal.dot(ray.direction.as_dvec3()) > 0.0
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

impl Mul<f64> for Lost {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            all: self.all * factor,
            onto_backs: self.onto_backs * factor,
        }
    }
}

/// The part of a shot's power that is lost, estimated with `count` rays.
/// Points that `is_open` denies give nothing: what is buried has received nothing either.
pub(super) fn escaped(
    source: &Source,
    visibility: &dyn Visibility,
    backing: &[Backing],
    is_open: impl Fn(DVec3) -> bool,
    extent: f64,
    (count, seed): (usize, u32),
) -> Lost {
    let draws: Vec<Draw> = draw(source, count, seed)
        .into_iter()
        .filter(|draw| is_open(draw.point))
        .collect();
    draws
        .par_chunks(1024)
        .map(|chunk| {
            let rays: Vec<Ray> = chunk.iter().map(|d| ray(source, d, extent)).collect();
            let mut hits = Vec::new();
            visibility.nearest(&rays, &mut hits);
            let mut lost = Lost::default();
            for ((draw, hit), ray) in chunk.iter().zip(&hits).zip(&rays) {
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

/// A point of the source, a direction on the unit square, and the power that goes there.
struct Draw {
    point: DVec3,
    direction: [f64; 2],
    power: Power,
}

/// Points in proportion to radiosity, by systematic sampling over the cells.
fn draw(source: &Source, count: usize, seed: u32) -> Vec<Draw> {
    let total: f64 = source
        .finest()
        .map(|(_, p)| f64::from(p.element_sum()))
        .sum();
    let step = total / count as f64;
    let mut draws = Vec::with_capacity(count);
    let (mut passed, mut next) = (0.0, 0.5 * step);
    for (cell, power) in source.finest() {
        let sum = f64::from(power.element_sum());
        passed += sum;
        while next < passed && draws.len() < count {
            let number = draws.len() as u32;
            let [s, t] = jitter(seed, 2 * number);
            let share: Spectrum = power / sum as f32;
            draws.push(Draw {
                point: cell.at(s, t),
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

fn ray(source: &Source, draw: &Draw, extent: f64) -> Ray {
    let normal = source.normal();
    let direction = cosine_direction(normal, draw.direction);
    Ray {
        origin: lift(draw.point, normal, extent).as_vec3(),
        direction: direction.as_vec3(),
    }
}
