//! Lines in a plane, found by place: there may be tens of thousands in front of one face.

use super::lines::Line;
use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Lines in the order in which they came.
pub(super) struct Index {
    pub list: Vec<Line>,
    tree: RTree<Numbered>,
}

/// The box around a line, with its number.
type Numbered = GeomWithData<Rectangle<[f64; 2]>, usize>;

impl Index {
    pub fn of(lines: impl IntoIterator<Item = Line>) -> Self {
        let list: Vec<Line> = lines.into_iter().collect();
        let boxes = list.iter().zip(0..).map(|(line, i)| numbered(line, i));
        let tree = RTree::bulk_load(boxes.collect());
        Self { list, tree }
    }

    pub fn push(&mut self, line: Line) {
        self.tree.insert(numbered(&line, self.list.len()));
        self.list.push(line);
    }

    /// The numbers of those whose boxes come nearer to that of a line than `distance`, in no order.
    pub fn near(&self, [a, b]: Line, distance: f64) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (a.min(b) - distance, a.max(b) + distance);
        let place = AABB::from_corners(low.to_array(), high.to_array());
        let found = self.tree.locate_in_envelope_intersecting(place);
        found.map(|found| found.data)
    }

    /// These lines, in order.
    pub fn lines_near(&self, line: Line, distance: f64) -> Vec<Line> {
        let mut numbers: Vec<usize> = self.near(line, distance).collect();
        numbers.sort_unstable();
        numbers.into_iter().map(|i| self.list[i]).collect()
    }
}

fn numbered([a, b]: &Line, number: usize) -> Numbered {
    let [low, high] = [DVec2::min, DVec2::max].map(|end| end(*a, *b).to_array());
    GeomWithData::new(Rectangle::from_corners(low, high), number)
}
