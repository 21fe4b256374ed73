//! Files that are refused, each with the whole message: file, line, what was found, what was expected.

use super::Files;

/// Vertices and a polygon to be wrong after: lines 1 to 4.
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[track_caller]
fn obj_is_refused(text: &str, message: &str) {
    assert_eq!(Files::new(&[("it.obj", text)]).refusal("it.obj"), message);
}

/// The text follows a good triangle, so its first line is line 5.
#[track_caller]
fn obj_line_is_refused(text: &str, message: &str) {
    obj_is_refused(
        &format!("{TRIANGLE}{text}\n"),
        &format!("it.obj:5: {message}"),
    );
}

#[track_caller]
fn mtl_is_refused(text: &str, message: &str) {
    let obj = format!("mtllib it.mtl\nusemtl a\n{TRIANGLE}");
    assert_eq!(
        Files::new(&[("it.obj", obj.as_str()), ("it.mtl", text)]).refusal("it.obj"),
        message
    );
}

/// The text follows the geometry, so its first line is line 2.
#[track_caller]
fn toml_is_refused(text: &str, message: &str) {
    let obj = format!("mtllib it.mtl\nusemtl a\n{TRIANGLE}");
    let toml = format!("geometry = 'it.obj'\n{text}\n");
    let files = [
        ("it.obj", obj.as_str()),
        ("it.mtl", "newmtl a\nKd .5 .5 .5\n"),
        ("scene.toml", &toml),
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
fn paths_that_are_no_scene() {
    let files = Files::new(&[("it.ply", "ply"), ("empty/readme", "")]);
    assert_eq!(
        files.refusal("none.obj"),
        "none.obj: found no such file or folder; expected a folder with a scene.toml, a .toml or an .obj file"
    );
    assert_eq!(
        files.refusal("it.ply"),
        "it.ply: found a file of another kind; expected a folder with a scene.toml, a .toml or an .obj file"
    );
    assert_eq!(
        files.refusal("empty"),
        "empty: found a folder without scene.toml; expected a folder with one, a .toml or an .obj file"
    );
}

#[test]
fn text_that_is_not_utf8() {
    let files = Files::new(&[
        ("it.obj", b"v 0 0 0\r\n# caf\xE9\r\n".as_slice()),
        ("it.toml", b"\n\xFF".as_slice()),
    ]);
    assert_eq!(
        files.refusal("it.obj"),
        "it.obj:2: found the byte 0xE9; expected text in UTF-8"
    );
    assert_eq!(
        files.refusal("it.toml"),
        "it.toml:2: found the byte 0xFF; expected text in UTF-8"
    );
}

#[test]
fn coordinates() {
    let finite = "expected a finite coordinate, at most 1e60";
    obj_line_is_refused(
        "v 0 nan 0",
        &format!("found the coordinate `nan`; {finite}"),
    );
    obj_line_is_refused(
        "v 0 0 -inf",
        &format!("found the coordinate `-inf`; {finite}"),
    );
    obj_line_is_refused(
        "v 1e400 0 0",
        &format!("found the coordinate `1e400`; {finite}"),
    );
    obj_line_is_refused(
        "v 1e61 0 0",
        &format!("found the coordinate `1e61`; {finite}"),
    );
    obj_line_is_refused(
        "v 1 2",
        "found a vertex with 2 coordinates; expected `v x y z`",
    );
    obj_line_is_refused(
        "v 1 2 # 3",
        "found a vertex with 2 coordinates; expected `v x y z`",
    );
    obj_line_is_refused("v 1 0,5 2", "found `0,5`; expected a number");
    obj_line_is_refused("v 1 2 3 red", "found `red`; expected a number");
}

#[test]
fn indices() {
    obj_line_is_refused(
        "f 1 2 4",
        "found the vertex index 4; expected 1 to 3, or -3 to -1",
    );
    obj_line_is_refused(
        "f 0 1 2",
        "found the vertex index 0; expected 1 to 3, or -3 to -1",
    );
    obj_line_is_refused(
        "f 1 2 -4",
        "found the vertex index -4; expected 1 to 3, or -3 to -1",
    );
    let least = i64::MIN;
    obj_line_is_refused(
        &format!("f {least} 1 2"),
        &format!("found the vertex index {least}; expected 1 to 3, or -3 to -1"),
    );
    obj_is_refused(
        "f -1 -2 -3",
        "it.obj:1: found the vertex index -1; expected a vertex to refer to",
    );
    obj_is_refused(
        "f 1 2 3",
        "it.obj:1: found the vertex index 3; expected a vertex to refer to",
    );
    let forms = "expected a corner `v`, `v/vt`, `v//vn` or `v/vt/vn` of whole numbers";
    for corner in ["1.5", "x", "/1", "1/2/3/4", "1/x", "99999999999999999999"] {
        obj_line_is_refused(
            &format!("f {corner} 2 3"),
            &format!("found `{corner}`; {forms}"),
        );
    }
}

#[test]
fn polygons() {
    obj_line_is_refused(
        "f 1 2",
        "found a polygon with 2 corners; expected 3 to 4096 corners",
    );
    obj_line_is_refused(
        "f",
        "found a polygon with 0 corners; expected 3 to 4096 corners",
    );
    let many = format!("f{}", " 1 2".repeat(2049));
    obj_line_is_refused(
        &many,
        "found a polygon with 4098 corners; expected 3 to 4096 corners",
    );
    obj_is_refused(
        "# empty\n",
        "it.obj: found no polygons; expected at least one polygon with an area",
    );
    obj_is_refused(
        "",
        "it.obj: found no polygons; expected at least one polygon with an area",
    );
    obj_is_refused(
        "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\nf 1 1 2\n",
        "it.obj: found 2 polygons, none of which can be used; expected at least one polygon with an area",
    );
}

#[test]
fn names_in_obj_files() {
    obj_line_is_refused(
        "usemtl",
        "found `usemtl` without a name; expected the name of a material",
    );
    obj_line_is_refused(
        "mtllib  ",
        "found `mtllib` without a name; expected the path of an .mtl file",
    );
    let files = Files::new(&[("it.obj", "\nmtllib no such.mtl\n")]);
    assert_eq!(
        files.refusal("it.obj"),
        "it.obj:2: found `mtllib no such.mtl`, a file that does not exist; expected an .mtl file of that name in FOLDER"
    );
    let files = Files::new(&[("it.obj", "mtllib a.mtl b.mtl\n"), ("a.mtl", "")]);
    assert_eq!(
        files.refusal("it.obj"),
        "it.obj:1: found `mtllib b.mtl`, a file that does not exist; expected an .mtl file of that name in FOLDER"
    );
}

#[test]
fn material_libraries() {
    let reflectance = "expected 0 <= reflectance < 1 in each channel";
    mtl_is_refused(
        "newmtl a\nKd 1 1 1\n",
        &format!("it.mtl:2: found the reflectance (1, 1, 1) of `a`; {reflectance}"),
    );
    mtl_is_refused(
        "newmtl a\n\nKd .1 -.2 .3\n",
        &format!("it.mtl:3: found the reflectance (0.1, -0.2, 0.3) of `a`; {reflectance}"),
    );
    mtl_is_refused(
        "newmtl a\nKd nan 0 0\n",
        &format!("it.mtl:2: found the reflectance (NaN, 0, 0) of `a`; {reflectance}"),
    );
    let almost = "newmtl a\nKd 0.99999999 0 0\n";
    mtl_is_refused(
        almost,
        &format!("it.mtl:2: found the reflectance (0.99999999, 0, 0) of `a`; {reflectance}"),
    );
    let radiance = "expected a finite radiance >= 0 in each channel";
    mtl_is_refused(
        "newmtl a\nKe 0 -1 0\n",
        &format!("it.mtl:2: found the emitted radiance (0, -1, 0) of `a`; {radiance}"),
    );
    mtl_is_refused(
        "newmtl a\nKe inf 0 0\n",
        &format!("it.mtl:2: found the emitted radiance (inf, 0, 0) of `a`; {radiance}"),
    );
    mtl_is_refused(
        "newmtl a\nKd .1 .2\n",
        "it.mtl:2: found `Kd` with 2 numbers; expected `Kd r g b`",
    );
    mtl_is_refused(
        "newmtl a\nKe\n",
        "it.mtl:2: found `Ke` with 0 numbers; expected `Ke r g b`",
    );
    mtl_is_refused(
        "newmtl a\nKd spectral x.rfl\n",
        "it.mtl:2: found `Kd` with `spectral`; expected `Kd r g b`",
    );
    mtl_is_refused(
        "Kd .1 .2 .3\n",
        "it.mtl:1: found `Kd` before any material; expected `newmtl NAME` first",
    );
    mtl_is_refused(
        "newmtl \n",
        "it.mtl:1: found `newmtl` without a name; expected the name of a material",
    );
}

#[test]
fn the_geometry_of_a_scene_file() {
    let refusal = |toml: &str| Files::new(&[("scene.toml", toml), ("a.txt", "")]).refusal("");
    assert_eq!(
        refusal("name = 'x'"),
        "scene.toml: found no `geometry`; expected `geometry = \"FILE.obj\"`"
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
        "scene.toml:1: found the geometry `a.txt`; expected an .obj file"
    );
}

#[test]
fn keys_of_a_scene_file() {
    toml_is_refused(
        "unti = 'm'",
        "scene.toml:2: found unknown field `unti`; expected one of `name`, `geometry`, `unit`, `metres_per_unit`, `sides`, `material`, `camera`",
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
    toml_is_refused(
        "metres_per_unit = 0",
        "scene.toml:2: found metres_per_unit = 0; expected a positive, finite number",
    );
    toml_is_refused(
        "metres_per_unit = nan",
        "scene.toml:2: found metres_per_unit = NaN; expected a positive, finite number",
    );
    toml_is_refused(
        "unit = 'm'\nmetres_per_unit = 1",
        "scene.toml:2: found both `unit` and `metres_per_unit`; expected one of them",
    );
}

#[test]
fn materials_of_a_scene_file() {
    let reflectance = "expected 0 <= reflectance < 1 in each channel";
    toml_is_refused(
        "[material.a]\nreflectance = 1.0",
        &format!("scene.toml:3: found the reflectance (1, 1, 1) of `a`; {reflectance}"),
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
        "scene.toml:3: found the emitted radiance (-1, -1, -1) of `a`; expected a finite radiance >= 0 in each channel",
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
    for name in ["", "a/b", "..", "a:b"] {
        let message =
            format!("`{name}` with such a name; expected a name that can be part of a file's");
        camera_is_refused(&format!("name = '{name}'"), &message);
    }
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
