//! glTF, VTK and OBJ files, read back by parsers that are not ours.

use super::{Outcome, small_mesh};
use glam::{DVec3, Vec3};
use radiosity::output::{GlbFacts, VtuFacts, write_glb, write_obj, write_vtu};
use radiosity::radiometry::{WHITE_EFFICACY, photometric};
use radiosity::scene::{Camera, Names};
use radiosity::solution::LitMesh;
use std::error::Error;
use std::fs;

/// A camera that looks down the x axis.
fn camera() -> Camera {
    Camera {
        name: "along x".into(),
        eye: DVec3::new(-100.0, 50.0, 0.0),
        look_at: DVec3::new(0.0, 50.0, 0.0),
        up: DVec3::Y,
        horizontal_fov: 90.0,
        width: 200,
        height: 100,
        exposure: None,
    }
}

/// The bytes of a `.glb` in centimetres.
fn glb(mesh: &LitMesh, cameras: &[Camera]) -> Result<Vec<u8>, Box<dyn Error>> {
    glb_of_sides(mesh, cameras, &[])
}

fn glb_of_sides(
    mesh: &LitMesh,
    cameras: &[Camera],
    two_sided: &[bool],
) -> Result<Vec<u8>, Box<dyn Error>> {
    glb_of_objects(mesh, cameras, two_sided, &Names::default())
}

fn glb_of_objects(
    mesh: &LitMesh,
    cameras: &[Camera],
    two_sided: &[bool],
    names: &Names,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("solution.glb");
    let facts = GlbFacts {
        name: "a \"quoted\" name",
        metres_per_unit: 0.01,
        cameras,
        names,
        exposure: 1.5,
        two_sided,
    };
    write_glb(&path, mesh, &facts, |vertex| {
        Vec3::new(vertex.radiosity.x / 20.0, 0.5, 7.0)
    })?;
    Ok(fs::read(path)?)
}

#[test]
fn glb_reads_back_the_same() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let read = gltf::Gltf::from_slice(&glb(&mesh, &[])?)?;
    let blob = read.blob.as_deref().ok_or("no binary part")?;
    let shape = read.meshes().next().ok_or("no mesh")?;
    let primitive = shape.primitives().next().ok_or("no primitive")?;
    let reader = primitive.reader(|_| Some(blob));
    let corners: Vec<u32> = reader.read_indices().ok_or("indices")?.into_u32().collect();
    assert_eq!(corners, mesh.triangles[0].vertices);
    let positions: Vec<_> = reader.read_positions().ok_or("positions")?.collect();
    let normals: Vec<_> = reader.read_normals().ok_or("normals")?.collect();
    let colours: Vec<_> = reader
        .read_colors(0)
        .ok_or("colours")?
        .into_rgba_f32()
        .collect();
    for (number, vertex) in mesh.vertices.iter().enumerate() {
        let place = 0.01 * mesh.positions[vertex.position as usize];
        assert_eq!(positions[number], place.as_vec3().to_array());
        assert_eq!(normals[number], vertex.normal.to_array());
        let seen = [vertex.radiosity.x / 20.0, 0.5, 1.0, 1.0];
        for (read, wanted) in colours[number].iter().zip(seen) {
            assert!((read - wanted).abs() < 1e-5, "{colours:?}");
        }
    }
    Ok(())
}

/// Three floats a vertex, from the attribute of that name.
fn light(read: &gltf::Gltf, name: &str) -> Option<Vec<[f32; 3]>> {
    let primitive = read.meshes().next()?.primitives().next()?;
    let extra = gltf::Semantic::Extras(name.trim_start_matches('_').into());
    let (blob, accessor) = (read.blob.as_deref()?, primitive.get(&extra)?);
    let items = gltf::accessor::Iter::<[f32; 3]>::new(accessor, |_| Some(blob))?;
    Some(items.collect())
}

#[test]
fn glb_keeps_the_light_and_says_what_it_is() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let bytes = glb(&mesh, &[])?;
    let read = gltf::Gltf::from_slice(&bytes)?;
    for (number, vertex) in mesh.vertices.iter().enumerate() {
        let radiosity = light(&read, "_RADIOSITY").ok_or("no radiosity")?;
        let irradiance = light(&read, "_IRRADIANCE").ok_or("no irradiance")?;
        assert_eq!(radiosity[number], vertex.radiosity.to_array());
        assert_eq!(irradiance[number], vertex.irradiance.to_array());
    }
    let length = u32::from_le_bytes(bytes[12..16].try_into()?) as usize;
    let document: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length])?;
    let extras = &document["meshes"][0]["extras"];
    assert_eq!(extras["_RADIOSITY"]["unit"], "W/m^2");
    assert_eq!(extras["COLOR_0"]["exposure_stops"], 1.5);
    assert_eq!(document["meshes"][0]["name"], "a \"quoted\" name");
    let unlit = &document["materials"][0]["extensions"]["KHR_materials_unlit"];
    assert!(unlit.is_object());
    Ok(())
}

#[test]
fn glb_has_a_node_for_each_object() -> Outcome {
    let mut mesh = small_mesh(DVec3::ZERO);
    let first = mesh.triangles[0];
    for polygon in [2, 1, 0] {
        let mut triangle = first;
        triangle.polygon = polygon;
        triangle.vertices.rotate_left(polygon as usize);
        mesh.triangles.push(triangle);
    }
    let names = Names {
        groups: vec!["wall".into(), "floor".into()],
        group_of: vec![Some(1), None, Some(0)],
        ..Names::default()
    };
    let bytes = glb_of_objects(&mesh, &[camera()], &[], &names)?;
    let read = gltf::Gltf::from_slice(&bytes)?;
    let blob = read.blob.as_deref();
    let mut found = Vec::new();
    for node in read.nodes().filter(|node| node.camera().is_none()) {
        let shape = node.mesh().ok_or("no mesh")?;
        assert_eq!(node.name(), shape.name());
        let primitive = shape.primitives().next().ok_or("no primitive")?;
        let corners = primitive.reader(|_| blob).read_indices();
        let corners: Vec<u32> = corners.ok_or("indices")?.into_u32().collect();
        found.push((node.name().unwrap_or_default().to_owned(), corners));
    }
    let corners = |numbers: &[usize]| -> Vec<u32> {
        let triangles = numbers.iter().map(|n| mesh.triangles[*n].vertices);
        triangles.flatten().collect()
    };
    let expected = [
        ("floor", corners(&[0, 3])),
        ("wall", corners(&[1])),
        ("a \"quoted\" name", corners(&[2])),
    ];
    assert_eq!(
        found,
        expected.map(|(name, corners)| (name.to_owned(), corners))
    );
    assert_eq!(read.nodes().count(), 4);
    Ok(())
}

#[test]
fn glb_far_from_the_origin_keeps_its_shape() -> Outcome {
    let origin = DVec3::new(148_376.0, 1_234.0, -223_423.0);
    let mesh = small_mesh(origin);
    let read = gltf::Gltf::from_slice(&glb(&mesh, &[])?)?;
    let node = read.nodes().next().ok_or("no node")?;
    let moved = DVec3::from(node.transform().decomposed().0.map(f64::from));
    assert!(moved.distance(0.01 * origin) < 1.0, "{moved}");
    let primitive = read.meshes().next().and_then(|m| m.primitives().next());
    let primitive = primitive.ok_or("no primitive")?;
    let blob = read.blob.as_deref();
    let positions = primitive.reader(|_| blob).read_positions();
    let positions: Vec<Vec3> = positions.ok_or("no positions")?.map(Vec3::from).collect();
    for pair in [[0, 1], [1, 2], [2, 0]] {
        let place = |i: usize| mesh.positions[mesh.vertices[i].position as usize];
        let side = 0.01 * (place(pair[0]) - place(pair[1]));
        let read = (positions[pair[0]] - positions[pair[1]]).as_dvec3();
        assert!(read.distance(side) < 1e-7, "{read} for {side}");
    }
    Ok(())
}

#[test]
fn glb_keeps_the_sides_of_a_sheet_apart() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let positions = |bytes: &[u8]| -> Result<Vec<Vec3>, Box<dyn Error>> {
        let read = gltf::Gltf::from_slice(bytes)?;
        let primitive = read.meshes().next().and_then(|m| m.primitives().next());
        let blob = read.blob.as_deref();
        let primitive = primitive.ok_or("no primitive")?;
        let positions = primitive.reader(|_| blob).read_positions();
        Ok(positions.ok_or("no positions")?.map(Vec3::from).collect())
    };
    let plain = positions(&glb(&mesh, &[])?)?;
    let apart = positions(&glb_of_sides(&mesh, &[], &[false, true, false])?)?;
    assert_eq!((plain[0], plain[2]), (apart[0], apart[2]));
    // The mesh is 1 unit of 1 cm wide.
    let moved = 1e-5 * 0.01 * mesh.vertices[1].normal;
    assert!(
        (apart[1] - plain[1]).distance(moved) < 1e-9,
        "{}",
        apart[1] - plain[1]
    );
    Ok(())
}

#[test]
fn glb_cameras_look_where_they_should() -> Outcome {
    let read = gltf::Gltf::from_slice(&glb(&small_mesh(DVec3::ZERO), &[camera()])?)?;
    let node = read.nodes().find(|node| node.camera().is_some());
    let matrix = node.ok_or("no camera")?.transform().matrix();
    let wanted = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0, 0.0],
        [-1.0, 0.5, 0.0, 1.0],
    ];
    assert_eq!(matrix, wanted, "right is +z, forward is +x, in metres");
    match read.cameras().next().ok_or("no camera")?.projection() {
        gltf::camera::Projection::Perspective(lens) => {
            assert_eq!(lens.aspect_ratio(), Some(2.0));
            assert!((lens.yfov() - 2.0 * 0.5f32.atan()).abs() < 1e-6);
        }
        gltf::camera::Projection::Orthographic(_) => return Err("orthographic".into()),
    }
    Ok(())
}

#[test]
fn glb_of_nothing_is_valid() -> Outcome {
    let read = gltf::Gltf::from_slice(&glb(&LitMesh::default(), &[])?)?;
    assert_eq!((read.meshes().count(), read.nodes().count()), (0, 1));
    Ok(())
}

/// A `.vtu`: its XML without the binary part, and that part.
struct Vtu {
    text: String,
    data: Vec<u8>,
}

impl Vtu {
    fn of(mesh: &LitMesh, facts: &VtuFacts) -> Result<Self, Box<dyn Error>> {
        const START: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
        const END: &[u8] = b"\n  </AppendedData>\n</VTKFile>\n";
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("solution.vtu");
        write_vtu(&path, mesh, facts)?;
        let bytes = fs::read(path)?;
        let start = bytes.windows(START.len()).position(|w| w == START);
        let (header, rest) = bytes.split_at(start.ok_or("no data")? + START.len());
        let data = rest.strip_suffix(END).ok_or("no end")?.to_vec();
        let text = [header, END].concat();
        Ok(Self {
            text: String::from_utf8(text)?,
            data,
        })
    }

    /// The bytes of the array of that name, with its type.
    fn array(&self, name: &str) -> Result<(String, &[u8]), Box<dyn Error>> {
        let document = roxmltree::Document::parse(&self.text)?;
        let mut nodes = document.descendants();
        let node = nodes.find(|node| node.attribute("Name") == Some(name));
        let node = node.ok_or_else(|| format!("no {name}"))?;
        let at: usize = node.attribute("offset").ok_or("no offset")?.parse()?;
        let (length, rest) = self.data[at..].split_at(8);
        let length = u64::from_le_bytes(length.try_into()?) as usize;
        let kind = node.attribute("type").ok_or("no type")?.to_owned();
        Ok((kind, &rest[..length]))
    }

    fn floats(&self, name: &str) -> Result<Vec<f32>, Box<dyn Error>> {
        let (kind, bytes) = self.array(name)?;
        assert_eq!(kind, "Float32", "{name}");
        let numbers = bytes.as_chunks::<4>().0.iter();
        Ok(numbers.map(|number| f32::from_le_bytes(*number)).collect())
    }
}

#[test]
fn vtu_reads_back_the_same() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let facts = VtuFacts {
        metres_per_unit: 2.0,
        efficacy: WHITE_EFFICACY,
        levels: &[3],
        errors: Some(&[0.25]),
    };
    let vtu = Vtu::of(&mesh, &facts)?;
    let flat = |of: &dyn Fn(usize) -> Vec3| -> Vec<f32> {
        (0..3).flat_map(|i| of(i).to_array()).collect()
    };
    let place = |i: usize| mesh.positions[mesh.vertices[i].position as usize];
    let positions = flat(&|i| (2.0 * place(i)).as_vec3());
    assert_eq!(vtu.floats("position")?, positions);
    let radiosity = flat(&|i| mesh.vertices[i].radiosity);
    assert_eq!(vtu.floats("radiosity (W/m2)")?, radiosity);
    let irradiance = flat(&|i| mesh.vertices[i].irradiance);
    assert_eq!(vtu.floats("irradiance (W/m2)")?, irradiance);
    let normals = flat(&|i| mesh.vertices[i].normal);
    assert_eq!(vtu.floats("normal")?, normals);
    let lux = mesh.vertices.iter();
    let lux: Vec<f32> = lux
        .map(|v| photometric(v.irradiance, 179.0) as f32)
        .collect();
    assert_eq!(vtu.floats("illuminance (lx)")?, lux);
    assert_eq!(vtu.floats("irradiance error (W/m2)")?, [0.25]);
    assert_eq!(vtu.array("element level")?.1, [3]);
    assert_eq!(vtu.array("types")?.1, [5]);
    assert_eq!(vtu.array("offsets")?.1, 3u64.to_le_bytes());
    let corners = mesh.triangles[0].vertices.map(u32::to_le_bytes);
    assert_eq!(vtu.array("connectivity")?.1, corners.as_flattened());
    assert!(
        vtu.text
            .contains("<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">")
    );
    Ok(())
}

#[test]
fn vtu_far_from_the_origin_is_in_double_precision_and_may_lack_errors() -> Outcome {
    let mesh = small_mesh(DVec3::new(148_376.0, 1_234.0, -223_423.0));
    let facts = VtuFacts {
        metres_per_unit: 1.0,
        efficacy: 1.0,
        levels: &[0],
        errors: None,
    };
    let vtu = Vtu::of(&mesh, &facts)?;
    let (kind, bytes) = vtu.array("position")?;
    assert_eq!((kind.as_str(), bytes.len()), ("Float64", 3 * 24));
    let first = mesh.positions[mesh.vertices[0].position as usize];
    assert_eq!(bytes[..8], first.x.to_le_bytes());
    assert!(vtu.array("irradiance error (W/m2)").is_err());
    Ok(())
}

#[test]
fn obj_reads_back_the_same() -> Outcome {
    let mesh = small_mesh(DVec3::ZERO);
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("solution.obj");
    write_obj(&path, &mesh, |vertex| vertex.radiosity / 100.0)?;
    let (models, _) = tobj::load_obj(&path, &tobj::LoadOptions::default())?;
    let read = &models[0].mesh;
    assert_eq!((models.len(), read.indices.as_slice()), (1, &[0, 1, 2][..]));
    // tobj numbers vertices as faces name them.
    for (i, vertex) in mesh.triangles[0].vertices.iter().enumerate() {
        let vertex = mesh.vertices[*vertex as usize];
        let place = mesh.positions[vertex.position as usize];
        assert_eq!(read.positions[3 * i..3 * i + 3], place.to_array());
        for channel in 0..3 {
            let (colour, normal) = (
                read.vertex_color[3 * i + channel],
                read.normals[3 * i + channel],
            );
            assert!((colour - f64::from(vertex.radiosity[channel]) / 100.0).abs() < 1e-4);
            assert!((normal - f64::from(vertex.normal[channel])).abs() < 1e-5);
        }
    }
    Ok(())
}
