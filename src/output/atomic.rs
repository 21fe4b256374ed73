//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// A file could not be written; nothing was left behind, and a file of that name from before is untouched.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {reason}", path.display())]
pub struct WriteError {
    /// The file that was asked for.
    pub path: PathBuf,
    /// What went wrong.
    pub reason: io::Error,
}

/// Writes `path` through `fill`: into a temporary file of the same folder first, which takes the real name only when
/// all of it has reached the disk. A reader never sees half a file, and an interrupted run keeps the previous one. Of a link it is the file
/// behind it that is written; what is no file, a device or a pipe, is written to as it is.
///
/// # Errors
/// When the folder cannot be written to, the disk is full, `path` is a folder, or `fill` fails.
pub fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    fill_and_rename(path, fill).map_err(|reason| WriteError {
        path: path.to_path_buf(),
        reason,
    })
}

fn fill_and_rename(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let path = &followed(path);
    if is_special(path) {
        let mut writer = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        fill(&mut writer)?;
        return writer.flush();
    }
    let (draft, file) = Draft::create(path)?;
    let mut writer = BufWriter::new(file);
    fill(&mut writer)?;
    writer.flush()?;
    writer.get_ref().sync_all()?;
    drop(writer);
    draft.publish(path)
}

/// Where a path leads to, through links.
fn followed(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf())
}

/// Whether there is something that is neither a file nor a folder.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|of| !of.is_file() && !of.is_dir())
}

/// Removes the temporary files that killed processes have left in `folder`; those of living ones stay.
pub fn remove_abandoned(folder: &Path) {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in names.map(|entry| entry.path()) {
        if process_of(&path).is_some_and(|id| id != process::id() && !is_alive(id)) {
            // Somebody else's to look after, if it cannot be removed.
            let _ = fs::remove_file(path);
        }
    }
}

/// The process that writes a temporary file, from its name.
fn process_of(path: &Path) -> Option<u32> {
    let name = path.file_name()?.to_str()?.strip_prefix('.')?;
    let mut parts = name.strip_suffix(".part")?.rsplit('.');
    let (_number, process) = (parts.next()?.parse::<u64>().ok()?, parts.next()?);
    process.parse().ok()
}

/// Whether there is such a process; where the system does not tell, there may be.
fn is_alive(process: u32) -> bool {
    let processes = Path::new("/proc");
    !processes.join("self").exists() || processes.join(process.to_string()).exists()
}

/// Checks that a file can be made beside `path`, before a long run whose result goes there.
///
/// # Errors
/// When the folder cannot be written to, or `path` names no file or a folder.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let target = followed(path);
    if is_special(&target) {
        return Ok(());
    }
    let reason = match Draft::create(&target) {
        Ok(_) if !path.is_dir() => return Ok(()),
        Ok(_) => io::ErrorKind::IsADirectory.into(),
        Err(reason) => reason,
    };
    Err(WriteError {
        path: path.to_path_buf(),
        reason,
    })
}

/// Temporary files that exist now.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes all temporary files and lets none come about or take its real name any more: for a process that is about to end.
pub fn abandon_drafts() {
    // Never unlocked, so that no other thread makes or publishes a file.
    let mut drafts = ManuallyDrop::new(DRAFTS.lock().unwrap_or_else(PoisonError::into_inner));
    for path in drafts.drain(..) {
        let _ = fs::remove_file(path);
    }
}

/// The temporary file; removed when dropped unless it was published.
struct Draft {
    path: Option<PathBuf>,
}

impl Draft {
    /// Creates it beside `path`, under a name that nobody else uses: `.name.process.number.part`.
    fn create(path: &Path) -> io::Result<(Self, File)> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let name = path
            .file_name()
            .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
        loop {
            let mut temporary = OsString::from(".");
            temporary.push(name);
            temporary.push(format!(
                ".{}.{}.part",
                process::id(),
                NUMBER.fetch_add(1, Ordering::Relaxed)
            ));
            let temporary = path.with_file_name(temporary);
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            match OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(&temporary)
            {
                Ok(file) => {
                    drafts.push(temporary.clone());
                    return Ok((
                        Self {
                            path: Some(temporary),
                        },
                        file,
                    ));
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn publish(mut self, path: &Path) -> io::Result<()> {
        if let Some(temporary) = &self.path {
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            fs::rename(temporary, path)?;
            drafts.retain(|draft| draft != temporary);
        }
        self.path = None;
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Some(temporary) = &self.path {
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            drafts.retain(|draft| draft != temporary);
            // Already failing: the first error is the one to report.
            let _ = fs::remove_file(temporary);
        }
    }
}
