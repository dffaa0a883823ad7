//! What a command may write to: nothing that it reads, nothing twice, and no file of others.
//!
//! All of it is asked before any work is done. Files are told apart by what they are, not by how they are called: by
//! device and inode on Unix, so that links are seen through, and by their canonical paths elsewhere. What is no plain file
//! (a pipe, a terminal, `/dev/null`) holds nothing that could be lost, and may always be written to.

use std::fs::{self, File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::output_error::OutputError;
use crate::{Error, files};

/// A kind of file that this program writes, and how to know one again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OutputKind {
    /// What people call it, as in "no scenario".
    pub name: &'static str,
    /// How many bytes of it say nothing of its kind: the length in front of a safetensors header.
    pub skipped: usize,
    /// What every file of the kind that this program wrote has behind them.
    pub opening: &'static str,
}

impl OutputKind {
    /// Whether this program wrote the file, as far as its beginning tells. An empty file holds nothing that could be lost, so it
    /// counts as one.
    ///
    /// # Errors
    /// What the operating system says where the file cannot be read.
    pub fn is_of(&self, path: &Path) -> io::Result<bool> {
        let most = (self.skipped + self.opening.len()) as u64;
        let mut beginning = Vec::new();
        File::open(path)?.take(most).read_to_end(&mut beginning)?;
        let known = beginning.get(self.skipped..) == Some(self.opening.as_bytes());
        Ok(known || beginning.is_empty())
    }
}

/// Whether a file may be written where this one is, if there is one: it is of the kind that this program writes there, and not
/// read-only, or `force` is given.
///
/// # Errors
/// [`OutputError`], or [`Error::CannotWrite`] where a folder is in the way.
pub fn check_output(path: &Path, kind: &OutputKind, force: bool) -> Result<(), Error> {
    let origin = files::origin(path);
    let cannot = |cause| Error::CannotWrite { origin: origin.clone(), cause };
    let Ok(former) = fs::metadata(path) else {
        files::leads_somewhere(path).map_err(cannot)?;
        // A folder that is not there is found before the work is done rather than after it.
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

/// The files of one command: those that it reads, and those that it is going to write.
#[derive(Debug, Default)]
pub struct Outputs {
    force: bool,
    read: Vec<Place>,
    written: Vec<Place>,
}

impl Outputs {
    /// Of a command that has no files yet. With `force`, files that this program did not write are replaced, and read-only ones; what
    /// the command reads never is.
    pub fn new(force: bool) -> Self {
        Self { force, ..Self::default() }
    }

    /// Whether files of others may be replaced.
    pub fn force(&self) -> bool {
        self.force
    }

    /// The command reads this file or folder.
    pub fn reads(&mut self, path: &Path) {
        self.read.extend(Place::of(path));
    }

    /// The command prints results to stdout, which may have been led to a file.
    pub fn prints(&mut self) {
        let stdout = Path::new("/dev/stdout");
        if cfg!(unix) && fs::metadata(stdout).is_ok_and(|former| former.is_file()) {
            self.written.extend(
                Place::of(stdout).map(|place| Place { origin: "stdout".to_owned(), ..place }),
            );
        }
    }

    /// The command is going to write this file.
    ///
    /// # Errors
    /// [`OutputError`] if the command reads the file or writes it already; else as [`check_output`].
    pub fn writes(&mut self, path: &Path, kind: &OutputKind) -> Result<(), Error> {
        self.claim(path, Place::is)?;
        check_output(path, kind, self.force)
    }

    /// The command is going to put a folder of its own in this one's place, if there is one.
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

/// Where a plain file or a folder is, or will be.
#[derive(Debug, Clone)]
struct Place {
    /// As the user named it.
    origin: String,
    /// Device and inode of a file that is there, where the system has such.
    node: Option<(u64, u64)>,
    /// Without links and dots.
    path: PathBuf,
}

impl Place {
    /// Nothing for what is neither a plain file nor a folder: it can be read and written at once.
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
            origin: files::origin(path),
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

/// The folder that a path lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
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
