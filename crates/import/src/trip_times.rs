//! The times of trip records, as the clocks of the network show them.
//!
//! A time is read as the file writes it, with its offset from UTC if it has one. A time with an
//! offset is an instant, which is converted to the time zone of the network if the import is given
//! one. A time without is taken as it is.

use std::str::FromStr;

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::fmt::strtime::{self, BrokenDownTime};
use jiff::tz::{TimeZone, TimeZoneDatabase};

use crate::Error;
use crate::cell::Cell;
use crate::date_time::{Moment, Stamp};

/// The forms of times that are read without a format, for messages.
pub(crate) const FORMS: &str = "2015-06-01 07:08:09, also with T in place of the space, without seconds, or with Z, UTC or an offset at its end";

/// How the times of trip records are written, where it is in no form that is read anyway.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeFormat(Format);

#[derive(Debug, Clone, PartialEq)]
enum Format {
    /// A count of this number of units to the second, since 1970 in UTC.
    Epoch { per_second: i64 },
    /// A pattern of `strptime`.
    Pattern(String),
}

/// A text that is no format of times.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected epoch-s, epoch-ms, or a pattern with a date and a time such as '%d/%m/%Y %H:%M' or '%m/%d/%Y %I:%M:%S %p', found {found:?}"
)]
pub struct NotAFormat {
    found: String,
}

impl FromStr for TimeFormat {
    type Err = NotAFormat;

    /// Reads `epoch-s`, `epoch-ms`, or a pattern of `strptime` with which a date and its hour and
    /// minute can be read.
    fn from_str(text: &str) -> Result<Self, NotAFormat> {
        match text {
            "epoch-s" => return Ok(Self(Format::Epoch { per_second: 1 })),
            "epoch-ms" => return Ok(Self(Format::Epoch { per_second: 1_000 })),
            _ => {}
        }
        let format = Self(Format::Pattern(text.to_owned()));
        // A pattern that leaves out a part of the date or the time gives another time back.
        let sample = DateTime::constant(2015, 12, 31, 17, 8, 0, 0);
        let zoned = sample.to_zoned(TimeZone::UTC).ok();
        let written = zoned.and_then(|zoned| strtime::format(text, &zoned).ok());
        let read = written.and_then(|written| format.pattern_stamp(written.as_bytes()));
        let expected = Moment::read(b"2015-12-31 17:08").map(|stamp| stamp.moment);
        if read.map(|stamp| stamp.moment) == expected {
            Ok(format)
        } else {
            Err(NotAFormat { found: text.chars().take(60).collect() })
        }
    }
}

impl TimeFormat {
    /// Whether times are numbers.
    pub(crate) fn is_epoch(&self) -> bool {
        matches!(self.0, Format::Epoch { .. })
    }

    fn stamp(&self, cell: Cell<'_>) -> Option<Stamp> {
        match (&self.0, cell) {
            (_, Cell::Stamp(stamp)) => Some(stamp),
            (Format::Epoch { per_second }, cell) => {
                Stamp::of_utc(cell.whole()?.div_euclid(*per_second))
            }
            (Format::Pattern(_), Cell::Text(text)) => self.pattern_stamp(text),
            (Format::Pattern(_), _) => None,
        }
    }

    fn pattern_stamp(&self, text: &[u8]) -> Option<Stamp> {
        let Format::Pattern(pattern) = &self.0 else { return None };
        let parts = BrokenDownTime::parse(pattern, text).ok()?;
        let offset_s = parts.offset().map(jiff::tz::Offset::seconds);
        let moment = Moment::of_civil(parts.to_datetime().ok()?)?;
        Some(Stamp { moment, offset_s })
    }
}

/// Reads times.
#[derive(Debug)]
pub(crate) struct TripTimes {
    format: Option<TimeFormat>,
    zone: Option<TimeZone>,
}

impl TripTimes {
    /// Times in this format, converted to this zone where they are instants.
    pub(crate) fn new(format: Option<TimeFormat>, zone: Option<TimeZone>) -> Self {
        Self { format, zone }
    }

    /// Whether the column of times must hold numbers.
    pub(crate) fn are_numbers(&self) -> bool {
        self.format.as_ref().is_some_and(TimeFormat::is_epoch)
    }

    /// The time that a cell holds, as the clocks of the network show it, and whether it is an
    /// instant.
    #[inline]
    pub(crate) fn read(&self, cell: Cell<'_>) -> Option<(Moment, bool)> {
        let stamp = match &self.format {
            Some(format) => format.stamp(cell),
            None => cell.stamp(),
        }?;
        match (&self.zone, stamp.offset_s) {
            (_, None) => Some((stamp.moment, false)),
            (None, Some(_)) => Some((stamp.moment, true)),
            (Some(zone), Some(offset_s)) => {
                let utc_s = stamp.moment.seconds() - i64::from(offset_s);
                let offset = zone.to_offset(Timestamp::from_second(utc_s).ok()?);
                Some((Moment::from_seconds(utc_s + i64::from(offset.seconds()))?, true))
            }
        }
    }
}

/// The time zone of a name of the IANA database.
pub(crate) fn zone(name: &str) -> Result<TimeZone, Error> {
    TimeZoneDatabase::bundled().get(name).map_err(|_| Error::Setting {
        setting: "time_zone",
        rule: "a time zone of the IANA database, such as America/New_York or UTC",
        found: name.chars().take(64).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::{TimeFormat, TripTimes, zone};
    use crate::cell::Cell;

    fn read(format: Option<&str>, zone_name: Option<&str>, text: &str) -> Option<(String, bool)> {
        let format = format.map(|format| format.parse().expect("a format"));
        let times = TripTimes::new(format, zone_name.map(|name| zone(name).expect("a zone")));
        let read = times.read(Cell::text(text.as_bytes()));
        read.map(|(moment, instant)| (moment.to_string(), instant))
    }

    #[test]
    fn instants_are_converted_to_the_time_zone_and_other_times_are_taken_as_they_are() {
        let new_york = Some("America/New_York");
        for (text, clock) in [
            ("2015-06-01T11:08:09Z", "2015-06-01 07:08:09"),
            ("2015-06-01 11:08:09 UTC", "2015-06-01 07:08:09"),
            ("2015-06-01 13:08:09+02:00", "2015-06-01 07:08:09"),
            ("2015-06-01 03:08:09.5-0800", "2015-06-01 07:08:09"),
            ("2015-01-01 04:30:00+00", "2014-12-31 23:30:00"),
        ] {
            assert_eq!(read(None, new_york, text), Some((clock.to_owned(), true)), "{text}");
        }
        let plain = "2015-06-01 11:08:09";
        assert_eq!(read(None, new_york, plain), Some((plain.to_owned(), false)));
        let kept = Some(("2015-06-01 11:08:09".to_owned(), true));
        assert_eq!(read(None, None, "2015-06-01T11:08:09Z"), kept);
    }

    #[test]
    fn times_are_read_as_the_format_says() {
        let seven = Some(("2015-06-01 19:08:00".to_owned(), false));
        assert_eq!(read(Some("%d/%m/%Y %H:%M"), None, "01/06/2015 19:08"), seven);
        assert_eq!(read(Some("%m/%d/%Y %I:%M %p"), None, "06/01/2015 07:08 PM"), seven);
        assert_eq!(read(Some("%d/%m/%Y %H:%M"), None, "2015-06-01 19:08"), None);
        let epoch = Some(("2015-06-01 07:08:09".to_owned(), true));
        assert_eq!(read(Some("epoch-s"), Some("America/New_York"), "1433156889"), epoch);
        assert_eq!(read(Some("epoch-ms"), Some("America/New_York"), "1433156889123"), epoch);
        assert_eq!(read(Some("epoch-s"), None, "2015-06-01 07:08:09"), None);
    }

    #[test]
    fn a_format_reads_a_date_with_hour_and_minute() {
        for wrong in ["", "%d/%m/%Y", "%H:%M", "%I:%M %d/%m/%Y", "%d/%m/%y at %Q", "seconds"] {
            assert!(wrong.parse::<TimeFormat>().is_err(), "{wrong}");
        }
        for right in ["%Y%m%d%H%M", "%d.%m.%y %H:%M:%S", "%Y-%m-%dT%H:%M:%S%z"] {
            assert!(right.parse::<TimeFormat>().is_ok(), "{right}");
        }
        assert!(zone("UTC-5").is_err() && zone("Mars/Base").is_err() && zone("Etc/GMT+5").is_ok());
    }
}
