//! What a solution file may hold: whatever is wrong with it is found when it is read, or before it is written.

use super::common::sessions::Batches;
use super::resume::{HEADER, settings};
use super::{bundled, draft, file};
use radiosity::mesh::{Element, Lattice, Mesh, Vertex};
use radiosity::scene::{Camera, Scene};
use radiosity::solution::Solution;
use radiosity::solver::Silent;
use radiosity::visibility::EngineChoice;
use radiosity::{Run, solve};
use std::io::Cursor;

/// A checksum that holds does not make the contents sound: whatever is wrong with them is found before they are used.
#[test]
fn a_file_whose_parts_do_not_fit_each_other_is_refused() {
    let scene = bundled("geometry");
    let how = settings(draft(), EngineChoice::Obvhs, 1);
    let mut run = Run::new(scene, how).expect("can be solved");
    run.go(&mut Batches(4)).expect("can be solved");
    let whole = run.finish();
    assert!(Solution::decode(&file(&whole)).is_ok());
    let refused = |spoil: &dyn Fn(&mut Solution), words: &str| {
        let mut spoilt = whole.clone();
        spoil(&mut spoilt);
        let error = Solution::decode(&file(&spoilt)).expect_err(words);
        assert!(error.contains(words), "{error}");
    };
    refused(&|s| s.mesh.buried.truncate(1), "buried");
    refused(&|s| s.light.irradiance.truncate(1), "does not fit the mesh");
    refused(&|s| s.light.exitance_unshot.truncate(1), "exitance");
    refused(&|s| s.light.unshot[0].x = f32::INFINITY, "no number");
    let scene = |s: &mut Solution, spoil: &dyn Fn(&mut Scene)| {
        spoil(&mut s.continuation.as_mut().expect("is kept").scene);
    };
    refused(&|s| scene(s, &|of| of.vertices.truncate(2)), "a surface");
    refused(&|s| scene(s, &|of| of.surfaces.truncate(1)), "no surface");
    refused(&|s| scene(s, &|of| of.vertices[0].y = f64::NAN), "nowhere");
}

/// `render` writes pictures under the names of cameras, so one with a folder in it could be written anywhere.
#[test]
fn a_file_with_a_camera_or_a_unit_that_no_scene_may_have_is_refused() {
    let whole = solve(
        &bundled("geometry"),
        &settings(draft(), EngineChoice::Obvhs, 1),
        &mut Silent,
    );
    let whole = whole.expect("can be solved");
    let refused = |spoil: &dyn Fn(&mut Solution), words: &str| {
        let mut spoilt = whole.clone();
        spoil(&mut spoilt);
        let error = Solution::decode(&file(&spoilt)).expect_err(words);
        assert!(error.contains(words), "{error}");
    };
    let elsewhere = |cameras: &mut Vec<Camera>| cameras[0].name = "/tmp/elsewhere".into();
    let scene = |s: &mut Solution, spoil: &dyn Fn(&mut Scene)| {
        spoil(&mut s.continuation.as_mut().expect("is kept").scene);
    };
    refused(&|s| elsewhere(&mut s.cameras), "`/tmp/elsewhere`");
    refused(
        &|s| scene(s, &|of| elsewhere(&mut of.cameras)),
        "`/tmp/elsewhere`",
    );
    refused(&|s| s.cameras[0].width = u32::MAX, "pixels");
    refused(&|s| s.cameras[0].eye.x = f64::NAN, "coordinates");
    refused(&|s| s.metres_per_unit = 0.0, "a unit of 0 m");
    refused(
        &|s| scene(s, &|of| of.metres_per_unit = f64::INFINITY),
        "a unit of inf m",
    );
}

#[test]
fn a_report_that_could_not_be_read_back_is_not_written() {
    let how = settings(draft(), EngineChoice::Obvhs, 1);
    let whole = solve(&bundled("geometry"), &how, &mut Silent).expect("can be solved");
    let refused = |spoil: &dyn Fn(&mut Solution), key: &str| {
        let mut spoilt = whole.clone();
        spoil(&mut spoilt);
        let error = spoilt.write(&mut Cursor::new(Vec::new())).expect_err(key);
        let words = format!("`{key}` of the report is not a number");
        assert!(error.to_string().contains(&words), "{error}");
    };
    refused(&|s| s.report.power.escaped = f64::NAN, "escaped");
    refused(
        &|s| s.report.power_rgb.residual[1] = f64::INFINITY,
        "residual",
    );
    refused(
        &|s| s.report.reference_irradiance = f64::NEG_INFINITY,
        "reference_irradiance",
    );
}

/// The name of a folder is no reason to lose a solve.
#[cfg(unix)]
#[test]
fn a_solve_of_a_scene_whose_path_is_not_unicode_is_written_and_read() {
    use std::os::unix::ffi::OsStringExt;
    let how = settings(draft(), EngineChoice::Obvhs, 1);
    let mut solution = solve(&bundled("geometry"), &how, &mut Silent).expect("can be solved");
    let path = std::ffi::OsString::from_vec(b"/home/m\xFCller/scene.toml".to_vec());
    solution.report.scene_file = Some(path.into());
    let read = Solution::decode(&file(&solution)).expect("was just written");
    let known = read.report.scene_file.expect("is kept");
    assert_eq!(known.to_str(), Some("/home/m\u{FFFD}ller/scene.toml"));
}

/// What a file says of a patch must be what follows from its corners, and from the elements and vertices that there are; and they must be
/// of a patch that there is.
#[test]
fn a_file_whose_mesh_is_not_sound_is_refused() {
    let how = settings(draft(), EngineChoice::Obvhs, 1);
    let run = Run::new(bundled("geometry"), how).expect("can be solved");
    let whole = run.finish();
    let written = file(&whole);
    let payload = &written[HEADER..];
    assert!(Solution::from_payload(payload).is_ok());
    let refused = |known: Vec<u8>, instead: Vec<u8>, words: &str| {
        let mut places = payload.windows(known.len());
        let at = places.position(|bytes| bytes == known).expect("is there");
        let rest = &payload[at + known.len()..];
        let spoilt = [&payload[..at], &instead, rest].concat();
        let error = Solution::from_payload(&spoilt).expect_err(words);
        assert!(error.contains(words), "{error}");
    };
    let of = whole.mesh.patch(1);
    let (normal, area) = (of.normal, of.area);
    refused(encoded((normal, area)), encoded((-normal, area)), "a patch");
    refused(
        encoded((normal, area)),
        encoded((normal, f64::NAN)),
        "a patch",
    );
    let begin = |end: u32| encoded((of.exitance, of.roots.start, end, of.grid));
    refused(begin(of.roots.end), begin(1 << 20), "a root");
    refused(begin(of.roots.end), begin(of.roots.end + 1), "a grid");
    let grid = (1u32 << 16, 1u32 << 16);
    let wide = encoded((of.exitance, of.roots.start, of.roots.end, grid));
    refused(begin(of.roots.end), wide, "a grid");
    let mut vertices: Vec<u32> = whole.mesh.vertices_of(1).collect();
    let known = encoded((of.grid, &vertices));
    vertices[0] = u32::MAX;
    refused(known, encoded((of.grid, &vertices)), "a vertex of a patch");
    let Vertex { patch, lattice, .. } = whole.mesh.vertex(3);
    let vertex = |patch, lattice| encoded((patch, lattice, whole.mesh.point(3)));
    let known = vertex(patch, lattice);
    refused(known.clone(), vertex(1 << 20, lattice), "a vertex");
    refused(known, vertex(patch, Lattice::new(u32::MAX, 0)), "a vertex");
    let last = whole.mesh.elements.len() as u32 - 1;
    let known = encoded(whole.mesh.element(last));
    let element = |spoil: &dyn Fn(&mut Element)| {
        let mut element = whole.mesh.element(last);
        spoil(&mut element);
        encoded(element)
    };
    let far = element(&|of| of.corners[0] = 1 << 30);
    refused(known.clone(), far, "the children");
    let circular = element(&|of| of.children = 0);
    refused(known, circular, "the children");
    quadtrees_are_trees(&whole.mesh, refused);
    let root = whole.mesh.element(0);
    let other = Element {
        centre: root.corners[0],
        ..root
    };
    refused(encoded(root), encoded(other), "an element of a grid");
    let clearances = whole.mesh.clearances();
    let first = |patch, clearance| {
        let mut clearances = clearances.clone();
        clearances[0] = (patch, clearance);
        encoded(clearances)
    };
    let (patch, clearance) = clearances[0];
    let known = first(patch, clearance);
    refused(known.clone(), first(1 << 20, clearance), "a clearance");
    refused(known, first(patch, -clearance), "a clearance");
}

/// Children of two parents would be walked through twice, theirs four times, and so on to the deepest level. And each child must be where its
/// parent has a quarter.
fn quadtrees_are_trees(mesh: &Mesh, refused: impl Fn(Vec<u8>, Vec<u8>, &str)) {
    let numbers = 0..mesh.elements.len() as u32;
    let split = |number: &u32| !mesh.element(*number).is_leaf();
    let split: Vec<u32> = numbers.filter(split).collect();
    let parent = split[split.len() - 2];
    let [of, last] = [parent, split[split.len() - 1]].map(|number| mesh.element(number));
    let child = mesh.element(of.children);
    let refused = |known: Element, spoil: &dyn Fn(&mut Element), words: &str| {
        let mut spoilt = known;
        spoil(&mut spoilt);
        refused(encoded(known), encoded(spoilt), words);
    };
    refused(of, &|of| of.children = last.children, "the children");
    refused(of, &|of| of.children += 1, "the children");
    refused(
        of,
        &|of| of.children = mesh.elements.len() as u32,
        "the children",
    );
    refused(of, &|of| of.children = u32::MAX, "an element of no other");
    refused(child, &|of| of.level += 1, "the children");
    refused(child, &|of| of.corners.swap(0, 1), "the children");
    refused(child, &|of| of.centre = of.corners[0], "the children");
    let other = mesh.vertices_of((of.patch + 1) % mesh.patches.len() as u32);
    let other = other.last().expect("has vertices");
    refused(child, &|of| of.centre = other, "the children");
}

fn encoded(of: impl serde::Serialize) -> Vec<u8> {
    postcard::to_stdvec(&of).expect("can be encoded")
}
