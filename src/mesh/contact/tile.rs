//! A face tiled along an arrangement of segments: a constrained Delaunay triangulation, joined to quads.

use super::arrange::{Arrangement, Node};
use super::face::Face;
use super::quads::{Tile, join};
use glam::DVec2;
use rustc_hash::FxHashSet;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// A node of the arrangement, as the triangulation sees it.
#[derive(Clone, Copy)]
struct Corner {
    at: Point2<f64>,
    node: u32,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// The triangles on the face, as nodes of the arrangement, counter-clockwise; `None` if its edges cross by a hair.
pub(super) fn triangulate(face: &Face, arrangement: &Arrangement) -> Option<Vec<[u32; 3]>> {
    let nodes = &arrangement.nodes;
    let corner = |(node, number): (&Node, u32)| {
        let at = spade::mitigate_underflow(Point2::new(node.at.x, node.at.y));
        Corner { at, node: number }
    };
    let corners = nodes.iter().zip(0..).map(corner).collect();
    let border = sides(face, nodes);
    let edges = arrangement
        .edges
        .iter()
        .chain(&border)
        .map(|edge| edge.map(|node| node as usize));
    let mut conflicts = 0;
    let count = |_| conflicts += 1;
    let triangulation = ConstrainedDelaunayTriangulation::<Corner>::try_bulk_load_cdt(
        corners,
        edges.collect(),
        count,
    )
    .ok()?;
    if conflicts > 0 || triangulation.num_vertices() < nodes.len() {
        return None;
    }
    // Rounding bends the border by a hair, which makes triangles without area along it.
    let on = |node: u32| nodes[node as usize].sides;
    let along_border = |[a, b, c]: &[u32; 3]| on(*a) & on(*b) & on(*c) != 0;
    let on_face = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|node| nodes[node as usize].at);
        face.encloses((a + b + c) / 3.0)
    };
    let triangles = triangulation
        .inner_faces()
        .map(|face| face.vertices().map(|vertex| vertex.data().node));
    Some(
        triangles
            .filter(|triangle| !along_border(triangle) && on_face(triangle))
            .collect(),
    )
}

/// The tiles, as nodes of the arrangement; `None` if its edges cross by a hair.
pub(super) fn tile(face: &Face, arrangement: &Arrangement) -> Option<Vec<Tile>> {
    let triangles = triangulate(face, arrangement)?;
    let points: Vec<DVec2> = arrangement.nodes.iter().map(|node| node.at).collect();
    let cuts: FxHashSet<[u32; 2]> = arrangement.edges.iter().copied().collect();
    Some(join(&points, &triangles, |[a, b]| {
        cuts.contains(&[a.min(b), a.max(b)])
    }))
}

/// The sides of the face, from node to node; none for a region, whose border is in the arrangement.
pub(super) fn sides(face: &Face, nodes: &[Node]) -> Vec<[u32; 2]> {
    let mut border = Vec::new();
    if face.border.is_some() {
        return border;
    }
    for side in 0..face.flat().len() {
        let [start, end] = face.side(side);
        let along = |node: u32| (nodes[node as usize].at - start).dot(end - start);
        let on_side = |node: &u32| nodes[*node as usize].sides & 1 << side != 0;
        let mut chain: Vec<u32> = (0..nodes.len() as u32).filter(on_side).collect();
        chain.sort_by(|a, b| along(*a).total_cmp(&along(*b)));
        border.extend(chain.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    border
}
