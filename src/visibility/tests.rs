//! Cases made by hand, asked of every engine there is.

use super::*;
use glam::vec3;

fn engines(triangles: &Triangles) -> Vec<Box<dyn Visibility>> {
    EngineChoice::ALL
        .into_iter()
        .filter(|&choice| choice != EngineChoice::Embree || cfg!(embree))
        .map(|choice| build(choice, triangles, 1).expect("valid triangles"))
        .collect()
}

/// The unit square in the plane z = 0, as two triangles that share the diagonal from (0, 0) to (1, 1).
fn square() -> Triangles {
    Triangles {
        vertices: vec![Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), Vec3::Y],
        indices: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// Asserts what all engines say about one segment.
#[track_caller]
fn assert_occluded(triangles: &Triangles, from: Vec3, to: Vec3, expected: bool) {
    let mut fans = Fans::default();
    fans.begin(from);
    fans.push(to);
    let mut masks = Vec::new();
    for engine in engines(triangles) {
        engine.occluded(&fans, &mut masks);
        assert_eq!(
            masks,
            [u64::from(expected)],
            "{} on {from} to {to}",
            engine.info().name
        );
    }
}

/// Asserts what all engines find on one ray.
#[track_caller]
fn assert_nearest(triangles: &Triangles, origin: Vec3, direction: Vec3, expected: Option<Hit>) {
    let mut hits = Vec::new();
    for engine in engines(triangles) {
        engine.nearest(&[Ray { origin, direction }], &mut hits);
        let name = engine.info().name;
        match (hits.as_slice(), expected) {
            ([Some(hit)], Some(expected)) => {
                assert_eq!(hit.triangle, expected.triangle, "{name}");
                let found = vec3(hit.t, hit.u, hit.v);
                let wanted = vec3(expected.t, expected.u, expected.v);
                // Far more than three roundings, far less than any other answer.
                assert!(found.abs_diff_eq(wanted, 1e-5), "{name}: {hit:?}");
            }
            ([None], None) => {}
            (found, _) => panic!("{name}: {found:?} instead of {expected:?}"),
        }
    }
}

#[test]
fn a_square_occludes_from_both_sides() {
    let (above, below) = (vec3(0.3, 0.1, 1.0), vec3(0.4, 0.2, -1.0));
    assert_occluded(&square(), above, below, true);
    assert_occluded(&square(), below, above, true);
}

#[test]
fn beside_the_square_nothing_occludes() {
    assert_occluded(
        &square(),
        vec3(1.01, 0.5, 1.0),
        vec3(1.01, 0.5, -1.0),
        false,
    );
    assert_occluded(&square(), vec3(0.5, 0.5, 1.0), vec3(0.5, 0.5, 0.1), false);
    assert_occluded(&square(), vec3(0.5, 0.5, -0.1), vec3(0.5, 0.5, -1.0), false);
}

#[test]
fn the_shared_edge_and_its_corners_occlude() {
    for p in [0.0, 0.125, 0.3, 0.5, 1.0] {
        assert_occluded(&square(), vec3(p, p, 1.0), vec3(p, p, -1.0), true);
    }
    assert_occluded(&square(), vec3(0.0, 1.0, 1.0), vec3(1.0, 0.0, -1.0), true);
}

#[test]
fn segments_are_open_at_their_ends() {
    let (on, off) = (vec3(0.25, 0.5, 0.0), vec3(0.25, 0.5, 2.0));
    assert_occluded(&square(), on, off, false);
    assert_occluded(&square(), off, on, false);
    assert_occluded(&square(), on, vec3(0.75, 0.5, 0.0), false);
    // Twice as far inside as the open interval begins, and half as far.
    let reach = 1.0 / T_NEAR;
    assert_occluded(
        &square(),
        vec3(0.25, 0.5, 2.0),
        vec3(0.25, 0.5, -reach),
        true,
    );
    assert_occluded(
        &square(),
        vec3(0.25, 0.5, 0.5),
        vec3(0.25, 0.5, -reach),
        false,
    );
    assert_occluded(
        &square(),
        vec3(0.25, 0.5, -reach),
        vec3(0.25, 0.5, 4.0),
        true,
    );
    assert_occluded(
        &square(),
        vec3(0.25, 0.5, -reach),
        vec3(0.25, 0.5, 0.25),
        false,
    );
}

#[test]
fn nothing_occludes_in_an_empty_scene() {
    for empty in [
        Triangles::default(),
        Triangles {
            indices: Vec::new(),
            ..square()
        },
    ] {
        assert_occluded(&empty, vec3(0.5, 0.5, 1.0), vec3(0.5, 0.5, -1.0), false);
        assert_nearest(&empty, Vec3::ZERO, Vec3::Z, None);
    }
}

#[test]
fn degenerate_triangles_hit_nothing_and_harm_nothing() {
    let mut triangles = square();
    triangles.vertices.extend([vec3(0.5, 0.5, 0.5); 3]);
    triangles
        .vertices
        .extend([vec3(0.0, 0.0, 0.5), vec3(1.0, 1.0, 0.5)]);
    triangles
        .indices
        .extend([[4, 4, 4], [4, 5, 6], [7, 8, 7], [7, 4, 8]]);
    assert_occluded(&triangles, vec3(0.5, 0.5, 1.0), vec3(0.5, 0.5, 0.1), false);
    assert_occluded(&triangles, vec3(0.0, 1.0, 0.5), vec3(1.0, 0.0, 0.5), false);
    assert_occluded(&triangles, vec3(0.5, 0.5, 1.0), vec3(0.5, 0.5, -1.0), true);
    let alone = Triangles {
        indices: triangles.indices.split_off(2),
        ..triangles
    };
    assert_occluded(&alone, vec3(0.0, 0.0, 1.0), vec3(1.0, 1.0, -1.0), false);
}

#[test]
fn copies_of_a_triangle_are_one_occluder() {
    let copies = Triangles {
        indices: square().indices.repeat(1000),
        ..square()
    };
    assert_occluded(&copies, vec3(0.5, 0.25, 1.0), vec3(0.5, 0.25, -1.0), true);
    assert_occluded(&copies, vec3(1.5, 0.25, 1.0), vec3(1.5, 0.25, -1.0), false);
}

#[test]
fn segments_that_cannot_be_traced_meet_nothing() {
    let good = vec3(0.5, 0.5, -1.0);
    for bad in [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        2.0 * COORDINATE_LIMIT,
    ] {
        assert_occluded(&square(), vec3(0.5, 0.5, bad), good, false);
        assert_occluded(&square(), vec3(bad, 0.5, 0.5), good, false);
        assert_occluded(&square(), good, vec3(0.5, 0.5, bad), false);
        assert_occluded(&square(), good, vec3(0.5, bad, 1.0), false);
        assert_nearest(&square(), good, vec3(0.0, 0.0, bad), None);
        assert_nearest(&square(), vec3(0.5, bad, -1.0), Vec3::Z, None);
    }
    assert_occluded(&square(), good, good, false);
    assert_nearest(&square(), good, Vec3::ZERO, None);
}

/// Single precision has numbers for all that the engines compute up to the limit of coordinates, and down to the least size that they promise.
#[test]
fn the_largest_and_the_smallest_triangles_that_may_be_traced_are_met() {
    for scale in [COORDINATE_LIMIT, 1e-10] {
        let corner = |v: &Vec3| (2.0 * *v - vec3(1.0, 1.0, 0.0)) * scale;
        let large = Triangles {
            vertices: square().vertices.iter().map(corner).collect(),
            ..square()
        };
        for step in 0..81 {
            let place = |k: u32| (step / 3_u32.pow(k) % 3) as f32 * 0.3 - 0.33;
            let from = vec3(place(0), place(1), 0.5) * scale;
            let to = vec3(place(2), place(3), -0.45) * scale;
            assert_occluded(&large, from, to, true);
            assert_occluded(&large, from, from * vec3(1.0, 1.0, 0.5), false);
            let hits = 0.5 / 0.95;
            for engine in engines(&large) {
                let ray = Ray {
                    origin: from,
                    direction: to - from,
                };
                let mut found = Vec::new();
                engine.nearest(&[ray], &mut found);
                let t = found[0].map(|hit| hit.t);
                let name = engine.info().name;
                assert!(t.is_some_and(|t| (t - hits).abs() < 1e-5), "{name}: {t:?}");
            }
        }
    }
}

#[test]
fn a_bad_segment_leaves_its_neighbours_alone() {
    let mut fans = Fans::default();
    fans.begin(vec3(0.5, 0.25, 1.0));
    for z in [-1.0, f32::NAN, 0.5, -1.0, f32::INFINITY, -2.0] {
        fans.push(vec3(0.5, 0.25, z));
    }
    fans.begin(vec3(f32::NAN, 0.25, 1.0));
    fans.push(vec3(0.5, 0.25, -1.0));
    fans.begin(vec3(0.5, 0.25, 1.0)); // and a fan without targets
    fans.begin(vec3(0.5, 0.25, 1.0));
    fans.push(vec3(0.5, 0.25, -1.0));
    let mut masks = Vec::new();
    for engine in engines(&square()) {
        engine.occluded(&fans, &mut masks);
        assert_eq!(masks, [0b101001, 0, 0, 1], "{}", engine.info().name);
    }
}

#[test]
fn full_fans_use_all_bits() {
    let mut fans = Fans::default();
    for origin in [vec3(0.5, 0.25, 1.0), vec3(0.5, 0.25, 3.0)] {
        fans.begin(origin);
        for k in 0..MAX_FAN {
            fans.push(vec3(0.5, 0.25, if k % 3 == 0 { -1.0 } else { 0.5 }));
        }
    }
    let every_third = (0..MAX_FAN).step_by(3).fold(0_u64, |mask, k| mask | 1 << k);
    let mut masks = vec![7; 5];
    for engine in engines(&square()) {
        engine.occluded(&fans, &mut masks);
        assert_eq!(masks, [every_third, every_third], "{}", engine.info().name);
    }
}

#[test]
fn nearest_finds_the_first_of_two_layers() {
    let mut triangles = square();
    triangles
        .vertices
        .extend(square().vertices.iter().map(|v| *v - Vec3::Z));
    triangles.indices.extend([[4, 5, 6], [4, 6, 7]]);
    let hit = |t, triangle, u, v| Some(Hit { t, triangle, u, v });
    let (above, below) = (vec3(0.75, 0.25, 1.0), vec3(0.25, 0.75, -3.0));
    assert_nearest(&triangles, above, -Vec3::Z, hit(1.0, 0, 0.5, 0.25));
    assert_nearest(&triangles, above, -0.25 * Vec3::Z, hit(4.0, 0, 0.5, 0.25));
    assert_nearest(&triangles, below, Vec3::Z, hit(2.0, 3, 0.25, 0.5));
    assert_nearest(&triangles, below, Vec3::X, None);
    assert_nearest(&triangles, above, Vec3::Z, None);
}

#[test]
fn bad_triangles_are_refused() {
    let mut nan = square();
    nan.vertices[3].y = f32::NAN;
    let mut far = square();
    far.vertices[1].x = 2.0 * COORDINATE_LIMIT;
    let mut index = square();
    index.indices[1][2] = 4;
    for choice in EngineChoice::ALL {
        let refusal = |triangles| {
            build(choice, triangles, 1)
                .err()
                .expect("refused")
                .to_string()
        };
        assert!(refusal(&nan).starts_with("vertex 3 at"));
        assert!(refusal(&far).starts_with("vertex 1 at"));
        assert_eq!(
            refusal(&index),
            "triangle 1 refers to vertex 4, but there are 4"
        );
    }
}

#[test]
fn choices_have_names() {
    for choice in EngineChoice::ALL {
        assert_eq!(choice.to_string().parse(), Ok(choice));
    }
    let error = "fastest".parse::<EngineChoice>().unwrap_err();
    assert!(error.to_string().contains("`fastest`"));
}

#[test]
fn auto_is_a_fixed_rule() {
    let chosen = |count: usize| {
        let corner = |n: usize| vec3(n as f32, (n % 2) as f32, 0.0);
        let triangles = Triangles {
            vertices: (0..count + 2).map(corner).collect(),
            indices: (0..count as u32).map(|n| [n, n + 1, n + 2]).collect(),
        };
        let engine = build(EngineChoice::Auto, &triangles, 1).unwrap();
        engine.info().name
    };
    let slow = if cfg!(embree) { "embree" } else { "obvhs" };
    let quick = if Isa::widest() == Isa::Portable {
        slow
    } else {
        "obvhs"
    };
    assert_eq!([2, FEW].map(chosen), [quick; 2]);
    assert_eq!([FEW + 1, 2 * FEW].map(chosen), [slow; 2]);
}

#[cfg(not(embree))]
#[test]
fn embree_is_not_built_in() {
    let error = build(EngineChoice::Embree, &square(), 1).err();
    assert_eq!(error, Some(VisibilityError::EmbreeNotBuilt));
}
