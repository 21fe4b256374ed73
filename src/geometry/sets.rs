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

    /// The sets of more than one member, each in order.
    pub fn groups(mut self) -> Vec<Vec<u32>> {
        let mut members: Vec<(u32, u32)> = (0..self.parent.len() as u32)
            .map(|member| (self.root(member), member))
            .collect();
        members.par_sort_unstable();
        let groups = members
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|group| group.len() > 1);
        groups
            .map(|group| group.iter().map(|(_, v)| *v).collect())
            .collect()
    }
}
