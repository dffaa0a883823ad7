//! Trip records of Parquet files, row group by row group. The row groups of all files are read by
//! all threads.

use std::ops::Range;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::Reading;
use super::blocks::{record, slot_columns};
use super::columns::Layout;
use super::signs::{Position, RowText};
use crate::Error;
use crate::input_file::InputFile;
use crate::parquet_file::{ParquetFile, Wanted};
use crate::parquet_meaning::Values;
use crate::zones::Zones;

/// Rows after which a reader reports how far it has come.
const STRETCH: u64 = 100_000;

/// The most parts into which a file is cut. Each part opens the file again and reads the
/// description of all its row groups, of which there may be thousands.
const MOST_PARTS: usize = 64;

/// Consecutive row groups of a file.
struct Part<'a> {
    file: &'a InputFile<'a>,
    /// The number of the file.
    number: usize,
    groups: Range<usize>,
    /// Number of rows in the groups before.
    rows_before: u64,
    layout: Layout,
    zones: &'a Zones,
    /// Bytes of the file for each of its rows.
    bytes_per_row: f64,
}

/// Adds all records of all files, each with its number.
pub(super) fn read(files: &[(usize, &InputFile<'_>)], reading: &Reading<'_>) -> Result<(), Error> {
    let mut parts = Vec::new();
    for &(number, input) in files {
        let (file, length) = open(input)?;
        let origin = input.origin();
        let layout = Layout::find(&reading.trips.columns, file.columns(), &origin)?;
        let zones = reading.zones_for(&layout, &origin)?;
        if let Some(column) = layout.overlooked {
            reading.overlook(&origin, &file.columns()[column]);
        }
        file.check(&wanted(&layout, reading))?;
        let rows_of = |groups: Range<usize>| {
            groups.map(|group| file.group_rows(group)).fold(0, u64::saturating_add)
        };
        let bytes_per_row = length as f64 / rows_of(0..file.groups()).max(1) as f64;
        let groups_a_part = file.groups().div_ceil(MOST_PARTS).max(1);
        let mut rows_before = 0_u64;
        for begin in (0..file.groups()).step_by(groups_a_part) {
            let groups = begin..(begin + groups_a_part).min(file.groups());
            let rows = rows_of(groups.clone());
            parts.push(Part {
                file: input,
                number,
                groups,
                rows_before,
                layout,
                zones,
                bytes_per_row,
            });
            rows_before = rows_before.saturating_add(rows);
        }
    }
    parts.par_iter().try_for_each(|part| part.add(reading))
}

/// Opens a file and returns its length too. Each thread opens its own files, because handles of one
/// opening share the position at which they read.
fn open(file: &InputFile<'_>) -> Result<(ParquetFile, u64), Error> {
    Ok((ParquetFile::open(file.content()?, &file.origin())?, file.length()?))
}

fn wanted(layout: &Layout, reading: &Reading<'_>) -> [Option<Wanted>; 6] {
    let mut slot = 0;
    let moments = !reading.tallies.rules.times.are_numbers();
    slot_columns(layout).map(|column| {
        slot += 1;
        let values = if slot == 1 && moments { Values::Moments } else { Values::Plain };
        column.map(|column| Wanted { column, values })
    })
}

impl Part<'_> {
    fn add(&self, reading: &Reading<'_>) -> Result<(), Error> {
        let (file, _) = open(self.file)?;
        reading.tallies.with(|tally, rules| {
            let mut rows = 0_u64;
            let pause = || Ok(reading.stop.check()?);
            let wanted = wanted(&self.layout, reading);
            for group in self.groups.clone() {
                file.rows(group, &wanted, &pause, &mut |cells| {
                    let at = self.rows_before.saturating_add(rows);
                    let position = Position { file: self.number, at };
                    let row = (position, RowText::Cells(cells));
                    tally.add(&record(cells, &self.layout, self.zones, row), rules);
                    rows += 1;
                    if rows.is_multiple_of(STRETCH) {
                        reading.progress.add(self.bytes(STRETCH));
                    }
                    Ok(())
                })?;
            }
            reading.progress.add(self.bytes(rows % STRETCH));
            Ok(())
        })
    }

    /// The bytes that this number of rows stands for.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "for the display of progress only, and casts saturate"
    )]
    fn bytes(&self, rows: u64) -> u64 {
        (self.bytes_per_row * rows as f64) as u64
    }
}
