//! Time of day in whole seconds since midnight. No clock in this project has fractions of a second.

use std::fmt;
use std::ops::Add;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Seconds since midnight. Times continue past midnight (`25:10:00`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Time(u32);

impl Time {
    /// The time `seconds` after midnight.
    #[inline]
    pub const fn from_seconds(seconds: u32) -> Self {
        Self(seconds)
    }

    /// Seconds since midnight.
    #[inline]
    pub const fn seconds(self) -> u32 {
        self.0
    }

    /// Hours since midnight, with fractions.
    #[inline]
    pub fn hours(self) -> f64 {
        f64::from(self.0) / 3600.0
    }

    /// Seconds from `earlier` to this time, or 0 if `earlier` is not earlier.
    #[inline]
    pub const fn since(self, earlier: Self) -> u32 {
        self.0.saturating_sub(earlier.0)
    }
}

impl Add<u32> for Time {
    type Output = Self;

    /// The time `seconds` later.
    #[inline]
    fn add(self, seconds: u32) -> Self {
        Self(self.0 + seconds)
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02}:{:02}:{:02}", self.0 / 3600, self.0 / 60 % 60, self.0 % 60)
    }
}

/// A text that is not a time of day.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected a time as HH:MM:SS, found {0:?}")]
pub struct NotATime(pub String);

impl FromStr for Time {
    type Err = NotATime;

    /// Reads `HH:MM:SS`. Hours may have one digit and may pass 24 (at most four digits); minutes
    /// and seconds are two digits below 60.
    fn from_str(text: &str) -> Result<Self, NotATime> {
        let wrong = || NotATime(text.chars().take(40).collect());
        let number = |part: &str, digits: std::ops::RangeInclusive<usize>| {
            let plain = part.bytes().all(|b| b.is_ascii_digit()) && digits.contains(&part.len());
            plain.then(|| part.parse::<u32>().ok()).flatten()
        };
        let mut parts = text.split(':');
        let (Some(h), Some(m), Some(s), None) =
            (parts.next(), parts.next(), parts.next(), parts.next())
        else {
            return Err(wrong());
        };
        match (number(h, 1..=4), number(m, 2..=2), number(s, 2..=2)) {
            (Some(h), Some(m), Some(s)) if m < 60 && s < 60 => Ok(Self(h * 3600 + m * 60 + s)),
            _ => Err(wrong()),
        }
    }
}

impl Serialize for Time {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Time {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::Time;

    #[test]
    fn a_time_reads_as_it_is_written() {
        for text in ["00:00:00", "06:00:00", "18:59:59", "25:10:03"] {
            assert_eq!(text.parse::<Time>().expect("a time").to_string(), text);
        }
    }

    #[test]
    fn an_hour_may_have_one_digit_and_is_written_with_two() {
        assert_eq!("6:05:00".parse::<Time>().expect("a time").to_string(), "06:05:00");
    }

    #[test]
    fn what_is_no_time_is_refused() {
        for text in [
            "",
            ":00:00",
            "6:0:00",
            "06:00",
            "06:60:00",
            "06:00:60",
            "-1:00:00",
            "06:00:00:00",
            "99999:00:00",
        ] {
            assert!(text.parse::<Time>().is_err(), "{text}");
        }
    }
}
