//! Expected errors of exports, V721 to V725. The error index is written from the comments here.

use vertifleet_core::{Code, Coded, Exit};

/// An error in the data to be exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// V721 vertiport without latitude and longitude. GeoJSON and GTFS place vertiports on the
    /// globe, and a vertiport of the day has a position in miles only.
    ///
    /// Fix: give every vertiport of the network `latitude` and `longitude`, or export CSV, Parquet
    /// or iCalendar, which do not need them.
    #[error(
        "day {day:?}: vertiport {vertiport:?} must have latitude and longitude for {format}, found a position in miles only"
    )]
    NoDegrees {
        /// Name of the day.
        day: String,
        /// The first vertiport without a place on the globe.
        vertiport: String,
        /// The format that needs one.
        format: &'static str,
    },

    /// V722 not a date. The date of the day is not a date, is written in another way, or lies
    /// outside the years 1970 to 2199.
    ///
    /// Fix: write year, month and day with dashes: `2026-11-24`.
    #[error("date must be {rule}, found {found:?}")]
    BadDate {
        /// How a date is written.
        rule: &'static str,
        /// The text found, cut short if it is long.
        found: String,
    },

    /// V723 unknown time zone. No time zone of the IANA database has this name.
    ///
    /// Fix: name the zone by area and city, for example `America/New_York`, or write `UTC`.
    #[error("time zone must be a name of the IANA time zone database, found {found:?}")]
    UnknownZone {
        /// The name found, cut short if it is long.
        found: String,
    },

    /// V724 row of another day. A row of the trace refers to an aircraft or a vertiport that the
    /// day does not have.
    ///
    /// Fix: export a trace with the scenario that it was made from.
    #[error(
        "day {day:?}: row {row}: {member} is entry {entry} of the {list}, found {found} of them"
    )]
    UnknownEntry {
        /// Name of the day.
        day: String,
        /// The row, from 1.
        row: usize,
        /// The member of the row.
        member: &'static str,
        /// The entry that it refers to, from 1.
        entry: usize,
        /// The list that has no such entry.
        list: &'static str,
        /// Number of the list's entries.
        found: usize,
    },

    /// V725 row with a value that no played day has. A row arrives before it departs, has a time
    /// past 9999:59:59, or an amount that is not finite.
    ///
    /// Fix: let `vertifleet check` judge the trace. It names the rule that is broken.
    #[error("day {day:?}: row {row}: {member} must be {rule}, found {found}")]
    WrongValue {
        /// Name of the day.
        day: String,
        /// The row, from 1.
        row: usize,
        /// The member of the row.
        member: &'static str,
        /// The rule that the value breaks.
        rule: String,
        /// The value.
        found: String,
    },
}

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::NoDegrees { .. } => 721,
            Self::BadDate { .. } => 722,
            Self::UnknownZone { .. } => 723,
            Self::UnknownEntry { .. } => 724,
            Self::WrongValue { .. } => 725,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::NoDegrees { .. } => {
                Some("CSV, Parquet and iCalendar do without latitude and longitude")
            }
            Self::UnknownZone { .. } => {
                Some("names are an area and a city, such as America/New_York")
            }
            Self::UnknownEntry { .. } => {
                Some("a trace belongs to the scenario that it was made from")
            }
            Self::BadDate { .. } | Self::WrongValue { .. } => None,
        }
    }

    fn exit(&self) -> Exit {
        Exit::Input
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Coded;

    use vertifleet_core::Code;

    use super::Error;

    #[test]
    fn every_error_has_a_code_with_a_title() {
        let (day, vertiport) = ("day".to_owned(), "V1".to_owned());
        let found = "found".to_owned();
        let rule = "finite".to_owned();
        let errors = [
            Error::NoDegrees { day: day.clone(), vertiport, format: "GeoJSON" },
            Error::BadDate { rule: "a date", found: found.clone() },
            Error::UnknownZone { found: found.clone() },
            Error::UnknownEntry {
                day: day.clone(),
                row: 1,
                member: "to",
                entry: 3,
                list: "vertiports",
                found: 2,
            },
            Error::WrongValue { day, row: 1, member: "revenue", rule, found },
        ];
        let codes: Vec<_> = errors.iter().map(Coded::code).collect();
        assert_eq!(codes, (721..=725).map(Code).collect::<Vec<_>>());
    }
}
