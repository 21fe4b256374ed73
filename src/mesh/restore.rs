//! A mesh that was read from a file: what it says is checked, what follows from it is computed again.

use super::stored::StoredVertex;
use super::{Element, Mesh, NONE, UNIT, Vertex};

/// An error if what was read does not hold.
pub(super) fn check(holds: bool, what: &str) -> Result<(), String> {
    if holds {
        Ok(())
    } else {
        Err(format!("{what} out of range"))
    }
}

impl Mesh {
    /// Takes in what was read to a mesh that has its patches and their coarsest grids, once it is checked, and restores what is not stored.
    pub(super) fn restore(
        &mut self,
        elements: &[Element],
        vertices: &[StoredVertex],
        buried: &[bool],
    ) -> Result<(), String> {
        check(self.frame.is_sound(), "the frame")?;
        check(
            buried.len() == vertices.len(),
            "the number of buried vertices",
        )?;
        let makers = self.restore_elements(elements, vertices.len())?;
        self.restore_vertices(vertices, &makers)?;
        self.finish_topology(0, buried);
        Ok(())
    }

    /// Takes in the elements; gives the first one that has each of the vertices that are not of coarsest grids.
    fn restore_elements(
        &mut self,
        elements: &[Element],
        vertices: usize,
    ) -> Result<Vec<u32>, String> {
        let (roots, first) = (self.elements.roots(), self.vertices.len());
        let mut makers = vec![NONE; vertices - first];
        for (number, element) in (0..).zip(elements) {
            let patch = element.patch as usize;
            check(patch < self.patches.len(), "the patch of an element")?;
            let within = |v: u32| (v as usize) < vertices;
            check(element.vertices().all(within), "a corner of an element")?;
            let children = element.children as usize;
            let follow = children > number as usize && children >= roots;
            let are_there = follow && children + 4 <= elements.len();
            check(element.is_leaf() || are_there, "the children of an element")?;
            let later = |v: u32| (v as usize).checked_sub(first);
            for vertex in element.vertices().filter_map(later) {
                makers[vertex] = number.min(makers[vertex]);
            }
            if number as usize >= roots {
                self.elements.push(*element);
                continue;
            }
            let now = Element {
                children: element.children,
                ..self.element(number)
            };
            // Hanging vertices are found anew.
            let read = Element {
                hanging: now.hanging,
                ..*element
            };
            check(read == now, "an element of a grid")?;
            if !now.is_leaf() {
                self.elements.change(number, now);
            }
        }
        Ok(makers)
    }

    fn restore_vertices(
        &mut self,
        vertices: &[StoredVertex],
        makers: &[u32],
    ) -> Result<(), String> {
        let (of_grids, later) = vertices.split_at(self.vertices.len());
        for (number, of) in (0..).zip(of_grids) {
            let made = self.vertex(number);
            let is_same = (made.patch, made.lattice) == (of.patch, of.lattice);
            check(is_same, "a vertex")?;
        }
        for (of, maker) in later.iter().zip(makers) {
            let StoredVertex { patch, lattice, .. } = *of;
            let is_on_a_patch = (patch as usize) < self.patches.len()
                && lattice.u.max(lattice.v) <= UNIT
                && *maker != NONE;
            check(is_on_a_patch, "a vertex")?;
            let number = self.vertices.push(Vertex {
                patch,
                lattice,
                maker: *maker,
            });
            self.at.insert((patch, lattice), number);
        }
        Ok(())
    }
}
