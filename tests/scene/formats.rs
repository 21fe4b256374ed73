//! Spellings of OBJ, MTL and TOML that mean the same, and what is warned of.

use super::{Files, obj};
use glam::{DVec3, Vec3};
use radiosity::scene::{Corners, Scene, Sides};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn with_material(mtl: &str) -> (Scene, Vec<String>) {
    let text = format!("mtllib it.mtl\n{SQUARE}usemtl a\nf 1 2 3 4\n");
    Files::new(&[("it.obj", text.as_str()), ("it.mtl", mtl)]).accepted("it.obj")
}

fn with_settings(toml: &str) -> (Scene, Vec<String>) {
    let text = format!("mtllib it.mtl\n{SQUARE}usemtl a\nf 1 2 3 4\n");
    let mtl = "newmtl a\nKd .1 .2 .3\n";
    let toml = format!("geometry = \"it.obj\"\n{toml}");
    Files::new(&[
        ("it.obj", text.as_str()),
        ("it.mtl", mtl),
        ("scene.toml", &toml),
    ])
    .accepted("")
}

#[test]
fn faces_may_be_written_in_many_ways() {
    let faces = [
        "f 1 2 3 4",
        "f 1/1 2/1 3/1 4/1",
        "f 1//1 2//1 3//1 4//1",
        "f 1/1/1 2/1/1 3/1/1 4/1/1",
        "f -4 -3 -2 -1",
        "f -4//-1 2 -2/1 4/",
        "  f\t1  2 3 4  # a square",
        "f 1 2 \\\n  3 \\\r\n 4",
    ];
    for face in faces {
        let (scene, _) = obj(&format!("{SQUARE}vt 0 0\nvn 0 0 1\n{face}\n"));
        assert_eq!(
            scene.surfaces[0].corners,
            Corners::Quad([0, 1, 2, 3]),
            "{face}"
        );
        assert_eq!(scene.normal(&scene.surfaces[0]), DVec3::Z, "{face}");
    }
}

#[test]
fn line_ends_and_byte_order_marks_do_not_matter() {
    let text = format!("\u{feff}# Comment\nmtllib it.mtl\n{SQUARE}usemtl a\nf 1 2 3 4\n");
    let mtl = "\u{feff}newmtl a\nKd .1 .2 .3\nKe 1 2 3\n";
    let toml = "\u{feff}name = 'Ende'\ngeometry = 'it.obj'\n";
    for end in ["\n", "\r\n", "\r"] {
        // TOML itself knows no lone CR.
        let toml = toml.replace('\n', if end == "\r" { "\n" } else { end });
        let files = [
            ("it.obj", text.replace('\n', end)),
            ("it.mtl", mtl.replace('\n', end)),
            ("scene.toml", toml),
        ];
        let (scene, warnings) = Files::new(&files).accepted("scene.toml");
        assert_eq!(warnings, [""; 0], "{end:?}");
        assert_eq!(scene.name, "Ende");
        assert_eq!(
            scene.materials[0].reflectance,
            Vec3::new(0.1, 0.2, 0.3),
            "{end:?}"
        );
        assert_eq!(
            scene.materials[0].emitted_radiance,
            Vec3::new(1.0, 2.0, 3.0),
            "{end:?}"
        );
    }
}

#[test]
fn names_may_hold_spaces_and_any_letters() {
    let text =
        format!("mtllib möbel & häuser.mtl\n{SQUARE}o Fußboden\nusemtl 壁 weiß #2\nf 1 2 3 4\n");
    let mtl = "newmtl 壁 weiß #2\nKd .5 .5 .5\n";
    let toml = "geometry = 'zimmer/größe.obj'\n[material.\"壁 weiß #2\"]\nreflectance = 0.25\n";
    let files = [
        ("zimmer/größe.obj", text.as_str()),
        ("zimmer/möbel & häuser.mtl", mtl),
        ("scene.toml", toml),
    ];
    let (scene, warnings) = Files::new(&files).accepted("");
    assert_eq!(warnings, [""; 0]);
    assert_eq!(
        (scene.name.as_str(), scene.materials[0].name.as_str()),
        ("größe", "壁 weiß #2")
    );
    assert_eq!(scene.materials[0].reflectance, Vec3::splat(0.25));
}

#[test]
fn one_line_may_name_several_libraries_and_folders_of_windows() {
    let text = format!("mtllib a.mtl lib\\b.mtl\n{SQUARE}usemtl b\nf 1 2 3\nusemtl a\nf 1 3 4\n");
    let files = [
        ("it.obj", text.as_str()),
        ("a.mtl", "newmtl a\nKd .1 .1 .1"),
        ("lib/b.mtl", "newmtl b\nKd .2 .2 .2"),
    ];
    // The second name is one of a single path as well, so it is looked for under both spellings.
    let (scene, warnings) = Files::new(&files).accepted("it.obj");
    assert_eq!(warnings, [""; 0]);
    let reflectance = |i: usize| {
        scene.materials[scene.surfaces[i].material as usize]
            .reflectance
            .x
    };
    assert_eq!((reflectance(0), reflectance(1)), (0.2, 0.1));
}

#[test]
fn comments_may_follow_names() {
    let text = format!(
        "mtllib my it.mtl # exported\n{SQUARE}g floor # a\nusemtl wood #2 # b\nf 1 2 3 4\n"
    );
    let mtl = "newmtl wood #2 # of oak\nKd .1 .2 .3\n";
    for library in ["my it.mtl # exported", "my it.mtl #exported", "my it.mtl"] {
        let text = text.replace("my it.mtl # exported", library);
        let files = [("it.obj", text.as_str()), ("my it.mtl", mtl)];
        let (scene, warnings) = Files::new(&files).accepted("it.obj");
        assert_eq!(warnings, [""; 0]);
        assert_eq!(scene.materials[0].name, "wood #2");
        assert_eq!(scene.materials[0].reflectance, Vec3::new(0.1, 0.2, 0.3));
    }
    // A file that is called so comes first.
    let text = text.replace("my it.mtl # exported", "it #2.mtl");
    let files = [
        ("it.obj", text.as_str()),
        ("it #2.mtl", mtl),
        ("it", "newmtl wood #2"),
    ];
    assert_eq!(Files::new(&files).accepted("it.obj").1, [""; 0]);
}

#[test]
fn every_way_to_be_transparent_is_counted_once_for_a_material() {
    for (lines, count) in [
        ("d 0.5", 1),
        ("d -halo 0.1", 1),
        ("Tr 0.9", 1),
        ("d 0.1\nTr 0.9", 1),
        ("d 1\nTr 1", 0),
        ("d -halo 1", 0),
        ("Tr 0", 0),
        ("d\nTr x", 0),
    ] {
        let (_, warnings) = with_material(&format!("newmtl a\nKd .5 .5 .5\n{lines}\n"));
        assert_eq!(warnings.len(), count, "{lines}: {warnings:?}");
    }
    let (_, warnings) = with_material("newmtl a\nKd .5\nTr .1\nnewmtl b\nKd .5\nd .2\n");
    let expected = "it.mtl:3: 2 transparent materials treated as opaque (first here)";
    assert_eq!(warnings, [expected]);
}

#[test]
fn a_face_may_come_before_its_vertices_and_use_before_the_library() {
    let text = format!("usemtl a\nf 1 2 3 4\n{SQUARE}mtllib it.mtl\n");
    let files = [
        ("it.obj", text.as_str()),
        ("it.mtl", "newmtl a\nKd .1 .1 .1"),
    ];
    let (scene, warnings) = Files::new(&files).accepted("it.obj");
    assert_eq!((scene.surfaces.len(), warnings.len()), (1, 0));
}

#[test]
fn positions_keep_all_digits_and_equal_ones_are_one_vertex() {
    let (scene, _) = obj(
        "v 0.1 123456.789012345 -0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 0 1 -1\nv 0 1 0\nv 1 0 0\nf 4 5 6\n",
    );
    assert_eq!(scene.vertices[0], DVec3::new(0.1, 123456.789012345, 0.0));
    assert!(scene.vertices[0].z.is_sign_positive());
    assert_eq!(scene.vertices.len(), 4);
    assert_eq!(scene.surfaces[1].corners, Corners::Triangle([3, 2, 1]));
}

#[test]
fn a_missing_colour_is_grey_with_a_warning() {
    let (scene, warnings) = with_material("newmtl a\nKs 1 1 1\n");
    assert_eq!(scene.materials[0].reflectance, Vec3::splat(0.5));
    assert_eq!(
        warnings,
        ["it.obj: 1 material without `Kd` given a grey of 0.5: `a`"]
    );
}

#[test]
fn missing_materials_are_grey_with_a_warning() {
    let text = format!("{SQUARE}f 1 2 3\nusemtl paint\nf 1 3 4\nf 1 2 4\n");
    let (scene, warnings) = obj(&text);
    let expected = [
        "it.obj:7: 2 polygons of material `paint`, which no .mtl file defines, given a grey of 0.5 (first here)",
        "it.obj:5: 1 polygon without a material, given a grey of 0.5",
    ];
    assert_eq!(warnings, expected);
    assert!(
        scene
            .materials
            .iter()
            .all(|material| material.reflectance == Vec3::splat(0.5))
    );

    // A scene file can give them a colour, and then nothing is amiss.
    let toml = "geometry = 'it.obj'\n[material]\ndefault = { reflectance = 0.1 }\npaint.reflectance = 0.2\n";
    let (scene, warnings) =
        Files::new(&[("it.obj", text.as_str()), ("scene.toml", toml)]).accepted("");
    assert_eq!(warnings, [""; 0]);
    let reflectance = |i: usize| {
        scene.materials[scene.surfaces[i].material as usize]
            .reflectance
            .x
    };
    assert_eq!((reflectance(0), reflectance(1)), (0.1, 0.2));
}

#[test]
fn what_the_program_cannot_show_is_counted() {
    let mtl =
        "newmtl a\nKd .5 .5 .5\nmap_Kd wood.png\nmap_Ke glow.png\nd 0.5\nnewmtl a\nKd .9 .9 .9\n";
    let (scene, warnings) = with_material(mtl);
    let expected = [
        "it.mtl:6: 1 material defined again: the first definition holds",
        "it.mtl:3: 2 textures ignored: a material has one colour (first here)",
        "it.mtl:5: 1 transparent material treated as opaque",
    ];
    assert_eq!(warnings, expected);
    assert_eq!(scene.materials[0].reflectance, Vec3::splat(0.5));

    let (_, warnings) = obj(&format!(
        "{SQUARE}curv 0 1 1 2\nusemtl default\nf 1 2 3 4\nsurf\n"
    ));
    assert_eq!(
        warnings[0],
        "it.obj:5: 2 lines of unknown kind skipped (first here)"
    );
}

#[test]
fn a_reflectance_of_one_is_lowered_with_a_warning() {
    let (scene, warnings) =
        with_material("newmtl a\nKd 1 .5 0\nnewmtl b\nKd .99999999 1.0000005 .9\n");
    assert_eq!(scene.materials[0].reflectance, Vec3::new(0.999, 0.5, 0.0));
    assert_eq!(scene.materials[1].reflectance, Vec3::new(0.999, 0.999, 0.9));
    let expected = "2 materials with a reflectance of 1 given 0.999 in that channel: `a`, `b`";
    assert_eq!(warnings, [format!("it.obj: {expected}")]);
}

#[test]
fn one_number_stands_for_three_channels() {
    let (scene, _) = with_material("newmtl a\nKd .25\nKe 2\n");
    assert_eq!(scene.materials[0].reflectance, Vec3::splat(0.25));
    assert_eq!(scene.materials[0].emitted_radiance, Vec3::splat(2.0));
}

#[test]
fn settings_override_materials() {
    let (scene, _) = with_settings(
        "[material.a]\nreflectance = [0.4, 0.5, 0.6]\nemitted_radiance = 3\nsides = 'both'",
    );
    assert_eq!(scene.materials[0].reflectance, Vec3::new(0.4, 0.5, 0.6));
    assert_eq!(scene.materials[0].emitted_radiance, Vec3::splat(3.0));
    assert_eq!(scene.surfaces[0].sides, Sides::Both);
    let (scene, _) = with_settings("sides = 'front'\n[material.a]\nemitted_radiance = [0, 0, 1.5]");
    assert_eq!(
        scene.materials[0].reflectance,
        Vec3::new(0.1, 0.2, 0.3),
        "what is not overridden stays"
    );
    assert_eq!(
        scene.materials[0].emitted_radiance,
        Vec3::new(0.0, 0.0, 1.5)
    );
    assert_eq!(scene.surfaces[0].sides, Sides::Front);
}

#[test]
fn units_have_lengths() {
    for (unit, metres) in [
        ("m", 1.0),
        ("cm", 0.01),
        ("mm", 0.001),
        ("in", 0.0254),
        ("ft", 0.3048),
    ] {
        let (scene, _) = with_settings(&format!("unit = '{unit}'"));
        assert_eq!(scene.metres_per_unit, metres);
        assert!(
            (scene.summary().area - metres * metres).abs() < 1e-15,
            "the square is 1 {unit} wide"
        );
    }
    assert_eq!(
        with_settings("metres_per_unit = 2.5").0.metres_per_unit,
        2.5
    );
    assert_eq!(with_settings("metres_per_unit = 3").0.metres_per_unit, 3.0);
    for extreme in ["1e-12", "1e12"] {
        let summary = with_settings(&format!("metres_per_unit = {extreme}")).0;
        assert!(summary.summary().area.is_normal());
    }
}

#[test]
fn cameras_have_defaults() {
    let (scene, _) =
        with_settings("[[camera]]\nname = 'a'\neye = [0, 0, 5]\nlook_at = [0, 0.5, 0]\n");
    let camera = &scene.cameras[0];
    assert_eq!(
        (camera.width, camera.height, camera.horizontal_fov),
        (1024, 768, 45.0)
    );
    assert_eq!((camera.up, camera.exposure), (DVec3::Y, None));
}

#[test]
fn without_cameras_one_sees_all_of_the_scene() {
    let (scene, _) = obj("v -3 7 0\nv 40 7 0\nv 40 9 -11\nf 1 2 3\n");
    let camera = &scene.cameras[0];
    assert_eq!((scene.cameras.len(), camera.name.as_str()), (1, "overview"));
    let forward = (camera.look_at - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let upwards = right.cross(forward);
    let half_width = (camera.horizontal_fov.to_radians() / 2.0).tan();
    let half_height = half_width * f64::from(camera.height) / f64::from(camera.width);
    for position in &scene.vertices {
        let offset = *position - camera.eye;
        let depth = offset.dot(forward);
        assert!(depth > 0.0);
        assert!(offset.dot(right).abs() <= half_width * depth);
        assert!(offset.dot(upwards).abs() <= half_height * depth);
    }
}

#[test]
fn a_scene_is_a_folder_a_toml_or_an_obj_file() {
    let text = format!("{SQUARE}f 1 2 3 4\n");
    let files = Files::new(&[
        ("Room.OBJ", text.as_str()),
        ("scene.toml", "geometry = './Room.OBJ'"),
        ("other.toml", "geometry = 'x/../Room.OBJ'\nname = 'other'"),
    ]);
    std::fs::create_dir(files.0.path().join("x")).expect("can be made");
    assert_eq!(files.accepted("").0.name, "Room");
    assert_eq!(files.accepted("other.toml").0.name, "other");
    let bare = files.accepted("Room.OBJ").0;
    assert_eq!((bare.name.as_str(), bare.metres_per_unit), ("Room", 1.0));
}
