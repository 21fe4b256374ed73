//! Which segments are close to a pixel: the screen in square cells.

use glam::DVec2;
use std::ops::RangeInclusive;

/// Side of a cell, in pixels.
const CELL: f64 = 8.0;

/// For each cell of the screen, the segments that come close to it.
pub(super) struct Cells {
    columns: usize,
    rows: usize,
    /// Indices of segments, cell by cell, in order.
    segments: Vec<u32>,
    /// Those of cell `i` are from `starts[i]` to `starts[i + 1]`.
    starts: Vec<usize>,
}

impl Cells {
    /// Sorts the `segments` into the cells of a screen of this size: into all that they come closer to than `reach`.
    pub(super) fn new(size: DVec2, segments: &[(DVec2, DVec2)], reach: f64) -> Self {
        let cells = (size / CELL).ceil().max(DVec2::ONE);
        let (columns, rows) = (cells.x as usize, cells.y as usize);
        let mut sorted = Self {
            columns,
            rows,
            segments: Vec::new(),
            starts: vec![0; columns * rows + 1],
        };
        let visits = || {
            (0..)
                .zip(segments)
                .flat_map(|(i, &s)| visited(columns, rows, s, reach).map(move |cell| (cell, i)))
        };
        for (cell, _) in visits() {
            sorted.starts[cell + 1] += 1;
        }
        for cell in 0..columns * rows {
            sorted.starts[cell + 1] += sorted.starts[cell];
        }
        let mut next = sorted.starts.clone();
        sorted.segments = vec![0; sorted.starts[columns * rows]];
        for (cell, segment) in visits() {
            sorted.segments[next[cell]] = segment;
            next[cell] += 1;
        }
        sorted
    }

    /// The segments that are closer than `reach` to some point of the cell around `at`, and perhaps others.
    pub(super) fn near(&self, at: DVec2) -> &[u32] {
        let cell = (at / CELL).floor().max(DVec2::ZERO);
        let cell = (cell.y as usize).min(self.rows - 1) * self.columns
            + (cell.x as usize).min(self.columns - 1);
        &self.segments[self.starts[cell]..self.starts[cell + 1]]
    }
}

/// The cells that a segment comes close to.
fn visited(
    columns: usize,
    rows: usize,
    (a, b): (DVec2, DVec2),
    reach: f64,
) -> impl Iterator<Item = usize> {
    let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
    let height = bottom.y - top.y;
    span(top.y - reach, bottom.y + reach, rows).flat_map(move |row| {
        // The piece of the segment that is level with the row.
        let level = row as f64 * CELL - top.y;
        let (start, end) = if height > 0.0 {
            ((level - reach) / height, (level + CELL + reach) / height)
        } else {
            (0.0, 1.0)
        };
        let ends = [start, end].map(|along| top.lerp(bottom, along.clamp(0.0, 1.0)).x);
        let columns_near = span(
            ends[0].min(ends[1]) - reach,
            ends[0].max(ends[1]) + reach,
            columns,
        );
        columns_near.map(move |column| row * columns + column)
    })
}

/// The cells between two coordinates, of `count` cells; none if both are on the same side of them all.
fn span(low: f64, high: f64, count: usize) -> RangeInclusive<usize> {
    if high < 0.0 || low >= count as f64 * CELL {
        return RangeInclusive::new(1, 0);
    }
    (low / CELL).max(0.0) as usize..=((high / CELL) as usize).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance from a point to a segment.
    fn distance(at: DVec2, (a, b): (DVec2, DVec2)) -> f64 {
        let along = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        at.distance(a.lerp(b, along))
    }

    #[test]
    fn no_segment_is_missed() {
        let size = DVec2::new(50.0, 30.0);
        let point =
            |i: u32| DVec2::new(f64::from(i * 37 % 71) - 10.0, f64::from(i * 53 % 47) - 8.0);
        let mut segments: Vec<_> = (0..40).map(|i| (point(i), point(i + 7))).collect();
        segments.push((DVec2::new(3.0, 12.0), DVec2::new(44.0, 12.0)));
        segments.push((DVec2::new(16.0, 3.0), DVec2::new(16.0, 44.0)));
        let cells = Cells::new(size, &segments, 1.5);
        for (x, y) in (0..50).flat_map(|x| (0..30).map(move |y| (x, y))) {
            let at = DVec2::new(f64::from(x) + 0.3, f64::from(y) + 0.6);
            for (i, &segment) in segments.iter().enumerate() {
                assert!(
                    distance(at, segment) > 1.5 || cells.near(at).contains(&(i as u32)),
                    "{i} at {at}"
                );
            }
        }
    }
}
