//! CSV: one row a flight or hold, for spreadsheets.
//!
//! The text is UTF-8, with a comma between values and a point in numbers. Numbers have the fewest
//! digits that read back as the same number, so that sums over the table are those of the trace.
//! Ids stand as they are in the scenario, in quotes where they need them; a spreadsheet takes an id
//! that begins with `=` for a formula.

use crate::columns::{Column, Values, columns};
use crate::flown::Taken;
use crate::{Calendar, Flown};

/// Every decision of the day as a CSV file with a header. With a calendar, the times stand there as
/// instants too.
pub fn csv(flown: &Flown<'_>, calendar: Option<&Calendar>) -> Vec<u8> {
    let columns: Vec<&Column> = columns(calendar.is_some()).collect();
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |fields: Vec<String>| {
        csv.write_record(fields)
            .expect("memory takes every byte, and rows are as wide as the header");
    };
    write(columns.iter().map(|column| column.name.to_owned()).collect());
    for taken in flown.decisions() {
        write(columns.iter().map(|column| field(column.values, &taken, calendar)).collect());
    }
    csv.into_inner().expect("memory takes every byte")
}

fn field(values: Values, taken: &Taken<'_>, calendar: Option<&Calendar>) -> String {
    match values {
        Values::Text(value) => value(taken).to_owned(),
        Values::Clock(value) => value(taken).to_string(),
        Values::Seconds(value) => value(taken).seconds().to_string(),
        Values::Instant(value) => {
            calendar.map(|calendar| calendar.instant(value(taken)).to_string()).unwrap_or_default()
        }
        Values::Count(value) => value(taken).to_string(),
        // `{}` writes an `f64` in the fewest digits that read back as the same number.
        Values::Number(value) => value(taken).to_string(),
        Values::Degrees(value) => {
            value(taken).map(|degrees| degrees.to_string()).unwrap_or_default()
        }
    }
}
