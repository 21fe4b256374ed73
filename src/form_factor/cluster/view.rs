//! Clusters as points see them: several points side by side, for the compiler to vectorise.

use super::{Aim, Node, Sends};
use crate::form_factor::hybrid::Receiver;
use crate::radiometry::Spectrum;
use glam::{Vec3, Vec3Swizzles};
use std::f32::consts::{FRAC_1_PI, PI};

/// By its size a cluster gains or loses no more than this part: the series does not hold beyond.
const MOST_GAIN: f32 = 0.5;

/// What is drawn of a cluster for all of it counts no more than this many times what can arrive.
const MOST_DRAWN: f32 = 8.0;

/// Points that walk the tree side by side.
pub(super) const LANES: usize = 16;

/// One number of each point.
pub(super) type Row = [f32; LANES];

/// Which of the points: a bit for each.
pub(super) type Mask = u32;

/// The points of a mask.
#[inline(always)]
pub(super) fn lanes(mut mask: Mask) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            lane as usize
        })
    })
}

/// The points for which `holds`.
#[inline(always)]
pub(super) fn mask(holds: impl Fn(usize) -> bool) -> Mask {
    let mut mask = 0;
    // No `fold`: that is not always compiled into what calls it, and then not for its instructions.
    for lane in 0..LANES {
        mask |= Mask::from(holds(lane)) << lane;
    }
    mask
}

/// Whether any of `WIDTH` points from the `first` on is in a mask: what an instruction does for one of them it does for all.
#[inline(always)]
const fn is_any<const WIDTH: usize>(of: Mask, first: usize) -> bool {
    of >> first & (Mask::MAX >> (Mask::BITS - WIDTH as u32)) != 0
}

/// Points with their normals, component by component.
pub(super) struct Rows {
    point: [Row; 3],
    normal: [Row; 3],
}

impl Rows {
    /// No more than [`LANES`] receivers.
    pub fn new(receivers: &[(Receiver, u32)]) -> Self {
        let mut rows = Self {
            point: [[0.0; LANES]; 3],
            normal: [[0.0; LANES]; 3],
        };
        for (lane, (receiver, _)) in receivers.iter().enumerate() {
            for axis in 0..3 {
                rows.point[axis][lane] = receiver.point[axis] as f32;
                rows.normal[axis][lane] = receiver.normal[axis] as f32;
            }
        }
        rows
    }

    #[inline(always)]
    fn to(&self, target: Vec3, lane: usize) -> Vec3 {
        target - Vec3::from([0, 1, 2].map(|axis| self.point[axis][lane]))
    }

    #[inline(always)]
    fn normal(&self, lane: usize) -> Vec3 {
        Vec3::from([0, 1, 2].map(|axis| self.normal[axis][lane]))
    }
}

/// What points see of a cluster, occlusion left aside.
pub(super) struct Views {
    /// Those that see any of it.
    pub seen: Mask,
    /// Those that all of it faces, and who have all of it above their horizon.
    pub whole: Mask,
    /// No more than this can arrive, strongest channel.
    pub bound: Row,
    /// Radius over distance.
    pub size: Row,
}

impl Node {
    /// What those points that are `asking` see of it; no higher than a `hair` above its tiles they see nothing.
    #[inline(always)]
    pub(super) fn views<const WIDTH: usize>(&self, of: &Rows, hair: f32, asking: Mask) -> Views {
        let mut views = Views {
            seen: 0,
            whole: 0,
            bound: [0.0; LANES],
            size: [0.0; LANES],
        };
        let (mut height, mut most, mut least) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (cosine, sine) = self.cone;
        let slack = self.thickness + self.radius * sine;
        for first in (0..LANES).step_by(WIDTH) {
            if !is_any::<WIDTH>(asking, first) {
                continue;
            }
            for lane in first..first + WIDTH {
                let to = of.to(self.centre, lane);
                height[lane] = of.normal(lane).dot(to);
                let square = to.length_squared();
                let distance = square.sqrt();
                // How far in front of the planes of its tiles the point is, at most and at least.
                let along = -self.axis.dot(to);
                let across = (square - along * along).max(0.0).sqrt();
                most[lane] = if along >= distance * cosine {
                    distance
                } else {
                    along * cosine + across * sine
                };
                least[lane] = along * cosine - across * sine - slack;
                // Right beside the centre there is no direction; what is that near is opened.
                let away = 1.0 / distance.max(0.01 * self.radius);
                let gap = (distance - self.radius).max(0.0);
                let nearness = 1.0 / gap;
                // The largest cosines there and here.
                let facing = ((most[lane] + slack) * nearness).min(1.0);
                let steepest = ((height[lane] + self.radius) * away).min(1.0);
                let nearest = self.strength * facing * steepest * FRAC_1_PI * nearness * nearness;
                let size = self.radius * away;
                // What is inside a sphere fills no more of a cosine-weighted hemisphere than the sphere does.
                let fill = (size * size).min(1.0) * (2.0 * steepest).min(1.0);
                views.bound[lane] = nearest.min(self.peak * fill);
                views.size[lane] = size;
            }
        }
        views.seen = mask(|lane| (height[lane] > -self.radius) & (most[lane] + slack > hair));
        views.seen &= asking;
        views.whole = mask(|lane| (least[lane] >= 0.0) & (height[lane] >= self.radius));
        views
    }
}

impl Sends {
    /// What arrives of a cluster of which a point does not see the whole, were it all at `aim`, a point that was drawn of it: right
    /// in the mean over all draws. `bound` is that of its view.
    #[inline(always)]
    pub(super) fn drawn(&self, aim: &Aim, of: &Rows, lane: usize, bound: f32) -> Spectrum {
        let to = of.to(aim.target, lane);
        let (a, b) = (-aim.normal.dot(to), of.normal(lane).dot(to));
        if a <= 0.0 || b <= 0.0 {
            return Spectrum::ZERO;
        }
        let square = to.length_squared();
        let most = MOST_DRAWN * bound / self.colour.max_element();
        self.colour * (self.weight * a * b / (PI * square * square)).min(most)
    }

    /// What arrives, mean of the channels, at those points that are `asking`, who see the whole of a cluster: the kernel (P·x)(n·x)/π r⁴ at the centre,
    /// and its terms of second order: for the covariance M of the sources
    /// ½ M:∇∇ = (PMn - 4 (b PMx + a nMx)/r² + ab (12 xMx/r² - 2 tr M)/r²) / π r⁴ with a = P·x and b = n·x, of which for a disk on the axis
    /// Eq. (1) begins; and for the way T in which their normals turn (b tr T + xTn - 4 b xTx/r²) / π r⁴. Without that one all that is seen of a
    /// sphere from inside was 2 to 3 % too dark.
    #[inline(always)]
    pub(super) fn arriving<const WIDTH: usize>(&self, of: &Rows, radius: f32, asking: Mask) -> Row {
        let [diagonal, mixed] = self.spread;
        let times = |v: Vec3| diagonal * v + mixed.zxy() * v.yzx() + mixed.yzx() * v.zxy();
        let spread_flux = times(self.flux);
        let trace = diagonal.element_sum();
        let turn = self.turn.x_axis.x + self.turn.y_axis.y + self.turn.z_axis.z;
        let turned = self.turn.transpose();
        let mut arriving = [0.0; LANES];
        for first in (0..LANES).step_by(WIDTH) {
            if !is_any::<WIDTH>(asking, first) {
                continue;
            }
            for (lane, arriving) in (first..).zip(&mut arriving[first..first + WIDTH]) {
                let (to, normal) = (of.to(self.centre, lane), of.normal(lane));
                // Nearer than this it is opened, whatever this says.
                let nearness = 1.0 / to.length_squared().max(radius * radius);
                let (a, b) = (-self.flux.dot(to), normal.dot(to));
                let (of_to, turned_to) = (times(to), turned * to);
                // What is in proportion to n, and to b.
                let by_normal = spread_flux + 4.0 * a * nearness * of_to + turned_to;
                let by_height = 4.0 * (spread_flux + turned_to).dot(to)
                    + a * (12.0 * to.dot(of_to) * nearness - 2.0 * trace);
                let change = b * (by_height * nearness - turn) - normal.dot(by_normal);
                let plain = (a * b).max(0.0);
                let change = change.max(-MOST_GAIN * plain).min(MOST_GAIN * plain);
                *arriving = (plain + change) * FRAC_1_PI * nearness * nearness;
            }
        }
        arriving
    }
}
