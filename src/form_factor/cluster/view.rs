//! A cluster as a point sees it.

use super::{Node, Sends};
use crate::radiometry::Spectrum;
use glam::Vec3;
use std::f32::consts::PI;

/// A cluster beside a receiver that looks along it gains no more than this part by its size: the series does not hold there.
const MOST_GAIN: f32 = 0.25;

/// What a point sees of a cluster, occlusion left aside.
pub(super) struct View {
    pub contribution: Spectrum,
    /// Largest channel of it.
    pub measure: f32,
    /// No more than this can arrive, largest channel.
    pub bound: f32,
    /// Radius over distance.
    pub size: f32,
    /// All of it faces the point and is above its horizon.
    pub whole: bool,
}

impl Node {
    /// What a point sees of it; `None` if nothing.
    #[inline]
    pub(super) fn view(&self, point: Vec3, normal: Vec3, hair: f32) -> Option<View> {
        let Sends {
            flux,
            weight,
            colour,
            ..
        } = self.sends;
        let to = self.centre - point;
        let height = normal.dot(to);
        if weight <= 0.0 || height <= -self.radius {
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
        let whole = least >= 0.0 && height >= self.radius;
        // Right beside the centre there is no direction; what is that near is opened.
        let away = distance.max(0.01 * self.radius).recip();
        let towards = -flux.dot(to) * away;
        let sent = if least >= 0.0 {
            towards
        } else {
            towards.max(0.0) + 0.25 * (weight - flux.length())
        };
        let above = if height >= self.radius {
            height
        } else {
            (height + self.radius).powi(2) / (4.0 * self.radius)
        };
        let gap = (distance - self.radius).max(0.0);
        let nearest = weight * ((height + self.radius) * away).min(1.0) / (PI * gap * gap);
        let brightest = weight / self.area.max(f32::MIN_POSITIVE);
        let bound = nearest.min(2.0 * brightest);
        let near = self.second_order(normal, along, height, square);
        let sent = sent.max(0.0) * above * away * near * away * away / PI;
        let contribution = colour * sent.min(bound);
        Some(View {
            contribution,
            measure: contribution.max_element(),
            bound: colour.max_element() * bound,
            size: self.radius * away,
            whole,
        })
    }

    /// What the size of a flat cluster makes of the kernel at its centre: the term of second order of cosθ_s cosθ_r / r²
    /// in its plane, 1 + (s²/r²) (4 + 4 n_s·n_r a/b - 12 a²/r²) with a = n_s·d, b = n_r·d; less than 1 as 1/(1 - …), which is
    /// Eq. (1) for a disk on the axis.
    #[inline]
    fn second_order(&self, normal: Vec3, along: f32, height: f32, square: f32) -> f32 {
        // Nearer than this it is opened, whatever this says.
        let square = square.max(self.radius * self.radius);
        let across = normal.dot(self.axis) * along / height.max(self.radius);
        let bend = 4.0 - 4.0 * across - 12.0 * along * along / square;
        let change = (self.variance / square * bend).min(MOST_GAIN);
        if change >= 0.0 {
            1.0 + change
        } else {
            1.0 / (1.0 - change)
        }
    }
}
