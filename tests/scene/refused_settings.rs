//! Scene files that are refused, each with the whole message.

use super::Files;

/// The text follows the geometry, so its first line is line 2.
#[track_caller]
fn toml_is_refused(text: &str, message: &str) {
    let obj = "mtllib it.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let toml = format!("geometry = 'it.obj'\n{text}\n");
    let files = [
        ("it.obj", obj),
        ("it.mtl", "newmtl a\nKd .5 .5 .5\n"),
        ("scene.toml", toml.as_str()),
    ];
    assert_eq!(Files::new(&files).refusal(""), message);
}

#[track_caller]
fn camera_is_refused(text: &str, message: &str) {
    let defaults = [
        ("name", "'a'"),
        ("eye", "[0, 0, 5]"),
        ("look_at", "[0, 0, 0]"),
    ];
    let stated = |key: &str| {
        text.lines()
            .any(|line| line.starts_with(&format!("{key} =")))
    };
    let missing = defaults.iter().filter(|(key, _)| !stated(key));
    let camera: String = missing
        .map(|(key, value)| format!("{key} = {value}\n"))
        .collect();
    toml_is_refused(
        &format!("[[camera]]\n{text}\n{camera}"),
        &format!("scene.toml:2: found the camera {message}"),
    );
}

#[test]
fn the_geometry_of_a_scene_file() {
    let refusal = |toml: &str| Files::new(&[("scene.toml", toml), ("a.txt", "")]).refusal("");
    assert_eq!(
        refusal("name = 'x'"),
        "scene.toml: found no `geometry`; expected `geometry = \"FILE\"`, an .obj, .glb, .gltf or .ply file"
    );
    assert_eq!(
        refusal("\ngeometry = 'b.obj'"),
        "scene.toml:2: found the geometry `b.obj`, which does not exist; expected a file at b.obj"
    );
    let inside = "expected a relative path that stays in the scene's folder";
    for path in ["/etc/a.obj", "../a.obj", "a/../../a.obj"] {
        let toml = format!("geometry = '{path}'");
        assert_eq!(
            refusal(&toml),
            format!("scene.toml:1: found the geometry `{path}`; {inside}")
        );
    }
    assert_eq!(
        refusal("geometry = 'a.txt'"),
        "scene.toml:1: found the geometry `a.txt`; expected an .obj, .glb, .gltf or .ply file"
    );
}

#[test]
fn keys_of_a_scene_file() {
    toml_is_refused(
        "unti = 'm'",
        "scene.toml:2: found unknown field `unti`; expected one of `name`, `geometry`, `unit`, `metres_per_unit`, `up`, `point_light_radius`, `sides`, `material`, `camera`",
    );
    toml_is_refused(
        "\nname = 3",
        "scene.toml:3: found invalid type: integer `3`; expected a string",
    );
    toml_is_refused(
        "sides = 'back'",
        "scene.toml:2: found unknown variant `back`; expected one of `front`, `both`, `auto`",
    );
    toml_is_refused(
        "unit = 'furlong'",
        "scene.toml:2: found the unit `furlong`; expected \"m\", \"cm\", \"mm\", \"in\" or \"ft\"; or `metres_per_unit` instead",
    );
    for (length, said) in [
        ("0", "0.0"),
        ("-1", "-1.0"),
        ("nan", "NaN"),
        ("1e-13", "1e-13"),
        ("1e300", "1e300"),
        ("inf", "inf"),
    ] {
        let found = format!("scene.toml:2: found metres_per_unit = {said}");
        toml_is_refused(
            &format!("metres_per_unit = {length}"),
            &format!("{found}; expected 1e-12 to 1e12 metres"),
        );
    }
    toml_is_refused(
        "unit = 'm'\nmetres_per_unit = 1",
        "scene.toml:2: found both `unit` and `metres_per_unit`; expected one of them",
    );
}

#[test]
fn materials_of_a_scene_file() {
    let reflectance = "expected 0 <= reflectance <= 1 in each channel";
    toml_is_refused(
        "[material.a]\nreflectance = 1.5",
        &format!("scene.toml:3: found the reflectance (1.5, 1.5, 1.5) of `a`; {reflectance}"),
    );
    toml_is_refused(
        "[material.a]\nreflectance = [0.1, 0.2]",
        "scene.toml:3: found invalid length 2; expected a number or [r, g, b]",
    );
    toml_is_refused(
        "[material.a]\nreflectance = [0.1, 0.2, 0.3, 0.4]",
        "scene.toml:3: found invalid length 4; expected a number or [r, g, b]",
    );
    toml_is_refused(
        "[material.a]\nreflectance = 'red'",
        "scene.toml:3: found invalid type: string \"red\"; expected a number or [r, g, b]",
    );
    toml_is_refused(
        "[material.a]\nemitted_radiance = -1",
        "scene.toml:3: found the emitted radiance (-1, -1, -1) of `a`; expected 0 <= radiance <= 1e30 in each channel",
    );
    toml_is_refused(
        "[material.b]\nreflectance = 0",
        "scene.toml:2: found the material `b`; expected a material of the geometry: `a`",
    );
}

#[test]
fn cameras_of_a_scene_file() {
    camera_is_refused(
        "eye = [1, 2, 3]\nlook_at = [1, 2, 3]",
        "`a` with eye = look_at; expected an eye at some distance from what it looks at",
    );
    camera_is_refused(
        "up = [0, 0, -2]",
        "`a` with up = [0, 0, -2]; expected a direction other than that of sight",
    );
    camera_is_refused(
        "up = [0, 0, 0]",
        "`a` with up = [0, 0, 0]; expected a direction other than that of sight",
    );
    camera_is_refused(
        "look_at = [0, -5, 5]",
        "`a` with up = [0, 1, 0]; expected a direction other than that of sight",
    );
    camera_is_refused(
        "eye = [0, inf, 5]",
        "`a` with eye = [0, inf, 5]; expected finite coordinates",
    );
    for fov in ["0", "180", "-45", "NaN"] {
        let text = format!("horizontal_fov = {}", fov.to_lowercase());
        camera_is_refused(
            &text,
            &format!("`a` with horizontal_fov = {fov}; expected degrees between 0 and 180"),
        );
    }
    camera_is_refused(
        "width = 0",
        "`a` with width = 0; expected 1 to 16384 pixels",
    );
    camera_is_refused(
        "height = 16385",
        "`a` with height = 16385; expected 1 to 16384 pixels",
    );
    camera_is_refused(
        "height = -3",
        "`a` with height = -3; expected 1 to 16384 pixels",
    );
    camera_is_refused(
        "exposure = inf",
        "`a` with exposure = inf; expected a finite number of stops",
    );
    let (long, longest) = ("ä".repeat(128), "ä".repeat(127));
    for name in ["", "a/b", "..", "a:b", "report.json", "Mesh.PNG", &long] {
        let shown: String = name.chars().take(60).collect();
        let more = if name.chars().count() > 60 { "…" } else { "" };
        let expected =
            "one for a folder beside the results: no path, none of their names, 255 bytes at most";
        let message = format!("`{shown}{more}` with such a name; expected {expected}");
        camera_is_refused(&format!("name = '{name}'"), &message);
    }
    let camera = format!("[[camera]]\nname = '{longest}'\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n");
    let toml = format!("geometry = \"it.obj\"\n{camera}");
    let files = Files::new(&[
        ("scene.toml", toml.as_str()),
        ("it.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ]);
    assert_eq!(
        files.load("").expect("can be read").cameras[0].name,
        longest
    );
    let camera = "[[camera]]\nname = 'a'\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    toml_is_refused(
        &format!("{camera}{camera}"),
        "scene.toml:6: found the camera `a` with a second one of that name; expected names that differ",
    );
    toml_is_refused(
        "[[camera]]\nname = 'a'",
        "scene.toml:2: found missing field `eye`; expected TOML with the keys of a scene",
    );
}

#[test]
fn toml_that_is_none() {
    let files = Files::new(&[("scene.toml", "geometry = 'it.obj'\nname = = 3\n")]);
    let message = files.refusal("");
    assert!(message.starts_with("scene.toml:2: found "), "{message}");
}
