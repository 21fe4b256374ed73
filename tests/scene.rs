//! What scenes load as, what is refused and how it is said.

use glam::{DVec3, Vec3};
use radiosity::scene::{Camera, Scene, Sides, Surface};
use std::path::Path;

fn bundled(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    Scene::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

mod bundled_scenes {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn have_the_polygons_of_table_1_whole() {
        let counts = [
            ("emission", 107),
            ("shadow", 55),
            ("huge", 20),
            ("secondary", 20),
            ("geometry", 30),
            ("cornell-box", 19),
        ];
        for (name, count) in counts {
            let scene = bundled(name);
            assert_eq!(scene.input_polygons, count, "{name}");
            assert_eq!(
                scene.surfaces.len(),
                count,
                "{name}: no polygon is split or dropped"
            );
            assert_eq!(scene.warnings, [""; 0], "{name}");
            assert!(
                scene.surfaces.iter().all(|s| s.sides == Sides::Front),
                "{name}"
            );
        }
    }

    #[test]
    fn have_triangles_only_at_the_ends_of_the_wedge() {
        for name in [
            "emission",
            "shadow",
            "huge",
            "secondary",
            "geometry",
            "cornell-box",
        ] {
            let expected = if name == "geometry" { 2 } else { 0 };
            assert_eq!(bundled(name).summary().triangles, expected, "{name}");
        }
    }
    #[test]
    fn emit_pi_l_a() {
        for name in [
            "emission",
            "shadow",
            "huge",
            "secondary",
            "geometry",
            "cornell-box",
        ] {
            let s = bundled(name).summary();
            println!(
                "{name} {:?} {:?} {:?}",
                s.emitted_power / PI,
                s.area,
                s.bounds
            );
        }
    }
}
