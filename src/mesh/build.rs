//! From a scene to its coarsest mesh.

use super::patches::{Known, MOST_ALONG};
use super::{Elements, Lattice, Mesh, Patch, Patches, Vertices, contact};
use crate::geometry::Frame;
use crate::radiometry::{Spectrum, exitance_from_radiance};
use crate::scene::{Scene, Sides};
use rustc_hash::FxHashMap;

/// How coarse the mesh starts and how fine it may become.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MeshLimits {
    /// The first elements are no longer than this fraction of the scene's extent.
    pub initial_size: f64,
    /// Elements are split to this level of the quadtree and no further.
    pub max_depth: u32,
    /// Elements whose longest side is below this fraction of the scene's extent are not split. Where patches shoot as clusters it is the least
    /// size of a patch that is split; elements of such may be a fifth as small.
    pub min_size: f64,
}

impl Mesh {
    /// The coarsest mesh: surfaces are split along the lines in which others meet them; then a patch for each radiating side
    /// of each piece, unless another surface has it, a grid of nearly square elements on each quad patch, one element on each triangle, split until
    /// `limits.initial_size` holds.
    pub fn new(scene: &Scene, limits: MeshLimits) -> Self {
        let frame = scene.frame();
        let regions = contact::regions(scene, &frame);
        let pieces = contact::pieces(scene, &frame, &regions, limits.min_size * frame.extent());
        drop(regions);
        let mut mesh = Self {
            unsplit_contacts: pieces.unsplit,
            uncut_gaps: pieces.uncut,
            ..Self::empty(frame, limits)
        };
        // Of many slivers there would be more such elements than of all others together.
        let shortest = if pieces.list.len() > contact::MANY {
            limits.min_size * mesh.frame.extent()
        } else {
            0.0
        };
        let mut known = Known::default();
        for piece in pieces.list {
            let surface = &scene.surfaces[piece.surface as usize];
            let material = &scene.materials[surface.material as usize];
            let first = mesh.patches.len() as u32;
            let mut corners = piece.corners().to_vec();
            let mut front = Patch::new(piece.surface, surface.polygon, &corners, false);
            front.outline = piece.outline;
            front.reflectance = material.reflectance;
            front.exitance = exitance_from_radiance(material.emitted_radiance);
            let [is_front_covered, is_back_covered] = piece.covered;
            // What emits is never left out.
            if is_front_covered && front.exitance == Spectrum::ZERO {
                mesh.covered_sides += 1;
            } else {
                mesh.add_patch(front, shortest, &mut known);
            }
            if surface.sides == Sides::Both && is_back_covered {
                mesh.covered_sides += 1;
            } else if surface.sides == Sides::Both {
                corners.reverse();
                let mut back = Patch::new(piece.surface, surface.polygon, &corners, true);
                back.outline = reversed(piece.outline, corners.len());
                back.reflectance = material.reflectance;
                mesh.add_patch(back, shortest, &mut known);
            }
            if piece.clearance > 0.0 {
                let sides = first..mesh.patches.len() as u32;
                mesh.clearances
                    .extend(sides.map(|side| (side, piece.clearance)));
            }
        }
        drop(known);
        mesh.patches.shrink();
        mesh.make_grids();
        mesh.split_to_initial_size();
        mesh.finish_topology(0, &[]);
        mesh
    }

    /// A mesh of nothing.
    pub(super) fn empty(frame: Frame, limits: MeshLimits) -> Self {
        Self {
            frame,
            patches: Patches::default(),
            elements: Elements::default(),
            vertices: Vertices::default(),
            buried: Vec::new(),
            weights: Vec::new(),
            buried_weights: FxHashMap::default(),
            continuation: Default::default(),
            weld: Default::default(),
            touched: Vec::new(),
            later: FxHashMap::default(),
            at: FxHashMap::default(),
            limits,
            clearances: FxHashMap::default(),
            unsplit_contacts: 0,
            uncut_gaps: 0,
            covered_sides: 0,
        }
    }

    /// What bounds the refinement.
    pub fn limits(&self) -> &MeshLimits {
        &self.limits
    }

    /// Adds a patch; its elements and vertices are to follow those of the one before.
    fn add_patch(&mut self, mut patch: Patch, shortest: f64, known: &mut Known) {
        patch.grid = grid_of(&patch, shortest);
        let (columns, rows) = patch.grid;
        let (element, vertex) = self.patches.first_after();
        patch.roots = element..element + columns * rows;
        patch.first_vertex = vertex;
        self.patches.push(&patch, known);
    }

    /// Makes the coarsest grids of all patches.
    pub(super) fn make_grids(&mut self) {
        self.elements = Elements::of_grids(self.patches.grids().map(|grid| grid.elements()));
        self.vertices = Vertices::of_grids(self.patches.grids().map(|grid| grid.vertices()));
        self.touched = (0..self.patches.len() as u32).collect();
    }

    fn split_to_initial_size(&mut self) {
        // A hair more, so that rounding does not decide about elements of exactly this size.
        let longest = self.limits.initial_size * self.frame.extent() * (1.0 + 1e-9);
        let mut from = 0;
        while from < self.elements.len() {
            let to = self.elements.len();
            for element in from as u32..to as u32 {
                if self.longest_side(element) > longest && self.may_split(element) {
                    self.split(element);
                }
            }
            from = to;
        }
    }
}

/// The outline of the same polygon with its corners in reverse order.
fn reversed(outline: [bool; 4], count: usize) -> [bool; 4] {
    let mut back = [true; 4];
    for (i, slot) in back.iter_mut().enumerate().take(count) {
        *slot = outline[(2 * count - 2 - i) % count];
    }
    back
}

/// The middle of an element: the bilinear centre of a quad, the centroid of a triangle.
pub(super) fn centre_of(corners: &[Lattice]) -> Lattice {
    if let [a, b, c] = corners {
        let third =
            |a: u32, b: u32, c: u32| ((u64::from(a) + u64::from(b) + u64::from(c)) / 3) as u32;
        Lattice::new(third(a.u, b.u, c.u), third(a.v, b.v, c.v))
    } else {
        corners[0].midpoint(corners[2])
    }
}

/// A grid of powers of two whose cells are between 1 : √2 and √2 : 1, unless that would make them shorter than `shortest`.
fn grid_of(patch: &Patch, shortest: f64) -> (u32, u32) {
    let &[a, b, c, d] = patch.corners() else {
        return (1, 1);
    };
    let width = a.distance(b).max(c.distance(d));
    let height = b.distance(c).max(d.distance(a));
    let most = (width.max(height) / shortest)
        .log2()
        .floor()
        .clamp(0.0, f64::from(MOST_ALONG).log2());
    let steps = (width / height).log2().round().clamp(-most, most) as i32;
    (1 << steps.max(0), 1 << (-steps).max(0))
}
