//! The solution file: everything a later command needs, with a version and a checksum.
//!
//! Layout: 8 bytes of magic, version (u32), length of the payload (u64), CRC-32 of the payload (u32), all little endian, then
//! the payload in the postcard format.

use super::Solution;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

const MAGIC: &[u8; 8] = b"RADIOSOL";
const VERSION: u32 = 1;
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

impl Solution {
    /// Writes the solution file's bytes.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let payload = postcard::to_stdvec(self).map_err(io::Error::other)?;
        out.write_all(MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        out.write_all(&(payload.len() as u64).to_le_bytes())?;
        out.write_all(&crc32fast::hash(&payload).to_le_bytes())?;
        out.write_all(&payload)
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
        if version != VERSION {
            return Err(format!(
                "format version {version}, where this program reads {VERSION}"
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
        let mut solution: Self =
            postcard::from_bytes(payload).map_err(|e| format!("undecodable contents ({e})"))?;
        let vertices = solution.mesh.vertices.len();
        if [&solution.light.irradiance, &solution.light.unshot]
            .iter()
            .any(|of| of.len() != vertices)
        {
            return Err("light that does not fit the mesh".into());
        }
        if solution.light.exitance_unshot.len() != solution.mesh.patches.len() {
            return Err("exitance that does not fit the mesh".into());
        }
        solution.mesh.restore()?;
        Ok(solution)
    }
}
