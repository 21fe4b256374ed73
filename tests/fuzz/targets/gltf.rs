//! Any glTF, in text or binary, is a scene or an error.
#![no_main]

mod files;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let name = if data.starts_with(b"glTF") { "s.glb" } else { "s.gltf" };
    files::read_geometry(name, data);
});
