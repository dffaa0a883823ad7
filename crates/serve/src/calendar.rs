//! The calendar of a day: its times in clocks of the real world.

use jiff::civil::Date;
use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};
use vertifleet_core::Time;

use crate::error::Error;

/// The years of days, for which time zones are known.
const YEARS: std::ops::RangeInclusive<i16> = 1970..=2199;

/// A date at a place. 00:00:00 of the day is twelve hours before noon of the date. That is midnight
/// except on days on which the clocks change, so every day has its hours in order, as in timetables
/// (GTFS).
#[derive(Debug, Clone)]
pub(crate) struct Calendar {
    zone: TimeZone,
    begin: Timestamp,
}

impl Calendar {
    /// The calendar of a date (`2026-11-23`) in a time zone (`America/New_York`).
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`] if there is no such date or no such time zone.
    pub(crate) fn new(date: &str, time_zone: &str) -> Result<Self, Error> {
        let wrong = |rule: String| Error::BadRequest { rule };
        let no_date =
            || wrong(format!("{date:?} is no date from 1970 to 2199: write it as 2026-11-23"));
        let is_plain = date.len() == 10 && !date.starts_with(['-', '+']);
        let read =
            date.parse::<Date>().ok().filter(|read| is_plain && YEARS.contains(&read.year()));
        let date = read.ok_or_else(no_date)?;
        let zone = TimeZone::get(time_zone).map_err(|_| {
            wrong(format!("{time_zone:?} is no time zone: use a name such as America/New_York"))
        })?;
        let noon = date.at(12, 0, 0, 0).to_zoned(zone.clone());
        let noon = noon.map_err(|error| wrong(error.to_string()))?.timestamp();
        let begin = noon - SignedDuration::from_hours(12);
        Ok(Self { zone, begin })
    }

    /// Today's date in a time zone; `None` if there is no such time zone.
    pub(crate) fn today(time_zone: &str) -> Option<String> {
        let zone = TimeZone::get(time_zone).ok()?;
        Some(Timestamp::now().to_zoned(zone).date().to_string())
    }

    /// The time of the day at an instant in ISO 8601, with its offset
    /// (`2026-11-23T07:10:00-05:00`); whole seconds.
    pub(crate) fn read(&self, text: &str) -> Option<Time> {
        let instant: Timestamp = text.parse().ok()?;
        let seconds = instant.duration_since(self.begin).as_secs();
        u32::try_from(seconds).ok().map(Time::from_seconds)
    }

    /// A time of the day in ISO 8601, with the offset of the place.
    pub(crate) fn write(&self, time: Time) -> String {
        let instant = self.begin + SignedDuration::from_secs(time.seconds().into());
        instant.to_zoned(self.zone.clone()).strftime("%Y-%m-%dT%H:%M:%S%:z").to_string()
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Time;

    use super::Calendar;

    fn calendar(date: &str) -> Calendar {
        Calendar::new(date, "America/New_York").expect("a date in a zone")
    }

    #[test]
    fn times_read_as_they_are_written() {
        let day = calendar("2026-11-23");
        let time = Time::from_seconds(7 * 3600 + 600);
        assert_eq!(day.write(time), "2026-11-23T07:10:00-05:00");
        assert_eq!(day.read("2026-11-23T07:10:00-05:00"), Some(time));
        for other in [
            "2026-11-23T12:10:00Z",
            "2026-11-23t12:10:00z",
            "2026-11-23 12:10:00Z",
            "2026-11-23 07:10:00-05:00",
            "2026-11-23t07:10:00.250-05:00",
        ] {
            assert_eq!(day.read(other), Some(time), "{other}");
        }
        assert_eq!(day.write(Time::from_seconds(25 * 3600)), "2026-11-24T01:00:00-05:00");
    }

    #[test]
    fn on_days_on_which_the_clocks_change_the_hours_of_operation_are_those_of_the_clocks() {
        for date in ["2026-03-08", "2026-11-01"] {
            let shown = calendar(date).write(Time::from_seconds(6 * 3600));
            assert!(shown.contains("T06:00:00-"), "{shown}");
        }
    }

    #[test]
    fn invalid_dates_zones_and_times_before_the_day_are_refused() {
        assert!(Calendar::new("23.11.2026", "America/New_York").is_err());
        assert!(Calendar::new("2026-02-30", "America/New_York").is_err());
        for date in ["9999-12-30", "1969-12-31", "2026-11-23T07:00", "-009999-01-02", "20261123"] {
            assert!(Calendar::new(date, "America/New_York").is_err(), "{date}");
        }
        assert!(Calendar::new("2026-11-23", "Mars/Olympus").is_err());
        assert_eq!(calendar("2026-11-23").read("2026-11-22T23:59:59-05:00"), None);
        assert_eq!(calendar("2026-11-23").read("2026-11-23T07:10:00"), None);
    }
}
