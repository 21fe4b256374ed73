//! The way through the tree: a few points side by side, each down to the coarsest clusters that its thresholds allow.

use super::found::Found;
use super::view::{LANES, Mask, Row, Rows, Views, lanes, mask};
use super::{Cluster, Clusters, Node, Tile};
use crate::form_factor::disk::point_to_disk;
use crate::form_factor::hybrid::{Receiver, above_horizon, point_in_cut};
use crate::form_factor::polygon::{point_to_quad, point_to_visible_polygon};
use crate::form_factor::{Formula, Sampler};
use crate::geometry::jitter;
use crate::radiometry::Spectrum;
use crate::simd::{Kernel, prefetch};
use glam::Vec3;

/// Parts that one point may gather before its thresholds are doubled; half as many more double them again.
const MOST: usize = 2048;

/// Light that is known to be there counts at least this part of the scene's reference: where it is dark, thresholds need not follow
/// the light to nothing.
const LEAST_KNOWN: f32 = 0.4;

/// A cluster that looks larger than this, radius over distance, is not taken whole for the first guess of the light at a point.
const GUESS: f32 = 1.0;

/// A cluster that looks larger than this is opened, unless no more than ε_fd can arrive.
const LARGE: f32 = 0.5;

/// A cluster of which a point may see a part is taken if no more than this part of ε_fe can arrive.
const PART: f32 = 0.5;

/// Rays along each side of a tile that gives a point much.
const MOST_RAYS: u32 = 4;

/// What a point sees of a tile, occlusion left aside.
struct Sight {
    form_factor: f64,
    /// Whether the horizon cuts the tile.
    cut: bool,
}

/// A few points on their way.
pub(super) struct Walk<'a> {
    pub sampler: &'a Sampler<'a>,
    pub clusters: &'a Clusters,
    /// No more than [`LANES`].
    pub receivers: &'a [(Receiver, u32)],
    pub settled: bool,
    /// Clusters that are yet to be looked at, and by whom.
    pub pending: &'a mut Vec<(Cluster, Mask)>,
    /// One for each receiver.
    pub points: &'a mut [Found],
}

/// The thresholds of each point.
struct Limits {
    difference: Row,
    estimate: Row,
    /// More parts than this double them.
    most: [usize; LANES],
}

impl Kernel for Walk<'_> {
    type Output = ();

    /// Finds the parts of all points.
    #[inline(always)]
    fn run<const WIDTH: usize>(mut self) {
        let rows = Rows::new(self.receivers);
        let all = Mask::MAX >> (Mask::BITS - self.receivers.len() as u32);
        let mut limits = self.limits::<WIDTH>(&rows, all);
        self.points.iter_mut().for_each(Found::clear);
        self.begin(all);
        while let Some((cluster, asking)) = self.next() {
            let node = self.clusters.node(cluster);
            let Some(views) = self.views::<WIDTH>(&node, &rows, asking) else {
                continue;
            };
            let opened = self.take::<WIDTH>(cluster, &node, &views, (&rows, &limits));
            self.open(cluster, &node, opened, &mut limits);
        }
        for lane in lanes(all) {
            self.points[lane].empty_pool();
            self.draw(lane, &rows);
        }
    }
}

impl Walk<'_> {
    #[inline(always)]
    fn begin(&mut self, all: Mask) {
        self.pending.clear();
        let roots = self.clusters.roots.iter().rev();
        self.pending.extend(roots.map(|root| (*root, all)));
    }

    /// The next cluster, and by whom it is asked. The walk would else wait for memory half of its time: what it will need of this one, and
    /// the one after it if this one is not opened, is asked for now.
    #[inline(always)]
    fn next(&mut self) -> Option<(Cluster, Mask)> {
        let next = self.pending.pop()?;
        if let Cluster::Node(number) = next.0 {
            prefetch(&self.clusters.sends[number as usize]);
            // The first child, unless it is a tile.
            if let Some(child) = self.clusters.nodes.get(number as usize + 1) {
                prefetch(child);
            }
        }
        match self.pending.last() {
            Some((Cluster::Node(after), _)) => prefetch(&self.clusters.nodes[*after as usize]),
            Some((Cluster::Tile(after), _)) => prefetch(&self.clusters.tiles[*after as usize]),
            None => {}
        }
        Some(next)
    }

    /// Takes a cluster by all that see any of it: those for whom it is fine take all of it at once, those of whom hardly anything can arrive
    /// from it a part. Gives those who open it.
    #[inline(always)]
    fn take<const WIDTH: usize>(
        &mut self,
        cluster: Cluster,
        node: &Node,
        views: &Views,
        (rows, limits): (&Rows, &Limits),
    ) -> Mask {
        let (difference, estimate) = (&limits.difference, &limits.estimate);
        let Views {
            seen,
            whole,
            bound,
            size,
        } = views;
        let slight = mask(|l| bound[l] <= difference[l]);
        let small = mask(|l| size[l] < LARGE);
        let part = mask(|l| bound[l] <= PART * estimate[l]) & seen & !whole;
        let mut whole = (slight | small) & seen & whole;
        if whole != 0 {
            let sends = self.clusters.sends(cluster);
            let arriving = sends.arriving::<WIDTH>(rows, node.radius, whole);
            let strongest = sends.colour.max_element();
            let is_fine = |l: usize| {
                let measure = arriving[l] * strongest;
                let left = 0.5 * size[l] * size[l] * measure;
                (measure <= estimate[l]) & (left <= difference[l])
            };
            whole &= slight | mask(is_fine);
            for lane in lanes(whole) {
                let contribution = sends.colour * arriving[lane];
                self.pool(lane, contribution, sends.aim.target, limits);
            }
        }
        if part != 0 {
            self.take_part(part, cluster, bound, (rows, limits));
        }
        seen & !whole & !part
    }

    /// What those who ask see of a cluster, if any sees any of it.
    #[inline(always)]
    fn views<const WIDTH: usize>(&self, node: &Node, rows: &Rows, asking: Mask) -> Option<Views> {
        if node.strength <= 0.0 {
            return None;
        }
        // Points no higher than a hair above a cluster lie in its plane, up to rounding.
        let hair = 0.1 * self.clusters.offset;
        let views = node.views::<WIDTH>(rows, hair, asking);
        (views.seen != 0).then_some(views)
    }

    #[inline(always)]
    fn limits<const WIDTH: usize>(&mut self, rows: &Rows, all: Mask) -> Limits {
        let mut known = [0.0; LANES];
        for (known, (receiver, _)) in known.iter_mut().zip(self.receivers) {
            *known = receiver.irradiance;
        }
        let unknown = all & mask(|l| known[l] <= 0.0);
        if unknown != 0 {
            let expected = self.expected::<WIDTH>(rows, unknown);
            lanes(unknown).for_each(|lane| known[lane] = expected[lane].max_element());
        }
        let thresholds = &self.sampler.thresholds;
        let least = LEAST_KNOWN * thresholds.scale.reference as f32;
        let unit = known.map(|known| thresholds.scale.at(f64::from(known.max(least))));
        Limits {
            difference: unit.map(|unit| (thresholds.difference * unit) as f32),
            estimate: unit.map(|unit| (thresholds.estimate * unit) as f32),
            most: [MOST; LANES],
        }
    }

    /// About what points would get were nothing in between.
    #[inline(always)]
    fn expected<const WIDTH: usize>(&mut self, rows: &Rows, all: Mask) -> [Spectrum; LANES] {
        let mut sum = [Spectrum::ZERO; LANES];
        self.begin(all);
        while let Some((cluster, asking)) = self.next() {
            let node = self.clusters.node(cluster);
            let Some(views) = self.views::<WIDTH>(&node, rows, asking) else {
                continue;
            };
            let large = mask(|l| views.size[l] > GUESS);
            let opened = match cluster {
                Cluster::Node(number) => self.descend(number, &node, large & views.seen),
                Cluster::Tile(_) => 0,
            };
            let taken = views.seen & !opened;
            let sends = self.clusters.sends(cluster);
            let whole = taken & views.whole;
            if whole != 0 {
                let arriving = sends.arriving::<WIDTH>(rows, node.radius, whole);
                lanes(whole).for_each(|l| sum[l] += sends.colour * arriving[l]);
            }
            for lane in lanes(taken & !whole) {
                sum[lane] += sends.drawn(&sends.aim, rows, lane, views.bound[lane]);
            }
        }
        sum
    }

    /// The children of a node are asked by those who have `opened` it, who are given.
    #[inline(always)]
    fn descend(&mut self, number: u32, node: &Node, opened: Mask) -> Mask {
        if opened == 0 {
            return 0;
        }
        if node.is_over_few() {
            let tiles = (node.first..node.end).rev();
            self.pending
                .extend(tiles.map(|place| (Cluster::Tile(place), opened)));
        } else {
            let [first, second] = node.children(number);
            self.pending.extend([(second, opened), (first, opened)]);
        }
        opened
    }

    #[inline(always)]
    fn open(&mut self, cluster: Cluster, node: &Node, opened: Mask, limits: &mut Limits) {
        let place = match cluster {
            Cluster::Node(number) => {
                self.descend(number, node, opened);
                return;
            }
            Cluster::Tile(place) => place,
        };
        for lane in lanes(opened) {
            self.take_tile(lane, place, limits);
            if self.points[lane].len() > limits.most[lane] {
                limits.most[lane] += MOST / 2;
                limits.difference[lane] *= 2.0;
                limits.estimate[lane] *= 2.0;
            }
        }
    }

    #[inline(always)]
    fn pool(&mut self, lane: usize, contribution: Spectrum, target: Vec3, limits: &Limits) {
        let (estimate, key) = (limits.estimate[lane], self.receivers[lane].1);
        self.points[lane].pool(contribution, target, estimate, key);
    }

    /// Takes what may be seen of a cluster in part: were it all at its aim, or at a point that is yet to be drawn.
    #[inline(always)]
    fn take_part(
        &mut self,
        by: Mask,
        cluster: Cluster,
        bound: &Row,
        (rows, limits): (&Rows, &Limits),
    ) {
        if self.settled {
            let sends = self.clusters.sends(cluster);
            for lane in lanes(by) {
                let contribution = sends.drawn(&sends.aim, rows, lane, bound[lane]);
                self.pool(lane, contribution, sends.aim.target, limits);
            }
            return;
        }
        for lane in lanes(by) {
            let (estimate, key) = (limits.estimate[lane], self.receivers[lane].1);
            self.points[lane].loosen(cluster, bound[lane], estimate, key);
        }
    }

    /// Takes what a point has put off: what may be seen of clusters in part, were they all at a point drawn of them.
    #[inline(always)]
    fn draw(&mut self, lane: usize, rows: &Rows) {
        let (clusters, key) = (self.clusters, self.receivers[lane].1);
        self.points[lane].draw(clusters, key, |of, aim| {
            let sends = clusters.sends(of.cluster);
            sends.drawn(aim, rows, lane, of.bound) * of.stands_for
        });
    }

    /// What a point sees of a tile from in front. Clusters take Eq. (1) where the five-times rule would; a single tile is near.
    fn sight(&self, receiver: Receiver, tile: &Tile) -> Option<Sight> {
        let corners = tile.corners.map(Vec3::as_dvec3);
        let normal = tile.normal.as_dvec3();
        let heights = corners.map(|corner| receiver.height(corner));
        let is_below = heights.iter().all(|height| *height <= 0.0);
        if is_below || normal.dot(corners[0] - receiver.point) >= 0.0 {
            return None;
        }
        if let Formula::Disk = self.sampler.formula {
            let to = tile.centre().as_dvec3() - receiver.point;
            let area = f64::from(tile.area());
            return Some(Sight {
                form_factor: point_to_disk(receiver.normal, to, normal, area),
                cut: false,
            });
        }
        let cut = heights.iter().any(|height| *height < 0.0);
        let relative = corners.map(|corner| corner - receiver.point);
        let form_factor = if cut {
            point_to_visible_polygon(receiver.normal, &relative[..tile.corner_count()]).0
        } else {
            point_to_quad(receiver.normal, relative).max(0.0)
        };
        Some(Sight { form_factor, cut })
    }

    #[inline(always)]
    fn take_tile(&mut self, lane: usize, number: u32, limits: &Limits) {
        let (receiver, key) = self.receivers[lane];
        let (tile, radiosity) = self.clusters.tile(number);
        if radiosity.max_element() <= 0.0 {
            return;
        }
        let Some(sight) = self.sight(receiver, tile) else {
            return;
        };
        let contribution = radiosity * sight.form_factor as f32;
        let measure = contribution.max_element();
        if measure <= 0.0 {
            return;
        }
        let side = (measure / limits.estimate[lane]).sqrt().ceil();
        let side = (side as u32).clamp(1, MOST_RAYS);
        let cut = sight.cut.then(|| {
            let corners = tile.corners.map(Vec3::as_dvec3);
            above_horizon(receiver, &corners[..tile.corner_count()])
        });
        let aim = |ray: u32| {
            let [s, t] = jitter(key, number ^ ray.wrapping_mul(0x9e37_79b9));
            let place = |i: u32, x: f64| (f64::from(i) + 0.05 + 0.9 * x) / f64::from(side);
            let (s, t) = (place(ray % side, s), place(ray / side, t));
            let point = match &cut {
                Some(cut) => (receiver.point + point_in_cut(cut, s, t)).as_vec3(),
                None => tile.at(s as f32, t as f32),
            };
            point + tile.normal * self.clusters.offset
        };
        if side == 1 {
            self.pool(lane, contribution, aim(0), limits);
        } else {
            // What is near counts more of a tile that is hidden in part.
            let kernel = |target: Vec3| {
                let to = target - receiver.point.as_vec3();
                let (a, b) = (-tile.normal.dot(to), receiver.normal.as_vec3().dot(to));
                (a * b).max(0.0) / to.length_squared().powi(2)
            };
            let targets = (0..side * side).map(aim);
            self.points[lane].push_all(contribution, targets, kernel);
        }
    }
}
