//! TensorBoard's event file, in which a run can be watched.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::run::Curve;

/// The names of the event files begin with this; TensorBoard looks for `tfevents`.
const PREFIX: &str = "events.out.tfevents.";
/// The names of the event files end with this.
const SUFFIX: &str = ".vertifleet";

/// A TensorBoard event file: records of protocol-buffer messages, each framed by its length and two
/// checksums.
///
/// The format is small and fixed, and the crates that write it depend on a whole protocol-buffer
/// compiler, so the three messages that are needed are written here by hand.
#[derive(Debug)]
pub(crate) struct EventFile {
    file: File,
    path: PathBuf,
}

impl EventFile {
    /// Creates an event file in `folder`, which is created if it does not exist; the file's name
    /// contains the time of its creation. It begins with the existing rows of the run, `so_far`,
    /// and replaces the run's earlier event files: a run that was killed may have written rows that
    /// its checkpoint does not have, and TensorBoard would show them twice.
    ///
    /// # Errors
    /// Returns an error if the file exists already or cannot be written, or if an earlier one
    /// cannot be removed.
    pub(crate) fn create(folder: &Path, unix_seconds: f64, so_far: &Curve) -> Result<Self, Error> {
        vertifleet_core::create_folder(folder)?;
        let path = folder.join(format!("{PREFIX}{unix_seconds:.6}{SUFFIX}"));
        let cannot = |cause| Self::cannot_write(&path, cause);
        let file = File::create_new(&path).map_err(cannot)?;
        let mut events = Self { file, path };
        // The field file_version (3) marks the second version of the format.
        let mut event = wall_time(unix_seconds);
        bytes_field(&mut event, 3, b"brain.Event:2");
        events.record(&event)?;
        for row in 0..so_far.rows().len() {
            let (steps, scalars) = so_far.scalars(row);
            events.append(unix_seconds, steps, &scalars)?;
        }
        events.remove_earlier(folder)?;
        Ok(events)
    }

    /// Removes the other event files of the run from this folder.
    fn remove_earlier(&self, folder: &Path) -> Result<(), Error> {
        let cannot = |cause| Self::cannot_write(folder, cause);
        for entry in fs::read_dir(folder).map_err(cannot)? {
            let path = entry.map_err(cannot)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with(PREFIX) && name.ends_with(SUFFIX) && path != self.path {
                fs::remove_file(&path).map_err(|cause| Self::cannot_write(&path, cause))?;
            }
        }
        Ok(())
    }

    /// Appends the values that were measured when the run had learned from `step` decisions.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub(crate) fn append(
        &mut self,
        unix_seconds: f64,
        steps: u64,
        scalars: &[(String, f64)],
    ) -> Result<(), Error> {
        let mut summary = Vec::new();
        for (tag, value) in scalars {
            // A Summary.Value has the fields tag (1) and simple_value (2, 32-bit).
            let mut scalar = Vec::new();
            bytes_field(&mut scalar, 1, tag.as_bytes());
            scalar.push(2 << 3 | 5);
            scalar.extend((*value as f32).to_le_bytes());
            bytes_field(&mut summary, 1, &scalar);
        }
        let mut event = wall_time(unix_seconds);
        event.push(2 << 3);
        varint(&mut event, steps);
        bytes_field(&mut event, 5, &summary);
        self.record(&event)
    }

    fn record(&mut self, event: &[u8]) -> Result<(), Error> {
        let length = (event.len() as u64).to_le_bytes();
        let mut record = Vec::with_capacity(event.len() + 16);
        record.extend(length);
        record.extend(masked_checksum(&length).to_le_bytes());
        record.extend(event);
        record.extend(masked_checksum(event).to_le_bytes());
        let written = self.file.write_all(&record).and_then(|()| self.file.flush());
        written.map_err(|cause| Self::cannot_write(&self.path, cause))
    }

    fn cannot_write(path: &Path, cause: io::Error) -> Error {
        vertifleet_core::Error::CannotWrite { origin: path.display().to_string(), cause }.into()
    }
}

/// The start of an Event message: its field wall_time (1, 64-bit).
fn wall_time(unix_seconds: f64) -> Vec<u8> {
    let mut event = vec![1 << 3 | 1];
    event.extend(unix_seconds.to_le_bytes());
    event
}

fn bytes_field(message: &mut Vec<u8>, field: u8, bytes: &[u8]) {
    message.push(field << 3 | 2);
    varint(message, bytes.len() as u64);
    message.extend(bytes);
}

fn varint(message: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        message.push((value & 0x7f) as u8 | 0x80);
        value >>= 7;
    }
    message.push(value as u8);
}

/// CRC-32C, rotated and offset so that checksums of data that contains checksums stay useful.
fn masked_checksum(bytes: &[u8]) -> u32 {
    crc32c::crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{EventFile, masked_checksum};
    use crate::ppo::PpoRow;
    use crate::run::Curve;

    fn of(rows: &[u64]) -> Curve {
        let rows = rows.iter().map(|&steps| PpoRow { steps, ..PpoRow::default() });
        Curve::of(&rows.collect::<Vec<_>>())
    }

    #[test]
    fn events_are_framed_by_length_and_checksums() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut events =
            EventFile::create(folder.path(), 1_700_000_000.0, &of(&[])).expect("a file");
        let row = PpoRow { mean_reward: Some(0.03125), ..PpoRow::default() };
        let (_, scalars) = Curve::of(&[row]).scalars(0);
        events.append(1_700_000_001.5, 300, &scalars).expect("a file");
        let path = folder.path().join("events.out.tfevents.1700000000.000000.vertifleet");
        let records = records(&path);
        assert_eq!(records.len(), 2);
        assert!(records[0].ends_with(b"brain.Event:2"));
        let has = |part: &[u8]| records[1].windows(part.len()).any(|window| window == part);
        assert!(has(b"rollout/ep_rew_mean") && has(&0.03125_f32.to_le_bytes()));
        assert!(!has(b"eval/mean_reward"), "what was not measured is not written");
    }

    #[test]
    fn a_killed_and_resumed_run_logs_each_step_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut killed =
            EventFile::create(folder.path(), 1_700_000_000.0, &of(&[])).expect("a file");
        for steps in 1..=5 {
            killed.append(1_700_000_001.0, steps, &[]).expect("a file");
        }
        std::fs::write(folder.path().join("notes.txt"), "not ours").expect("a file");

        let kept = of(&[1, 2, 3]);
        let mut resumed = EventFile::create(folder.path(), 1_700_000_009.0, &kept).expect("a file");
        resumed.append(1_700_000_010.0, 4, &[]).expect("a file");
        let files = std::fs::read_dir(folder.path()).expect("a folder");
        let files = files.map(|file| file.expect("a file").path());
        let (events, others): (Vec<_>, Vec<_>) =
            files.partition(|file| file.to_string_lossy().contains("tfevents"));
        let steps: Vec<u8> =
            events.iter().flat_map(|file| records(file)).filter_map(|event| step(&event)).collect();
        assert_eq!((steps.as_slice(), others.len()), (&[1, 2, 3, 4][..], 1));
    }

    /// The step of an event, which must be below 128: one byte after the time, preceded by its
    /// field's number.
    fn step(event: &[u8]) -> Option<u8> {
        (event[9] == 2 << 3).then(|| event[10])
    }

    /// The events of a file, after a check of their frames.
    fn records(path: &Path) -> Vec<Vec<u8>> {
        let bytes = std::fs::read(path).expect("the file");
        let mut records = Vec::new();
        let mut rest = bytes.as_slice();
        while !rest.is_empty() {
            let (length, after) = rest.split_at(8);
            let (length_sum, after) = after.split_at(4);
            assert_eq!(length_sum, masked_checksum(length).to_le_bytes());
            let length = u64::from_le_bytes(length.try_into().expect("eight bytes"));
            let (event, after) = after.split_at(usize::try_from(length).expect("a short record"));
            let (event_sum, after) = after.split_at(4);
            assert_eq!(event_sum, masked_checksum(event).to_le_bytes());
            records.push(event.to_vec());
            rest = after;
        }
        records
    }

    #[test]
    fn the_checksum_is_that_of_the_format() {
        // The CRC-32C of nine digits is 0xe3069283 (RFC 3720, appendix B.4 gives the polynomial);
        // it is masked as in TFRecord.
        assert_eq!(
            masked_checksum(b"123456789"),
            0xe306_9283_u32.rotate_right(15).wrapping_add(0xa282_ead8)
        );
    }
}
