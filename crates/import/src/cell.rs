//! A value of one column in one row, whichever kind of file it comes from.
//!
//! Text is read by hand from bytes: there are four to six values in each of many million rows, and
//! the general parser of the standard library costs several times as much as the short forms that
//! occur.

use std::borrow::Cow;

use unicode_normalization::{UnicodeNormalization, is_nfc};
use vertifleet_core::Time;

use crate::date_time::{Moment, Stamp};

/// A value of one column in one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cell<'a> {
    /// The row has no value here.
    Missing,
    /// A text without spaces around it, not empty.
    Text(&'a [u8]),
    Whole(i64),
    Number(f64),
    /// A time of day without a date, seconds since midnight.
    TimeOfDay(u32),
    Stamp(Stamp),
}

impl<'a> Cell<'a> {
    /// A text from a file; an empty one counts as missing.
    #[inline]
    pub(crate) fn text(text: &'a [u8]) -> Self {
        let text = text.trim_ascii();
        if text.is_empty() { Self::Missing } else { Self::Text(text) }
    }

    /// The finite number that the cell holds.
    #[inline]
    pub(crate) fn number(self) -> Option<f64> {
        match self {
            Self::Text(text) => number(text),
            Self::Whole(whole) => Some(whole as f64),
            Self::Number(number) => Some(number).filter(|number| number.is_finite()),
            Self::Missing | Self::TimeOfDay(_) | Self::Stamp(_) => None,
        }
    }

    /// The whole number that the cell holds, also one that is written with a fraction of zero
    /// (`132.0`).
    #[inline]
    pub(crate) fn whole(self) -> Option<i64> {
        // Whole numbers up to this size are exact as `f64`.
        const MOST: f64 = 9_007_199_254_740_992.0;
        if let Self::Whole(whole) = self {
            return Some(whole);
        }
        let number = self.number()?;
        #[expect(clippy::cast_possible_truncation, reason = "whole and within the range of i64")]
        (number.fract() == 0.0 && number.abs() <= MOST).then_some(number as i64)
    }

    /// The date and time of day that the cell holds.
    #[inline]
    pub(crate) fn stamp(self) -> Option<Stamp> {
        match self {
            Self::Text(text) => Moment::read(text),
            Self::Stamp(stamp) => Some(stamp),
            Self::Missing | Self::Whole(_) | Self::Number(_) | Self::TimeOfDay(_) => None,
        }
    }

    /// The cell as a person would write it, for ids and messages.
    pub(crate) fn shown(self) -> Cow<'a, str> {
        match self {
            Self::Missing => Cow::Borrowed(""),
            Self::Text(text) => String::from_utf8_lossy(text),
            Self::Whole(whole) => Cow::Owned(whole.to_string()),
            Self::Number(number) => Cow::Owned(number.to_string()),
            Self::TimeOfDay(second) => Cow::Owned(Time::from_seconds(second).to_string()),
            Self::Stamp(stamp) => Cow::Owned(stamp.moment.to_string()),
        }
    }
}

/// A text with composed accents. Some systems write a letter and its accent as one character, and
/// others as two, so that ids that look the same would differ.
pub(crate) fn composed(text: Cow<'_, str>) -> Cow<'_, str> {
    if is_nfc(&text) { text } else { Cow::Owned(text.nfc().collect()) }
}

/// Reads a finite decimal number.
///
/// Where the digits fit into 53 bits and the power of ten is exact, one division rounds correctly
/// (Clinger 1990); all other texts go to the standard library. Both give the same number.
#[inline]
fn number(text: &[u8]) -> Option<f64> {
    const EXACT_POWERS: [f64; 16] =
        [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    // Fifteen digits are below 2^53.
    if digits.len() > 16 || !digits.first()?.is_ascii_digit() {
        return slow_number(text);
    }
    let (mut value, mut read, mut decimals) = (0_u64, 0_usize, None);
    for &byte in digits {
        match byte {
            b'0'..=b'9' => {
                value = value * 10 + u64::from(byte - b'0');
                read += 1;
            }
            b'.' if decimals.is_none() => decimals = Some(read),
            _ => return slow_number(text),
        }
    }
    if read > 15 {
        return slow_number(text);
    }
    let number = value as f64 / EXACT_POWERS[read - decimals.unwrap_or(read)];
    Some(if negative { -number } else { number })
}

fn slow_number(text: &[u8]) -> Option<f64> {
    let number: f64 = str::from_utf8(text).ok()?.parse().ok()?;
    Some(number).filter(|number| number.is_finite())
}

/// A text that fits on a line of comment.
pub(crate) fn printable(text: &str) -> String {
    crate::error::shortened(&without_controls(text), 80)
}

/// A text with a space in place of each control character.
pub(crate) fn without_controls(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{any, proptest};

    use super::{Cell, slow_number};

    #[test]
    fn empty_texts_are_missing_and_whole_numbers_may_have_a_fraction_of_zero() {
        assert_eq!(Cell::text(b"  "), Cell::Missing);
        assert_eq!(Cell::text(b" 132.0 ").whole(), Some(132));
        assert_eq!(Cell::Number(132.5).whole(), None);
        assert_eq!(Cell::Number(1e300).whole(), None);
        assert_eq!(Cell::text(b"nan").number(), None);
        assert_eq!(Cell::text(b"-.5").number(), Some(-0.5));
        assert_eq!(Cell::text(b"1.").number(), Some(1.0));
        assert_eq!(Cell::text(b"1.2.3").number(), None);
    }

    proptest! {
        #[test]
        fn short_numbers_are_read_as_the_standard_library_reads_them(
            whole in any::<i32>(), fraction in "[0-9]{0,14}", point in any::<bool>(),
        ) {
            let text = format!("{whole}{}{fraction}", if point { "." } else { "" });
            assert_eq!(Cell::text(text.as_bytes()).number(), slow_number(text.as_bytes()), "{text}");
        }

        #[test]
        fn any_text_is_read_as_the_standard_library_reads_it(text in "[-+0-9.eEx]{1,20}") {
            assert_eq!(Cell::Text(text.as_bytes()).number(), slow_number(text.as_bytes()), "{text}");
        }
    }
}
