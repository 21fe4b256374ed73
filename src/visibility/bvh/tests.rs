use super::*;
use glam::Vec3;

#[test]
fn is_send_and_sync() {
    fn check<T: Send + Sync>() {}
    check::<Obvhs>();
}

/// Numbers in -1 … 1 without order, the same on every machine.
fn numbers() -> impl FnMut() -> f32 {
    let mut state = 1_u32;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 23) as f32 - 1.0
    }
}

fn soup(triangles: usize) -> Triangles {
    let mut number = numbers();
    let mut point = || Vec3::new(number(), number(), number());
    let mut soup = Triangles::default();
    for first in (0..triangles as u32).map(|i| 3 * i) {
        let centre = point();
        soup.vertices
            .extend([0, 1, 2].map(|_| centre + 0.2 * point()));
        soup.indices.push([first, first + 1, first + 2]);
    }
    soup
}

/// Fans of all sizes, some aimed through corners, some with ends that cannot be traced.
fn fans(triangles: &Triangles, count: usize) -> Fans {
    let mut number = numbers();
    let mut fans = Fans::default();
    for fan in 0..count {
        fans.begin(Vec3::new(number(), number(), number()));
        for target in 0..fan % (MAX_FAN + 1) {
            fans.push(match target % 7 {
                0 => triangles.vertices[(7 * fan + target) % triangles.vertices.len()],
                1 => Vec3::new(number(), f32::NAN, number()),
                _ => Vec3::new(number(), number(), number()),
            });
        }
    }
    fans
}

#[test]
fn all_instruction_sets_give_the_same_bits() {
    let triangles = soup(500);
    let (tree, fans) = (Tree::new(&triangles), fans(&triangles, 2000));
    let ask = |isa: Isa| {
        let mut masks = Vec::new();
        isa::occluded(isa, &tree, &fans, &mut masks);
        masks
    };
    let expected = ask(Isa::Portable);
    assert!(expected.iter().any(|&mask| mask != 0));
    for isa in Isa::available() {
        assert!(ask(isa) == expected, "{isa:?}");
    }
}

#[test]
fn the_tree_holds_every_triangle_in_boxes_within_boxes() {
    let triangles = soup(300);
    let tree = Tree::new(&triangles);
    let mut indices = tree.indices.clone();
    indices.sort_unstable();
    assert!(indices.iter().copied().eq(0..300));

    let inside = |point: Vec3, node: &tree::Node| {
        point.cmpge(Vec3::from(node.min)).all() && point.cmple(Vec3::from(node.max)).all()
    };
    let mut nodes = vec![tree.root.expect("a root")];
    while let Some(node) = nodes.pop() {
        match node.content() {
            tree::Content::Leaf(leaf) => {
                let corners = tree.corners[leaf].iter().flatten();
                corners.for_each(|&corner| assert!(inside(corner, &node)));
            }
            tree::Content::Inner(pair) => {
                for child in tree.pairs[pair as usize].0 {
                    assert!(inside(child.min.into(), &node) && inside(child.max.into(), &node));
                    nodes.push(child);
                }
            }
        }
    }
}

/// See `padded_bounds`: floor and ceiling of a room must not share leaves.
#[test]
fn flat_faces_of_the_scene_stay_apart() {
    let mut triangles = Triangles::default();
    for y in [0.0, 1.0] {
        for cell in 0..100 {
            let (x, z) = ((cell / 10) as f32, (cell % 10) as f32);
            let first = triangles.vertices.len() as u32;
            let at = |dx, dz| Vec3::new(x + dx, y, z + dz);
            triangles
                .vertices
                .extend([at(0.0, 0.0), at(0.0, 1.0), at(1.0, 0.0)]);
            triangles.indices.push([first, first + 1, first + 2]);
        }
    }
    let tree = Tree::new(&triangles);
    for pair in &tree.pairs {
        for node in pair.0 {
            if let tree::Content::Leaf(_) = node.content() {
                assert!(node.max[1] - node.min[1] < 0.1, "{node:?}");
            }
        }
    }
}
