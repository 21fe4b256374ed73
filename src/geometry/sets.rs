//! Union-find.

use rayon::prelude::*;

/// Disjoint sets.
#[derive(Debug, Clone)]
pub struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// `count` sets of one member each.
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    /// The lowest member of the set that a member is in.
    pub fn root(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Makes the sets of two members one.
    pub fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [a, b].map(|v| self.root(v));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// The members of all sets of more than one, each after the lowest of its set; set by set, and in order.
    pub fn members(mut self) -> Vec<(u32, u32)> {
        let mut is_shared = vec![false; self.parent.len()];
        for member in 0..self.parent.len() as u32 {
            let root = self.root(member);
            is_shared[root as usize] |= root != member;
        }
        let all = (0..self.parent.len() as u32).map(|member| (self.root(member), member));
        let mut members: Vec<(u32, u32)> =
            all.filter(|(root, _)| is_shared[*root as usize]).collect();
        members.par_sort_unstable();
        members
    }
}
