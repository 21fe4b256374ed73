//! Integrals over parallelograms.

use crate::common::shapes::rectangle;
use crate::shapes::{moved, seen};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// A corner and two sides.
pub struct Parallelogram(pub DVec3, pub DVec3, pub DVec3);

impl Parallelogram {
    pub fn corners(&self) -> [DVec3; 4] {
        rectangle(self.0, self.1, self.2)
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        self.1.cross(self.2).length()
    }

    /// Mean over the area by a product rule whose points crowd towards the sides, where form factors have kinks.
    pub fn integrate(&self, f: impl Fn(DVec3) -> f64) -> f64 {
        let crowd =
            |&(t, weight): &(f64, f64)| (t * t * (3.0 - 2.0 * t), weight * 6.0 * t * (1.0 - t));
        let points: Vec<(f64, f64)> = gauss().iter().map(crowd).collect();
        let row = |t: f64| {
            points
                .iter()
                .map(|(s, w)| w * f(self.0 + self.1 * *s + self.2 * t))
                .sum::<f64>()
        };
        points.iter().map(|(t, w)| w * row(*t)).sum()
    }

    /// The form factor F_ij to a polygon.
    pub fn mean(&self, to: &[DVec3]) -> f64 {
        let normal = self.1.cross(self.2).normalize();
        self.integrate(|x| seen(normal, &moved(to, -x)))
    }
}

/// Nodes and weights of the Gauss-Legendre rule of 48 points on [0, 1], by Newton's method on P₄₈.
pub fn gauss() -> &'static [(f64, f64)] {
    const N: usize = 48;
    static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
        let node = |i: usize| {
            let mut x = (PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut below, mut p) = (1.0, x);
                for k in 2..=N {
                    let k = k as f64;
                    (below, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * below) / k);
                }
                slope = N as f64 * (x * p - below) / (x * x - 1.0);
                x -= p / slope;
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        };
        (0..N).map(node).collect()
    });
    &RULE
}
