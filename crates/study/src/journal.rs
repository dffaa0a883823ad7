//! The journal of a study: the parts that are finished, so that a study that ends early goes on
//! where it was.
//!
//! A journal begins with a line that says which study it belongs to. Each finished part is a
//! further line, which is on the disk before the next part of the same thread begins. A process
//! that is killed leaves at most one line that is not whole; it is cut off when the journal is
//! opened again.

use std::fs::{self, File, OpenOptions};
use std::hash::Hasher;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use siphasher::sip128::{Hasher128, SipHasher13};
use vertifleet_core::write_atomically;

use crate::error::Error;

/// The first line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Head {
    /// The format of the journal, with its version.
    pub(crate) format: String,
    /// The fingerprint of the study.
    pub(crate) study: String,
}

/// Makes the folder of a study, if it is not there.
///
/// # Errors
/// Returns [`Error::CannotMakeFolder`].
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    let cannot = |cause| Error::CannotMakeFolder { path: folder.to_owned(), cause };
    fs::create_dir_all(folder).map_err(cannot)
}

/// The fingerprint of a study: a number that changes when anything changes that `depends_on` names.
pub(crate) fn fingerprint(depends_on: &serde_json::Value) -> String {
    let mut hasher = SipHasher13::new();
    hasher.write(depends_on.to_string().as_bytes());
    format!("{:032x}", hasher.finish128().as_u128())
}

/// A journal that is being written.
pub(crate) struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

impl Journal {
    /// Opens the journal at `path`, and returns the parts that it holds, up to the first that
    /// `is_new` refuses. With `fresh`, a journal with another head is replaced.
    pub(crate) fn open<Part: DeserializeOwned>(
        path: &Path,
        head: &Head,
        fresh: bool,
        is_new: impl FnMut(&Part) -> bool,
    ) -> Result<(Self, Vec<Part>), Error> {
        let text = match fs::read_to_string(path) {
            Ok(text) if !text.is_empty() => text,
            Ok(_) => return Ok((Self::begin(path, head)?, Vec::new())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok((Self::begin(path, head)?, Vec::new()));
            }
            // What a power cut leaves at the end need not be text.
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                let bytes = fs::read(path).map_err(|cause| cannot_read(path, cause))?;
                String::from_utf8_lossy(&bytes).into_owned()
            }
            Err(cause) => return Err(cannot_read(path, cause)),
        };
        let found =
            text.split_inclusive('\n').next().and_then(|line| serde_json::from_str(line).ok());
        if found.as_ref() != Some(head) {
            if fresh {
                return Ok((Self::begin(path, head)?, Vec::new()));
            }
            return Err(Error::OtherStudy { path: path.to_owned() });
        }
        let (parts, length) = whole_lines(&text, is_new);
        let file = OpenOptions::new().append(true).open(path);
        let file = file.map_err(|cause| cannot_write(path, cause))?;
        // Everything before `length` is text that was read as it is, so the length in bytes is the
        // same.
        file.set_len(length as u64).map_err(|cause| cannot_write(path, cause))?;
        Ok((Self { path: path.to_owned(), file: Mutex::new(file) }, parts))
    }

    fn begin(path: &Path, head: &Head) -> Result<Self, Error> {
        write_atomically(path, line(head).as_bytes())?;
        let file = OpenOptions::new().append(true).open(path);
        let file = Mutex::new(file.map_err(|cause| cannot_write(path, cause))?);
        Ok(Self { path: path.to_owned(), file })
    }

    /// Adds a part. It is on the disk when this returns.
    pub(crate) fn add(&self, part: &impl Serialize) -> Result<(), Error> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let written = file.write_all(line(part).as_bytes()).and_then(|()| file.sync_data());
        written.map_err(|cause| cannot_write(&self.path, cause))
    }
}

/// The text of a journal that holds these parts.
pub(crate) fn text<Part: Serialize>(head: &Head, parts: &[Part]) -> String {
    parts.iter().fold(line(head), |text, part| text + &line(part))
}

/// The parts of whole lines behind the first, and the length of the text up to there.
fn whole_lines<Part: DeserializeOwned>(
    text: &str,
    mut is_new: impl FnMut(&Part) -> bool,
) -> (Vec<Part>, usize) {
    let mut parts = Vec::new();
    let mut lines = text.split_inclusive('\n');
    let mut length = lines.next().map_or(0, str::len);
    for line in lines.take_while(|line| line.ends_with('\n')) {
        let Ok(part) = serde_json::from_str::<Part>(line) else { break };
        if !is_new(&part) {
            break;
        }
        length += line.len();
        parts.push(part);
    }
    (parts, length)
}

fn line(content: &impl Serialize) -> String {
    serde_json::to_string(content).expect("plain data") + "\n"
}

fn cannot_read(path: &Path, cause: io::Error) -> Error {
    Error::Core(vertifleet_core::Error::CannotRead { origin: path.display().to_string(), cause })
}

fn cannot_write(path: &Path, cause: io::Error) -> Error {
    Error::Core(vertifleet_core::Error::CannotWrite { origin: path.display().to_string(), cause })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use proptest::prelude::{prop_assert, prop_assert_eq, proptest};
    use vertifleet_core::Coded;
    use vertifleet_sim::DayTotals;

    use super::{Head, Journal};
    use crate::error::Error;
    use crate::sweep::CellRecord;

    const NAME: &str = "cells.jsonl";

    fn record(cell: usize) -> CellRecord {
        let day = DayTotals { profit_usd: 0.1 + cell as f64 / 3.0, ..DayTotals::default() };
        CellRecord {
            cell,
            upper_bounds_usd: vec![1.0 / 7.0],
            totals: vec![vec![day]],
            decision_ns: Vec::new(),
        }
    }

    fn open(folder: &Path, study: &str, fresh: bool) -> Result<(Journal, Vec<CellRecord>), Error> {
        let head = Head { format: "a format/1".to_owned(), study: study.to_owned() };
        let mut known = BTreeSet::new();
        Journal::open(&folder.join(NAME), &head, fresh, |record: &CellRecord| {
            known.insert(record.cell)
        })
    }

    #[test]
    fn a_journal_of_another_study_is_refused_and_replaced_on_request() {
        let folder = tempfile::tempdir().expect("a folder");
        let (journal, _) = open(folder.path(), "abc", false).expect("a journal");
        journal.add(&record(3)).expect("room");
        let other = open(folder.path(), "xyz", false).err().expect("another study");
        assert_eq!(other.code().to_string(), "V414");
        let (_, records) = open(folder.path(), "xyz", true).expect("a fresh journal");
        assert!(records.is_empty());
    }

    proptest! {
        /// Whatever part of the last line a killed process has written, all parts before it are
        /// there, bit for bit.
        #[test]
        fn parts_before_a_torn_line_are_kept(cells in 1..8_usize, cut: proptest::sample::Index, garbage: Vec<u8>) {
            let folder = tempfile::tempdir().expect("a folder");
            let open = || open(folder.path(), "abc", false).expect("a journal");
            let journal = open().0;
            let path = folder.path().join(NAME);
            let before = fs::read(&path).expect("a head").len();
            let mut ends = vec![before];
            for cell in 0..cells {
                journal.add(&record(cell)).expect("room");
                ends.push(fs::read(&path).expect("it is there").len());
            }
            let bytes = fs::read(&path).expect("it is there");
            let kept = before + cut.index(bytes.len() - before + 1);
            let mut torn = bytes[..kept].to_vec();
            torn.extend(garbage.iter().filter(|&&byte| byte != b'\n'));
            fs::write(&path, &torn).expect("room");
            let whole = ends.iter().filter(|&&end| end <= kept).count() - 1;
            let (journal, records) = open();
            prop_assert_eq!(&records, &(0..whole).map(record).collect::<Vec<_>>());
            journal.add(&record(19)).expect("room");
            let (_, again) = open();
            prop_assert_eq!(again.len(), whole + 1);
            prop_assert!(again[whole] == record(19));
        }
    }
}
