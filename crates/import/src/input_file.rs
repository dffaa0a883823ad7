//! A file that a user names, opened once however often its content is read.
//!
//! Files are recognised by their first bytes, and some are read again for the number of a line. A
//! pipe (`/dev/stdin`, `<(...)`, a named pipe) gives its bytes only once, so its content is copied
//! to a temporary file first. Messages and comments have the path that the user gave.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use tempfile::{NamedTempFile, TempPath};
use vertifleet_core::{Error as CoreError, Stop};

use crate::Error;

/// Bytes that are copied at once.
const BLOCK: usize = 1 << 20;

/// A file that can be read several times.
pub(crate) struct InputFile<'a> {
    /// The path that the user gave.
    path: &'a Path,
    /// The content, if the path leads to no plain file.
    copy: Option<TempPath>,
}

impl<'a> InputFile<'a> {
    /// Copies what is no plain file, up to `longest` bytes and one more.
    pub(crate) fn open(path: &'a Path, longest: u64, stop: &Stop) -> Result<Self, Error> {
        let mut file = Self { path, copy: None };
        let kind = fs::metadata(path).map_err(|cause| file.cannot_read(cause))?.file_type();
        if !kind.is_file() && !kind.is_dir() {
            let pipe = File::open(path).map_err(|cause| file.cannot_read(cause))?;
            file.copy = Some(copied(&mut pipe.take(longest.saturating_add(1)), &file, stop)?);
        }
        Ok(file)
    }

    /// The path that the user gave.
    pub(crate) fn path(&self) -> &'a Path {
        self.path
    }

    /// The name of the file in messages.
    pub(crate) fn origin(&self) -> String {
        self.path.display().to_string()
    }

    /// The ending of the name in small letters.
    pub(crate) fn extension(&self) -> Option<String> {
        let extension = self.path.extension().map(OsStr::to_ascii_lowercase)?;
        extension.into_string().ok()
    }

    /// Opens the content at its begin.
    pub(crate) fn content(&self) -> Result<File, Error> {
        File::open(self.copy.as_deref().unwrap_or(self.path))
            .map_err(|cause| self.cannot_read(cause))
    }

    /// Length of the content, bytes.
    pub(crate) fn length(&self) -> Result<u64, Error> {
        let length = self.content()?.metadata().map(|about| about.len());
        length.map_err(|cause| self.cannot_read(cause))
    }

    /// The first `most` bytes of the content, at most.
    pub(crate) fn opening(&self, most: u64) -> Result<Vec<u8>, Error> {
        let mut opening = Vec::new();
        let read = self.content()?.take(most).read_to_end(&mut opening);
        read.map_err(|cause| self.cannot_read(cause))?;
        Ok(opening)
    }

    /// The error that the operating system does not let the file be read.
    pub(crate) fn cannot_read(&self, cause: io::Error) -> Error {
        CoreError::CannotRead { origin: self.origin(), cause }.into()
    }
}

/// Copies a pipe to a temporary file, which is removed when it is dropped.
fn copied(pipe: &mut dyn Read, file: &InputFile<'_>, stop: &Stop) -> Result<TempPath, Error> {
    let cannot = |cause| file.cannot_read(cause);
    let mut copy = NamedTempFile::new().map_err(cannot)?;
    let mut block = vec![0; BLOCK];
    loop {
        stop.check()?;
        match pipe.read(&mut block) {
            Ok(0) => return Ok(copy.into_temp_path()),
            Ok(read) => copy.write_all(&block[..read]).map_err(cannot)?,
            Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
            Err(cause) => return Err(cannot(cause)),
        }
    }
}
