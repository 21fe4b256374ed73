//! What a mesh receives, from values at its vertices.

use super::common::shapes::{add_grey, add_quad, add_triangle, empty};
use glam::{DMat3, DVec3};
use radiosity::mesh::{Mesh, MeshLimits, NONE};

/// Three values of second degree in the coordinates.
fn quadratic(p: DVec3) -> DVec3 {
    let m = DMat3::from_cols_array(&[0.7, -0.4, 1.1, 0.3, 2.0, -0.9, -1.6, 0.2, 0.5]);
    DVec3::new(
        p.dot(m * p),
        p.x * p.y - 0.3 * p.z + 2.0,
        p.length_squared(),
    )
}

/// The exact integral over a triangle: its area by the mean in the middles of its sides.
fn over_triangle([a, b, c]: [DVec3; 3]) -> DVec3 {
    let area = (b - a).cross(c - a).length() / 2.0;
    let middles = [(a, b), (b, c), (c, a)].map(|(p, q)| quadratic(0.5 * (p + q)));
    area / 3.0 * middles.iter().sum::<DVec3>()
}

#[test]
fn a_graded_mesh_integrates_polynomials_of_second_degree_exactly() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 1.0);
    let [a, b, d] = [
        DVec3::new(0.1, 0.2, 0.0),
        DVec3::new(1.3, 0.4, 0.3),
        DVec3::new(0.5, 1.6, -0.2),
    ];
    let c = b + d - a;
    add_quad(&mut scene, grey, [a, b, c, d]);
    let apart = DVec3::new(4.0, 0.0, 1.0);
    let triangle = [a, b, d].map(|p| p + apart);
    add_triangle(&mut scene, grey, triangle);
    let limits = MeshLimits {
        initial_size: 1.0,
        max_depth: 6,
        min_size: 1e-3,
    };
    let mut mesh = Mesh::new(&scene, limits);
    // The first leaf of each patch three times over, and what balance asks for.
    for _ in 0..3 {
        let first_of = |patch: u32| mesh.leaves().find(|e| mesh.elements.patch_of(*e) == patch);
        let mut failed: Vec<u32> = (0..2).filter_map(first_of).collect();
        while !failed.is_empty() {
            for element in failed {
                mesh.split(element);
            }
            failed = mesh.unbalanced();
        }
    }
    mesh.finish_topology(0, &[]);
    assert!(mesh.leaves().any(|e| mesh.element(e).hanging != [NONE; 4]));
    let square = mesh.frame.scale().powi(2);
    for (patch, exact) in [
        (0, over_triangle([a, b, c]) + over_triangle([a, c, d])),
        (1, over_triangle(triangle)),
    ] {
        let vertices = mesh.vertices_of(patch);
        let found: DVec3 = vertices
            .map(|v| quadratic(mesh.frame.leave(mesh.position(v))) * mesh.weights[v as usize])
            .sum();
        let found = found / square;
        assert!(
            (found - exact).abs().max_element() < 1e-9,
            "{patch}: {found} for {exact}"
        );
    }
}
