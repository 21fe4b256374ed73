//! One ray to its nearest hit: near children first, boxes behind the best hit are skipped.

use super::fan::{ROUNDING, SHORTEST};
use super::probe::Probe;
use super::tree::{Content, Node, Tree};
use crate::visibility::{Hit, Ray, traceable};
use glam::Vec3;

/// A pair that waits for its turn, and where the ray enters its box.
pub type Waiting = (u32, f32);

/// The nearest hit with t > 0; of several at the same distance the triangle of the lowest index.
pub fn nearest(tree: &Tree, ray: &Ray, stack: &mut Vec<Waiting>) -> Option<Hit> {
    let root = tree.root.as_ref()?;
    if !traceable(ray.origin, ray.direction) {
        return None;
    }
    let mut search = Search {
        tree,
        ray,
        inverse: inverse(ray.direction),
        best: None,
    };
    stack.clear();
    search.visit(root, stack);
    while let Some((pair, entry)) = stack.pop() {
        if entry > search.limit() {
            continue;
        }
        let [left, right] = &tree.pairs[pair as usize].0;
        let waiting = stack.len();
        search.visit(left, stack);
        search.visit(right, stack);
        // Two inner children: the nearer one is popped first.
        if let [.., (_, first), (_, second)] = stack[waiting..]
            && first < second
        {
            stack.swap(waiting, waiting + 1);
        }
    }
    search.best
}

struct Search<'a> {
    tree: &'a Tree,
    ray: &'a Ray,
    inverse: Vec3,
    best: Option<Hit>,
}

impl Search<'_> {
    /// No hit behind this can be the nearest.
    fn limit(&self) -> f32 {
        self.best.map_or(f32::INFINITY, |hit| hit.t * ROUNDING)
    }

    /// Tests the triangles of a leaf, or puts off the children of an inner node, if the ray enters.
    fn visit(&mut self, node: &Node, stack: &mut Vec<Waiting>) {
        let Some(entry) = self.entry(node) else {
            return;
        };
        match node.content() {
            Content::Inner(pair) => stack.push((pair, entry)),
            Content::Leaf(triangles) => triangles.for_each(|i| self.test(i)),
        }
    }

    /// Where the ray enters a box, if it does before [`Self::limit`].
    fn entry(&self, node: &Node) -> Option<f32> {
        let a = (Vec3::from_array(node.min) - self.ray.origin) * self.inverse;
        let b = (Vec3::from_array(node.max) - self.ray.origin) * self.inverse;
        let enter = a.min(b).max_element().max(0.0);
        let leave = a.max(b).min_element().min(self.limit());
        (enter <= leave * ROUNDING).then_some(enter)
    }

    fn test(&mut self, i: usize) {
        let probe = Probe::new(&self.tree.corners[i], self.ray.origin);
        let Some(crossing) = probe.crossing(self.ray.direction) else {
            return;
        };
        let (t, triangle) = (crossing.t as f32, self.tree.indices[i]);
        if !(t > 0.0 && t < f32::INFINITY) {
            return;
        }
        let nearer = |best: Hit| t < best.t || (t == best.t && triangle < best.triangle);
        if self.best.is_none_or(nearer) {
            let (u, v) = (crossing.u as f32, crossing.v as f32);
            self.best = Some(Hit { t, triangle, u, v });
        }
    }
}

/// One over each component, finite.
fn inverse(direction: Vec3) -> Vec3 {
    let tiny = direction.abs().cmplt(Vec3::splat(SHORTEST));
    Vec3::select(tiny, Vec3::splat(SHORTEST), direction).recip()
}
