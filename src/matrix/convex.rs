//! Convex polygons with few corners, kept without allocation, and their division by planes.

use glam::DVec3;

/// A planar convex polygon of at most [`Convex::MOST`] corners.
#[derive(Debug, Clone, Copy)]
pub(super) struct Convex {
    corners: [DVec3; Self::MOST],
    len: usize,
}

/// The two parts of a polygon beside a plane.
pub(super) struct Halves {
    /// Where the height is positive.
    pub above: Convex,
    /// Where it is negative.
    pub below: Convex,
}

impl Convex {
    /// Each plane adds at most one corner; a quad seldom meets more than a few.
    pub const MOST: usize = 12;

    pub const EMPTY: Self = Self {
        corners: [DVec3::ZERO; Self::MOST],
        len: 0,
    };

    /// A polygon of the given corners, of which there are at most [`Self::MOST`].
    pub fn new(corners: &[DVec3]) -> Self {
        let mut polygon = Self::EMPTY;
        for corner in corners {
            polygon.push(*corner);
        }
        polygon
    }

    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..self.len]
    }

    /// The corners of a quad, or of a triangle with its last twice.
    pub fn quad(&self) -> [DVec3; 4] {
        let c = self.corners();
        [c[0], c[1], c[2], *c.get(3).unwrap_or(&c[2])]
    }

    /// Fewer than three corners: nothing is left.
    pub fn is_empty(&self) -> bool {
        self.len < 3
    }

    /// Whether one more cut could ask for more corners than there is room for.
    pub fn is_full(&self) -> bool {
        self.len + 1 >= Self::MOST
    }

    fn push(&mut self, corner: DVec3) {
        self.corners[self.len] = corner;
        self.len += 1;
    }

    /// Divides by the plane where `height`, a linear function, is 0; corners nearer to it than `reach` lie on it.
    pub fn divide(&self, height: impl Fn(DVec3) -> f64, reach: f64) -> Halves {
        let mut heights = [0.0; Self::MOST];
        for (slot, corner) in heights.iter_mut().zip(self.corners()) {
            *slot = height(*corner);
        }
        self.divide_at(&heights, reach)
    }

    /// The same where the heights of the corners are known.
    pub fn divide_at(&self, heights: &[f64; Self::MOST], reach: f64) -> Halves {
        let mut halves = Halves {
            above: Self::EMPTY,
            below: Self::EMPTY,
        };
        for i in 0..self.len {
            let next = if i + 1 == self.len { 0 } else { i + 1 };
            let (a, b) = (self.corners[i], self.corners[next]);
            let (ha, hb) = (heights[i], heights[next]);
            if ha >= -reach {
                halves.above.push(a);
            }
            if ha <= reach {
                halves.below.push(a);
            }
            if (ha > reach && hb < -reach) || (ha < -reach && hb > reach) {
                let crossing = a + (b - a) * (ha / (ha - hb));
                halves.above.push(crossing);
                halves.below.push(crossing);
            }
        }
        halves
    }

    /// Splits into quads and triangles: fans of quads from the first corner. Nothing from nothing.
    pub fn tiles(&self) -> impl Iterator<Item = Convex> + '_ {
        let first = self.corners[0];
        (1..self.len.saturating_sub(1)).step_by(2).map(move |i| {
            let end = (i + 3).min(self.len);
            let mut tile = Convex::EMPTY;
            tile.push(first);
            self.corners[i..end].iter().for_each(|c| tile.push(*c));
            tile
        })
    }

    /// A quad or triangle in four similar parts.
    pub fn quarters(&self) -> [Convex; 4] {
        let c = self.corners();
        let middle = |i: usize, j: usize| (c[i] + c[j]) * 0.5;
        match *c {
            [p, q, r] => {
                let (a, b, d) = (middle(0, 1), middle(1, 2), middle(2, 0));
                [[p, a, d], [a, q, b], [d, b, r], [a, b, d]].map(|t| Convex::new(&t))
            }
            _ => {
                let centre = (c[0] + c[1] + c[2] + c[3]) * 0.25;
                let sides = [middle(0, 1), middle(1, 2), middle(2, 3), middle(3, 0)];
                std::array::from_fn(|i| Convex::new(&[c[i], sides[i], centre, sides[(i + 3) % 4]]))
            }
        }
    }
}

/// Leaves in `above` the part of a convex polygon where `height`, a linear function, is positive; corners nearer to 0 than `reach` belong
/// to it.
pub(super) fn part_above(
    polygon: &[DVec3],
    height: impl Fn(DVec3) -> f64,
    reach: f64,
    above: &mut Vec<DVec3>,
) {
    above.clear();
    let Some(mut a) = polygon.last().copied() else {
        return;
    };
    let mut ha = height(a);
    for b in polygon {
        let hb = height(*b);
        if (ha > reach && hb < -reach) || (ha < -reach && hb > reach) {
            above.push(a + (*b - a) * (ha / (ha - hb)));
        }
        if hb >= -reach {
            above.push(*b);
        }
        (a, ha) = (*b, hb);
    }
}

/// A convex polygon of any number of corners in parts of no more than eight, which leaves room for what is cut out of them.
pub(super) fn fan(polygon: &[DVec3]) -> impl Iterator<Item = Convex> + '_ {
    (1..polygon.len().saturating_sub(1))
        .step_by(6)
        .map(|first| {
            let mut part = Convex::new(&polygon[..1]);
            let end = (first + 7).min(polygon.len());
            polygon[first..end].iter().for_each(|c| part.push(*c));
            part
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::vector_area;

    fn area(polygon: &Convex) -> f64 {
        if polygon.is_empty() {
            0.0
        } else {
            vector_area(polygon.corners()).length()
        }
    }

    fn hexagon() -> Convex {
        let corner = |i: u32| {
            DVec3::new(
                (f64::from(i) / 6.0 * std::f64::consts::TAU).cos(),
                (f64::from(i) / 6.0 * std::f64::consts::TAU).sin(),
                2.0,
            )
        };
        Convex::new(&[0, 1, 2, 3, 4, 5].map(corner))
    }

    #[test]
    fn parts_add_up() {
        let whole = hexagon();
        for offset in [-2.0, -0.3, 0.0, 0.5, 1.0, 3.0] {
            let Halves { above, below } = whole.divide(|p| p.x + 0.2 * p.y - offset, 1e-12);
            assert!((area(&above) + area(&below) - area(&whole)).abs() < 1e-12);
        }
        let tiles: f64 = whole.tiles().map(|tile| area(&tile)).sum();
        assert!((tiles - area(&whole)).abs() < 1e-12);
        for tile in whole.tiles() {
            let quarters: f64 = tile.quarters().iter().map(area).sum();
            assert!((quarters - area(&tile)).abs() < 1e-12);
        }
    }
}
