//! A mesh that was read from a file: what it says is checked, what follows from it is computed again.

use super::build::centre_of;
use super::refine::{DEEPEST, quarters};
use super::stored::StoredVertex;
use super::{Element, Lattice, Mesh, NONE, UNIT, Vertex};

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
        let is_on_a_patch = |of: &StoredVertex| of.lattice.u.max(of.lattice.v) <= UNIT;
        check(vertices.iter().all(is_on_a_patch), "a vertex")?;
        let makers = self.restore_elements(elements, vertices)?;
        self.restore_vertices(vertices, &makers)?;
        self.finish_topology(0, buried);
        Ok(())
    }

    /// Takes in the elements; gives the first one that has each of the vertices that are not of coarsest grids.
    fn restore_elements(
        &mut self,
        elements: &[Element],
        vertices: &[StoredVertex],
    ) -> Result<Vec<u32>, String> {
        let (roots, first) = (self.elements.roots(), self.vertices.len());
        let mut makers = vec![NONE; vertices.len() - first];
        let mut groups = Groups::new(elements.len(), roots);
        for (number, element) in (0..).zip(elements) {
            check(
                (element.patch as usize) < self.patches.len(),
                "the patch of an element",
            )?;
            let of_its_patch = |v: u32| {
                let vertex = vertices.get(v as usize);
                vertex.is_some_and(|vertex| vertex.patch == element.patch)
            };
            check(
                element.vertices().all(of_its_patch),
                "a corner of an element",
            )?;
            let later = |v: u32| (v as usize).checked_sub(first);
            for vertex in element.vertices().filter_map(later) {
                makers[vertex] = number.min(makers[vertex]);
            }
            check(
                element.is_leaf()
                    || groups.claim(number, element) && are_parts(element, elements, vertices),
                "the children of an element",
            )?;
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
        check(groups.are_all_claimed(), "an element of no other")?;
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
            check(*maker != NONE, "a vertex")?;
            let number = self.vertices.push(Vertex {
                patch,
                lattice,
                maker: *maker,
            });
            let of_grid = self.patches.first_at(patch, lattice);
            let is_first = self.at.insert((patch, lattice), number).is_none();
            check(of_grid.is_none() && is_first, "a vertex")?;
        }
        Ok(())
    }
}

/// The groups of four that follow the elements of coarsest grids. Each has one parent, before it: with two, and these of two in their turn, a
/// walk through the quadtree would take twice as long for each level.
struct Groups {
    roots: usize,
    elements: usize,
    claimed: Vec<bool>,
}

impl Groups {
    fn new(elements: usize, roots: usize) -> Self {
        Self {
            roots,
            elements,
            claimed: vec![false; (elements - roots) / 4],
        }
    }

    /// Lets an element have its children; false if they are no such group, or have a parent.
    fn claim(&mut self, number: u32, element: &Element) -> bool {
        let place = (element.children as usize).checked_sub(self.roots);
        let place = place.filter(|at| at % 4 == 0 && element.children > number);
        let claimed = place.and_then(|at| self.claimed.get_mut(at / 4));
        claimed.is_some_and(|claimed| !std::mem::replace(claimed, true))
    }

    fn are_all_claimed(&self) -> bool {
        self.roots + 4 * self.claimed.len() == self.elements && !self.claimed.contains(&false)
    }
}

/// Whether the children of an element are its quarters.
fn are_parts(of: &Element, elements: &[Element], vertices: &[StoredVertex]) -> bool {
    let lattice = |v: u32| vertices.get(v as usize).map(|vertex| vertex.lattice);
    let corners: Option<Vec<Lattice>> = of.corners().iter().map(|v| lattice(*v)).collect();
    let (Some(corners), Some(centre)) = (corners, lattice(of.centre)) else {
        return false;
    };
    let children = elements[of.children as usize..].iter();
    children.zip(quarters(&corners, centre)).all(|(child, at)| {
        let at = &at[..corners.len()];
        let has_corners = child.corners().len() == at.len()
            && child
                .corners()
                .iter()
                .zip(at)
                .all(|(v, at)| lattice(*v) == Some(*at));
        child.patch == of.patch
            && u32::from(child.level) == u32::from(of.level) + 1
            && u32::from(child.level) <= DEEPEST
            && has_corners
            && lattice(child.centre) == Some(centre_of(at))
    })
}
