//! Which surfaces come near one another.
//!
//! A tree of boxes, packed as `rstar` packs one (overlap-minimising top-down bulk loading, Lee & Lee 2003), but in two flat lists: nodes
//! that each have a list of their own were a million small pieces of memory, and the holes that they left were there for the whole solve.

use crate::geometry::bounds;
use crate::scene::Surface;
use glam::DVec3;

/// No node over fewer surfaces has others below it.
const FULL: usize = 6;

/// The boxes around all surfaces of a scene, in a tree.
pub(super) struct Neighbours {
    /// Those of surfaces, in the order of the leaves from the last one on.
    boxes: Vec<Around>,
    /// Each before those below it, the last one first.
    nodes: Vec<Node>,
}

/// A surface with the box around it.
struct Around {
    bounds: Bounds,
    surface: u32,
}

/// The box around the boxes `first..end`.
struct Node {
    bounds: Bounds,
    first: u32,
    end: u32,
    /// The node that follows those below it.
    after: u32,
}

#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Neighbours {
    pub fn new(surfaces: &[Surface], positions: &[DVec3]) -> Self {
        let numbered = surfaces.iter().zip(0..);
        let boxes = numbered.map(|(surface, number)| Around {
            bounds: Bounds::around(surface.corners.places(positions)),
            surface: number,
        });
        let mut boxes: Vec<Around> = boxes.collect();
        // Room for more than there will be takes no memory, growing would.
        let mut nodes = Vec::with_capacity(boxes.len());
        let depth = least_depth(boxes.len());
        add(&mut nodes, &mut boxes, 0, depth);
        Self { boxes, nodes }
    }

    /// The surfaces whose boxes come closer than `margin` to the box around `corners`.
    pub fn of(&self, corners: &[DVec3], margin: f64) -> impl Iterator<Item = u32> + '_ {
        let Bounds { low, high } = Bounds::around(corners.iter().copied());
        let place = Bounds {
            low: low - margin,
            high: high + margin,
        };
        let mut next = 0;
        let leaves = std::iter::from_fn(move || {
            while let Some(node) = self.nodes.get(next) {
                let below = next + 1;
                let after = node.after as usize;
                let meets = node.bounds.meets(&place);
                next = if meets { below } else { after };
                if meets && below == after {
                    return Some(&self.boxes[node.first as usize..node.end as usize]);
                }
            }
            None
        });
        let boxes = leaves.flat_map(|leaf| leaf.iter().rev());
        boxes
            .filter(move |of| of.bounds.meets(&place))
            .map(|of| of.surface)
    }
}

impl Bounds {
    fn around(points: impl Iterator<Item = DVec3>) -> Self {
        let (low, high) = bounds(points);
        Self { low, high }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && self.high.cmpge(other.low).all()
    }
}

/// Adds the node over `boxes`, of which the first has the number `first`, and the nodes below it, down to leaves `depth` levels deep.
fn add(nodes: &mut Vec<Node>, boxes: &mut [Around], first: usize, depth: usize) {
    let ends = boxes.iter().flat_map(|of| [of.bounds.low, of.bounds.high]);
    let number = nodes.len();
    nodes.push(Node {
        bounds: Bounds::around(ends),
        first: first as u32,
        end: (first + boxes.len()) as u32,
        after: 0,
    });
    if depth > 1 {
        let slabs = slabs_along_axis(boxes.len());
        slice(boxes, first, (slabs, 3), &mut |part, first| {
            add(nodes, part, first, depth - 1)
        });
    }
    nodes[number].after = nodes.len() as u32;
}

/// Slices boxes into so many slabs along each of the first `axes` axes, and takes up the parts, the last one first.
fn slice(
    mut boxes: &mut [Around],
    first: usize,
    (slabs, axes): (usize, usize),
    take_up: &mut impl FnMut(&mut [Around], usize),
) {
    let Some(axis) = axes.checked_sub(1) else {
        return take_up(boxes, first);
    };
    let thickness = boxes.len().div_ceil(slabs);
    while boxes.len() > thickness {
        let begin = boxes.len() - thickness;
        let low = |of: &Around| of.bounds.low[axis] + 0.0;
        boxes.select_nth_unstable_by(begin, |a, b| low(a).total_cmp(&low(b)));
        let (rest, slab) = boxes.split_at_mut(begin);
        slice(slab, first + begin, (slabs, axis), take_up);
        boxes = rest;
    }
    slice(boxes, first, (slabs, axis), take_up);
}

/// Into how many slabs along each axis so many boxes are sliced: the nodes below them are to be full.
fn slabs_along_axis(boxes: usize) -> usize {
    let full = FULL as f32;
    let depth = (boxes as f32).log(full).ceil() as i32;
    let parts = (boxes as f32 / full.powi(depth - 1)).ceil();
    (parts.powf(1.0 / 3.0).floor() as usize).max(2)
}

/// How deep the shallowest leaf is if each node over no more than [`FULL`] boxes is one: so deep are all.
fn least_depth(boxes: usize) -> usize {
    if boxes <= FULL {
        return 1;
    }
    1 + least_depth_of_parts(boxes, slabs_along_axis(boxes), 3)
}

/// That of the parts that `boxes` are sliced into along so many axes: slabs of the same size, and a last one with the rest.
fn least_depth_of_parts(boxes: usize, slabs: usize, axes: usize) -> usize {
    if axes == 0 {
        return least_depth(boxes);
    }
    let thickness = boxes.div_ceil(slabs);
    let rest = boxes - (boxes.div_ceil(thickness) - 1) * thickness;
    let depth = |boxes| least_depth_of_parts(boxes, slabs, axes - 1);
    match rest == thickness {
        true => depth(thickness),
        false => depth(thickness).min(depth(rest)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Corners, Sides};
    use rstar::primitives::{GeomWithData, Rectangle};
    use rstar::{AABB, RTree};

    /// Triangles in a cube, with corners on a lattice: many of them touch.
    fn triangles(count: u32) -> (Vec<Surface>, Vec<DVec3>) {
        let mut random = fastrand::Rng::with_seed(u64::from(count));
        let mut coordinate = || f64::from(random.u8(..32)) - 16.0;
        let mut corner = || DVec3::new(coordinate(), coordinate(), coordinate());
        let positions = (0..3 * count).map(|_| corner()).collect();
        let surface = |number| Surface {
            corners: Corners::Triangle([0, 1, 2].map(|corner| 3 * number + corner)),
            material: 0,
            polygon: number,
            sides: Sides::Front,
        };
        ((0..count).map(surface).collect(), positions)
    }

    #[test]
    fn those_near_are_found_in_the_order_of_rstar() {
        for count in [0, 1, 6, 7, 25, 216, 217, 1000, 2345] {
            let (surfaces, positions) = triangles(count);
            let boxes = surfaces.iter().zip(positions.chunks(3));
            let boxes = boxes.map(|(surface, corners)| {
                let Bounds { low, high } = Bounds::around(corners.iter().copied());
                let around = Rectangle::from_corners(low.to_array(), high.to_array());
                GeomWithData::new(around, surface.polygon)
            });
            let tree = RTree::bulk_load(boxes.collect());
            let neighbours = Neighbours::new(&surfaces, &positions);
            for corners in positions.chunks(3) {
                let Bounds { low, high } = Bounds::around(corners.iter().copied());
                let [low, high] = [low - 0.5, high + 0.5].map(|end| end.to_array());
                let expected = tree.locate_in_envelope_intersecting(AABB::from_corners(low, high));
                let found = neighbours.of(corners, 0.5);
                assert!(found.eq(expected.map(|found| found.data)), "of {count}");
            }
        }
    }
}
