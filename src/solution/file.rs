//! The solution file: everything a later command needs, with a version and a checksum.
//!
//! Layout: 8 bytes of magic, version (u32), length of the payload (u64), CRC-32 of the payload (u32), all little endian, then
//! the payload in the postcard format: [`Stored`]. The report, which grows with the program, is JSON in it. Files of version 2, which end
//! before the clearances, and of version 1 (`format_1`) are still read.

use super::{Continuation, Report, Solution, format_1};
use crate::mesh::StoredMesh;
use crate::scene::{Camera, check_unit};
use crate::solver::Light;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

const MAGIC: &[u8; 8] = b"RADIOSOL";
const VERSION: u32 = 3;
const HEADER: usize = 24;

/// An empty list in the postcard format.
const NO_CLEARANCES: [u8; 1] = [0];

/// Bytes of the payload that are written at a time.
const MANY: usize = 1 << 16;

/// Why a solution file cannot be read.
#[derive(Debug, Error)]
pub enum SolutionError {
    /// The file could not be read at all.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file is not a solution, or not an undamaged one.
    #[error("{}: {found}; expected a solution written by `radiosity solve`", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
    },
}

/// The payload.
#[derive(Serialize, Deserialize)]
struct Stored<'a, M> {
    report: String,
    cameras: Cow<'a, [Camera]>,
    metres_per_unit: f64,
    mesh: M,
    light: Cow<'a, Light>,
    continuation: Cow<'a, Option<Continuation>>,
    clearances: Vec<(u32, f32)>,
}

/// The payload on its way out, with what the header says of it. Keeps the reason when writing fails: the encoder only says that it could
/// not go on.
struct Payload<'a, W> {
    out: &'a mut W,
    length: u64,
    checksum: crc32fast::Hasher,
    failure: Option<io::Error>,
}

impl<W: Write> Write for Payload<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes).map_err(|reason| {
            let kind = reason.kind();
            self.failure = Some(reason);
            io::Error::from(kind)
        })?;
        self.length += written as u64;
        self.checksum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Solution {
    /// Writes the solution file's bytes, the header last: what it says of the payload is known when that is written.
    ///
    /// # Errors
    /// When `out` cannot be written to, or a number of the report is not finite: JSON has no such numbers, and the file could not be read.
    pub fn write(&self, out: &mut (impl Write + Seek)) -> io::Result<()> {
        let begin = out.stream_position()?;
        out.write_all(&[0; HEADER])?;
        let (length, checksum) = self.write_payload(out)?;
        let end = out.stream_position()?;
        out.seek(SeekFrom::Start(begin))?;
        out.write_all(MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        out.write_all(&length.to_le_bytes())?;
        out.write_all(&checksum.to_le_bytes())?;
        out.seek(SeekFrom::Start(end))?;
        Ok(())
    }

    /// Writes what follows the header; gives its length and its checksum. It is nowhere whole in memory: that would be the most that a solve
    /// of a large scene takes.
    fn write_payload(&self, out: &mut impl Write) -> io::Result<(u64, u32)> {
        let stored = Stored {
            report: stored_report(&self.report)?,
            cameras: Cow::Borrowed(&self.cameras),
            metres_per_unit: self.metres_per_unit,
            mesh: &self.mesh,
            light: Cow::Borrowed(&self.light),
            continuation: Cow::Borrowed(&self.continuation),
            clearances: self.mesh.clearances(),
        };
        let mut payload = Payload {
            out,
            length: 0,
            checksum: crc32fast::Hasher::new(),
            failure: None,
        };
        // The encoder gives out a few bytes at a time, a checksum is for many.
        let mut many = BufWriter::with_capacity(MANY, &mut payload);
        let encoded = postcard::to_io(&stored, &mut many).map(|_| ());
        let encoded = encoded.map_err(io::Error::other);
        let encoded = encoded.and_then(|()| many.flush());
        drop(many);
        match (encoded, payload.failure) {
            (Ok(()), _) => Ok((payload.length, payload.checksum.finalize())),
            (Err(_), Some(reason)) | (Err(reason), None) => Err(reason),
        }
    }

    /// Reads a solution file.
    pub fn read(path: &Path) -> Result<Self, SolutionError> {
        let bytes = std::fs::read(path).map_err(|source| SolutionError::Unreadable {
            path: path.into(),
            source,
        })?;
        Self::decode(&bytes).map_err(|found| SolutionError::Damaged {
            path: path.into(),
            found,
        })
    }

    /// Decodes the bytes of a solution file; the error says what was found.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() < HEADER || &bytes[..8] != MAGIC {
            return Err("not a solution file".into());
        }
        let (header, payload) = bytes.split_at(HEADER);
        let u32_at = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| header[at + i]));
        let (version, checksum) = (u32_at(8), u32_at(20));
        if !(1..=VERSION).contains(&version) {
            return Err(format!(
                "format version {version}, where this program reads 1 to {VERSION}"
            ));
        }
        let length = u64::from_le_bytes(std::array::from_fn(|i| header[12 + i]));
        if payload.len() as u64 != length {
            return Err(format!(
                "{} bytes of {length}: the file is cut short or has grown",
                payload.len()
            ));
        }
        if crc32fast::hash(payload) != checksum {
            return Err("the checksum does not match: the file is damaged".into());
        }
        match version {
            1 => format_1::decode(payload)?.checked(),
            2 => Self::from_payload(&[payload, &NO_CLEARANCES].concat()),
            _ => Self::from_payload(payload),
        }
    }

    /// Decodes what follows the header of a file of the present format. Any bytes give a sound solution or an error.
    pub fn from_payload(payload: &[u8]) -> Result<Self, String> {
        let stored: Stored<StoredMesh> = postcard::from_bytes(payload).map_err(undecodable)?;
        let report: Report = serde_json::from_str(&stored.report).map_err(undecodable)?;
        let solution = Self {
            report,
            cameras: stored.cameras.into_owned(),
            metres_per_unit: stored.metres_per_unit,
            mesh: stored.mesh.restored(&stored.clearances)?,
            light: stored.light.into_owned(),
            continuation: stored.continuation.into_owned(),
        };
        solution.checked()
    }

    /// Checks that the parts fit each other, and what nothing else follows from.
    fn checked(self) -> Result<Self, String> {
        check_unit(self.metres_per_unit)?;
        self.cameras.iter().try_for_each(Camera::check)?;
        let (vertices, patches) = (self.mesh.vertices.len(), self.mesh.patches.len());
        let light = &self.light;
        if light.irradiance.len() != vertices || light.unshot.len() != vertices {
            return Err("light that does not fit the mesh".into());
        }
        if light.exitance_unshot.len() != patches {
            return Err("exitance that does not fit the mesh".into());
        }
        let of_all = [&light.irradiance, &light.unshot, &light.exitance_unshot];
        if !of_all.into_iter().flatten().all(|e| e.is_finite()) {
            return Err("light that is no number".into());
        }
        if let Some(Continuation { scene, course }) = &self.continuation {
            scene.check()?;
            course.check(&self.mesh)?;
            let surfaces = scene.surfaces.len();
            let on_scene = |p: crate::mesh::Patch| (p.surface as usize) < surfaces;
            if !self.mesh.patches.iter().all(on_scene) {
                return Err("a patch of no surface".into());
            }
        }
        Ok(self)
    }
}

/// The report as JSON, if it can be read back.
fn stored_report(report: &Report) -> io::Result<String> {
    let json = serde_json::to_string(report)?;
    let Err(error) = serde_json::from_str::<Report>(&json) else {
        return Ok(json);
    };
    // All of it is on one line; the last key before the fault is that of the number.
    let before = json.as_bytes().get(..error.column()).unwrap_or_default();
    let before = String::from_utf8_lossy(before);
    let key = before.rsplit('"').nth(1).unwrap_or_default();
    let found =
        format!("`{key}` of the report is not a number; expected one that is finite ({error})");
    Err(io::Error::new(io::ErrorKind::InvalidData, found))
}

pub(super) fn undecodable(error: impl std::fmt::Display) -> String {
    format!("undecodable contents ({error})")
}
