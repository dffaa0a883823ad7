//! How commands write files (`output/files.rs`) and folders (`output/folders.rs`), and where they
//! may: to no file that they read, to no file twice, and to no file that others wrote.
//!
//! All checks come before any work is done. Files are identified by device and inode on Unix, so
//! that links are seen through, and by their canonical paths elsewhere. Anything but a plain file
//! (a pipe, a terminal, `/dev/null`) holds nothing that could be lost, and may always be written
//! to.

mod error;
mod files;
mod folders;

use std::fs::{self, File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::Error;
use crate::paths::{folder_of, origin, refuse_dangling_link};

pub use error::OutputError;
pub use files::{block_writes, create_folder, write_atomically};
pub use folders::{FolderKind, check_folder, replace_folder};

/// A kind of file that this program writes, and how to recognise one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OutputKind {
    /// The word for it in messages, as in "no scenario".
    pub name: &'static str,
    /// Number of bytes to skip before `opening`: the length in front of a safetensors header.
    pub skipped: usize,
    /// The bytes after those, which begin every file of this kind that this program wrote.
    pub opening: &'static str,
}

impl OutputKind {
    /// Whether the beginning of the file shows that this program wrote it. An empty file holds
    /// nothing that could be lost, so it counts as one.
    ///
    /// # Errors
    /// The operating system's error if the file cannot be read.
    pub fn is_of(&self, path: &Path) -> io::Result<bool> {
        let most = (self.skipped + self.opening.len()) as u64;
        let mut beginning = Vec::new();
        File::open(path)?.take(most).read_to_end(&mut beginning)?;
        let known = beginning.get(self.skipped..) == Some(self.opening.as_bytes());
        Ok(known || beginning.is_empty())
    }
}

/// Checks that a file may replace the one at `path`, if there is one. It may if the old file is of
/// the kind that this program writes there and not read-only, or if `force` is given.
///
/// # Errors
/// [`OutputError`], or [`Error::CannotWrite`] where a folder is in the way.
pub fn check_output(path: &Path, kind: &OutputKind, force: bool) -> Result<(), Error> {
    let origin = origin(path);
    let cannot = |cause| Error::CannotWrite { origin: origin.clone(), cause };
    let Ok(former) = fs::metadata(path) else {
        refuse_dangling_link(path).map_err(cannot)?;
        // A missing folder is found now rather than after the work is done.
        return fs::metadata(folder_of(path)).map(|_| ()).map_err(cannot);
    };
    if former.is_dir() {
        return Err(cannot(io::ErrorKind::IsADirectory.into()));
    }
    if force || !former.is_file() {
        return Ok(());
    }
    if former.permissions().readonly() {
        return Err(OutputError::ReadOnly { origin }.into());
    }
    if !kind.is_of(path).map_err(cannot)? {
        return Err(OutputError::NotOurs { origin, kind: kind.name }.into());
    }
    Ok(())
}

/// The files of one command: those that it reads and those that it is going to write.
#[derive(Debug, Default)]
pub struct Outputs {
    force: bool,
    read: Vec<Place>,
    written: Vec<Place>,
}

impl Outputs {
    /// The outputs of a command that has no files yet. With `force`, read-only files and files that
    /// this program did not write are replaced, but never a file that the command reads.
    pub fn new(force: bool) -> Self {
        Self { force, ..Self::default() }
    }

    /// Whether files that this program did not write may be replaced.
    pub fn force(&self) -> bool {
        self.force
    }

    /// Records that the command reads this file or folder.
    pub fn reads(&mut self, path: &Path) {
        self.read.extend(Place::of(path));
    }

    /// Records that the command prints results to stdout, which may be redirected to a file.
    pub fn prints(&mut self) {
        let stdout = Path::new("/dev/stdout");
        if cfg!(unix) && fs::metadata(stdout).is_ok_and(|former| former.is_file()) {
            self.written.extend(
                Place::of(stdout).map(|place| Place { origin: "stdout".to_owned(), ..place }),
            );
        }
    }

    /// Records that the command is going to write this file.
    ///
    /// # Errors
    /// [`OutputError`] if the command reads the file or writes it already, and the errors of
    /// [`check_output`].
    pub fn writes(&mut self, path: &Path, kind: &OutputKind) -> Result<(), Error> {
        self.claim(path, Place::is)?;
        check_output(path, kind, self.force)
    }

    /// Records that the command is going to replace this folder, if there is one, by its own.
    ///
    /// # Errors
    /// [`OutputError`] if the command reads or writes the folder or something in it.
    pub fn replaces_folder(&mut self, path: &Path) -> Result<(), Error> {
        self.claim(path, Place::is_or_lies_in)
    }

    fn claim(
        &mut self,
        path: &Path,
        clashes: impl Fn(&Place, &Place) -> bool,
    ) -> Result<(), Error> {
        let Some(place) = Place::of(path) else { return Ok(()) };
        let clash = |others: &[Place]| {
            others.iter().find(|other| clashes(other, &place)).map(|other| other.origin.clone())
        };
        let output = place.origin.clone();
        if let Some(input) = clash(&self.read) {
            return Err(OutputError::IsInput { output, input }.into());
        }
        if let Some(first) = clash(&self.written) {
            return Err(OutputError::Twice { first, second: output }.into());
        }
        self.written.push(place);
        Ok(())
    }
}

/// The place of a plain file or a folder, which may not exist yet.
#[derive(Debug, Clone)]
struct Place {
    /// The path as the user named it.
    origin: String,
    /// Device and inode of an existing file, on systems that have them.
    node: Option<(u64, u64)>,
    /// The path without links and dots.
    path: PathBuf,
}

impl Place {
    /// Returns `None` for anything that is neither a plain file nor a folder, because it can be
    /// read and written at once.
    fn of(path: &Path) -> Option<Self> {
        let former = fs::metadata(path).ok();
        if former.as_ref().is_some_and(|former| !former.is_file() && !former.is_dir()) {
            return None;
        }
        let whole = path.canonicalize().or_else(|_| {
            let folder = folder_of(path).canonicalize()?;
            Ok::<_, io::Error>(folder.join(path.file_name().unwrap_or_default()))
        });
        Some(Self {
            origin: origin(path),
            node: former.as_ref().and_then(node),
            path: whole.unwrap_or_else(|_| path.to_owned()),
        })
    }

    fn is(&self, other: &Self) -> bool {
        self.path == other.path || (self.node.is_some() && self.node == other.node)
    }

    fn is_or_lies_in(&self, folder: &Self) -> bool {
        self.is(folder) || self.path.starts_with(&folder.path)
    }
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "elsewhere there is none")]
fn node(former: &Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((former.dev(), former.ino()))
}

#[cfg(not(unix))]
fn node(_: &Metadata) -> Option<(u64, u64)> {
    None
}
