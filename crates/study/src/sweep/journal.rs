//! The journal of a sweep: the cells that are finished, so that a sweep that ends early goes on where it was.
//!
//! `cells.jsonl` begins with a line that says which sweep it belongs to. Each finished cell is a further line, which is
//! on the disk before the next cell of the same thread begins. A process that is killed leaves at most one line that is
//! not whole; it is cut off when the journal is opened again.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use vertifleet_core::{OutputKind, write_atomically};

use super::record::CellRecord;
use crate::error::Error;

/// The name of the journal in the folder of a sweep.
pub const JOURNAL: &str = "cells.jsonl";
const FORMAT: &str = "vertifleet-sweep-cells/1";

/// The beginning of every journal, in any version of the format.
pub(super) const KIND: OutputKind =
    OutputKind { name: "sweep", skipped: 0, opening: "{\"format\":\"vertifleet-sweep-cells/" };

/// The first line.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: String,
    /// The fingerprint of the sweep.
    sweep: String,
    cells: usize,
}

/// A journal that is being written.
pub(super) struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

impl Journal {
    /// Opens the journal of a sweep with this fingerprint, and returns the cells that it holds. With `anew`, a journal of
    /// another sweep is replaced.
    pub(super) fn open(
        folder: &Path,
        fingerprint: &str,
        cells: usize,
        anew: bool,
    ) -> Result<(Self, Vec<CellRecord>), Error> {
        let path = folder.join(JOURNAL);
        let head = Head { format: FORMAT.to_owned(), sweep: fingerprint.to_owned(), cells };
        let text = match fs::read_to_string(&path) {
            Ok(text) if !text.is_empty() => text,
            Ok(_) => return Self::begin(path, &head),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Self::begin(path, &head);
            }
            // What a power cut leaves at the end need not be text.
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                let bytes = fs::read(&path).map_err(|cause| cannot_read(&path, cause))?;
                String::from_utf8_lossy(&bytes).into_owned()
            }
            Err(cause) => return Err(cannot_read(&path, cause)),
        };
        let found =
            text.split_inclusive('\n').next().and_then(|line| serde_json::from_str(line).ok());
        if found.as_ref() != Some(&head) {
            if anew {
                return Self::begin(path, &head);
            }
            return Err(Error::OtherSweep { path });
        }
        let (records, length) = whole_lines(&text, cells);
        let file = OpenOptions::new().append(true).open(&path);
        let file = file.map_err(|cause| cannot_write(&path, cause))?;
        // Everything before `length` is text that was read as it is, so the length in bytes is the same.
        file.set_len(length as u64).map_err(|cause| cannot_write(&path, cause))?;
        Ok((Self { path, file: Mutex::new(file) }, records))
    }

    fn begin(path: PathBuf, head: &Head) -> Result<(Self, Vec<CellRecord>), Error> {
        write_atomically(&path, line(head).as_bytes())?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = Mutex::new(file.map_err(|cause| cannot_write(&path, cause))?);
        Ok((Self { path, file }, Vec::new()))
    }

    /// Adds a cell. It is on the disk when this returns.
    pub(super) fn add(&self, record: &CellRecord) -> Result<(), Error> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let written = file.write_all(line(record).as_bytes()).and_then(|()| file.sync_data());
        written.map_err(|cause| cannot_write(&self.path, cause))
    }
}

/// The text of a journal that holds these cells.
pub(super) fn text(fingerprint: &str, cells: usize, records: &[CellRecord]) -> String {
    let head = Head { format: FORMAT.to_owned(), sweep: fingerprint.to_owned(), cells };
    records.iter().fold(line(&head), |text, record| text + &line(record))
}

/// The cells of whole lines behind the first, and the length of the text up to there.
fn whole_lines(text: &str, cells: usize) -> (Vec<CellRecord>, usize) {
    let mut records: Vec<CellRecord> = Vec::new();
    let mut known = vec![false; cells];
    let mut lines = text.split_inclusive('\n');
    let mut length = lines.next().map_or(0, str::len);
    for line in lines.take_while(|line| line.ends_with('\n')) {
        let Ok(record) = serde_json::from_str::<CellRecord>(line) else { break };
        let Some(known) = known.get_mut(record.cell).filter(|known| !**known) else { break };
        *known = true;
        length += line.len();
        records.push(record);
    }
    (records, length)
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
    use std::fs;
    use std::path::Path;

    use proptest::prelude::{prop_assert, prop_assert_eq, proptest};
    use vertifleet_core::Coded;
    use vertifleet_sim::DayTotals;

    use super::{JOURNAL, Journal};
    use crate::sweep::record::CellRecord;

    fn record(cell: usize) -> CellRecord {
        let day = DayTotals { profit_usd: 0.1 + cell as f64 / 3.0, ..DayTotals::default() };
        CellRecord { cell, upper_bounds_usd: vec![1.0 / 7.0], totals: vec![vec![day]] }
    }

    fn open(folder: &Path) -> (Journal, Vec<CellRecord>) {
        Journal::open(folder, "abc", 20, false).expect("a journal")
    }

    #[test]
    fn a_journal_of_another_sweep_is_refused_and_replaced_on_request() {
        let folder = tempfile::tempdir().expect("a folder");
        open(folder.path()).0.add(&record(3)).expect("room");
        let other = Journal::open(folder.path(), "xyz", 20, false).err().expect("another sweep");
        assert_eq!(other.code().to_string(), "V414");
        let (_, records) = Journal::open(folder.path(), "xyz", 20, true).expect("anew");
        assert!(records.is_empty());
    }

    proptest! {
        /// Whatever part of the last line a killed process has written, all cells before it are there, bit for bit.
        #[test]
        fn cells_before_a_torn_line_are_kept(cells in 1..8_usize, cut: proptest::sample::Index, garbage: Vec<u8>) {
            let folder = tempfile::tempdir().expect("a folder");
            let journal = open(folder.path()).0;
            let before = fs::read(folder.path().join(JOURNAL)).expect("a head").len();
            let mut ends = vec![before];
            for cell in 0..cells {
                journal.add(&record(cell)).expect("room");
                ends.push(fs::read(folder.path().join(JOURNAL)).expect("it is there").len());
            }
            let path = folder.path().join(JOURNAL);
            let bytes = fs::read(&path).expect("it is there");
            let kept = before + cut.index(bytes.len() - before + 1);
            let mut torn = bytes[..kept].to_vec();
            torn.extend(garbage.iter().filter(|&&byte| byte != b'\n'));
            fs::write(&path, &torn).expect("room");
            let whole = ends.iter().filter(|&&end| end <= kept).count() - 1;
            let (journal, records) = open(folder.path());
            prop_assert_eq!(&records, &(0..whole).map(record).collect::<Vec<_>>());
            journal.add(&record(19)).expect("room");
            let (_, again) = open(folder.path());
            prop_assert_eq!(again.len(), whole + 1);
            prop_assert!(again[whole] == record(19));
        }
    }
}
