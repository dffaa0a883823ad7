//! The learning curve: one row an update, as CSV for people and as TensorBoard events for those who watch.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::Error;

/// One update of a training run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CurveRow {
    /// Updates done.
    pub update: u64,
    /// Decisions learned from.
    pub steps: u64,
    /// Days finished.
    pub days: u64,
    /// Mean reward of the last 100 days finished, choices drawn from the policy; none before the first day is over.
    pub mean_reward: Option<f64>,
    /// Mean reward on the validation days, best choices only, where it was measured after this update.
    pub validation_reward: Option<f64>,
    /// Mean clipped surrogate loss of the last epoch.
    pub policy_loss: f64,
    /// Mean squared error of the values in the last epoch, in scaled rewards.
    pub value_loss: f64,
    /// Mean entropy of the policy in the last epoch, nats.
    pub entropy: f64,
    /// Mean of the divergence estimate in the last epoch.
    pub approx_kl: f64,
    /// Share of clipped decisions in the last epoch.
    pub clip_fraction: f64,
    /// Adam's step size.
    pub learning_rate: f64,
}

/// A curve as a CSV text, one column a member of its rows.
///
/// # Panics
/// Never, for rows of numbers.
pub fn to_csv(rows: &[impl Serialize]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("rows of numbers go into memory");
    }
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("numbers are text")
}

/// Reads a curve's CSV text; `origin` names it in errors.
///
/// # Errors
/// [`Error::BadCurve`] for the first row that is not one.
pub(crate) fn from_csv<Row: DeserializeOwned>(text: &str, origin: &str) -> Result<Vec<Row>, Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.deserialize().collect::<Result<_, csv::Error>>();
    rows.map_err(|error| Error::BadCurve {
        origin: origin.to_owned(),
        line: error.position().map_or(1, csv::Position::line),
        rule: error.to_string(),
    })
}

/// How the names of our event files begin; TensorBoard looks for `tfevents`.
const PREFIX: &str = "events.out.tfevents.";
/// How they end.
const SUFFIX: &str = ".vertifleet";

/// A TensorBoard event file: records of protocol-buffer messages, each framed by its length and two checksums.
///
/// The format is small and fixed, and the crates that write it bring a whole protocol-buffer compiler along, so the
/// three messages that are needed are written here by hand.
#[derive(Debug)]
pub struct EventFile {
    file: File,
    path: PathBuf,
}

impl EventFile {
    /// A new event file in `folder`, which is made if it is not there; named after the time it was begun. It begins
    /// with the updates that are behind the run, `so_far`, and takes the place of the run's earlier event files: one that
    /// was killed may have told of updates which its checkpoint knows nothing of, and TensorBoard would show them twice.
    ///
    /// # Errors
    /// If the file is there already or cannot be written, or an earlier one cannot be removed.
    pub fn create(folder: &Path, unix_seconds: f64, so_far: &[CurveRow]) -> Result<Self, Error> {
        vertifleet_core::create_folder(folder)?;
        let path = folder.join(format!("{PREFIX}{unix_seconds:.6}{SUFFIX}"));
        let cannot = |cause| Self::cannot_write(&path, cause);
        let file = File::create_new(&path).map_err(cannot)?;
        let mut events = Self { file, path };
        // file_version (field 3) marks the second version of the format.
        let mut event = wall_time(unix_seconds);
        bytes_field(&mut event, 3, b"brain.Event:2");
        events.record(&event)?;
        for row in so_far {
            events.append(unix_seconds, row, None)?;
        }
        events.remove_earlier(folder)?;
        Ok(events)
    }

    /// Removes the other event files that a run left in this folder.
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

    /// Appends one update; `steps_per_second` is how fast it went, where that is known.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn append(
        &mut self,
        unix_seconds: f64,
        row: &CurveRow,
        steps_per_second: Option<f64>,
    ) -> Result<(), Error> {
        let scalars = [
            ("rollout/ep_rew_mean", row.mean_reward),
            ("eval/mean_reward", row.validation_reward),
            ("train/policy_gradient_loss", Some(row.policy_loss)),
            ("train/value_loss", Some(row.value_loss)),
            ("train/entropy", Some(row.entropy)),
            ("train/approx_kl", Some(row.approx_kl)),
            ("train/clip_fraction", Some(row.clip_fraction)),
            ("train/learning_rate", Some(row.learning_rate)),
            ("time/fps", steps_per_second),
        ];
        let mut summary = Vec::new();
        for (tag, value) in scalars.into_iter().filter_map(|(tag, value)| Some((tag, value?))) {
            // Summary.Value: tag (1), simple_value (2, 32-bit).
            let mut scalar = Vec::new();
            bytes_field(&mut scalar, 1, tag.as_bytes());
            scalar.push(2 << 3 | 5);
            scalar.extend((value as f32).to_le_bytes());
            bytes_field(&mut summary, 1, &scalar);
        }
        let mut event = wall_time(unix_seconds);
        event.push(2 << 3);
        varint(&mut event, row.steps);
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

/// An Event with its wall_time (field 1, 64-bit).
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

/// CRC-32C, rotated and offset so that checksums of checksums stay useful.
fn masked_checksum(bytes: &[u8]) -> u32 {
    crc32c::crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{CurveRow, EventFile, from_csv, masked_checksum, to_csv};

    fn row() -> CurveRow {
        CurveRow {
            update: 3,
            steps: 300,
            mean_reward: Some(0.03125),
            entropy: 1.5,
            ..CurveRow::default()
        }
    }

    #[test]
    fn a_curve_reads_as_it_was_written() {
        let rows = [CurveRow::default(), row()];
        assert_eq!(from_csv::<CurveRow>(&to_csv(&rows), "curve").expect("a curve"), rows);
        let error = from_csv::<CurveRow>("update,steps\n1,x\n", "curve").expect_err("no curve");
        assert_eq!(error.code().to_string(), "V308");
    }

    #[test]
    fn events_are_framed_by_length_and_checksums() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut events = EventFile::create(folder.path(), 1_700_000_000.0, &[]).expect("a file");
        events.append(1_700_000_001.5, &row(), Some(1234.0)).expect("a file");
        let path = folder.path().join("events.out.tfevents.1700000000.000000.vertifleet");
        let records = records(&path);
        assert_eq!(records.len(), 2);
        assert!(records[0].ends_with(b"brain.Event:2"));
        let has = |part: &[u8]| records[1].windows(part.len()).any(|window| window == part);
        assert!(has(b"rollout/ep_rew_mean") && has(&0.03125_f32.to_le_bytes()));
        assert!(!has(b"eval/mean_reward"), "what was not measured is not written");
    }

    #[test]
    fn a_run_that_was_killed_and_goes_on_tells_of_each_step_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let row = |update| CurveRow { update, steps: update, ..CurveRow::default() };
        let mut killed = EventFile::create(folder.path(), 1_700_000_000.0, &[]).expect("a file");
        for update in 1..=5 {
            killed.append(1_700_000_001.0, &row(update), Some(1234.0)).expect("a file");
        }
        std::fs::write(folder.path().join("notes.txt"), "not ours").expect("a file");

        let kept = [row(1), row(2), row(3)];
        let mut resumed = EventFile::create(folder.path(), 1_700_000_009.0, &kept).expect("a file");
        resumed.append(1_700_000_010.0, &row(4), Some(1234.0)).expect("a file");
        let files = std::fs::read_dir(folder.path()).expect("a folder");
        let files = files.map(|file| file.expect("a file").path());
        let (events, others): (Vec<_>, Vec<_>) =
            files.partition(|file| file.to_string_lossy().contains("tfevents"));
        let steps: Vec<u8> =
            events.iter().flat_map(|file| records(file)).filter_map(|event| step(&event)).collect();
        assert_eq!((steps.as_slice(), others.len()), (&[1, 2, 3, 4][..], 1));
    }

    /// The step of an event, below 128: a byte that stands, with its field's number before it, behind the time.
    fn step(event: &[u8]) -> Option<u8> {
        (event[9] == 2 << 3).then(|| event[10])
    }

    /// The events of a file, after checking their frames.
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
        // CRC-32C of nine digits is 0xe3069283 (RFC 3720, appendix B.4 gives the polynomial); masked as TFRecord does.
        assert_eq!(
            masked_checksum(b"123456789"),
            0xe306_9283_u32.rotate_right(15).wrapping_add(0xa282_ead8)
        );
    }
}
