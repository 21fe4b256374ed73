//! Step 3 of sampling a source: where some rays arrive and some do not.

use super::hybrid::Receiver;
use super::partition::Limits;
use super::sampling::{Leaf, Sampler};
use super::source::{CellIndex, Source, children};

/// What is known of a cell while the leaves of one point are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    Outside,
    Split,
    Seen,
    Occluded,
}

impl Sampler<'_> {
    /// Step 3: replaces leaves that disagree with a neighbour by their children, at the end; gives where those begin.
    pub(super) fn split_disagreeing(
        &self,
        source: &Source,
        receiver: Receiver,
        limits: Limits,
        leaves: &mut Vec<Leaf>,
        state: &mut [State],
    ) -> usize {
        let seen = leaves.iter().filter(|leaf| leaf.seen).count();
        let large = |leaf: &Leaf| {
            f64::from(leaf.measure) > limits.difference && source.has_children(leaf.cell)
        };
        if seen == 0 || seen == leaves.len() || !leaves.iter().any(large) {
            return leaves.len();
        }
        for leaf in leaves.iter() {
            state[leaf.cell as usize] = if leaf.seen {
                State::Seen
            } else {
                State::Occluded
            };
            mark_ancestors(leaf.cell, state, State::Split);
        }
        let splits = |leaf: &Leaf| {
            large(leaf)
                && source
                    .neighbours(leaf.cell)
                    .iter()
                    .flatten()
                    .any(|n| disagrees(*n, state[leaf.cell as usize], state))
        };
        let split: Vec<Leaf> = leaves.iter().copied().filter(splits).collect();
        for leaf in leaves.iter() {
            state[leaf.cell as usize] = State::Outside;
            mark_ancestors(leaf.cell, state, State::Outside);
        }
        if split.is_empty() {
            return leaves.len();
        }
        let mut next = split.iter().map(|leaf| leaf.cell).peekable();
        leaves.retain(|leaf| next.next_if_eq(&leaf.cell).is_none());
        let fresh = leaves.len();
        for cell in split.iter().flat_map(|leaf| children(leaf.cell)) {
            let sight = self
                .formula
                .sight(receiver, source.cell(cell), source.normal());
            if sight.form_factor > 0.0 {
                leaves.push(self.leaf(source, receiver, cell, &sight));
            }
        }
        fresh
    }
}

fn mark_ancestors(mut cell: CellIndex, state: &mut [State], mark: State) {
    while cell > 0 {
        cell = (cell - 1) / 4;
        if state[cell as usize] == mark {
            return;
        }
        state[cell as usize] = mark;
    }
}

/// Whether the leaf that covers `cell`, or any leaf inside it, is in another state than `own`.
fn disagrees(cell: CellIndex, own: State, state: &[State]) -> bool {
    match state[cell as usize] {
        State::Split => children(cell).any(|child| {
            state
                .get(child as usize)
                .is_some_and(|s| *s != State::Outside)
                && disagrees(child, own, state)
        }),
        State::Outside => {
            let mut above = cell;
            while above > 0 {
                above = (above - 1) / 4;
                match state[above as usize] {
                    State::Outside => {}
                    State::Split => return false,
                    other => return other != own,
                }
            }
            false
        }
        other => other != own,
    }
}
