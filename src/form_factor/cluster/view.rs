//! A cluster as a point sees it.

use super::{Aim, Node, Sends};
use crate::radiometry::Spectrum;
use glam::{Vec3, Vec3Swizzles};
use std::f32::consts::PI;

/// By its size a cluster gains or loses no more than this part: the series does not hold beyond.
const MOST_GAIN: f32 = 0.5;

/// What is drawn of a cluster for all of it counts no more than this many times what can arrive.
const MOST_DRAWN: f32 = 8.0;

/// What a point sees of a cluster, occlusion left aside.
pub(super) struct View {
    /// All of it faces the point and is above its horizon.
    pub whole: bool,
    /// No more than this can arrive, strongest channel.
    pub bound: f32,
    /// Radius over distance.
    pub size: f32,
}

impl Node {
    /// What a point sees of it; `None` if nothing.
    #[inline]
    pub(super) fn view(&self, point: Vec3, normal: Vec3, hair: f32) -> Option<View> {
        let to = self.centre - point;
        let height = normal.dot(to);
        if self.strength <= 0.0 || height <= -self.radius {
            return None;
        }
        let square = to.length_squared();
        let distance = square.sqrt();
        // How far in front of the planes of its tiles the point is, at most and at least.
        let along = -self.axis.dot(to);
        let across = (square - along * along).max(0.0).sqrt();
        let (cosine, sine) = self.cone;
        let slack = self.thickness + self.radius * sine;
        let most = if along >= distance * cosine {
            distance
        } else {
            along * cosine + across * sine
        };
        if most + slack <= hair {
            return None;
        }
        let least = along * cosine - across * sine - slack;
        // Right beside the centre there is no direction; what is that near is opened.
        let away = distance.max(0.01 * self.radius).recip();
        let gap = (distance - self.radius).max(0.0);
        let nearest = self.strength * ((height + self.radius) * away).min(1.0) / (PI * gap * gap);
        let size = self.radius * away;
        Some(View {
            whole: least >= 0.0 && height >= self.radius,
            // What is inside a sphere fills no more of a cosine-weighted hemisphere than the sphere does.
            bound: nearest.min(self.peak * (size * size).min(1.0)),
            size,
        })
    }
}

impl Sends {
    /// What arrives of a cluster of which a point does not see the whole, were it all at `aim`, a point that was drawn of it: right
    /// in the mean over all draws. `bound` is that of its view.
    pub(super) fn drawn(&self, aim: &Aim, point: Vec3, normal: Vec3, bound: f32) -> Spectrum {
        let to = aim.target - point;
        let (a, b) = (-aim.normal.dot(to), normal.dot(to));
        if a <= 0.0 || b <= 0.0 {
            return Spectrum::ZERO;
        }
        let square = to.length_squared();
        let most = MOST_DRAWN * bound / self.colour.max_element();
        self.colour * (self.weight * a * b / (PI * square * square)).min(most)
    }

    /// What arrives at a point of a cluster that is whole above its horizon and faces it: the kernel (P·x)(n·x)/π r⁴ at the centre,
    /// and its term of second order for the covariance M of the sources,
    /// ½ M:∇∇ = (PMn - 4 (b PMx + a nMx)/r² + ab (12 xMx/r² - 2 tr M)/r²) / π r⁴ with a = P·x and b = n·x. For a disk on the axis it
    /// begins like Eq. (1).
    #[inline]
    pub(super) fn arriving(&self, point: Vec3, normal: Vec3, radius: f32) -> Spectrum {
        let to = self.centre - point;
        // Nearer than this it is opened, whatever this says.
        let square = to.length_squared().max(radius * radius);
        let (a, b) = (-self.flux.dot(to), normal.dot(to));
        let [diagonal, mixed] = self.spread;
        let times = |v: Vec3| diagonal * v + mixed.zxy() * v.yzx() + mixed.yzx() * v.zxy();
        let (of_normal, of_to) = (times(normal), times(to));
        let trace = diagonal.element_sum();
        let change = -self.flux.dot(of_normal)
            - 4.0 * (a * normal.dot(of_to) - b * self.flux.dot(of_to)) / square
            + a * b * (12.0 * to.dot(of_to) / square - 2.0 * trace) / square;
        let plain = (a * b).max(0.0);
        let change = change.clamp(-MOST_GAIN * plain, MOST_GAIN * plain);
        self.colour * ((plain + change) / (PI * square * square))
    }
}
