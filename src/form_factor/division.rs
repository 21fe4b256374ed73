//! How a patch is cut into cells, level by level.

use super::cell::SourceShape;
use super::source::DEEPEST;
use glam::DVec3;

/// How a patch is cut into cells: each into quarters, but a strip into slices first, so that its cells are no strips. Light on a strip
/// changes over its width, and quarters as narrow as that would be as many times as long as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Division {
    pub(super) shape: SourceShape,
    /// Levels of slices, before those of quarters; none of a triangle.
    pub(super) sliced: u32,
    /// Whether slices follow one another from the first side to the third, rather than from the fourth to the second.
    pub(super) upwards: bool,
}

/// How the cells of a level are cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cut {
    /// Across their longer sides: as the flag of [`Division::upwards`] says.
    Slices {
        upwards: bool,
    },
    Quarters,
}

/// Slices are four times as short as what is cut; what is longer than wide by less than this would be wider than long by more.
const STRIP: f64 = 2.0;

impl Division {
    /// The one that suits a convex polygon of three or four corners.
    pub fn of(corners: &[DVec3]) -> Self {
        let &[a, b, c, d] = corners else {
            return Self::even(SourceShape::Triangle);
        };
        let width = a.distance(b).max(c.distance(d));
        let height = b.distance(c).max(d.distance(a));
        let ratio = width.max(height) / width.min(height);
        // Rounding must not decide about halves.
        let slices = (ratio / STRIP * (1.0 - 1e-6)).log(4.0).ceil();
        Self {
            shape: SourceShape::Quad,
            sliced: slices.clamp(0.0, f64::from(DEEPEST)) as u32,
            upwards: height > width,
        }
    }

    /// Quarters on all levels.
    pub const fn even(shape: SourceShape) -> Self {
        Self {
            shape,
            sliced: 0,
            upwards: false,
        }
    }

    /// The shape of all cells.
    pub const fn shape(self) -> SourceShape {
        self.shape
    }

    /// How the cells of a level are cut.
    #[inline(always)]
    pub(super) const fn cut(self, level: u32) -> Cut {
        if level < self.sliced {
            Cut::Slices {
                upwards: self.upwards,
            }
        } else {
            Cut::Quarters
        }
    }

    /// The corners of the four parts of a cell of a level; quarters in the order in which the mesh numbers the children of an element.
    pub fn children<P: Copy>(
        self,
        level: u32,
        corners: [P; 4],
        midpoint: impl Fn(P, P) -> P,
        centre: impl Fn([P; 4]) -> P,
    ) -> [[P; 4]; 4] {
        match self.cut(level) {
            Cut::Quarters => self.shape.children(corners, midpoint, centre),
            Cut::Slices { upwards } => slices(corners, upwards, midpoint),
        }
    }
}

/// A quad in four slices, each with its corners in the order of the quad's.
fn slices<P: Copy>(
    [a, b, c, d]: [P; 4],
    upwards: bool,
    midpoint: impl Fn(P, P) -> P,
) -> [[P; 4]; 4] {
    let along = |from: P, to: P| {
        let middle = midpoint(from, to);
        let quarters = [midpoint(from, middle), middle, midpoint(middle, to)];
        [from, quarters[0], quarters[1], quarters[2], to]
    };
    let (near, far) = if upwards {
        (along(a, d), along(b, c))
    } else {
        (along(a, b), along(d, c))
    };
    [0, 1, 2, 3].map(|i| {
        let [p, q, r, s] = [near[i], near[i + 1], far[i + 1], far[i]];
        if upwards { [p, s, r, q] } else { [p, q, r, s] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of this width and height.
    fn divided(width: f64, height: f64) -> Division {
        let [u, v] = [DVec3::X * width, DVec3::Y * height];
        Division::of(&[DVec3::ZERO, u, u + v, v])
    }

    #[test]
    fn cells_are_no_strips() {
        for i in 0..80 {
            let ratio = 1.1_f64.powi(i);
            let [wide, high] = [divided(ratio, 1.0), divided(1.0, ratio)];
            let cell = ratio / 4_f64.powi(wide.sliced as i32);
            assert!(cell < 2.01 && (cell > 0.49 || wide.sliced == 0), "{ratio}");
            assert_eq!(wide.sliced, high.sliced);
            assert!(i == 0 || high.upwards != wide.upwards);
        }
        assert_eq!(
            [1.0, 2.0, 8.0].map(|ratio| divided(ratio, 1.0).sliced),
            [0, 0, 1]
        );
    }

    #[test]
    fn slices_lie_side_by_side() {
        let corners = [[0, 0], [8, 0], [8, 8], [0, 8]];
        let half = |p: [i32; 2], q: [i32; 2]| [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
        let wide = slices(corners, false, half);
        assert_eq!(wide[1], [[2, 0], [4, 0], [4, 8], [2, 8]]);
        let high = slices(corners, true, half);
        assert_eq!(high[3], [[0, 6], [8, 6], [8, 8], [0, 8]]);
    }
}
