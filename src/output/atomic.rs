//! Files that appear whole or not at all.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Write};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// What the name of a temporary file has before its numbers, so that no other program's is taken for one.
const MARK: &str = ".radiosity-";

/// So many bytes of a file's name begin that of its temporary file, which is longer and must not be too long.
const MOST_OF_NAME: usize = 64;

/// Links that are followed from one to the next.
const MOST_LINKS: usize = 40;

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
/// behind it that is written, also if there is none yet; what is no file, a device or a pipe, is written to as it is. A file that takes the
/// place of another has its permissions. Gives what `fill` does.
///
/// # Errors
/// When the folder cannot be written to, the disk is full, `path` is a folder, or `fill` fails.
pub fn write_atomically<T>(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> Result<T, WriteError> {
    fill_and_rename(path, fill).map_err(|reason| WriteError {
        path: path.to_path_buf(),
        reason,
    })
}

fn fill_and_rename<T>(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> io::Result<T> {
    if is_special(path) {
        let mut writer = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        let filled = fill(&mut writer)?;
        writer.flush()?;
        return Ok(filled);
    }
    let path = &followed(path)?;
    let (draft, file) = Draft::create(path)?;
    let mut writer = BufWriter::new(file);
    let filled = fill(&mut writer)?;
    writer.flush()?;
    writer.get_ref().sync_all()?;
    // The file is closed only then: until it has its name, the lock says that somebody looks after it.
    draft.publish(path)?;
    Ok(filled)
}

/// Where a path leads to, through links, whether there is a file or not.
fn followed(path: &Path) -> io::Result<PathBuf> {
    if let Ok(path) = fs::canonicalize(path) {
        return Ok(path);
    }
    let mut end = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let Ok(target) = fs::read_link(&end) else {
            return Ok(end);
        };
        end = end.parent().unwrap_or(Path::new("")).join(target);
    }
    Err(io::Error::other("too many links, one behind the other"))
}

/// Whether there is something that is neither a file nor a folder.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|of| !of.is_file() && !of.is_dir())
}

/// Removes the temporary files that killed processes have left in `folder`. Who writes to one holds its lock, on this machine or on another
/// that shares the folder, and the system takes it away from a process that ends. So a file whose lock is free is nobody's; where the file
/// system has no locks all files stay. Only files with names that [`write_atomically`] gives are looked at.
pub fn remove_abandoned(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()).filter(|p| is_draft(p)) {
        let is_file = fs::symlink_metadata(&path).is_ok_and(|of| of.is_file());
        let file = is_file.then(|| OpenOptions::new().write(true).open(&path));
        if let Some(Ok(file)) = file
            && file.try_lock().is_ok()
        {
            // Somebody else's to look after, if it cannot be removed.
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether a file has the name of a temporary one: `.NAME.radiosity-PROCESS-NUMBER.part`.
fn is_draft(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    let numbers = name.as_deref().and_then(|name| {
        let rest = name.strip_prefix('.')?.strip_suffix(".part")?;
        let (_, numbers) = rest.rsplit_once(MARK)?;
        numbers.split_once('-')
    });
    numbers.is_some_and(|(process, number)| {
        process.parse::<u32>().is_ok() && number.parse::<u64>().is_ok()
    })
}

/// Checks that a file can be made beside `path`, before a long run whose result goes there.
///
/// # Errors
/// When the folder cannot be written to, or `path` names no file or a folder.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    if is_special(path) {
        return Ok(());
    }
    let reason = match followed(path).and_then(|target| Draft::create(&target)) {
        Ok(_) if !path.is_dir() => return Ok(()),
        Ok(_) => io::ErrorKind::IsADirectory.into(),
        Err(reason) => reason,
    };
    Err(WriteError {
        path: path.to_path_buf(),
        reason,
    })
}

/// Lets a new file be read and written by whom the one at `path`, if there is one, may be. On Windows all that there is to keep is that it
/// must not be written, and such a file cannot be replaced.
fn keep_permissions(path: &Path, file: &File) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(old) if cfg!(unix) && old.is_file() => file.set_permissions(old.permissions()),
        _ => Ok(()),
    }
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
    /// Creates it beside `path`, under a name that nobody else uses, with the permissions of the file that it is to replace, and locks it.
    fn create(path: &Path) -> io::Result<(Self, File)> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let name = path
            .file_name()
            .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
        let name = name.to_string_lossy();
        let is_cut = |at: &usize| name.is_char_boundary(*at);
        let end = (0..=MOST_OF_NAME.min(name.len())).rev().find(is_cut);
        let beginning = &name[..end.unwrap_or(0)];
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let temporary = format!(".{beginning}{MARK}{}-{number}.part", process::id());
            let temporary = path.with_file_name(temporary);
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            let made = OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(&temporary);
            let file = match made {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                made => made?,
            };
            drafts.push(temporary.clone());
            drop(drafts);
            let draft = Self {
                path: Some(temporary),
            };
            if draft.is_kept(&file) {
                keep_permissions(path, &file)?;
                return Ok((draft, file));
            }
        }
    }

    /// Locks the new file. Another process may have taken it for abandoned before that, and removes it or has done so.
    fn is_kept(&self, file: &File) -> bool {
        let is_taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        !is_taken && self.path.as_ref().is_some_and(|path| path.exists())
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
