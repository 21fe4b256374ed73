//! The parts of a glTF file: the document, and its buffers.

use super::complete::gap;
use crate::codec::from_base64;
use crate::scene::SceneError;
use crate::scene::load::stays_below;
use crate::scene::text::quote;
use ::gltf::buffer::{Source, View};
use ::gltf::{Document, Gltf};
use std::path::{Path, PathBuf};

/// Required extensions that make no difference to what is read, or are understood.
const UNDERSTOOD: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// A checked document with its buffers.
pub(super) struct File<'a> {
    pub path: &'a Path,
    pub document: Document,
    buffers: Vec<Vec<u8>>,
}

impl<'a> File<'a> {
    pub fn open(path: &'a Path) -> Result<Self, SceneError> {
        let bytes = read(path, path, "a glTF 2.0 file")?;
        let refuse = |found: String, expected: &str| SceneError::new(path, None, found, expected);
        let gltf = Gltf::from_slice_without_validation(&bytes)
            .map_err(|e| refuse(format!("a file that cannot be read ({e})"), "glTF 2.0"))?;
        let mut root = gltf.document.into_json();
        let required = std::mem::take(&mut root.extensions_required);
        if let Some(unknown) = required.iter().find(|e| !UNDERSTOOD.contains(&e.as_str())) {
            let found = format!("a file that requires the extension {}", quote(unknown));
            return Err(refuse(
                found,
                "one without, as exported without compression",
            ));
        }
        if let Some((found, expected)) = gap(&root) {
            return Err(refuse(found, expected));
        }
        let document = Document::from_json(root)
            .map_err(|e| refuse(format!("a file that breaks the rules ({e})"), "glTF 2.0"))?;
        let mut file = Self {
            path,
            document,
            buffers: Vec::new(),
        };
        file.buffers = file.read_buffers(gltf.blob)?;
        Ok(file)
    }

    pub fn error(&self, found: impl Into<String>, expected: &str) -> SceneError {
        SceneError::new(self.path, None, found, expected)
    }

    fn read_buffers(&self, mut blob: Option<Vec<u8>>) -> Result<Vec<Vec<u8>>, SceneError> {
        let mut buffers = Vec::new();
        for buffer in self.document.buffers() {
            let bytes = match buffer.source() {
                Source::Bin => blob
                    .take()
                    .ok_or_else(|| self.error("no binary part", "one, as the buffers say")),
                Source::Uri(uri) => self.resource(uri),
            }?;
            if bytes.len() < buffer.length() {
                let (number, has, wants) = (buffer.index(), bytes.len(), buffer.length());
                let found = format!("buffer {number} with {has} bytes");
                return Err(self.error(found, &format!("{wants} bytes")));
            }
            buffers.push(bytes);
        }
        Ok(buffers)
    }

    /// What an address stands for: data within it, or a file beside this one.
    pub fn resource(&self, uri: &str) -> Result<Vec<u8>, SceneError> {
        if let Some(data) = uri.strip_prefix("data:") {
            let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
            return encoded
                .and_then(from_base64)
                .ok_or_else(|| self.error(format!("the data {}", quote(uri)), "base64"));
        }
        let named = percent_decoded(uri).map(PathBuf::from);
        let named = named.filter(|path| !uri.contains(':') && stays_below(path));
        let named = named.ok_or_else(|| {
            let expected = "a relative path that stays in the folder";
            self.error(format!("the address {}", quote(uri)), expected)
        })?;
        let folder = self.path.parent().unwrap_or(Path::new(""));
        read(&folder.join(named), self.path, "a file that it names")
    }

    /// The bytes of a view; the error says what it names.
    pub fn view(&self, view: &View) -> Result<&[u8], String> {
        let end = view.offset().checked_add(view.length());
        let bytes = self.buffers.get(view.buffer().index());
        bytes
            .zip(end)
            .and_then(|(bytes, end)| bytes.get(view.offset()..end))
            .ok_or_else(|| format!("buffer view {} beyond the end of its buffer", view.index()))
    }
}

fn read(path: &Path, of: &Path, expected: &str) -> Result<Vec<u8>, SceneError> {
    std::fs::read(path).map_err(|error| {
        let found = match path == of {
            true => format!("an unreadable file ({error})"),
            false => format!("{} unreadable ({error})", path.display()),
        };
        SceneError::new(of, None, found, expected)
    })
}

/// Undoes `%20` and the like.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let (digits, after) = rest.split_at_checked(2)?;
        bytes.push(u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?);
        rest = after;
    }
    String::from_utf8(bytes).ok()
}
