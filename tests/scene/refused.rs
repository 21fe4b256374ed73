//! Geometry that is refused, each with the whole message: file, line, what was found, what was expected.

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

#[test]
fn paths_that_are_no_scene() {
    let files = Files::new(&[("it.stl", "ply"), ("empty/readme", "")]);
    assert_eq!(
        files.refusal("none.obj"),
        "none.obj: found no such file or folder; expected a folder with a scene.toml, a .toml, .obj, .glb, .gltf or .ply file"
    );
    assert_eq!(
        files.refusal("it.stl"),
        "it.stl: found a file of another kind; expected a folder with a scene.toml, a .toml, .obj, .glb, .gltf or .ply file"
    );
    assert_eq!(
        files.refusal("empty"),
        "empty: found a folder without scene.toml; expected a folder with one, a .toml, .obj, .glb, .gltf or .ply file"
    );
}

#[cfg(unix)]
#[test]
fn a_path_that_leads_nowhere_says_why() {
    let files = Files::new(&[("here", "")]);
    let link = files.0.path().join("round.obj");
    std::os::unix::fs::symlink(&link, &link).expect("can be made");
    let refusal = files.refusal("round.obj");
    let found =
        "round.obj: found what cannot be read (Too many levels of symbolic links (os error 40))";
    assert!(refusal.starts_with(found), "{refusal}");
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
    let finite = "expected a finite coordinate, at most 1e18";
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
    let reflectance = "expected 0 <= reflectance <= 1 in each channel";
    mtl_is_refused(
        "newmtl a\nKd 1 1 1.00001\n",
        &format!("it.mtl:2: found the reflectance (1, 1, 1.00001) of `a`; {reflectance}"),
    );
    mtl_is_refused(
        "newmtl a\n\nKd .1 -.2 .3\n",
        &format!("it.mtl:3: found the reflectance (0.1, -0.2, 0.3) of `a`; {reflectance}"),
    );
    mtl_is_refused(
        "newmtl a\nKd nan 0 0\n",
        &format!("it.mtl:2: found the reflectance (NaN, 0, 0) of `a`; {reflectance}"),
    );
    let radiance = "expected 0 <= radiance <= 1e30 in each channel";
    mtl_is_refused(
        "newmtl a\nKe 0 -1 0\n",
        &format!("it.mtl:2: found the emitted radiance (0, -1, 0) of `a`; {radiance}"),
    );
    mtl_is_refused(
        "newmtl a\nKe inf 0 0\n",
        &format!("it.mtl:2: found the emitted radiance (inf, 0, 0) of `a`; {radiance}"),
    );
    mtl_is_refused(
        "newmtl a\nKe 1 2e31 3\n",
        &format!(
            "it.mtl:2: found the emitted radiance (1, 20000000000000000000000000000000, 3) of `a`; {radiance}"
        ),
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
