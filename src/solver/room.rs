//! How much more the mesh may grow: the limits on elements and on memory.

use super::course::MeshingEnd;
use super::options::Options;
use super::run::Solver;
use super::tiling::cell_count;
use crate::form_factor::Clusters;
use crate::mesh::Mesh;

/// Memory that a leaf takes in all, at the peak of a run that writes everything there is to write: its vertices and parents, the
/// light, what a shot keeps, the triangles of the results. On the Cornell box 1000 to 1200 were measured (`peak_memory` in the
/// reports of 12,000 and 49,000 elements); the rest is for lists that have just grown.
const BYTES_PER_LEAF: u64 = 1600;

/// What the process takes besides, pictures included.
const BYTES_BEFORE: u64 = 64 << 20;

/// Leaves that go with each split: three more, and as many again for the balance.
const LEAVES_PER_SPLIT: usize = 6;

/// Memory that a run takes in all, bytes, if it refines `mesh` no further and its engine holds `engine`.
pub fn memory_for(mesh: &Mesh, options: &Options, engine: u64) -> u64 {
    without_leaves(mesh, options, engine) + mesh.leaf_count() as u64 * BYTES_PER_LEAF
}

/// The part of it that does not grow with the leaves.
fn without_leaves(mesh: &Mesh, options: &Options, engine: u64) -> u64 {
    let tiles = if options.clusters(mesh) {
        cell_count(mesh)
    } else {
        0
    };
    BYTES_BEFORE + engine + Clusters::bytes_for(tiles)
}

impl Solver<'_> {
    /// Elements that may be split in the next pass.
    pub(super) fn room(&self) -> usize {
        let most = self.most_leaves().map_or(usize::MAX, |(most, _)| most);
        most.saturating_sub(self.mesh.leaf_count()) / LEAVES_PER_SPLIT
    }

    /// The limit that leaves no room, if one does.
    pub(super) fn meshing_end(&self) -> Option<MeshingEnd> {
        let (_, end) = self.most_leaves()?;
        (self.room() == 0).then_some(end)
    }

    /// The tighter of the limits, in leaves.
    fn most_leaves(&self) -> Option<(usize, MeshingEnd)> {
        let elements = self.options.max_elements;
        let memory = self.options.memory_limit.map(|limit| {
            let engine = self.visibility.info().bytes;
            let before = without_leaves(&self.mesh, &self.options, engine);
            (limit.saturating_sub(before) / BYTES_PER_LEAF) as usize
        });
        let elements = elements.map(|most| (most, MeshingEnd::MaxElements));
        let memory = memory.map(|most| (most, MeshingEnd::MemoryLimit));
        elements
            .into_iter()
            .chain(memory)
            .min_by_key(|(most, _)| *most)
    }
}
