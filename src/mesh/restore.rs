//! A mesh that was read from a file: what it says is checked, what follows from it is computed again.

use super::{Mesh, UNIT, Vertex};

impl Mesh {
    /// Checks a mesh that was read and restores what is not stored. Errors say what does not fit.
    pub fn restore(&mut self) -> Result<(), String> {
        let (patches, elements, vertices) =
            (self.patches.len(), self.elements.len(), self.vertices.len());
        let check = |holds: bool, what: &str| {
            if holds {
                Ok(())
            } else {
                Err(format!("{what} out of range"))
            }
        };
        check(self.frame.is_sound(), "the frame")?;
        for patch in &self.patches {
            check(patch.is_sound(), "a patch")?;
            check(
                patch.roots.start <= patch.roots.end && patch.roots.end as usize <= elements,
                "a root element",
            )?;
            let roots = patch.grid.0.checked_mul(patch.grid.1);
            check(
                roots.is_some_and(|n| n > 0 && n == patch.roots.end - patch.roots.start),
                "a grid",
            )?;
            check(
                patch.vertices.iter().all(|v| (*v as usize) < vertices),
                "a vertex of a patch",
            )?;
        }
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
        let on_a_patch = |v: &Vertex| {
            (v.patch as usize) < patches
                && v.lattice.u.max(v.lattice.v) <= UNIT
                && v.point.is_finite()
        };
        check(self.vertices.iter().all(on_a_patch), "a vertex")?;
        check(
            self.buried.len() == vertices,
            "the number of buried vertices",
        )?;
        (0..patches as u32).for_each(|patch| self.index(patch, 0));
        let buried = std::mem::take(&mut self.buried);
        self.touched = vec![true; patches];
        self.finish_topology(0, &buried);
        Ok(())
    }
}
