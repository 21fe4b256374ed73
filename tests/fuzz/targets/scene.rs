//! Any files are a scene or an error.
#![no_main]

mod files;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| files::read(&files::scene_of(data)));
