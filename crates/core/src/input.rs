//! Reads whole files, and never more than a bound.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::paths::origin;
use crate::{Error, FormatError};

/// The longest scenario file that is read. Every scenario that obeys the rules is shorter when
/// written.
pub(crate) const LONGEST_SCENARIO: u64 = 64 << 20;

/// The longest network file that is read. Most of its length is demand by hour and pair.
pub(crate) const LONGEST_NETWORK: u64 = 32 << 20;

/// The longest table of demand that is read.
pub(crate) const LONGEST_TABLE: u64 = 16 << 20;

/// Reads a whole file of at most `longest` bytes.
///
/// # Errors
/// [`Error::CannotRead`] or [`FormatError::FileTooLarge`].
pub fn read_at_most(path: &Path, longest: u64) -> Result<Vec<u8>, Error> {
    let cannot = |cause| Error::CannotRead { origin: origin(path), cause };
    let mut text = Vec::new();
    // One byte more than allowed is read, because a file that is too long must be distinguished
    // from one that just fits, even where the length is not known beforehand (a pipe).
    File::open(path).map_err(cannot)?.take(longest + 1).read_to_end(&mut text).map_err(cannot)?;
    check_length(&text, longest).map_err(|error| error.in_file(&origin(path)))?;
    Ok(text)
}

/// Refuses a text of more than `longest` bytes.
pub(crate) fn check_length(text: &[u8], longest: u64) -> Result<(), FormatError> {
    if text.len() as u64 > longest {
        return Err(FormatError::FileTooLarge { limit: longest });
    }
    Ok(())
}
