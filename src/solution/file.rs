//! The solution file: everything a later command needs, with a version and a checksum.
//!
//! Layout: 8 bytes of magic, version (u32), length of the payload (u64), CRC-32 of the payload (u32), all little endian, then
//! the payload in the postcard format: [`Stored`]. The report, which grows with the program, is JSON in it. Files of version 1 are
//! still read (`format_1`).

use super::{Continuation, Report, Solution, format_1};
use crate::mesh::StoredMesh;
use crate::scene::Camera;
use crate::solver::Light;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

const MAGIC: &[u8; 8] = b"RADIOSOL";
const VERSION: u32 = 2;
const HEADER: usize = 24;

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
}

/// What the header says of the payload, found by writing it to nowhere: kept in memory, it would be the most that a solve of a large
/// scene takes.
#[derive(Default)]
struct Tally {
    length: u64,
    checksum: crc32fast::Hasher,
}

impl Write for Tally {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.length += bytes.len() as u64;
        self.checksum.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A writer that keeps the reason when it fails: the encoder only says that it could not go on.
struct Candid<'a, W> {
    out: &'a mut W,
    failure: Option<io::Error>,
}

impl<W: Write> Write for Candid<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).map_err(|reason| {
            let kind = reason.kind();
            self.failure = Some(reason);
            kind.into()
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Solution {
    /// Writes the solution file's bytes.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let stored = Stored {
            report: serde_json::to_string(&self.report)?,
            cameras: Cow::Borrowed(&self.cameras),
            metres_per_unit: self.metres_per_unit,
            mesh: &self.mesh,
            light: Cow::Borrowed(&self.light),
            continuation: Cow::Borrowed(&self.continuation),
        };
        let mut tally = BufWriter::new(Tally::default());
        postcard::to_io(&stored, &mut tally).map_err(io::Error::other)?;
        let Tally { length, checksum } = tally.into_inner()?;
        out.write_all(MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        out.write_all(&length.to_le_bytes())?;
        out.write_all(&checksum.finalize().to_le_bytes())?;
        let mut out = Candid { out, failure: None };
        let encoded = postcard::to_io(&stored, &mut out).map(|_| ());
        encoded.map_err(|e| out.failure.unwrap_or_else(|| io::Error::other(e)))
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
        let u32_at = |at: usize| {
            header[at..at + 4]
                .iter()
                .rev()
                .fold(0u32, |n, b| n << 8 | u32::from(*b))
        };
        let (version, checksum) = (u32_at(8), u32_at(20));
        if !(1..=VERSION).contains(&version) {
            return Err(format!(
                "format version {version}, where this program reads 1 to {VERSION}"
            ));
        }
        let length = u64::from(u32_at(12)) | u64::from(u32_at(16)) << 32;
        if payload.len() as u64 != length {
            return Err(format!(
                "{} bytes of {length}: the file is cut short or has grown",
                payload.len()
            ));
        }
        if crc32fast::hash(payload) != checksum {
            return Err("the checksum does not match: the file is damaged".into());
        }
        if version == 1 {
            format_1::decode(payload)?.checked()
        } else {
            Self::from_payload(payload)
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
            mesh: stored.mesh.restored()?,
            light: stored.light.into_owned(),
            continuation: stored.continuation.into_owned(),
        };
        solution.checked()
    }

    /// Checks that the parts fit each other.
    fn checked(self) -> Result<Self, String> {
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

pub(super) fn undecodable(error: impl std::fmt::Display) -> String {
    format!("undecodable contents ({error})")
}
