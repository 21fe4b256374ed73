//! The files: whole or absent, and reading back what was written.

mod atomic;
mod meshes;

use glam::{DVec3, Vec3};
use radiosity::output::{
    SummaryRow, summary_table, write_atomically, write_exr, write_ply, write_png,
};
use radiosity::solution::{LitMesh, LitTriangle, LitVertex};
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

type Outcome = Result<(), Box<dyn Error>>;

#[test]
fn an_atomic_file_appears_whole_and_replaces_the_old_one() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("result.txt");
    for content in ["first", "second"] {
        write_atomically(&path, |out| out.write_all(content.as_bytes()))?;
        assert_eq!(fs::read_to_string(&path)?, content);
    }
    assert_eq!(names_in(folder.path())?, ["result.txt"]);
    Ok(())
}

#[test]
fn a_failing_writer_leaves_the_old_file_and_nothing_else() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("result.txt");
    fs::write(&path, "old")?;
    let outcome: Result<(), _> = write_atomically(&path, |out| {
        out.write_all(&[b'x'; 100_000])?;
        Err(io::Error::other("the disk is full"))
    });
    let message = outcome.expect_err("the writer failed").to_string();
    assert!(
        message.contains("result.txt") && message.contains("the disk is full"),
        "{message}"
    );
    assert_eq!(fs::read_to_string(&path)?, "old");
    assert_eq!(names_in(folder.path())?, ["result.txt"]);
    Ok(())
}

#[test]
fn paths_that_cannot_be_files_are_errors_that_name_them() -> Outcome {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("file");
    fs::write(&file, "")?;
    fs::create_dir(folder.path().join("taken"))?;
    for path in [
        file.join("below"),
        folder.path().join("missing/file"),
        folder.path().join("taken"),
        "/".into(),
    ] {
        let error = write_atomically(&path, |out| out.write_all(b"x")).expect_err("no such place");
        assert_eq!(error.path, path);
        assert!(
            error
                .to_string()
                .starts_with(&format!("cannot write {}: ", path.display()))
        );
    }
    assert_eq!(names_in(folder.path())?, ["file", "taken"]);
    Ok(())
}

fn names_in(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = fs::read_dir(folder)?
        .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
        .collect::<io::Result<Vec<_>>>()?;
    names.sort();
    Ok(names)
}

/// A triangle whose every number differs.
fn small_mesh(origin: DVec3) -> LitMesh {
    let vertex = |i: u32| LitVertex {
        position: 2 - i,
        normal: Vec3::new(0.0, 0.6, 0.8),
        irradiance: Vec3::new(0.5, 0.25, 0.125) * (i + 1) as f32,
        radiosity: Vec3::new(10.0, 20.0, 30.0) + i as f32,
    };
    LitMesh {
        positions: [
            DVec3::ZERO,
            DVec3::new(1.0, 0.1, 0.0),
            DVec3::new(0.0, 1.0, 0.3),
        ]
        .map(|p| p + origin)
        .to_vec(),
        vertices: (0..3).map(vertex).collect(),
        triangles: vec![LitTriangle {
            vertices: [2, 0, 1],
            element: 0,
            polygon: 0,
            on_border: true,
        }],
    }
}

/// A PLY file, as much of it as this program writes.
struct Ply {
    comments: Vec<String>,
    properties: Vec<String>,
    vertices: Vec<Vec<f64>>,
    faces: Vec<Vec<u32>>,
    errors: Vec<f32>,
}

fn parse_ply(bytes: &[u8]) -> Result<Ply, Box<dyn Error>> {
    const END: &[u8] = b"end_header\n";
    let end = bytes
        .windows(END.len())
        .position(|window| window == END)
        .ok_or("no end of the header")?;
    let header = std::str::from_utf8(&bytes[..end])?;
    let mut body = bytes[end + END.len()..].iter().copied();
    let mut ply = Ply {
        comments: vec![],
        properties: vec![],
        vertices: vec![],
        faces: vec![],
        errors: vec![],
    };
    let (mut types, mut counts, mut errors) = (vec![], vec![], false);
    for line in header.lines() {
        match line.split(' ').collect::<Vec<_>>()[..] {
            ["ply"] | ["format", "binary_little_endian", "1.0"] => {}
            ["comment", ..] => ply.comments.push(line.into()),
            ["element", "vertex" | "face", count] => counts.push(count.parse::<usize>()?),
            ["property", "list", "uchar", "uint", "vertex_indices"] => {}
            ["property", "float", "irradiance_error"] => errors = true,
            ["property", kind, name] => {
                types.push(kind.to_owned());
                ply.properties.push(name.into());
            }
            _ => return Err(format!("unexpected line: {line}").into()),
        }
    }
    let mut take = |n: usize| body.by_ref().take(n).collect::<Vec<u8>>();
    for _ in 0..counts[0] {
        let mut vertex = vec![];
        for kind in &types {
            vertex.push(match kind.as_str() {
                "float" => f64::from(f32::from_le_bytes(take(4).as_slice().try_into()?)),
                "double" => f64::from_le_bytes(take(8).as_slice().try_into()?),
                "uchar" => f64::from(take(1)[0]),
                other => return Err(format!("unexpected type: {other}").into()),
            });
        }
        ply.vertices.push(vertex);
    }
    for _ in 0..counts[1] {
        let corners = take(1)[0];
        let face = (0..corners).map(|_| Ok(u32::from_le_bytes(take(4).as_slice().try_into()?)));
        ply.faces.push(face.collect::<Result<_, Box<dyn Error>>>()?);
        if errors {
            ply.errors
                .push(f32::from_le_bytes(take(4).as_slice().try_into()?));
        }
    }
    assert_eq!(body.next(), None, "nothing follows the last face");
    Ok(ply)
}

/// Writes the mesh, reads it back and compares every value; returns it for more.
fn round_trip(mesh: &LitMesh) -> Result<Ply, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("solution.ply");
    write_ply(&path, mesh, None, |vertex| {
        [vertex.radiosity.x as u8, 7, 255]
    })?;
    let ply = parse_ply(&fs::read(&path)?)?;
    let names = "x y z nx ny nz radiosity_r radiosity_g radiosity_b irradiance_r irradiance_g irradiance_b red green blue";
    assert_eq!(ply.properties.join(" "), names);
    assert_eq!(ply.vertices.len(), mesh.vertices.len());
    for (read, vertex) in ply.vertices.iter().zip(&mesh.vertices) {
        let rest = [vertex.normal, vertex.radiosity, vertex.irradiance]
            .map(|value| value.as_dvec3().to_array());
        assert_eq!(read[3..12], *rest.as_flattened());
        assert_eq!(
            read[12..],
            [f64::from(vertex.radiosity.x as u8), 7.0, 255.0]
        );
    }
    let faces: Vec<_> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.vertices.to_vec())
        .collect();
    assert_eq!(ply.faces, faces);
    Ok(ply)
}

/// A table that goes to a pipe or to `/dev/stdout` must not take the place of it.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_written_to_as_it_is_and_links_are_followed() -> Outcome {
    let folder = tempfile::tempdir()?;
    let [pipe, file, link] = ["pipe", "real.csv", "link.csv"].map(|name| folder.path().join(name));
    let made = std::process::Command::new("mkfifo").arg(&pipe).status()?;
    assert!(made.success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::read_to_string(pipe)
    });
    write_atomically(&pipe, |out| out.write_all(b"read"))?;
    assert_eq!(reader.join().expect("does not panic")?, "read");

    fs::write(&file, "before")?;
    std::os::unix::fs::symlink("real.csv", &link)?;
    write_atomically(&link, |out| out.write_all(b"after"))?;
    assert_eq!(fs::read_to_string(&file)?, "after");
    assert!(fs::symlink_metadata(&link)?.is_symlink());
    assert_eq!(fs::read_dir(folder.path())?.count(), 3);
    Ok(())
}

#[test]
fn ply_reads_back_the_same() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let ply = round_trip(&mesh)?;
    assert!(
        ply.comments
            .iter()
            .any(|line| line.contains("W/m^2") && line.contains("linear Rec. 709"))
    );
    for (read, vertex) in ply.vertices.iter().zip(&mesh.vertices) {
        let position = mesh.positions[vertex.position as usize];
        assert_eq!(read[..3], position.to_array().map(|x| f64::from(x as f32)));
    }
    Ok(())
}

#[test]
fn ply_far_from_the_origin_keeps_its_shape() -> Outcome {
    let mesh = small_mesh(DVec3::new(148_376.0, 1_234.0, -223_423.0));
    for (read, vertex) in round_trip(&mesh)?.vertices.iter().zip(&mesh.vertices) {
        assert_eq!(
            read[..3],
            mesh.positions[vertex.position as usize].to_array()
        );
    }
    Ok(())
}

#[test]
fn ply_carries_the_error_of_each_triangle() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let errors: Vec<f32> = (1..=mesh.triangles.len()).map(|i| 0.5 / i as f32).collect();
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("solution.ply");
    write_ply(&path, &mesh, Some(&errors), |_| [0; 3])?;
    let ply = parse_ply(&fs::read(&path)?)?;
    assert_eq!(ply.errors, errors);
    assert_eq!(ply.faces.len(), errors.len());
    Ok(())
}

#[test]
fn ply_of_nothing_is_valid() -> Outcome {
    let ply = round_trip(&LitMesh::default())?;
    assert!(ply.vertices.is_empty() && ply.faces.is_empty());
    Ok(())
}

#[test]
fn exr_reads_back_the_same_bits() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("picture.exr");
    let pixels: Vec<[f32; 4]> = (0..6)
        .map(|i| [i as f32 / 3.0, 1e-30, 12345.678, 0.5])
        .collect();
    write_exr(&path, 3, 2, &pixels)?;
    let picture = exr::prelude::read_first_rgba_layer_from_file(
        &path,
        |size, _| vec![[0.0; 4]; size.area()],
        |read: &mut Vec<[f32; 4]>, at, (r, g, b, a): (f32, f32, f32, f32)| {
            read[at.y() * 3 + at.x()] = [r, g, b, a]
        },
    )?;
    assert_eq!(picture.layer_data.channel_data.pixels, pixels);
    Ok(())
}

#[test]
fn png_reads_back_the_same_and_says_srgb() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("picture.png");
    let pixels: Vec<[u8; 3]> = (0..6).map(|i| [i, 10 * i, 255 - i]).collect();
    write_png(&path, 3, 2, &pixels)?;
    let mut reader = png::Decoder::new(io::BufReader::new(fs::File::open(&path)?)).read_info()?;
    assert!(reader.info().srgb.is_some());
    assert_eq!(reader.info().size(), (3, 2));
    let mut read = vec![0; 18];
    reader.next_frame(&mut read)?;
    assert_eq!(read, pixels.as_flattened());
    Ok(())
}

#[test]
fn pictures_of_the_wrong_size_are_refused() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("picture");
    for (width, height, pixels) in [(3, 2, 5), (0, 0, 0), (0, 7, 0), (u32::MAX, u32::MAX, 1)] {
        assert!(write_exr(&path, width, height, &vec![[0.0; 4]; pixels]).is_err());
        assert!(write_png(&path, width, height, &vec![[0; 3]; pixels]).is_err());
    }
    assert!(names_in(folder.path())?.is_empty());
    Ok(())
}

#[test]
fn the_table_is_aligned_for_any_width() {
    let row = |scene: &str, elements| SummaryRow {
        scene: scene.into(),
        input_patches: 1,
        shots: 2,
        quadtree_depth: 3,
        meshing_shots: 4,
        elements,
        seconds: 1234.5678,
    };
    let table = summary_table(&[row("Küche", 5), row("a much longer name", 12_345_678_901)]);
    let widths: Vec<_> = table.lines().map(|line| line.chars().count()).collect();
    assert_eq!(widths.len(), 4);
    assert!(widths.iter().all(|&width| width == widths[0]), "{table}");
    assert!(table.contains("1234.57"));
}
