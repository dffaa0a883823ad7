//! Writes whole files, and never leaves a half-written one.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use crate::Error;
use crate::paths::{folder_of, origin, refuse_dangling_link};

/// Held for reading while a file is written, and for writing when the process is to end, so that it
/// ends between two files.
static WRITING: RwLock<()> = RwLock::new(());

/// Prefix of the names of unfinished files and folders, which remain if the process is killed.
/// Nothing reads them, and they may be removed whenever no program is writing.
pub(crate) const UNFINISHED: &str = ".vertifleet-";

/// Creates a folder and its missing parents.
///
/// # Errors
/// [`Error::CannotWrite`].
pub fn create_folder(path: &Path) -> Result<(), Error> {
    let in_the_way = || {
        io::Error::new(io::ErrorKind::NotADirectory, "a file has this name, and a folder is needed")
    };
    let created = if path.is_file() { Err(in_the_way()) } else { fs::create_dir_all(path) };
    created.map_err(|cause| Error::CannotWrite { origin: origin(path), cause })
}

/// Writes a whole file, so that whenever the program ends, `path` has either its former contents or
/// all of `contents`.
///
/// A link is followed. Where `path` is no plain file (a pipe, `/dev/stdout`), `contents` is simply
/// written to it.
///
/// # Errors
/// [`Error::CannotWrite`]; then `path` is as before.
pub fn write_atomically(path: &Path, contents: &[u8]) -> Result<(), Error> {
    write(path, contents).map_err(|cause| Error::CannotWrite { origin: origin(path), cause })
}

/// Waits for the files that [`write_atomically`] is writing. While the guard lives, no other write
/// begins. This lets the process end while its threads are at work without leaving an unfinished
/// file behind.
pub fn block_writes() -> RwLockWriteGuard<'static, ()> {
    WRITING.write().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the guard to hold while files that belong together are written.
pub(crate) fn writing() -> RwLockReadGuard<'static, ()> {
    WRITING.read().unwrap_or_else(PoisonError::into_inner)
}

fn write(path: &Path, contents: &[u8]) -> io::Result<()> {
    refuse_dangling_link(path)?;
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let former = fs::metadata(&target).ok();
    if former.as_ref().is_some_and(|former| !former.is_file()) {
        return fs::write(&target, contents);
    }
    let folder = folder_of(&target);
    fs::metadata(folder)?;
    // The lock is not held for pipes, above, so that a process that waits for a pipe's reader can
    // be ended.
    let _writing = writing();
    // The name of the temporary file would only confuse a message, so only the kind of the error is
    // kept.
    let mut file = new_file_in(folder).map_err(|error| io::Error::from(error.kind()))?;
    file.write_all(contents)?;
    if let Some(former) = former {
        fs::set_permissions(file.path(), former.permissions())?;
    }
    file.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// A temporary file with the permissions of any other new file; by default only its owner could
/// read it.
fn new_file_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
