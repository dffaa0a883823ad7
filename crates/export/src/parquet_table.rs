//! Parquet: the columns of the CSV file with types, for data frames and databases.
//!
//! | values | physical type | logical type |
//! |---|---|---|
//! | ids, kinds, clock times | `BYTE_ARRAY` | `STRING` |
//! | passengers, seats, seconds since midnight | `INT32` | |
//! | amounts, distances, energies | `DOUBLE` | |
//! | instants, with a calendar | `INT64` | `TIMESTAMP`, in microseconds UTC |
//! | latitudes and longitudes | `DOUBLE`, optional | |
//!
//! The file's metadata hold the name of the day, and the date and time zone of the calendar.

use vertifleet_core::Time;

use crate::columns::{Values, columns};
use crate::flown::Taken;
use crate::typed_table::{Cells, TypedColumn, typed_table};
use crate::{Calendar, Flown};

/// Every decision of the day as a Parquet file. With a calendar, the times stand there as instants
/// too.
pub fn parquet(flown: &Flown<'_>, calendar: Option<&Calendar>) -> Vec<u8> {
    let taken: Vec<Taken<'_>> = flown.decisions().collect();
    let columns: Vec<TypedColumn> = columns(calendar.is_some())
        .map(|column| TypedColumn::new(column.name, cells(column.values, &taken, calendar)))
        .collect();
    typed_table("decisions", &columns, &metadata(flown, calendar))
}

fn metadata(flown: &Flown<'_>, calendar: Option<&Calendar>) -> Vec<(&'static str, String)> {
    let mut entries = vec![("vertifleet.day", flown.day().name.clone())];
    if let Some(calendar) = calendar {
        entries.push(("vertifleet.date", calendar.date().to_string()));
        entries.push(("vertifleet.time_zone", calendar.zone_name().to_owned()));
    }
    entries
}

fn cells(values: Values, taken: &[Taken<'_>], calendar: Option<&Calendar>) -> Cells {
    let taken = taken.iter();
    match values {
        Values::Text(value) => Cells::Text(taken.map(|taken| value(taken).to_owned()).collect()),
        Values::Clock(value) => Cells::Text(taken.map(|taken| value(taken).to_string()).collect()),
        Values::Seconds(value) => Cells::Short(taken.map(|taken| seconds(value(taken))).collect()),
        Values::Count(value) => Cells::Short(taken.map(|taken| value(taken).into()).collect()),
        Values::Instant(value) => {
            let instant =
                |taken| calendar.map(|calendar| calendar.instant(value(taken)).as_microsecond());
            Cells::Instant(taken.filter_map(instant).collect())
        }
        Values::Number(value) => Cells::Number(taken.map(value).collect()),
        Values::Degrees(value) => Cells::OptionalNumber(taken.map(value).collect()),
    }
}

fn seconds(time: Time) -> i32 {
    i32::try_from(time.seconds()).expect("`Flown` holds no time past 9999:59:59")
}
