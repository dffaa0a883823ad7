//! The calendar of a day: which instant a time of the day is.
//!
//! The clock of a day runs evenly, and all durations of the day are read off it. So it is not the
//! wall clock on a date on which summer time begins or ends: that clock skips or repeats an hour.
//! As in GTFS and in live days, seconds are counted from twelve hours before noon of the date,
//! which is midnight on every other date. No time of a day falls into a gap or has two meanings,
//! flights last as long as they do in the day, and all formats name the same instants. The clock
//! agrees with the wall clock at noon, hence from the change of the clock on; before it, on such a
//! date, the two differ by the hour that is skipped or repeated.

use std::ops::RangeInclusive;

use jiff::civil::Date;
use jiff::tz::{TimeZone, TimeZoneDatabase};
use jiff::{Timestamp, Zoned};
use vertifleet_core::Time;

use crate::Error;

/// The years of days, which are those of live days too.
const YEARS: RangeInclusive<i16> = 1970..=2199;

/// The date and the time zone that the clock of a day belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct Calendar {
    date: Date,
    zone: TimeZone,
    zone_name: String,
    /// Twelve hours before noon of the date.
    midnight: Timestamp,
}

impl Calendar {
    /// The calendar of a date such as `2026-11-24` in a time zone such as `America/New_York`. The
    /// rules of time zones are those that this program was built with, so that every machine has
    /// the same ones.
    ///
    /// # Errors
    /// [`Error::BadDate`] (V722) and [`Error::UnknownZone`] (V723).
    pub fn new(date: &str, zone: &str) -> Result<Self, Error> {
        let date = checked_date(date)?;
        let unknown = || Error::UnknownZone { found: shortened(zone) };
        let zone = TimeZoneDatabase::bundled().get(zone).map_err(|_| unknown())?;
        let zone_name = zone.iana_name().filter(|_| !zone.is_unknown()).ok_or_else(unknown)?;
        let zone_name = zone_name.to_owned();
        // In a zone that skips a whole date, the noon of that date is taken to be the next one.
        let noon = zone.to_ambiguous_timestamp(date.at(12, 0, 0, 0)).compatible();
        let noon = noon.expect("the years 1970 to 2199 are within the years that jiff counts");
        let midnight = seconds_after(noon, -12 * 3600);
        Ok(Self { date, zone, zone_name, midnight })
    }

    /// The date on which the day begins.
    pub(crate) fn date(&self) -> Date {
        self.date
    }

    /// The name of the time zone, in the letters of the IANA database.
    pub(crate) fn zone_name(&self) -> &str {
        &self.zone_name
    }

    /// The instant of a time of the day.
    pub(crate) fn instant(&self, time: Time) -> Timestamp {
        seconds_after(self.midnight, time.seconds().into())
    }

    /// The instant of a time of the day, as the clocks of the zone show it.
    pub(crate) fn local(&self, time: Time) -> Zoned {
        self.instant(time).to_zoned(self.zone.clone())
    }
}

fn seconds_after(instant: Timestamp, seconds: i64) -> Timestamp {
    Timestamp::from_second(instant.as_second() + seconds)
        .expect("a time of day adds 137 years at most, and jiff counts to the year 9999")
}

fn checked_date(text: &str) -> Result<Date, Error> {
    const RULE: &str = "a date from 1970-01-01 to 2199-12-31, written as YYYY-MM-DD";
    let date = text.parse::<Date>().ok();
    // jiff reads other forms too, and a date with a time. One form is enough, and a mistake is
    // found.
    let date = date.filter(|date| date.to_string() == text && YEARS.contains(&date.year()));
    date.ok_or_else(|| Error::BadDate { rule: RULE, found: shortened(text) })
}

/// The beginning of a text, for a message.
fn shortened(text: &str) -> String {
    text.chars().take(64).collect()
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{Coded, Time};

    use super::Calendar;

    fn local(date: &str, zone: &str, time: &str) -> String {
        let calendar = Calendar::new(date, zone).expect("a calendar");
        let time: Time = time.parse().expect("a time");
        calendar.local(time).strftime("%Y-%m-%dT%H:%M:%S%:z").to_string()
    }

    #[test]
    fn times_are_those_of_the_wall_clock_and_pass_midnight() {
        let winter = |time| local("2026-11-24", "America/New_York", time);
        assert_eq!(winter("00:00:00"), "2026-11-24T00:00:00-05:00");
        assert_eq!(winter("06:00:00"), "2026-11-24T06:00:00-05:00");
        assert_eq!(winter("25:10:00"), "2026-11-25T01:10:00-05:00");
        assert_eq!(local("2026-07-01", "UTC", "06:00:00"), "2026-07-01T06:00:00+00:00");
    }

    #[test]
    fn the_clock_runs_evenly_where_summer_time_begins_and_ends() {
        let begins = |time| local("2026-03-08", "America/New_York", time);
        assert_eq!(begins("06:00:00"), "2026-03-08T06:00:00-04:00");
        assert_eq!(begins("03:00:00"), "2026-03-08T03:00:00-04:00");
        assert_eq!(begins("02:59:59"), "2026-03-08T01:59:59-05:00");
        let ends = |time| local("2026-11-01", "America/New_York", time);
        assert_eq!(ends("06:00:00"), "2026-11-01T06:00:00-05:00");
        assert_eq!(ends("00:30:00"), "2026-11-01T01:30:00-04:00");
        assert_eq!(ends("01:30:00"), "2026-11-01T01:30:00-05:00");
        // The night before the change belongs to the day before, whose clock runs on.
        assert_eq!(
            local("2026-03-07", "America/New_York", "26:30:00"),
            "2026-03-08T03:30:00-04:00"
        );
    }

    #[test]
    fn a_date_that_a_zone_skips_is_taken_to_be_the_next_one() {
        assert_eq!(local("2011-12-30", "Pacific/Apia", "06:00:00"), "2011-12-31T06:00:00+14:00");
    }

    #[test]
    fn the_latest_time_of_the_latest_date_is_an_instant() {
        let calendar = Calendar::new("2199-12-31", "UTC").expect("a calendar");
        assert_eq!(
            calendar.instant(Time::from_seconds(u32::MAX)).to_string(),
            "2336-02-07T06:28:15Z"
        );
    }

    #[test]
    fn zones_are_known_in_any_letters_and_named_as_in_the_database() {
        let calendar = Calendar::new("2026-11-24", "america/new_york").expect("a calendar");
        assert_eq!(calendar.zone_name(), "America/New_York");
    }

    #[test]
    fn what_is_no_date_or_zone_is_refused() {
        for date in [
            "",
            "2026-02-29",
            "24.11.2026",
            "20261124",
            "2026-11-24T06:00",
            "1969-12-31",
            "2200-01-01",
            "-002026-11-24",
        ] {
            let error = Calendar::new(date, "UTC").expect_err(date);
            assert_eq!(error.code().to_string(), "V722", "{date}");
        }
        for zone in ["", "New York", "Etc/Unknown", "+05:00", "../UTC"] {
            let error = Calendar::new("2026-11-24", zone).expect_err(zone);
            assert_eq!(error.code().to_string(), "V723", "{zone}");
        }
    }
}
