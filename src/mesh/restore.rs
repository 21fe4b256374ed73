//! A mesh that was read from a file: what it says is checked, what follows from it is computed again.

use super::{Mesh, UNIT, Vertex};

/// An error if what was read does not hold.
pub(super) fn check(holds: bool, what: &str) -> Result<(), String> {
    if holds {
        Ok(())
    } else {
        Err(format!("{what} out of range"))
    }
}

impl Mesh {
    /// Checks the parts of a mesh that was read, but for its patches, and restores what is not stored.
    pub(super) fn restore(&mut self) -> Result<(), String> {
        let (patches, elements, vertices) =
            (self.patches.len(), self.elements.len(), self.vertices.len());
        check(self.frame.is_sound(), "the frame")?;
        for (number, element) in self.elements.iter().enumerate() {
            check(
                (element.patch as usize) < patches,
                "the patch of an element",
            )?;
            let within = |v: &u32| (*v as usize) < vertices;
            check(
                element.corners().iter().all(within) && within(&element.centre),
                "a corner of an element",
            )?;
            let children = element.children as usize;
            check(
                element.is_leaf() || (children > number && children + 4 <= elements),
                "the children of an element",
            )?;
        }
        for (number, element) in (0..).zip(&self.elements) {
            for vertex in element.vertices() {
                let maker = &mut self.vertices[vertex as usize].maker;
                *maker = number.min(*maker);
            }
        }
        let on_a_patch = |v: &Vertex| {
            (v.patch as usize) < patches
                && v.lattice.u.max(v.lattice.v) <= UNIT
                && (v.maker as usize) < elements
        };
        check(self.vertices.iter().all(on_a_patch), "a vertex")?;
        check(
            self.buried.len() == vertices,
            "the number of buried vertices",
        )?;
        for vertex in 0..vertices as u32 {
            if self.is_indexed(self.vertices[vertex as usize].patch) {
                self.index(vertex);
            }
        }
        let buried = std::mem::take(&mut self.buried);
        self.touched = (0..patches as u32).collect();
        self.finish_topology(0, &buried);
        Ok(())
    }
}
