//! A grid of points on a plane, and what lighting designers say of the values there.

use glam::DVec3;

/// A rectangle parallel to two axes of the scene, in equal cells with a point in the middle of each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The axis that the plane is perpendicular to: 0, 1 or 2.
    pub axis: usize,
    /// Where it lies on that axis, in scene units.
    pub at: f64,
    /// Whether it faces along the axis, or against it.
    pub along: bool,
    /// The lowest corner, in scene units; its coordinate on the axis is not used.
    pub low: DVec3,
    /// The highest corner.
    pub high: DVec3,
    /// Cells beside one another; along x, or along z on a plane across x.
    pub columns: usize,
    /// Cells behind or above one another; along y, or along z on a plane across y.
    pub rows: usize,
}

impl Plane {
    /// The grid over the box from `low` to `high` whose cells are as near to squares of `spacing` as fill it.
    pub fn over(
        (low, high): (DVec3, DVec3),
        axis: usize,
        at: f64,
        along: bool,
        spacing: f64,
    ) -> Self {
        let mut plane = Self {
            axis,
            at,
            along,
            low,
            high,
            columns: 0,
            rows: 0,
        };
        let cells = |axis: usize| ((high - low)[axis] / spacing).round().max(1.0) as usize;
        let (column, row) = Self::sides(axis);
        plane.columns = cells(column);
        plane.rows = cells(row);
        plane
    }

    /// The axes that columns and rows follow on a plane across an axis.
    pub fn sides(axis: usize) -> (usize, usize) {
        match axis {
            0 => (2, 1),
            1 => (0, 2),
            _ => (0, 1),
        }
    }

    /// The unit normal.
    pub fn normal(&self) -> DVec3 {
        let axis = DVec3::AXES[self.axis];
        // From zero, as the others would be -0 otherwise.
        if self.along { axis } else { DVec3::ZERO - axis }
    }

    /// The points, row after row; rows in the order of their coordinate.
    pub fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let (column, row) = Self::sides(self.axis);
        let size = self.high - self.low;
        let middle = move |axis: usize, number: usize, count: usize| {
            self.low[axis] + size[axis] * (number as f64 + 0.5) / count as f64
        };
        (0..self.rows * self.columns).map(move |number| {
            let mut point = DVec3::splat(self.at);
            point[column] = middle(column, number % self.columns, self.columns);
            point[row] = middle(row, number / self.columns, self.rows);
            point
        })
    }
}

/// Values on a plane, summed up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Points with a value.
    pub points: usize,
    /// The least value.
    pub least: f64,
    /// The mean of all: each point stands for an equal area.
    pub mean: f64,
    /// The largest value.
    pub most: f64,
}

impl Levels {
    /// Of some values; `None` of none.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let (mut points, mut sum) = (0, 0.0);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
            (points, sum) = (points + 1, sum + value);
            (least, most) = (least.min(value), most.max(value));
        }
        (points > 0).then(|| Self {
            points,
            least,
            mean: sum / points as f64,
            most,
        })
    }

    /// Uniformity U₀ (EN 12464-1): the least over the mean; 0 where all is dark.
    pub fn uniformity(&self) -> f64 {
        if self.mean > 0.0 {
            self.least / self.mean
        } else {
            0.0
        }
    }

    /// Diversity U_d: the least over the largest; 0 where all is dark.
    pub fn diversity(&self) -> f64 {
        if self.most > 0.0 {
            self.least / self.most
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_the_middles_of_cells_that_fill_the_box() {
        let bounds = (DVec3::ZERO, DVec3::new(4.0, 9.0, 1.1));
        let plane = Plane::over(bounds, 1, 0.8, true, 0.5);
        assert_eq!((plane.columns, plane.rows), (8, 2));
        let points: Vec<DVec3> = plane.points().collect();
        assert_eq!(points.len(), 16);
        assert!(points[0].distance(DVec3::new(0.25, 0.8, 0.275)) < 1e-12);
        assert!(points[15].distance(DVec3::new(3.75, 0.8, 0.825)) < 1e-12);
        assert_eq!(plane.normal(), DVec3::Y);
        let wall = Plane::over(bounds, 0, 1.0, false, 100.0);
        assert_eq!(
            (wall.columns, wall.rows, wall.normal()),
            (1, 1, DVec3::NEG_X)
        );
        assert!(wall.normal().y.is_sign_positive(), "no table says -0");
        assert_eq!(wall.points().next(), Some(DVec3::new(1.0, 4.5, 0.55)));
    }

    #[test]
    fn levels_are_what_their_names_say() {
        let levels = Levels::of([2.0, 4.0, 6.0].into_iter()).expect("has values");
        assert_eq!((levels.least, levels.mean, levels.most), (2.0, 4.0, 6.0));
        assert_eq!(levels.uniformity(), 0.5);
        assert!((levels.diversity() - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(Levels::of(std::iter::empty()), None);
        let dark = Levels::of(std::iter::once(0.0)).expect("has a value");
        assert_eq!((dark.uniformity(), dark.diversity()), (0.0, 0.0));
    }
}
