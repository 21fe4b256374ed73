//! Radiance, and what the screen shows of it.

use crate::setup::{COLOUR, add_quad, head_on, look, square};
use glam::{DVec3, Vec3};
use radiosity::output::write_exr;
use radiosity::render::{RenderOptions, Tone};
use radiosity::scene::Camera;
use std::f32::consts::PI;

#[test]
fn a_constant_quad_has_its_radiance_in_every_pixel_of_the_exr()
-> Result<(), Box<dyn std::error::Error>> {
    let mesh = square(2.0, 3, |_| PI * COLOUR);
    let picture = look(&mesh, &head_on(24, 1.0), &RenderOptions::standard()).radiance();
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("quad.exr");
    write_exr(&path, picture.width, picture.height, &picture.pixels)?;
    let read = exr::prelude::read_first_rgba_layer_from_file(
        &path,
        |size, _| vec![[0.0; 4]; size.area()],
        |read: &mut Vec<[f32; 4]>, at, (r, g, b, a): (f32, f32, f32, f32)| {
            read[at.y() * 24 + at.x()] = [r, g, b, a]
        },
    )?;
    let pixels = read.layer_data.channel_data.pixels;
    assert_eq!(pixels.len(), 24 * 24);
    for [r, g, b, alpha] in pixels {
        assert_eq!(alpha, 1.0, "no crack");
        // Rounding of the weights and of the mean of 16 samples.
        assert!((Vec3::new(r, g, b) - COLOUR).abs().max_element() < 1e-6);
    }
    Ok(())
}

#[test]
fn radiosity_is_interpolated_linearly() {
    let mesh = square(2.0, 2, |at| {
        PI * Vec3::new(at.x as f32 + 1.0, at.y as f32 + 1.0, 1.0)
    });
    let picture = look(&mesh, &head_on(20, 2.0), &RenderOptions::standard()).radiance();
    for (x, y) in (0..20).flat_map(|x| (0..20).map(move |y| (x, y))) {
        let middle = Vec3::new(x as f32 + 0.5, 19.5 - y as f32, 10.0) / 10.0;
        let [r, g, b, _] = *picture.at(x, y);
        // The pattern of samples is off the middle by less than a thousandth of a pixel, and a pixel spans 0.1.
        assert!(
            (Vec3::new(r, g, b) - middle).abs().max_element() < 2e-4,
            "({x}, {y})"
        );
    }
}

#[test]
fn a_tessellated_wall_has_no_crack_from_any_angle() {
    let mesh = square(20.0, 20, |_| COLOUR);
    for eye in [
        DVec3::new(0.3, 0.2, 1.0),
        DVec3::new(-0.7, 0.5, 1.0),
        DVec3::new(0.0, 0.0, 2.0),
    ] {
        let camera = Camera {
            eye,
            look_at: DVec3::new(0.01, 0.02, 0.0),
            horizontal_fov: 60.0,
            ..head_on(24, 1.0)
        };
        let picture = look(&mesh, &camera, &RenderOptions::standard()).radiance();
        assert!(
            picture.pixels.iter().all(|pixel| pixel[3] == 1.0),
            "from {eye}"
        );
    }
}

#[test]
fn the_edge_covers_its_share_of_a_pixel() {
    // 10 pixels to the unit: the square ends in the middle of the pixels 5 and 14.
    let picture = look(
        &square(0.9, 1, |_| PI * Vec3::ONE),
        &head_on(20, 2.0),
        &RenderOptions::standard(),
    )
    .radiance();
    for (column, share) in [
        (4, 0.0),
        (5, 0.5),
        (6, 1.0),
        (13, 1.0),
        (14, 0.5),
        (15, 0.0),
    ] {
        let [radiance, .., alpha] = *picture.at(column, 10);
        assert!((alpha - share).abs() < 0.01, "column {column}: {alpha}");
        assert!((radiance - alpha).abs() < 1e-6, "premultiplied");
    }
}

#[test]
fn backs_are_see_through_and_two_sided_surfaces_show_the_side_that_faces() {
    let mut mesh = square(2.0, 1, |_| PI * Vec3::X);
    // The other side of the same surface, meshed differently.
    let corner = DVec3::new(-1.0, -1.0, 0.0);
    add_quad(
        &mut mesh,
        [corner, DVec3::Y * 2.0, DVec3::X * 2.0],
        3,
        |_| PI * Vec3::Y,
    );
    // Between the eye and it, the back of a wall.
    let before = [corner + 0.5 * DVec3::Z, DVec3::Y * 2.0, DVec3::X * 2.0];
    add_quad(&mut mesh, before, 1, |_| PI * Vec3::Z);
    let front = look(&mesh, &head_on(9, 1.0), &RenderOptions::draft()).radiance();
    let from_behind = Camera {
        eye: DVec3::NEG_Z,
        ..head_on(9, 1.0)
    };
    let back = look(&mesh, &from_behind, &RenderOptions::draft()).radiance();
    for (picture, colour) in [(front, Vec3::X), (back, Vec3::Y)] {
        for pixel in picture.pixels {
            assert!(
                (Vec3::from_slice(&pixel) - colour).abs().max_element() < 1e-6,
                "{pixel:?}"
            );
        }
    }
}

#[test]
fn exposure_is_in_stops_and_what_is_shown_is_srgb() {
    // sRGB of 0.5 is 187.5 of 255, of 0.25 it is 136.96, of 1/16 it is 70.5.
    for (exposure, gain) in [(0.0, 1.0), (-3.0, 8.0), (5.0, 1.0 / 32.0)] {
        let camera = Camera {
            exposure: Some(exposure),
            ..head_on(16, 1.0)
        };
        let view = look(
            &square(2.0, 1, |_| gain * PI * COLOUR),
            &camera,
            &RenderOptions::draft(),
        );
        assert_eq!(view.exposure(), exposure);
        let shown = view.shaded();
        for pixel in &shown.pixels {
            for (value, expected) in pixel.iter().zip([187.5, 136.96, 70.5]) {
                assert!((f64::from(*value) - expected).abs() < 1.1, "{pixel:?}");
            }
        }
        let mean = shown
            .pixels
            .iter()
            .map(|pixel| f64::from(pixel[0]))
            .sum::<f64>()
            / 256.0;
        assert!((mean - 187.5).abs() < 0.1, "dither keeps the mean: {mean}");
    }
    assert_eq!(Tone::new(0.0).colour(COLOUR), [188, 137, 71]);
}

#[test]
fn automatic_exposure_brings_a_grey_wall_to_a_fifth_of_white() {
    let camera = Camera {
        exposure: None,
        ..head_on(16, 1.0)
    };
    for radiance in [1e-6, 0.2, 3e7] {
        let mesh = square(2.0, 2, |_| Vec3::splat(PI * radiance));
        let expected = f64::from(0.2 / radiance).log2();
        assert!((look(&mesh, &camera, &RenderOptions::draft()).exposure() - expected).abs() < 1e-4);
        assert!((Tone::for_mesh(&mesh).exposure() - expected).abs() < 1e-4);
    }
}

#[test]
fn false_colours_tell_the_value_of_what_is_seen() {
    use radiosity::render::false_colour;
    let mesh = square(1.0, 2, |_| Vec3::new(3.0, 2.0, 1.0));
    let view = look(&mesh, &head_on(20, 2.0), &RenderOptions::standard());
    // Irradiance is twice the radiosity in this mesh.
    let radiosity = view.false_colours(4.0, false, |radiosity, _| f64::from(radiosity.y));
    let irradiance = view.false_colours(16.0, false, |_, irradiance| f64::from(irradiance.x));
    assert_eq!(*radiosity.at(10, 8), false_colour(0.5));
    assert_eq!(*irradiance.at(10, 8), false_colour(0.375));
    assert_eq!(*radiosity.at(1, 1), [0; 3], "nothing is there");
    let meshed = view.false_colours(4.0, true, |radiosity, _| f64::from(radiosity.y));
    assert_ne!(
        meshed.at(10, 9),
        radiosity.at(10, 9),
        "a line between elements"
    );
    assert_eq!(meshed.at(7, 7), radiosity.at(7, 7), "inside of one");
}
