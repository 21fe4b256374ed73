//! The tree of nodes: who is where.

use super::file::File;
use crate::scene::SceneError;
use ::gltf::Node;
use glam::{DMat4, DVec4};

/// A node with the way from its own coordinates to those of the scene.
pub(super) struct Placed<'a> {
    pub node: Node<'a>,
    pub to_scene: DMat4,
}

/// All nodes of the default scene (or the first; or of the file, where it has no scene), parents first.
pub(super) fn placed<'a>(file: &'a File) -> Result<Vec<Placed<'a>>, SceneError> {
    let document = &file.document;
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let mut stack: Vec<(Node, DMat4)> = match scene {
        Some(scene) => scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect(),
        None => roots(file).map(|node| (node, DMat4::IDENTITY)).collect(),
    };
    stack.reverse();
    let mut seen = vec![false; document.nodes().count()];
    let mut placed = Vec::new();
    while let Some((node, parent)) = stack.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            let found = format!("node {} twice in the tree of nodes", node.index());
            return Err(file.error(found, "each node below one other at most"));
        }
        let to_scene = parent * matrix(&node);
        let below = stack.len();
        stack.extend(node.children().map(|child| (child, to_scene)));
        stack[below..].reverse();
        placed.push(Placed { node, to_scene });
    }
    Ok(placed)
}

/// The nodes that are nobody's children.
fn roots<'a>(file: &'a File) -> impl Iterator<Item = Node<'a>> {
    let mut child = vec![false; file.document.nodes().count()];
    for node in file.document.nodes() {
        node.children()
            .for_each(|below| child[below.index()] = true);
    }
    let nodes = file.document.nodes();
    nodes.filter(move |node| !child[node.index()])
}

fn matrix(node: &Node) -> DMat4 {
    let columns = node.transform().matrix();
    let [x, y, z, w] = columns.map(|column| DVec4::from_array(column.map(f64::from)));
    DMat4::from_cols(x, y, z, w)
}
