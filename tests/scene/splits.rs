//! Polygons that must be split: area, orientation and convexity of their pieces.

use super::obj;
use glam::DVec3;
use radiosity::scene::{Corners, Scene, Surface};

/// One polygon with these corners, written as OBJ and loaded.
fn polygon(corners: &[[f64; 3]]) -> (Scene, Vec<String>) {
    let mut text: String = corners
        .iter()
        .map(|[x, y, z]| format!("v {x} {y} {z}\n"))
        .collect();
    text.push_str("usemtl default\nf");
    (1..=corners.len()).for_each(|i| text.push_str(&format!(" {i}")));
    let (scene, mut warnings) = obj(&text);
    warnings.retain(|warning| !warning.contains("given a grey"));
    (scene, warnings)
}

fn in_plane(corners: &[[f64; 2]]) -> Vec<[f64; 3]> {
    // A plane in general position, so that no coordinate is special.
    let (u, v) = (
        DVec3::new(2.0, 1.0, 2.0) / 3.0,
        DVec3::new(-2.0, 2.0, 1.0) / 3.0,
    );
    corners
        .iter()
        .map(|[x, y]| (DVec3::new(5.0, -3.0, 8.0) + *x * u + *y * v).to_array())
        .collect()
}

/// The normal of that plane.
const NORMAL: DVec3 = DVec3::new(-1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0);

/// The polygon's area by the shoelace formula.
fn shoelace(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0)
        .sum()
}

/// The sine of the turn at each corner, positive for a turn to the left of the plane's front.
fn turns(scene: &Scene, surface: &Surface, normal: DVec3) -> Vec<f64> {
    let p: Vec<DVec3> = scene.positions(surface).collect();
    let n = p.len();
    let edge = |i: usize| (p[(i + 1) % n] - p[i % n]).normalize();
    (0..n)
        .map(|i| normal.dot(edge(i).cross(edge(i + 1))))
        .collect()
}

/// Checks the pieces of a planar polygon and gives the numbers of triangles and of quads.
#[track_caller]
fn split(corners: &[[f64; 2]]) -> (usize, usize) {
    let (scene, warnings) = polygon(&in_plane(corners));
    assert_eq!(warnings, [""; 0]);
    let summary = scene.summary();
    let area = shoelace(corners);
    assert!(
        (summary.area - area).abs() < 1e-12 * area,
        "area {} of {area}",
        summary.area
    );
    for surface in &scene.surfaces {
        assert!(
            turns(&scene, surface, NORMAL)
                .iter()
                .all(|sine| *sine > 1e-3),
            "{surface:?} is convex"
        );
        assert!(
            scene.normal(surface).dot(NORMAL) > 1.0 - 1e-12,
            "{surface:?} is oriented as the polygon"
        );
        assert_eq!(surface.polygon, 0);
    }
    assert_eq!(scene.input_polygons, 1);
    (summary.triangles, summary.quads)
}

#[test]
fn convex_quads_and_triangles_stay() {
    assert_eq!(split(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), (1, 0));
    assert_eq!(
        split(&[[0.0, 0.0], [3.0, 0.0], [2.0, 1.0], [0.0, 1.0]]),
        (0, 1)
    );
}

#[test]
fn concave_quads_are_cut_at_the_dent_whichever_corner_it_is() {
    let dart = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
    for begin in 0..4 {
        let mut corners = dart;
        corners.rotate_left(begin);
        assert_eq!(split(&corners), (2, 0));
    }
}

#[test]
fn a_straight_corner_is_no_corner_of_a_quad() {
    for begin in 0..4 {
        let mut corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        corners.rotate_left(begin);
        assert_eq!(split(&corners), (2, 0));
    }
}

#[test]
fn an_l_becomes_two_quads() {
    let l = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    for begin in 0..6 {
        let mut corners = l;
        corners.rotate_left(begin);
        assert_eq!(split(&corners), (0, 2));
    }
}

#[test]
fn stars_combs_and_discs_are_covered_once() {
    let wheel = |n: usize, radius: fn(usize) -> f64| -> Vec<[f64; 2]> {
        let angle = |i: usize| i as f64 / n as f64 * std::f64::consts::TAU;
        (0..n)
            .map(|i| [radius(i) * angle(i).cos(), radius(i) * angle(i).sin()])
            .collect()
    };
    let star = |i: usize| if i.is_multiple_of(2) { 1.0 } else { 0.3 };
    let (triangles, quads) = split(&wheel(10, star));
    assert_eq!(
        triangles + 2 * quads,
        8,
        "a star of ten corners has eight triangles"
    );
    for n in [5, 6, 17, 64] {
        let (triangles, quads) = split(&wheel(n, |_| 2.0));
        assert_eq!(triangles + 2 * quads, n - 2, "{n} corners");
    }
    let comb: Vec<[f64; 2]> = (0..40)
        .map(|i| {
            [
                f64::from(i / 2),
                if (i / 2) % 2 == i % 2 { 1.0 } else { 5.0 },
            ]
        })
        .chain([[19.0, 0.0], [0.0, 0.0]])
        .rev()
        .collect();
    let (triangles, quads) = split(&comb);
    assert!(
        triangles + 2 * quads == 40,
        "{triangles} triangles, {quads} quads"
    );
}

#[test]
fn a_hole_tied_to_the_rim_by_a_cut_stays_a_hole() {
    let rim = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
    let hole = [[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0]];
    let corners: Vec<[f64; 2]> = rim.into_iter().chain(hole).collect();
    let (triangles, quads) = split(&corners);
    assert_eq!((triangles, quads), (0, 4), "a frame of four trapezoids");
}

#[test]
fn a_corner_on_a_straight_side_is_kept_for_the_neighbour() {
    let (scene, _) = polygon(&in_plane(&[
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [2.0, 2.0],
        [0.0, 2.0],
    ]));
    let used = |vertex: u32| {
        scene
            .surfaces
            .iter()
            .any(|s| s.corners.indices().contains(&vertex))
    };
    assert!((0..5).all(used));
}

#[test]
fn a_bent_quad_is_cut_along_the_better_diagonal() {
    // A long kite: the short diagonal from corner 1 to corner 3 makes the better triangles.
    let (scene, warnings) = polygon(&[
        [-3.0, 0.0, 0.0],
        [0.0, -1.0, 0.1],
        [3.0, 0.0, 0.0],
        [0.0, 1.0, 0.1],
    ]);
    assert_eq!(warnings, [""; 0]);
    let corners: Vec<Corners> = scene
        .surfaces
        .iter()
        .map(|surface| surface.corners)
        .collect();
    assert_eq!(
        corners,
        [Corners::Triangle([1, 2, 3]), Corners::Triangle([1, 3, 0])]
    );
}

#[test]
fn planarity_is_relative_to_the_size() {
    for size in [1e-3, 1.0, 1e6] {
        let quad = |lift: f64| {
            [
                [0.0, 0.0, 0.0],
                [size, 0.0, 0.0],
                [size, size, lift * size],
                [0.0, size, 0.0],
            ]
        };
        assert_eq!(polygon(&quad(1e-5)).0.surfaces.len(), 1, "{size}");
        assert_eq!(polygon(&quad(1e-4)).0.surfaces.len(), 2, "{size}");
    }
}

#[test]
fn far_from_the_origin_nothing_changes() {
    let square = [
        [1e6, 1e6, 0.0],
        [1e6 + 1.0, 1e6, 0.0],
        [1e6 + 1.0, 1e6 + 1.0, 0.0],
        [1e6, 1e6 + 1.0, 0.0],
    ];
    let (scene, warnings) = polygon(&square);
    assert_eq!((scene.surfaces.len(), warnings.len()), (1, 0));
    assert_eq!(scene.area(&scene.surfaces[0]), 1.0);
}

#[test]
fn unusable_polygons_are_left_out_and_counted() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\n";
    let faces = [
        "f 1 2 3 4",   // good
        "f 2 3 4 1",   // the same again
        "f 1 4 3 2",   // its back, which is another polygon
        "f 1 2 5",     // on a line
        "f 1 2 5 6",   // on a line
        "f 1 2 1",     // two corners
        "f 1 2 4 3",   // a bow tie whose lobes cancel
        "f 1 5 2 3 4", // runs back over its own side
        "f 1 2 2 3",   // a triangle
    ];
    let text = format!("{vertices}usemtl default\n{}\n", faces.join("\n"));
    let (scene, warnings) = obj(&text);
    assert_eq!(scene.input_polygons, faces.len());
    assert_eq!(
        warnings[1..],
        [
            "it.obj:16: 1 polygon with a corner twice in a row, taken as once",
            "it.obj:9: 1 repeated polygon left out",
            "it.obj:11: 3 polygons without area left out (first here)",
            "it.obj:14: 2 polygons whose boundary crosses itself left out: light passes there (first here)",
        ]
    );
    let polygons: Vec<u32> = scene
        .surfaces
        .iter()
        .map(|surface| surface.polygon)
        .collect();
    assert_eq!(polygons, [0, 2, 8]);
}

#[test]
fn crossing_polygons_have_no_inside() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    // A bow tie with unequal lobes, and a pentagram that winds around its middle twice.
    let bow_tie = "v 0 0 5\nv 4 0 5\nv 1 1 5\nv 3 2 5\nf 4 5 6 7\n";
    let pentagram: String = (0..5)
        .map(|i| (f64::from(i) * 2.0 / 5.0 * std::f64::consts::TAU).sin_cos())
        .map(|(sin, cos)| format!("v {cos} {sin} 9\n"))
        .chain(["f -5 -4 -3 -2 -1\n".to_owned()])
        .collect();
    let (scene, warnings) = obj(&format!("{vertices}{bow_tie}{pentagram}"));
    assert_eq!(scene.surfaces.len(), 1, "{:?}", scene.surfaces);
    assert!(
        warnings[1].contains("2 polygons whose boundary crosses itself"),
        "{warnings:?}"
    );
}
