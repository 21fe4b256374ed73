//! What the crate's own checks take for granted, and panics without.

use ::gltf::json::Root;
use ::gltf::json::camera::{Camera, Type};
use ::gltf::json::image::Image;
use ::gltf::json::validation::Checked;

/// The first thing that is not there: what was found, and what is expected.
pub(super) fn gap(root: &Root) -> Option<(String, &'static str)> {
    accessor(root)
        .or_else(|| first(&root.images, "image", image))
        .or_else(|| first(&root.cameras, "camera", camera))
}

fn accessor(root: &Root) -> Option<(String, &'static str)> {
    let accessors = root.accessors.len();
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut attributes = primitives.flat_map(|primitive| primitive.attributes.values());
    let wrong = attributes.find(|accessor| accessor.value() >= accessors)?;
    let found = format!("accessor {} of {accessors}", wrong.value());
    Some((found, "one that exists"))
}

/// The first item that lacks something.
fn first<T>(
    items: &[T],
    name: &str,
    lacks: impl Fn(&T) -> Option<(&'static str, &'static str)>,
) -> Option<(String, &'static str)> {
    items.iter().enumerate().find_map(|(number, item)| {
        let (what, expected) = lacks(item)?;
        Some((format!("{name} {number} without {what}"), expected))
    })
}

fn image(image: &Image) -> Option<(&'static str, &'static str)> {
    match (&image.uri, &image.buffer_view, &image.mime_type) {
        (None, None, _) => Some(("a source", "`uri` or `bufferView`")),
        (_, Some(_), None) => Some(("a type", "`mimeType` beside `bufferView`")),
        _ => None,
    }
}

fn camera(camera: &Camera) -> Option<(&'static str, &'static str)> {
    let (perspective, orthographic) = (&camera.perspective, &camera.orthographic);
    match camera.type_ {
        Checked::Valid(Type::Perspective) if perspective.is_none() => {
            Some(("its view", "`perspective`, as its type says"))
        }
        Checked::Valid(Type::Orthographic) if orthographic.is_none() => {
            Some(("its view", "`orthographic`, as its type says"))
        }
        _ => None,
    }
}
