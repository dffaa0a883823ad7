//! Dates, weekdays, and moments of trip records: wall-clock times without a time zone.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

/// Seconds of a day.
pub(crate) const DAY_S: u32 = 86_400;

/// 0001-01-01 and 9999-12-31, in days since 1970-01-01.
const FIRST_DAY: i32 = -719_162;
const LAST_DAY: i32 = 2_932_896;

/// A date of the Gregorian calendar, in a year of four digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Date {
    /// Days since 1970-01-01.
    days: i32,
}

/// A date and a time of day.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Moment {
    pub(crate) date: Date,
    /// Seconds since midnight, below [`DAY_S`].
    pub(crate) second: u32,
}

/// A date and a time of day as a file writes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stamp {
    pub(crate) moment: Moment,
    /// By how much its clock is ahead of UTC, seconds, if the file states it.
    pub(crate) offset_s: Option<i32>,
}

/// A day of the week.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are clear")]
pub enum Weekday {
    Monday,
    Tuesday,
    Wednesday,
    Thursday,
    Friday,
    Saturday,
    Sunday,
}

/// A set of days of the week.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Weekdays(u8);

impl Date {
    /// The date of this year, month and day, if there is one. Years have four digits.
    pub fn new(year: i32, month: u32, day: u32) -> Option<Self> {
        const DAYS: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
        let days = DAYS.get(usize::try_from(month).ok()?.checked_sub(1)?)?;
        let days = days + u32::from(leap && month == 2);
        if !(1..=days).contains(&day) || !(1..=9999).contains(&year) {
            return None;
        }
        // Years that begin in March put the leap day at their end. 400 of them have 146,097 days.
        let (month, day) = (i32::try_from(month).ok()?, i32::try_from(day).ok()?);
        let year = year - i32::from(month <= 2);
        let from_march = (month + 9) % 12;
        let day_of_year = (153 * from_march + 2) / 5 + day - 1;
        Some(Self { days: 365 * year + year / 4 - year / 100 + year / 400 + day_of_year - 719_468 })
    }

    /// The date before.
    #[inline]
    pub(crate) fn before(self) -> Self {
        Self { days: self.days.saturating_sub(1) }
    }

    /// The number of days from this date to another, below 0 if that one is earlier.
    pub(crate) fn days_until(self, other: Self) -> i32 {
        other.days.saturating_sub(self.days)
    }

    /// The dates from this one to another.
    pub(crate) fn to(self, last: Self) -> impl Iterator<Item = Self> + Clone {
        (self.days..=last.days).map(|days| Self { days })
    }

    /// The day of the week.
    #[inline]
    pub fn weekday(self) -> Weekday {
        // 1970-01-01 was a Thursday.
        match (i64::from(self.days) + 3).rem_euclid(7) {
            0 => Weekday::Monday,
            1 => Weekday::Tuesday,
            2 => Weekday::Wednesday,
            3 => Weekday::Thursday,
            4 => Weekday::Friday,
            5 => Weekday::Saturday,
            _ => Weekday::Sunday,
        }
    }

    /// Year, month and day.
    pub(crate) fn parts(self) -> (i64, i64, i64) {
        let days = i64::from(self.days) + 719_468;
        let (era, day) = (days.div_euclid(146_097), days.rem_euclid(146_097));
        let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
        let day_of_year = day - (365 * year + year / 4 - year / 100);
        let from_march = (5 * day_of_year + 2) / 153;
        let month = (from_march + 2) % 12 + 1;
        let day = day_of_year - (153 * from_march + 2) / 5 + 1;
        (era * 400 + year + i64::from(month <= 2), month, day)
    }

    /// The date with day and month exchanged, if there is one.
    pub(crate) fn exchanged(self) -> Option<Self> {
        let (year, month, day) = self.parts();
        Self::new(i32::try_from(year).ok()?, u32::try_from(day).ok()?, u32::try_from(month).ok()?)
    }

    /// Reads `YYYY-MM-DD`.
    fn read(text: &[u8]) -> Option<Self> {
        let [y1, y2, y3, y4, b'-', m1, m2, b'-', d1, d2] = *text else { return None };
        let year = two_digits(y1, y2)? * 100 + two_digits(y3, y4)?;
        Self::new(i32::try_from(year).ok()?, two_digits(m1, m2)?, two_digits(d1, d2)?)
    }
}

impl Moment {
    /// Reads `YYYY-MM-DD HH:MM`, with a `T` in place of the space if need be, and with or without
    /// seconds and a fraction of a second. At its end may stand `Z`, `UTC`, `GMT` or an offset as
    /// `-04:00`, `-0400` or `-04`.
    #[inline]
    pub(crate) fn read(text: &[u8]) -> Option<Stamp> {
        let (date, time) = text.split_at_checked(10)?;
        let date = Date::read(date)?;
        let [b' ' | b'T', h1, h2, b':', m1, m2, rest @ ..] = time else { return None };
        let (hour, minute) = (two_digits(*h1, *h2)?, two_digits(*m1, *m2)?);
        let (second, rest) = match rest {
            [b':', s1, s2, rest @ ..] => (two_digits(*s1, *s2)?, without_fraction(rest)),
            rest => (0, rest),
        };
        if hour >= 24 || minute >= 60 || second >= 60 {
            return None;
        }
        let offset_s = if rest.is_empty() { None } else { Some(offset_s(rest.trim_ascii())?) };
        let moment = Self { date, second: hour * 3600 + minute * 60 + second };
        Some(Stamp { moment, offset_s })
    }

    /// The date and time of day of the civil calendar, to the second.
    pub(crate) fn of_civil(time: jiff::civil::DateTime) -> Option<Self> {
        let part = |part: i8| u32::try_from(part).ok();
        let date = Date::new(time.year().into(), part(time.month())?, part(time.day())?)?;
        let (hour, minute, second) =
            (part(time.hour())?, part(time.minute())?, part(time.second())?);
        Some(Self { date, second: hour * 3600 + minute * 60 + second })
    }

    /// Seconds since 1970-01-01 00:00.
    pub(crate) fn seconds(self) -> i64 {
        i64::from(self.date.days) * i64::from(DAY_S) + i64::from(self.second)
    }

    /// The moment `seconds` after 1970-01-01 00:00.
    pub(crate) fn from_seconds(seconds: i64) -> Option<Self> {
        let length = i64::from(DAY_S);
        let days = i32::try_from(seconds.div_euclid(length)).ok()?;
        let second = u32::try_from(seconds.rem_euclid(length)).ok()?;
        let four_digits = FIRST_DAY..=LAST_DAY;
        four_digits.contains(&days).then_some(Self { date: Date { days }, second })
    }
}

impl Stamp {
    /// The instant `seconds` after 1970 began in UTC.
    pub(crate) fn of_utc(seconds: i64) -> Option<Self> {
        Some(Self { moment: Moment::from_seconds(seconds)?, offset_s: Some(0) })
    }
}

/// The rest of a time after the fraction of a second.
#[inline]
fn without_fraction(text: &[u8]) -> &[u8] {
    match text {
        [b'.', fraction @ ..] => {
            let digits = fraction.iter().take_while(|byte| byte.is_ascii_digit()).count();
            &fraction[digits..]
        }
        text => text,
    }
}

/// An offset from UTC, seconds.
fn offset_s(text: &[u8]) -> Option<i32> {
    let (sign, digits) = match text {
        b"Z" | b"z" | b"UTC" | b"GMT" => return Some(0),
        [b'+', digits @ ..] => (1, digits),
        [b'-', digits @ ..] => (-1, digits),
        _ => return None,
    };
    let (hours, minutes) = match *digits {
        [h1, h2] => (two_digits(h1, h2)?, 0),
        [h1, h2, m1, m2] | [h1, h2, b':', m1, m2] => (two_digits(h1, h2)?, two_digits(m1, m2)?),
        _ => return None,
    };
    let valid = hours < 24 && minutes < 60;
    valid.then_some(sign * i32::try_from(hours * 3600 + minutes * 60).ok()?)
}

#[inline]
fn two_digits(tens: u8, ones: u8) -> Option<u32> {
    (tens.is_ascii_digit() && ones.is_ascii_digit())
        .then(|| u32::from(tens - b'0') * 10 + u32::from(ones - b'0'))
}

impl Weekday {
    /// The days of the week in their order.
    pub const ALL: [Self; 7] = [
        Self::Monday,
        Self::Tuesday,
        Self::Wednesday,
        Self::Thursday,
        Self::Friday,
        Self::Saturday,
        Self::Sunday,
    ];

    /// The first three letters of its name.
    fn short_name(self) -> &'static str {
        ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"][self as usize]
    }
}

impl Weekdays {
    /// Every day of the week.
    pub const ALL: Self = Self(0b111_1111);

    /// Whether the set has this day.
    #[inline]
    pub fn contains(self, day: Weekday) -> bool {
        self.0 & (1 << day as u8) != 0
    }

    /// Whether the set has no day.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl Default for Weekdays {
    fn default() -> Self {
        Self::ALL
    }
}

impl FromStr for Weekdays {
    type Err = NotADate;

    /// Reads days with commas between them: `Mon,Tue`.
    fn from_str(text: &str) -> Result<Self, NotADate> {
        text.split(',').map(str::parse).collect::<Result<Vec<Weekday>, _>>().map(Self::from_iter)
    }
}

impl FromIterator<Weekday> for Weekdays {
    fn from_iter<I: IntoIterator<Item = Weekday>>(days: I) -> Self {
        Self(days.into_iter().fold(0, |set, day| set | 1 << day as u8))
    }
}

/// A text that is not a date or not a day of the week.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}, found {found:?}")]
pub struct NotADate {
    expected: &'static str,
    found: String,
}

impl FromStr for Date {
    type Err = NotADate;

    /// Reads `YYYY-MM-DD`.
    fn from_str(text: &str) -> Result<Self, NotADate> {
        Self::read(text.as_bytes()).ok_or_else(|| NotADate {
            expected: "a date as YYYY-MM-DD",
            found: text.chars().take(40).collect(),
        })
    }
}

impl FromStr for Weekday {
    type Err = NotADate;

    /// Reads the first three letters of a day's name in either case.
    fn from_str(text: &str) -> Result<Self, NotADate> {
        let named = |day: &Self| day.short_name().eq_ignore_ascii_case(text.trim());
        Self::ALL.into_iter().find(named).ok_or_else(|| NotADate {
            expected: "one of Mon, Tue, Wed, Thu, Fri, Sat and Sun",
            found: text.chars().take(40).collect(),
        })
    }
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (year, month, day) = self.parts();
        write!(f, "{year:04}-{month:02}-{day:02}")
    }
}

impl fmt::Display for Moment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (hour, minute, second) = (self.second / 3600, self.second / 60 % 60, self.second % 60);
        write!(f, "{} {hour:02}:{minute:02}:{second:02}", self.date)
    }
}

impl fmt::Display for Weekdays {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let days = Weekday::ALL.into_iter().filter(|&day| self.contains(day));
        let names: Vec<&str> = days.map(Weekday::short_name).collect();
        f.write_str(&names.join(", "))
    }
}

impl Serialize for Date {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::{DAY_S, Date, FIRST_DAY, LAST_DAY, Moment, Stamp, Weekday, Weekdays};

    #[test]
    fn every_day_of_eight_centuries_follows_the_one_before() {
        let first = Date::new(1600, 1, 1).expect("a date").days;
        let last = Date::new(2400, 1, 1).expect("a date").days;
        assert_eq!(last - first, 2 * 146_097);
        for days in first..=last {
            let date = Date { days };
            assert_eq!(date.to_string().parse(), Ok(date));
        }
    }

    #[test]
    fn known_dates_have_their_weekdays_and_wrong_ones_are_refused() {
        assert_eq!(Date::new(1970, 1, 1).expect("a date").days, 0);
        assert_eq!(Date::new(2015, 6, 1).expect("a date").weekday(), Weekday::Monday);
        assert_eq!(Date::new(1969, 12, 28).expect("a date").weekday(), Weekday::Sunday);
        for (year, month, day) in
            [(2015, 2, 29), (1900, 2, 29), (2015, 13, 1), (2015, 0, 1), (0, 1, 1)]
        {
            assert_eq!(Date::new(year, month, day), None);
        }
    }

    #[test]
    fn moments_are_read_in_every_form_that_occurs() {
        let read = |text: &str| {
            Moment::read(text.as_bytes()).map(|Stamp { moment, offset_s }| (moment, offset_s))
        };
        let (moment, _) = read("2015-06-01 07:08:09").expect("a moment");
        assert_eq!((moment.date.to_string().as_str(), moment.second), ("2015-06-01", 25_689));
        for text in ["2015-06-01T07:08:09", "2015-06-01 07:08:09.123", "2015-06-01 07:08:09."] {
            assert_eq!(read(text), Some((moment, None)), "{text}");
        }
        for (text, offset_s) in [
            ("2015-06-01T07:08:09Z", 0),
            ("2015-06-01 07:08:09.5 UTC", 0),
            ("2015-06-01 07:08:09-04:00", -14_400),
            ("2015-06-01 07:08:09 +0530", 19_800),
            ("2015-06-01 07:08:09+00", 0),
        ] {
            assert_eq!(read(text), Some((moment, Some(offset_s))), "{text}");
        }
        let minutes = read("2015-06-01 07:08").map(|(moment, _)| moment.second);
        assert_eq!(minutes, Some(25_680));
        for text in [
            "",
            "2015-06-01",
            "2015-06-31 07:08",
            "2015-06-01 24:00",
            "2015-06-01 07:08:9",
            "01/06/2015 07:08",
            "2015-06-01 07:08 PM",
            "2015-06-01 07:08:09-4",
            "2015-06-01 07:08:09+25:00",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
        assert_eq!(Moment::from_seconds(-1).map(|moment| moment.second), Some(86_399));
        assert_eq!(Moment::from_seconds(i64::MAX), None);
        assert_eq!(Date::new(1, 1, 1).map(|date| date.days), Some(FIRST_DAY));
        assert_eq!(Date::new(9999, 12, 31).map(|date| date.days), Some(LAST_DAY));
        let after = i64::from(LAST_DAY + 1) * i64::from(DAY_S);
        assert_eq!(Moment::from_seconds(after), None);
        assert!(Moment::from_seconds(after - 1).is_some());
    }

    #[test]
    fn sets_of_weekdays_say_what_they_hold() {
        let days: Weekdays =
            ["mon", "Fri"].iter().map(|day| day.parse::<Weekday>().expect("a day")).collect();
        assert_eq!(days.to_string(), "Mon, Fri");
        assert_eq!(
            (days.to_string().parse(), "Mon,,Fri".parse::<Weekdays>().is_err()),
            (Ok(days), true)
        );
        assert!(days.contains(Weekday::Friday) && !days.contains(Weekday::Sunday));
        assert!(Weekdays::from_iter([]).is_empty() && "Frei".parse::<Weekday>().is_err());
    }
}
