//! Paths of files: their names in messages, the folders that they lie in, and links.

use std::io;
use std::path::Path;

/// The name of a path in messages.
pub(crate) fn origin(path: &Path) -> String {
    path.display().to_string()
}

/// The folder that a path lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Refuses a link to a file that does not exist: the new file would replace the link, and the
/// link's target would stay empty.
pub(crate) fn refuse_dangling_link(path: &Path) -> io::Result<()> {
    if path.is_symlink() && !path.exists() {
        let why = "it is a link to a file that is not there";
        return Err(io::Error::new(io::ErrorKind::NotFound, why));
    }
    Ok(())
}
