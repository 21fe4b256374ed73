//! All segments of a fan through the tree together.
//!
//! Because they share their origin, a box is moved to it once and a triangle is prepared once for all
//! of them; and because they head for one place, the nearer of two boxes is opened first. An inner node is entered by the whole fan as soon as one segment enters it; in a leaf only
//! the segments that enter its box are tested. A box contains those of its descendants, and every
//! operation of the box test is monotonic, also when rounded; so a segment that enters a leaf's box
//! enters all boxes above, and its answer is the same in whatever company it travels.

use super::lanes::Lanes;
use super::probe::{Probe, Verdict, error_bound};
use super::tree::{Content, Node, Tree};
use crate::visibility::{COORDINATE_LIMIT, Fans, MAX_FAN, T_FAR, T_NEAR, in_range};
use glam::Vec3;

/// Directions shorter than this along an axis count as this long: their inverse stays finite.
pub(super) const SHORTEST: f32 = 1e-18;
/// The last of the products in the box test is enlarged by its six roundings and a reserve.
pub(super) const ROUNDING: f32 = 1.0 + 4.0 * f32::EPSILON;

/// The segments of one fan, up to 64, in arrays of one coordinate each.
#[repr(align(64))]
struct Segments {
    direction: [[f32; MAX_FAN]; 3],
    /// One over the direction's components, finite.
    inverse: [[f32; MAX_FAN]; 3],
    /// Sum of the magnitudes of a direction's components.
    size: [f32; MAX_FAN],
    origin: Vec3,
    /// About where the segments go.
    heading: Vec3,
    /// Which segments are not known to be occluded.
    active: u64,
}

/// Appends a mask for each fan.
#[inline(always)]
pub fn occluded<L: Lanes>(tree: &Tree, fans: &Fans, masks: &mut Vec<u64>) {
    let mut stack = Vec::with_capacity(tree.depth());
    let mut segments = Segments {
        direction: [[0.0; MAX_FAN]; 3],
        inverse: [[0.0; MAX_FAN]; 3],
        size: [0.0; MAX_FAN],
        origin: Vec3::ZERO,
        heading: Vec3::ZERO,
        active: 0,
    };
    for fan in 0..fans.len() {
        segments.fill::<L>(fans, fan);
        let asked = segments.active;
        segments.traverse::<L>(tree, &mut stack);
        masks.push(asked & !segments.active);
    }
}

impl Segments {
    /// Takes fan `fan`; segments that cannot be traced are left out, as
    /// [`traceable`](crate::visibility::traceable) has it.
    #[inline(always)]
    fn fill<L: Lanes>(&mut self, fans: &Fans, fan: usize) {
        let range = fans.range(fan);
        let count = range.len();
        self.origin = fans.origins[fan];
        for (row, targets) in self.direction.iter_mut().zip([&fans.x, &fans.y, &fans.z]) {
            row[..count].copy_from_slice(&targets[range.clone()]);
        }
        let mut traceable = 0;
        for group in (0..count).step_by(L::WIDTH) {
            traceable |= u64::from(self.prepare::<L>(group)) << group;
        }
        let unused = (MAX_FAN - count) as u32;
        let used = u64::MAX.checked_shr(unused).unwrap_or(0);
        self.active = if in_range(self.origin) {
            traceable & used
        } else {
            0
        };
        self.heading = match count {
            0 => Vec3::ZERO,
            n => self.direction(0) + self.direction(n - 1),
        };
    }

    /// Turns a group of targets into directions and what follows from them; mask of those in range.
    #[inline(always)]
    fn prepare<L: Lanes>(&mut self, group: usize) -> u32 {
        let limit = L::splat(COORDINATE_LIMIT);
        let (mut size, mut in_range) = (L::splat(0.0), u32::MAX);
        for axis in 0..3 {
            let target = L::load(&self.direction[axis][group..]);
            let direction = target.sub(L::splat(self.origin[axis]));
            direction.store(&mut self.direction[axis][group..]);
            direction
                .inverse(SHORTEST)
                .store(&mut self.inverse[axis][group..]);
            size = size.add(direction.abs());
            in_range &= direction.abs().le(limit);
        }
        size.store(&mut self.size[group..]);
        in_range
    }

    /// Clears the bits of occluded segments in `active`.
    #[inline(always)]
    fn traverse<L: Lanes>(&mut self, tree: &Tree, stack: &mut Vec<u32>) {
        let Some(root) = &tree.root else { return };
        stack.clear();
        stack.extend(self.visit::<L>(tree, root));
        while let Some(pair) = stack.pop() {
            let [left, right] = &tree.pairs[pair as usize].0;
            let inner = (self.visit::<L>(tree, left), self.visit::<L>(tree, right));
            if self.active == 0 {
                return;
            }
            match inner {
                (Some(l), Some(r)) if self.ahead(left) <= self.ahead(right) => {
                    stack.extend([r, l]);
                }
                (Some(l), Some(r)) => stack.extend([l, r]),
                (one, other) => stack.extend(one.or(other)),
            }
        }
    }

    /// Tests the triangles of a leaf; gives the children of an inner node, if a segment enters it.
    #[inline(always)]
    fn visit<L: Lanes>(&mut self, tree: &Tree, node: &Node) -> Option<u32> {
        match node.content() {
            Content::Inner(pair) => (self.entering::<L>(node, true) != 0).then_some(pair),
            Content::Leaf(triangles) => {
                let entering = self.entering::<L>(node, false);
                if entering != 0 {
                    let [min, max] = [node.min, node.max].map(|v| Vec3::from(v) - self.origin);
                    let error = error_bound(min, max);
                    for corners in &tree.corners[triangles] {
                        self.test::<L>(&Probe::new(corners, self.origin), error, entering);
                    }
                }
                None
            }
        }
    }

    /// How far ahead the middle of a box lies, up to a factor and a constant.
    #[inline(always)]
    fn ahead(&self, node: &Node) -> f32 {
        (Vec3::from_array(node.min) + Vec3::from_array(node.max)).dot(self.heading)
    }

    /// Mask of the active segments that enter a box; if `any` will do, not all of them.
    #[inline(always)]
    fn entering<L: Lanes>(&self, node: &Node, any: bool) -> u64 {
        let mut min = [L::splat(0.0); 3];
        let mut max = min;
        for axis in 0..3 {
            min[axis] = L::splat(node.min[axis] - self.origin[axis]);
            max[axis] = L::splat(node.max[axis] - self.origin[axis]);
        }
        let (near, far) = (L::splat(T_NEAR), L::splat(T_FAR));
        let mut mask = 0;
        for group in (0..MAX_FAN).step_by(L::WIDTH) {
            let active = self.active_in::<L>(group);
            if active == 0 {
                continue;
            }
            let (mut enter, mut leave) = (near, far);
            for axis in 0..3 {
                let inverse = L::load(&self.inverse[axis][group..]);
                let (a, b) = (min[axis].mul(inverse), max[axis].mul(inverse));
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
            let inside = enter.le(leave.mul(L::splat(ROUNDING))) & active;
            mask |= u64::from(inside) << group;
            if any && mask != 0 {
                break;
            }
        }
        mask
    }

    /// Tests the segments in `candidates` against one triangle.
    #[inline(always)]
    fn test<L: Lanes>(&mut self, probe: &Probe, error: f32, candidates: u64) {
        for group in (0..MAX_FAN).step_by(L::WIDTH) {
            let candidates = (candidates >> group) as u32 & self.active_in::<L>(group);
            if candidates == 0 {
                continue;
            }
            let [x, y, z] = &self.direction;
            let direction = [
                L::load(&x[group..]),
                L::load(&y[group..]),
                L::load(&z[group..]),
            ];
            let error = L::load(&self.size[group..]).mul(L::splat(error));
            let Verdict {
                mut crossed,
                doubtful,
            } = probe.crossed(direction, error);
            let mut doubtful = doubtful & candidates;
            while doubtful != 0 {
                let lane = doubtful.trailing_zeros();
                crossed |= u32::from(probe.settle(self.direction(group + lane as usize))) << lane;
                doubtful &= doubtful - 1;
            }
            self.active &= !(u64::from(crossed & candidates) << group);
        }
    }

    fn direction(&self, segment: usize) -> Vec3 {
        Vec3::from_array([0, 1, 2].map(|axis| self.direction[axis][segment]))
    }

    /// The bits of the active segments from `group` on, as many as there are lanes.
    #[inline(always)]
    fn active_in<L: Lanes>(&self, group: usize) -> u32 {
        ((self.active >> group) & ((1 << L::WIDTH) - 1)) as u32
    }
}
