//! The exported triangles conform: no T-junctions and no cracks, neither inside a patch nor where patches meet.

use super::{Preset, bundled, by_preset, draft, solved};
use glam::DVec3;
use radiosity::scene::Scene;
use radiosity::solution::LitMesh;
use std::collections::{BTreeSet, HashMap};

/// Sides of triangles by position, as often as they are used in this direction.
type Sides = HashMap<(u32, u32), usize>;

/// The triangles of each polygon, as positions.
fn triangles(lit: &LitMesh, polygons: usize) -> Vec<Vec<[u32; 3]>> {
    let mut of = vec![Vec::new(); polygons];
    for triangle in &lit.triangles {
        of[triangle.polygon as usize]
            .push(triangle.vertices.map(|v| lit.vertices[v as usize].position));
    }
    of
}

fn sides(triangles: &[[u32; 3]]) -> Sides {
    let mut sides = Sides::new();
    for [a, b, c] in triangles {
        for side in [(*a, *b), (*b, *c), (*c, *a)] {
            *sides.entry(side).or_insert(0) += 1;
        }
    }
    sides
}

/// The sides that no triangle of the same polygon has on its other side.
fn open_sides(sides: &Sides) -> Vec<(u32, u32)> {
    sides
        .keys()
        .filter(|(a, b)| !sides.contains_key(&(*b, *a)))
        .copied()
        .collect()
}

/// Distance of `point` from the segment, and whether it is nearer to an end than to all else.
fn distance(point: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let along = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    point.distance(a.lerp(b, along))
}

fn outline(scene: &Scene, polygon: usize) -> Vec<[DVec3; 2]> {
    let corners: Vec<DVec3> = scene.positions(&scene.surfaces[polygon]).collect();
    (0..corners.len())
        .map(|i| [corners[i], corners[(i + 1) % corners.len()]])
        .collect()
}

fn area(corners: [DVec3; 3]) -> DVec3 {
    (corners[1] - corners[0]).cross(corners[2] - corners[0]) * 0.5
}

fn assert_conforming(name: &str) {
    let scene = bundled(name);
    let lit = solved(&scene, draft()).lit_mesh();
    let (low, high) = scene.bounds();
    // Half of the distance within which positions are taken to be one.
    let hair = 0.5e-7 * (high - low).max_element();
    let at = |position: u32| lit.positions[position as usize];
    let mut borders = Vec::new();
    for (polygon, triangles) in triangles(&lit, scene.surfaces.len()).iter().enumerate() {
        let sides = sides(triangles);
        assert!(
            sides.values().all(|uses| *uses == 1),
            "{name}: triangles of polygon {polygon} overlap or are folded"
        );
        let outline = outline(&scene, polygon);
        for (a, b) in open_sides(&sides) {
            let on_outline = outline
                .iter()
                .any(|side| distance(at(a), *side) < hair && distance(at(b), *side) < hair);
            assert!(
                on_outline,
                "{name}: polygon {polygon} is torn open between {} and {}",
                at(a),
                at(b)
            );
            borders.push((a, b));
        }
        let whole = scene.normal(&scene.surfaces[polygon]);
        let covered: f64 = triangles.iter().map(|t| area(t.map(at)).dot(whole)).sum();
        let expected = scene.area(&scene.surfaces[polygon]);
        assert!(
            (covered / expected - 1.0).abs() < 1e-9,
            "{name}: {covered} of {expected} of polygon {polygon}"
        );
        assert!(
            triangles.iter().all(|t| area(t.map(at)).dot(whole) > 0.0),
            "{name}: polygon {polygon} has folded triangles"
        );
    }
    assert_matching(name, &lit, &borders, hair);
}

/// Where the outlines of polygons meet they have the same positions: none lies on a side of another without being its end.
fn assert_matching(name: &str, lit: &LitMesh, borders: &[(u32, u32)], hair: f64) {
    let at = |position: u32| lit.positions[position as usize];
    let positions: BTreeSet<u32> = borders.iter().flat_map(|(a, b)| [*a, *b]).collect();
    for &(a, b) in borders {
        let ends = [at(a), at(b)];
        let (low, high) = (ends[0].min(ends[1]) - hair, ends[0].max(ends[1]) + hair);
        for &position in positions.iter().filter(|p| **p != a && **p != b) {
            let point = at(position);
            let near = point.cmpge(low).all() && point.cmple(high).all();
            assert!(
                !near || distance(point, ends) > hair,
                "{name}: {point} lies on the side from {} to {}",
                ends[0],
                ends[1]
            );
        }
    }
}

#[test]
fn cornell_box() {
    assert_conforming("cornell-box");
}

#[test]
fn geometry() {
    assert_conforming("geometry");
}

#[test]
fn shadow() {
    assert_conforming("shadow");
}

#[test]
fn triangles_are_the_same_on_any_number_of_threads() {
    let solution = by_preset("shadow", Preset::Standard);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start").install(|| solution.lit_mesh())
    };
    let (one, three) = (on(1), on(3));
    assert!(one.triangles.len() > 50_000, "{}", one.triangles.len());
    assert_eq!(one.positions, three.positions);
    assert_eq!(one.vertices, three.vertices);
    assert_eq!(one.triangles, three.triangles);
}
