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
        let (roots, first) = (self.elements.roots(), self.vertices.len());
        check(
            buried.len() == vertices.len(),
            "the number of buried vertices",
        )?;
        let mut makers = vec![NONE; vertices.len() - first];
        for (number, element) in (0..).zip(elements) {
            let patch = element.patch as usize;
            check(patch < self.patches.len(), "the patch of an element")?;
            let within = |v: u32| (v as usize) < vertices.len();
            check(element.vertices().all(within), "a corner of an element")?;
            let children = element.children as usize;
            let follow = children > number as usize && children >= roots;
            check(
                element.is_leaf() || (follow && children + 4 <= elements.len()),
                "the children of an element",
            )?;
            let later = |v: u32| (v as usize).checked_sub(first);
            for vertex in element.vertices().filter_map(later) {
                makers[vertex] = number.min(makers[vertex]);
            }
            if (number as usize) < roots {
                let now = Element {
                    children: element.children,
                    ..self.element(number)
                };
                let hanging = now.hanging;
                check(
                    now == Element {
                        hanging,
                        ..*element
                    },
                    "an element of a grid",
                )?;
                if !now.is_leaf() {
                    self.elements.change(number, now);
                }
            } else {
                self.elements.push(*element);
            }
        }
        for (number, of) in (0..).zip(vertices) {
            let StoredVertex { patch, lattice, .. } = *of;
            let Some(later) = (number as usize).checked_sub(first) else {
                let made = self.vertex(number);
                check((made.patch, made.lattice) == (patch, lattice), "a vertex")?;
                continue;
            };
            let maker = makers[later];
            let is_on_a_patch = (patch as usize) < self.patches.len()
                && lattice.u.max(lattice.v) <= UNIT
                && maker != NONE;
            check(is_on_a_patch, "a vertex")?;
            self.vertices.push(Vertex {
                patch,
                lattice,
                maker,
            });
            self.at.insert((patch, lattice), number);
        }
        self.finish_topology(0, buried);
        Ok(())
    }
}
