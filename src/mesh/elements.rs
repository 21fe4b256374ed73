//! All elements of a mesh as they are kept.

use super::{Element, Mesh, NONE};

/// The elements of a mesh: those of the coarsest grids, patch by patch, and then those of splits; children follow one another.
#[derive(Debug, Clone, Default)]
pub struct Elements {
    roots: Vec<Root>,
    /// Roots that are not what the grid of their patch says of them: split, or with a hanging vertex.
    changed: Vec<Element>,
    later: Vec<Element>,
}

/// An element of a coarsest grid. In a large scene most have not changed.
#[derive(Debug, Clone, Copy)]
struct Root {
    patch: u32,
    /// Which of the changed ones it is, or [`NONE`].
    changed: u32,
}

/// How an element is kept.
enum Kept<'a> {
    /// As it is.
    Whole(&'a Element),
    /// As its patch: it is as the grid of that says.
    ByGrid(u32),
}

impl Elements {
    /// Those of coarsest grids, by the number that each patch has of them.
    pub(super) fn of_grids(counts: impl Iterator<Item = u32> + Clone) -> Self {
        let count = counts.clone().sum::<u32>() as usize;
        let mut roots = Vec::with_capacity(count);
        for (patch, count) in (0..).zip(counts) {
            let root = Root {
                patch,
                changed: NONE,
            };
            roots.extend(std::iter::repeat_n(root, count as usize));
        }
        Self {
            roots,
            changed: Vec::new(),
            // What is not written to takes no memory, but growing into a new place takes that of the old one too.
            later: Vec::with_capacity(count),
        }
    }

    /// How many there are, parents included.
    pub fn len(&self) -> usize {
        self.roots.len() + self.later.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How many are leaves: a split makes four elements of one.
    pub(super) fn leaves(&self) -> usize {
        self.roots.len() + self.later.len() / 4 * 3
    }

    /// How many are of coarsest grids.
    pub(super) fn roots(&self) -> usize {
        self.roots.len()
    }

    /// Whether one of them is not split.
    #[inline(always)]
    pub fn is_leaf(&self, number: u32) -> bool {
        match self.kept(number) {
            Kept::Whole(element) => element.is_leaf(),
            Kept::ByGrid(_) => true,
        }
    }

    /// The patch that one of them is a part of.
    #[inline(always)]
    pub fn patch_of(&self, number: u32) -> u32 {
        match self.kept(number) {
            Kept::Whole(element) => element.patch,
            Kept::ByGrid(patch) => patch,
        }
    }

    /// The four children of a split element.
    #[inline(always)]
    pub fn children(&self, of: &Element) -> &[Element] {
        &self.later[of.children as usize - self.roots.len()..][..4]
    }

    #[inline(always)]
    fn kept(&self, number: u32) -> Kept<'_> {
        match self.roots.get(number as usize) {
            None => Kept::Whole(&self.later[number as usize - self.roots.len()]),
            Some(root) if root.changed == NONE => Kept::ByGrid(root.patch),
            Some(root) => Kept::Whole(&self.changed[root.changed as usize]),
        }
    }

    /// Adds one that is not of a coarsest grid.
    pub(super) fn push(&mut self, element: Element) {
        self.later.push(element);
    }

    /// Puts another in the place of one of them.
    pub(super) fn change(&mut self, number: u32, element: Element) {
        let roots = self.roots.len();
        match self.roots.get_mut(number as usize) {
            None => self.later[number as usize - roots] = element,
            Some(root) if root.changed == NONE => {
                root.changed = self.changed.len() as u32;
                self.changed.push(element);
            }
            Some(root) => self.changed[root.changed as usize] = element,
        }
    }
}

impl Mesh {
    /// The element with a number. Who asks for a part of it pays for little more if this is compiled where it is asked for.
    #[inline(always)]
    pub fn element(&self, number: u32) -> Element {
        match self.elements.kept(number) {
            Kept::Whole(element) => *element,
            Kept::ByGrid(patch) => self.patches.root(patch, number),
        }
    }
}
