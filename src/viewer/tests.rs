//! The viewer without a window.

use super::keys::{Wish, wish};
use super::{Action, Exhibit, Fineness, Frame, Labels, Look, Quantity, Reading, Studio, Viewer};
use crate::output::write_ply;
use crate::radiometry::Spectrum;
use crate::render::{Picture, Place, RenderOptions, View};
use crate::scene::Camera;
use crate::solution::{LitMesh, LitTriangle, LitVertex};
use crate::visibility::{EngineChoice, Visibility, VisibilityError, build};
use glam::{DVec2, DVec3};
use std::sync::{Arc, mpsc};
use std::time::Duration;
use winit::keyboard::{Key, NamedKey};

/// A square of one element in the plane z = 0, a unit long, brighter to the right.
fn square() -> LitMesh {
    let places = [
        (0.0, 0.0),
        (-0.5, -0.5),
        (0.5, -0.5),
        (0.5, 0.5),
        (-0.5, 0.5),
    ];
    let vertex = |(position, (x, _)): (u32, (f64, f64))| LitVertex {
        position,
        normal: glam::Vec3::Z,
        irradiance: Spectrum::splat(2.0 + x as f32),
        radiosity: Spectrum::new(1.0, 0.5, 0.25) * (2.0 + x as f32) * 0.5,
    };
    LitMesh {
        positions: places.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec(),
        vertices: (0..).zip(places).map(vertex).collect(),
        triangles: (0..4)
            .map(|side| LitTriangle {
                vertices: [0, 1 + side, 1 + (side + 1) % 4],
                element: 0,
                polygon: 0,
                on_border: true,
            })
            .collect(),
    }
}

fn exhibit() -> Arc<Exhibit> {
    Arc::new(Exhibit::new(square(), Labels::default(), 179.0))
}

/// Looks at the middle of the square from a distance of 1; the picture is 1.2 wide there.
fn camera() -> Camera {
    Camera {
        name: "front".into(),
        eye: DVec3::Z,
        look_at: DVec3::ZERO,
        up: DVec3::Y,
        horizontal_fov: 2.0 * 0.6f64.atan().to_degrees(),
        width: 60,
        height: 40,
        exposure: None,
    }
}

fn viewer() -> Viewer {
    let other = Camera {
        name: "other".into(),
        eye: DVec3::new(1.0, 0.0, 2.0),
        exposure: Some(1.0),
        ..camera()
    };
    Viewer::new(vec![camera(), other], 0, 1.0)
}

fn tracer(triangles: crate::visibility::Triangles) -> Result<Box<dyn Visibility>, VisibilityError> {
    build(EngineChoice::BruteForce, &triangles, 1)
}

fn drawn(look: &Look, fineness: Fineness) -> Frame {
    let exhibit = exhibit();
    let place = Place::new(&exhibit.lit, look.camera.eye, tracer).expect("can be traced");
    let frame = look.draw(&exhibit, &place, fineness, &|| true);
    frame.expect("is wanted")
}

fn rendered(camera: &Camera) -> View {
    let options = RenderOptions::standard();
    View::new(&square(), camera, &options, tracer).expect("can be traced")
}

#[test]
fn a_full_frame_is_the_renderer_s_picture() {
    let mut viewer = viewer();
    let look = viewer.look();
    assert_eq!(look.camera, camera());
    let frame = drawn(&look, Fineness::Full);
    let picture = rendered(&camera());
    assert_eq!(frame.picture, picture.shaded());
    assert_eq!((frame.legend, frame.exposure), (None, picture.exposure()));
    viewer.act(Action::Elements);
    let frame = drawn(&viewer.look(), Fineness::Full);
    assert_eq!(frame.picture, picture.mesh());
    assert_ne!(frame.picture, picture.shaded());
    viewer.act(Action::Elements);
    assert_eq!(viewer.look(), look);
}

#[test]
fn the_eye_circles_turns_and_walks() {
    let mut viewer = viewer();
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-9, "{a} is not {b}");
    let eye = |viewer: &Viewer| viewer.look().camera.eye;
    // Half a window's width is a quarter of the way around.
    viewer.act(Action::Orbit(DVec2::new(-30.0, 0.0)));
    near(eye(&viewer), DVec3::X);
    near(viewer.look().camera.look_at, DVec3::ZERO);
    viewer.act(Action::Zoom(5.0));
    near(eye(&viewer), DVec3::X * 0.88f64.powi(5));
    viewer.act(Action::Zoom(1e9));
    assert!((1e-3 - 1e-9..0.01).contains(&eye(&viewer).length()));
    viewer.act(Action::Home);
    assert_eq!(viewer.look().camera, camera());
    viewer.act(Action::Walk(DVec3::new(1.0, 2.0, 10.0)));
    near(eye(&viewer), DVec3::new(0.02, 0.04, 0.8));
    near(viewer.look().camera.look_at, DVec3::new(0.02, 0.04, -0.2));
    viewer.act(Action::Home);
    viewer.act(Action::Turn(DVec2::new(60.0, 0.0)));
    // What is under the hand goes along to the right, so the head turns to the left.
    near(eye(&viewer), DVec3::Z);
    near(viewer.look().camera.look_at, DVec3::new(-1.0, 0.0, 1.0));
    viewer.act(Action::NextCamera);
    near(eye(&viewer), DVec3::new(1.0, 0.0, 2.0));
    assert_eq!(viewer.look().camera.exposure, Some(1.0));
    viewer.act(Action::NextCamera);
    assert_eq!(viewer.look().camera, camera());
}

#[test]
fn no_drag_turns_the_picture_over() {
    let mut viewer = viewer();
    for drag in [1e3, -1e5, 3.0, 7e4] {
        viewer.act(Action::Orbit(DVec2::new(11.0, drag)));
        viewer.act(Action::Turn(DVec2::new(-5.0, drag)));
        viewer.act(Action::Walk(DVec3::ONE));
        let camera = viewer.look().camera;
        let sight = camera.look_at - camera.eye;
        assert!(sight.is_finite() && (sight.length() - 1.0).abs() < 1e-6);
        assert!(sight.normalize().cross(DVec3::Y).length() > 0.01);
        assert_eq!(camera.up, DVec3::Y);
    }
}

#[test]
fn brighter_is_brighter_than_the_picture_before() {
    let mut viewer = viewer();
    let chosen = drawn(&viewer.look(), Fineness::Full).exposure;
    viewer.seen(chosen);
    viewer.act(Action::Expose(0.5));
    viewer.act(Action::Expose(0.5));
    assert_eq!(viewer.look().camera.exposure, Some(chosen + 1.0));
    let brighter = drawn(&viewer.look(), Fineness::Full);
    assert_eq!(brighter.exposure, chosen + 1.0);
    viewer.act(Action::AutoExpose);
    assert_eq!(viewer.look().camera.exposure, None);
}

#[test]
fn false_colours_have_a_legend_and_a_scale_that_can_be_shortened() {
    let mut viewer = viewer();
    viewer.act(Action::NextQuantity);
    let look = viewer.look();
    assert_eq!(look.quantity, Quantity::Illuminance);
    let frame = drawn(&look, Fineness::Full);
    // 179 lm/W * 2 W/m² of 500 lx.
    let middle = *frame.picture.at(30, 20);
    let expected = crate::render::false_colour(358.0 / 500.0);
    let off = middle.iter().zip(expected).map(|(a, b)| a.abs_diff(b));
    assert!(off.max() < Some(4), "{middle:?} is not {expected:?}");
    assert_eq!(*frame.picture.at(0, 0), [0; 3], "beside the square");
    assert_eq!(frame.legend, Some(crate::render::legend(500.0, "lx", 40)));
    viewer.act(Action::Expose(1.0));
    let shorter = drawn(&viewer.look(), Fineness::Full);
    assert_eq!(shorter.legend, Some(crate::render::legend(250.0, "lx", 40)));
    viewer.act(Action::NextQuantity);
    assert_eq!(viewer.look().quantity, Quantity::Radiosity);
    viewer.act(Action::NextQuantity);
    assert_eq!(
        viewer.look().camera.exposure,
        None,
        "exposure is of the light"
    );
}

#[test]
fn a_coarse_frame_fills_the_window_and_the_legend_lies_on_the_right() {
    let frame = Frame {
        picture: Picture {
            width: 2,
            height: 1,
            pixels: vec![[1, 2, 3], [4, 5, 6]],
        },
        legend: Some(Picture {
            width: 1,
            height: 2,
            pixels: vec![[9; 3]; 2],
        }),
        exposure: 0.0,
    };
    let mut window = vec![0; 16];
    frame.fill(&mut window, 4, 4);
    let (a, b, c) = (0x010203, 0x040506, 0x090909);
    let rows = [[a, a, b, b], [a, a, b, c], [a, a, b, c], [a, a, b, b]];
    assert_eq!(window, rows.concat());
    let mut tiny = vec![0; 1];
    frame.fill(&mut tiny, 1, 1);
    assert_eq!(tiny, [c]);
    let coarse = drawn(&viewer().look(), Fineness::Coarse(7));
    assert_eq!((coarse.picture.width, coarse.picture.height), (9, 6));
}

#[test]
fn a_click_reads_the_light_that_is_interpolated_there() {
    let look = viewer().look();
    let at = |x: f64, y: f64| {
        let reading = Reading::take(&exhibit(), &look, DVec2::new(x, y));
        reading.expect("can be traced")
    };
    // The picture is 1.2 wide, so 10 pixels are 0.2.
    let reading = at(40.0, 25.0).expect("hits the square");
    assert!(reading.sighting.point.distance(DVec3::new(0.2, -0.1, 0.0)) < 1e-6);
    assert!((reading.sighting.irradiance - Spectrum::splat(2.2)).length() < 1e-5);
    assert!((reading.illuminance - 179.0 * 2.2).abs() < 1e-2);
    let said = reading.to_string();
    let start =
        "393.8 lx, irradiance 2.200 2.200 2.200 W/m2, radiosity 1.100 0.5500 0.2750 W/m2 at 0.2";
    assert!(said.starts_with(start), "{said}");
    assert_eq!(at(1.0, 1.0), None);
}

#[test]
fn a_studio_ends_with_the_full_picture_of_the_last_look() {
    let (sender, frames) = mpsc::channel();
    let mut viewer = viewer();
    let shown = exhibit();
    let studio = Studio::new(
        EngineChoice::Obvhs,
        shown.clone(),
        viewer.look(),
        move |f| {
            let _ = sender.send(f);
        },
    );
    for _ in 0..5 {
        viewer.act(Action::Walk(DVec3::X));
        studio.ask(shown.clone(), viewer.look());
    }
    viewer.act(Action::Home);
    studio.ask(shown, viewer.look());
    let expected = rendered(&camera()).shaded();
    let next = || frames.recv_timeout(Duration::from_secs(30));
    let found = std::iter::from_fn(|| next().ok()).any(|frame| {
        let frame = frame.unwrap_or_else(|error| panic!("{error}"));
        frame.picture == expected
    });
    assert!(found, "the full picture is among those that are delivered");
    drop(studio);
    assert!(frames.try_iter().count() < 20, "and then there are no more");
    assert!(frames.recv().is_err(), "the thread has ended");
}

#[test]
fn keys_are_those_of_the_help() {
    let of = |text: &str| wish(&Key::Character(text.into()), false);
    assert_eq!(of("q"), Some(Wish::Quit));
    assert_eq!(wish(&Key::Named(NamedKey::Escape), false), Some(Wish::Quit));
    assert_eq!(of("F"), Some(Wish::Act(Action::NextQuantity)));
    assert_eq!(of("="), of("+"));
    assert_eq!(of("x"), None);
    let fast = wish(&Key::Character("W".into()), true);
    assert_eq!(fast, Some(Wish::Act(Action::Walk(DVec3::Z * 5.0))));
    let up = wish(&Key::Named(NamedKey::ArrowUp), false);
    assert_eq!(up, of("w"));
}

#[test]
fn a_ply_file_holds_the_light_and_damaged_ones_are_refused() {
    let folder = tempfile::tempdir().expect("can be made");
    let path = folder.path().join("solution.ply");
    let mesh = square();
    write_ply(&path, &mesh, Some(&[0.5; 4]), |_| [1, 2, 3]).expect("can be written");
    let read = super::read_ply(&path).expect("was just written");
    assert_eq!(
        (&read.positions, &read.vertices),
        (&mesh.positions, &mesh.vertices)
    );
    let corners = |of: &LitMesh| of.triangles.iter().map(|t| t.vertices).collect::<Vec<_>>();
    assert_eq!(corners(&read), corners(&mesh));
    let bytes = std::fs::read(&path).expect("was just written");
    let refused = |bytes: &[u8], words: &str| {
        std::fs::write(&path, bytes).expect("can be written");
        let error = super::read_ply(&path).expect_err("is damaged").to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(&bytes[..bytes.len() - 1], "cut short");
    refused(&bytes[..40], "no end of a header");
    let text = String::from_utf8_lossy(&bytes[..200]).replace("1.0\n", "2.0\n");
    refused(text.as_bytes(), "line 2: `format binary_little_endian 2.0`");
    let mut wrong = bytes.clone();
    let last = wrong.len() - 8;
    wrong[last..last + 4].copy_from_slice(&99u32.to_le_bytes());
    refused(&wrong, "face 3 with 3 corners [0, 4, 99], of 5 vertices");
    for length in 0..bytes.len() {
        std::fs::write(&path, &bytes[..length]).expect("can be written");
        assert!(super::read_ply(&path).is_err(), "{length}");
    }
}
