//! Trip records of Parquet files, row group by row group. The row groups of all files are read by all threads.

use std::fs::File;
use std::path::{Path, PathBuf};

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::blocks::{record, slot_columns};
use super::columns::Layout;
use super::{Reading, cannot_read};
use crate::Error;
use crate::parquet_file::{ParquetFile, Wanted};
use crate::zones::Zones;

/// Rows after which a reader reports how far it has come.
const STRETCH: u64 = 100_000;

/// A row group of a file.
struct Group<'a> {
    path: &'a Path,
    number: usize,
    layout: Layout,
    zones: &'a Zones,
    /// Bytes of the file for each of its rows.
    bytes_per_row: f64,
}

/// Adds all records of all files.
pub(super) fn read(paths: &[PathBuf], reading: &Reading<'_>) -> Result<(), Error> {
    let mut groups = Vec::new();
    for path in paths {
        let (file, length) = open(path)?;
        let origin = path.display().to_string();
        let layout = Layout::find(&reading.trips.columns, file.columns(), &origin)?;
        let zones = reading.zones_for(&layout, &origin)?;
        file.check(&wanted(&layout))?;
        let rows: u64 =
            (0..file.groups()).map(|group| file.group_rows(group)).fold(0, u64::saturating_add);
        let bytes_per_row = length as f64 / rows.max(1) as f64;
        groups.extend((0..file.groups()).map(|number| Group {
            path,
            number,
            layout,
            zones,
            bytes_per_row,
        }));
    }
    groups.par_iter().try_for_each(|group| group.add(reading))
}

/// Opens a file and returns its length too. Each thread opens files anew, because handles of one opening share the
/// position at which they read.
fn open(path: &Path) -> Result<(ParquetFile, u64), Error> {
    let cannot = |cause| cannot_read(path, cause);
    let file = File::open(path).map_err(cannot)?;
    let length = file.metadata().map_err(cannot)?.len();
    Ok((ParquetFile::open(file, &path.display().to_string())?, length))
}

fn wanted(layout: &Layout) -> [Option<Wanted>; 6] {
    let mut slot = 0;
    slot_columns(layout).map(|column| {
        slot += 1;
        column.map(|column| Wanted { column, moment: slot == 1 })
    })
}

impl Group<'_> {
    fn add(&self, reading: &Reading<'_>) -> Result<(), Error> {
        let (file, _) = open(self.path)?;
        reading.tallies.with(|tally, rules| {
            let mut rows = 0_u64;
            let pause = || Ok(reading.stop.check()?);
            file.rows(self.number, &wanted(&self.layout), &pause, &mut |cells| {
                tally.add(&record(cells, &self.layout, self.zones), rules);
                rows += 1;
                if rows.is_multiple_of(STRETCH) {
                    reading.progress.add(self.bytes(STRETCH));
                }
                Ok(())
            })?;
            reading.progress.add(self.bytes(rows % STRETCH));
            Ok(())
        })
    }

    /// The bytes that so many rows stand for.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "for the display of progress only, and casts saturate"
    )]
    fn bytes(&self, rows: u64) -> u64 {
        (self.bytes_per_row * rows as f64) as u64
    }
}
