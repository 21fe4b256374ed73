//! What a mesh receives, from values at its vertices.

use super::common::shapes::{add_grey, add_quad, add_triangle, empty};
use glam::{DMat3, DVec3};
use radiosity::mesh::{Mesh, MeshLimits, NONE};
use radiosity::radiometry::Spectrum;

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

/// A parallelogram and a triangle apart from it.
fn two_patches() -> (Mesh, [DVec3; 4], [DVec3; 3]) {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 1.0);
    let [a, b, d] = [
        DVec3::new(0.1, 0.2, 0.0),
        DVec3::new(1.3, 0.4, 0.3),
        DVec3::new(0.5, 1.6, -0.2),
    ];
    let quad = [a, b, b + d - a, d];
    add_quad(&mut scene, grey, quad);
    let triangle = [a, b, d].map(|p| p + DVec3::new(4.0, 0.0, 1.0));
    add_triangle(&mut scene, grey, triangle);
    let limits = MeshLimits {
        initial_size: 1.0,
        max_depth: 6,
        min_size: 1e-3,
    };
    (Mesh::new(&scene, limits), quad, triangle)
}

/// Splits the first leaf of some patches, and what balance asks for.
fn split_first_of(mesh: &mut Mesh, patches: &[u32]) {
    let first_of = |patch: &u32| mesh.leaves().find(|e| mesh.elements.patch_of(*e) == *patch);
    let mut failed: Vec<u32> = patches.iter().filter_map(first_of).collect();
    while !failed.is_empty() {
        for element in failed {
            mesh.split(element);
        }
        failed = mesh.unbalanced();
    }
}

#[test]
fn a_graded_mesh_integrates_polynomials_of_second_degree_exactly() {
    let (mut mesh, [a, b, c, d], triangle) = two_patches();
    for _ in 0..3 {
        split_first_of(&mut mesh, &[0, 1]);
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

#[test]
fn light_continues_alike_whether_patches_were_split_one_by_one_or_all_at_once() {
    let is_buried = |mesh: &Mesh, vertex: u32| {
        let middle = mesh.position(mesh.element(0).centre);
        mesh.position(vertex).distance(middle) < 0.3 || vertex.is_multiple_of(7)
    };
    let finish = |mesh: &mut Mesh, first: u32| {
        let vertices = first..mesh.vertices.len() as u32;
        let buried: Vec<bool> = vertices.map(|v| is_buried(mesh, v)).collect();
        mesh.finish_topology(first, &buried);
    };
    let refined = |step_by_step: bool| {
        let mut mesh = two_patches().0;
        finish(&mut mesh, 0);
        for round in 0..8 {
            let first = mesh.vertices.len() as u32;
            split_first_of(&mut mesh, &[round % 2]);
            if step_by_step {
                finish(&mut mesh, first);
            }
        }
        finish(&mut mesh, 0);
        mesh
    };
    let continued = |mesh: &Mesh| {
        let vertices = 0..mesh.vertices.len() as u32;
        let mut values: Vec<Spectrum> = vertices
            .map(|v| quadratic(mesh.position(v)).as_vec3())
            .collect();
        let before = values.clone();
        mesh.continue_to_buried(&mut values, |e| e, 0);
        assert_ne!(values, before);
        values
    };
    let (one_by_one, at_once) = (refined(true), refined(false));
    assert!(one_by_one.buried == at_once.buried && one_by_one.weights == at_once.weights);
    assert_eq!(continued(&one_by_one), continued(&at_once));
}
