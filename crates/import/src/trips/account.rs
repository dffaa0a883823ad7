//! An account of all trip records: those that were kept, and those that were dropped.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::date_time::Date;

/// How many trip records were read, and what became of them. Each row has exactly one of the
/// reasons, the first that applies in the order in which they stand here.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TripAccount {
    /// The names of the files, without their folders.
    pub files: Vec<String>,
    /// Rows of all files.
    pub rows: u64,
    /// Rows that became demand.
    pub kept: u64,
    /// Rows with more values than the header has columns.
    pub too_many_values: u64,
    /// Rows whose pick-up time cannot be read.
    pub no_time: u64,
    /// Rows without a place or a known zone of pick-up or drop-off.
    pub no_place: u64,
    /// Rows whose number of passengers is not above 0 and at most 100.
    pub no_passengers: u64,
    /// Rows before the first date or after the last one that counts.
    pub other_date: u64,
    /// Rows of days of the week that do not count.
    pub other_weekday: u64,
    /// Rows with a pick-up outside of operations.
    pub outside_operations: u64,
    /// Rows without a vertiport near the pick-up.
    pub far_pickup: u64,
    /// Rows without a vertiport near the drop-off.
    pub far_dropoff: u64,
    /// Rows whose pick-up and drop-off have the same nearest vertiport.
    pub same_vertiport: u64,
    /// Number of days that the demand is averaged over.
    pub days: u32,
    /// The first of these days.
    pub first_date: Option<Date>,
    /// The last of these days.
    pub last_date: Option<Date>,
    /// Passengers of a day on the mean, of all pairs together.
    pub passengers_a_day: f64,
    /// The first row that was dropped for each reason for which any was.
    pub first_dropped: Vec<DroppedRow>,
}

/// A row that was dropped.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DroppedRow {
    /// Why, in words.
    pub reason: &'static str,
    /// The name of its file, without the folder.
    pub file: String,
    /// Its line in a CSV file, or its row in a Parquet file, from 1.
    pub place: String,
    /// Its text, cut short if it is long.
    pub row: String,
}

impl TripAccount {
    /// The reasons for which rows were dropped and the first row of each, a line for each reason.
    pub fn dropped_rows(&self) -> String {
        let mut text = String::new();
        for (reason, rows) in self.dropped().into_iter().filter(|(_, rows)| *rows > 0) {
            let _ = writeln!(text, "{rows} had {reason}");
            for row in self.first_dropped.iter().filter(|row| row.reason == reason) {
                let _ = writeln!(text, "  first: {}, {}: {}", row.file, row.place, row.row);
            }
        }
        text
    }

    /// The reasons for which rows were dropped, in words, with the number of rows.
    pub fn dropped(&self) -> [(&'static str, u64); 10] {
        [
            ("more values than the header has columns", self.too_many_values),
            ("no readable time of pick-up", self.no_time),
            ("no readable place or known zone", self.no_place),
            ("no valid number of passengers", self.no_passengers),
            ("a date that does not count", self.other_date),
            ("a day of the week that does not count", self.other_weekday),
            ("a pick-up outside of operations", self.outside_operations),
            ("no vertiport near the pick-up", self.far_pickup),
            ("no vertiport near the drop-off", self.far_dropoff),
            ("the same vertiport at both ends", self.same_vertiport),
        ]
    }
}

impl fmt::Display for TripAccount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "of {} rows, {} were kept", self.rows, self.kept)?;
        for (reason, rows) in self.dropped().into_iter().filter(|(_, rows)| *rows > 0) {
            write!(f, ", {rows} had {reason}")?;
            if let Some(first) = self.first_dropped.iter().find(|row| row.reason == reason) {
                write!(f, " (first in {}, {})", first.file, first.place)?;
            }
        }
        Ok(())
    }
}
