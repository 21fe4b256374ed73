//! Step 3 of sampling a source: where some rays arrive and some do not.

use super::neighbours::Neighbours;
use super::partition::Pairing;
use super::sampling::Leaf;
use super::source::{CELLS, CellIndex, children};

/// What the leaves of one point are, cell by cell: what lies in it, itself included.
#[derive(Debug)]
pub(super) struct Marks([u8; CELLS]);

const SEEN: u8 = 1;
const OCCLUDED: u8 = 2;
/// It is a leaf, so nothing else lies in it.
const LEAF: u8 = 4;

impl Default for Marks {
    fn default() -> Self {
        Self([0; CELLS])
    }
}

impl Marks {
    #[inline(always)]
    fn set(&mut self, leaves: &[Leaf]) {
        self.0.fill(0);
        for leaf in leaves {
            let mark = own(leaf);
            let mut cell = leaf.cell;
            self.0[cell as usize] = mark | LEAF;
            while cell > 0 {
                cell = (cell - 1) / 4;
                if self.0[cell as usize] & mark != 0 {
                    break;
                }
                self.0[cell as usize] |= mark;
            }
        }
    }

    /// Whether a leaf is beside any that is another.
    #[inline(always)]
    fn disagrees(&self, leaf: &Leaf, neighbours: Neighbours) -> bool {
        let other = own(leaf) ^ (SEEN | OCCLUDED);
        let beside = neighbours.map(|cell| self.0[usize::from(cell)]);
        let any = beside[0] | beside[1] | beside[2] | beside[3];
        any & other != 0
            || beside.contains(&0)
                && neighbours
                    .iter()
                    .any(|cell| self.covering(CellIndex::from(*cell)) & other != 0)
    }

    /// What the leaf is that covers a cell, if one does.
    fn covering(&self, mut cell: CellIndex) -> u8 {
        while cell > 0 && self.0[cell as usize] == 0 {
            cell = (cell - 1) / 4;
        }
        // A cell that is split, but not into this part, is not seen from in front here.
        match self.0[cell as usize] {
            leaf if leaf & LEAF != 0 => leaf,
            _ => 0,
        }
    }
}

/// What a leaf is.
#[inline(always)]
fn own(leaf: &Leaf) -> u8 {
    if leaf.seen { SEEN } else { OCCLUDED }
}

impl Pairing<'_> {
    /// Step 3: replaces leaves that disagree with a neighbour by their children, at the end; gives where those begin.
    #[inline(always)]
    pub fn split_disagreeing(
        &self,
        leaves: &mut Vec<Leaf>,
        marks: &mut Marks,
        split: &mut Vec<CellIndex>,
    ) -> usize {
        let is_large = |leaf: &Leaf| {
            f64::from(leaf.measure) > self.limits.difference && self.source.has_children(leaf.cell)
        };
        let seen = leaves.iter().filter(|leaf| leaf.seen).count();
        if seen == 0 || seen == leaves.len() || !leaves.iter().any(is_large) {
            return leaves.len();
        }
        marks.set(leaves);
        split.clear();
        leaves.retain(|leaf| {
            let neighbours = self.source.neighbours(leaf.cell);
            let splits = is_large(leaf) && marks.disagrees(leaf, neighbours);
            if splits {
                split.push(leaf.cell);
            }
            !splits
        });
        let fresh = leaves.len();
        for parent in split {
            let sights = self.sights(*parent);
            for (i, cell) in children(*parent).enumerate() {
                if sights.form_factor[i] > 0.0 {
                    leaves.push(self.leaf(cell, &sights, i));
                }
            }
        }
        fresh
    }
}
