//! Degenerate input, and what must not change a picture.

use crate::setup::{COLOUR, brightness, head_on, look, square};
use glam::{DVec3, Vec3};
use radiosity::render::{Picture, RenderOptions, View};
use radiosity::scene::Camera;
use radiosity::solution::LitMesh;

#[test]
fn nothing_to_see_is_background_and_asks_nobody() {
    let away = Camera {
        eye: DVec3::NEG_Z,
        ..head_on(8, 1.0)
    };
    for (mesh, camera) in [
        (LitMesh::default(), head_on(8, 1.0)),
        (square(1.0, 1, |_| COLOUR), away),
    ] {
        let view = View::new(&mesh, &camera, &RenderOptions::standard(), |_| Err("asked"));
        let view = view.expect("no engine is needed");
        assert_eq!(view.radiance().pixels, [[0.0; 4]; 64]);
        assert_eq!(view.shaded().pixels, [[0; 3]; 64]);
        assert_eq!(view.mesh().pixels, [[0; 3]; 64]);
        assert_eq!(view.wireframe().pixels, [[255; 3]; 64]);
    }
}

#[test]
fn a_failing_engine_is_an_error() {
    let mesh = square(1.0, 1, |_| COLOUR);
    let outcome = View::new(&mesh, &head_on(8, 1.0), &RenderOptions::standard(), |_| {
        Err("no engine")
    });
    assert_eq!(outcome.err(), Some("no engine"));
}

#[test]
fn any_number_of_threads_gives_the_same_picture() -> Result<(), rayon::ThreadPoolBuildError> {
    let mesh = square(1.3, 4, |at| {
        Vec3::new(at.x.abs() as f32, 0.3, at.y.abs() as f32)
    });
    let camera = Camera {
        eye: DVec3::new(0.4, 0.3, 0.8),
        exposure: None,
        ..head_on(40, 1.4)
    };
    let pictures = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        let view = pool.install(|| look(&mesh, &camera, &RenderOptions::draft()));
        Ok((
            view.radiance(),
            view.shaded(),
            view.wireframe(),
            view.mesh(),
        ))
    };
    assert_eq!(pictures(1)?, pictures(5)?);
    Ok(())
}

#[test]
fn neither_place_nor_scale_nor_distance_changes_the_picture() {
    let mesh = square(1.0, 4, |at| Vec3::new(at.x.abs() as f32, 0.3, 1.0));
    let camera = Camera {
        eye: DVec3::new(0.4, 0.3, 0.8),
        ..head_on(24, 1.4)
    };
    let expected = look(&mesh, &camera, &RenderOptions::draft());
    for (scale, shift) in [
        (1e-6, DVec3::ZERO),
        (1e6, DVec3::ZERO),
        (1.0, DVec3::new(148_376.0, 1_234.0, -223_423.0)),
    ] {
        let mut moved = mesh.clone();
        moved
            .positions
            .iter_mut()
            .for_each(|position| *position = *position * scale + shift);
        let camera = Camera {
            eye: camera.eye * scale + shift,
            look_at: camera.look_at * scale + shift,
            ..camera.clone()
        };
        let view = look(&moved, &camera, &RenderOptions::draft());
        assert_similar(&view.wireframe(), &expected.wireframe());
        assert_similar(&view.mesh(), &expected.mesh());
    }
    // From a million units away, through a lens that is as much longer.
    let far = Camera {
        eye: DVec3::Z * 1e6,
        horizontal_fov: 2.0 * 0.7e-6_f64.atan().to_degrees(),
        ..head_on(24, 1.4)
    };
    let view = look(&mesh, &far, &RenderOptions::draft());
    assert_similar(
        &view.mesh(),
        &look(&mesh, &head_on(24, 1.4), &RenderOptions::draft()).mesh(),
    );
}

/// Rounding may move a sample across an edge here and there, but no more.
fn assert_similar(a: &Picture<[u8; 3]>, b: &Picture<[u8; 3]>) {
    let differing = a
        .pixels
        .iter()
        .zip(&b.pixels)
        .filter(|(a, b)| (brightness(a) - brightness(b)).abs() > 2)
        .count();
    assert!(
        differing * 100 <= a.pixels.len(),
        "{differing} of {} pixels differ",
        a.pixels.len()
    );
}
