//! Times of day as planners write the begin of a period: `06:00`, `6:00 AM`, `0600`, `06:00-07:00`,
//! or the hour alone.

use std::collections::{BTreeMap, BTreeSet};

use vertifleet_core::Time;

use crate::cell::Cell;

/// The begin of the period that a cell names.
pub(crate) fn begin(cell: Cell<'_>) -> Option<Time> {
    span(cell).map(|(begin, _)| begin)
}

/// The begin of the period that a cell names, and its end where the cell states it.
pub(crate) fn span(cell: Cell<'_>) -> Option<(Time, Option<Time>)> {
    if let Cell::Text(text) = cell {
        return span_of(str::from_utf8(text).ok()?);
    }
    let begin = match cell.whole() {
        Some(hour) => hours(u32::try_from(hour).ok()?),
        None => cell.shown().parse().ok(),
    };
    Some((begin?, None))
}

/// The ends of periods that a table states, by their begins.
#[derive(Debug, Default)]
pub(crate) struct StatedEnds(BTreeMap<Time, Time>);

impl StatedEnds {
    /// Adds the end of the period that a cell names, if the cell states it.
    pub(crate) fn add(&mut self, cell: Cell<'_>) {
        if let Some((begin, Some(end))) = span(cell) {
            self.0.insert(begin, end);
        }
    }

    /// The first of the periods that begin at `starts` whose stated end is another time than the
    /// begin of the next one, or than the end of operations: its begin, the stated end, and the
    /// other time. `end` is the end of operations for a stated end of the last period.
    pub(crate) fn other(
        &self,
        starts: &BTreeSet<Time>,
        end: impl Fn(Time) -> Time,
    ) -> Option<(Time, Time, Time)> {
        let with_next = starts.iter().zip(starts.iter().skip(1).map(Some).chain([None]));
        let ends = with_next.filter_map(|(begin, next)| {
            let stated = *self.0.get(begin)?;
            Some((*begin, stated, next.copied().unwrap_or_else(|| end(stated))))
        });
        // A period that begins after operations end has no end among them.
        let mut ends = ends.filter(|(begin, _, next)| begin < next);
        ends.find(|(_, stated, next)| stated != next)
    }
}

fn span_of(text: &str) -> Option<(Time, Option<Time>)> {
    if let Some(begin) = time(text) {
        return Some((begin, None));
    }
    let ends = ["-", "–", "—", " to "].into_iter().find_map(|dash| text.split_once(dash));
    let (begin, end) = ends?;
    let (begin, end) = (begin.trim(), end.trim());
    // "6-7 AM" has the half of the day once.
    let half = half_of(end).map(|(_, half)| half);
    let written = match half {
        Some(half) if half_of(begin).is_none() => format!("{begin} {half}"),
        _ => begin.to_owned(),
    };
    let (begin, end) = (time(&written)?, time(end)?);
    // A period until midnight may end at 0:00.
    let end = if end <= begin { end + 24 * 3600 } else { end };
    Some((begin, Some(end)))
}

/// A time without an end.
fn time(text: &str) -> Option<Time> {
    if let Some((clock, half)) = half_of(text) {
        let clock = plain(clock)?;
        let hour = clock.seconds() / 3600;
        if !(1..=12).contains(&hour) {
            return None;
        }
        let noon = if half == "PM" { 12 * 3600 } else { 0 };
        return Some(Time::from_seconds(clock.seconds() % (12 * 3600) + noon));
    }
    plain(text)
}

/// A time of 12 hours without its half of the day, and this half.
fn half_of(text: &str) -> Option<(&str, &'static str)> {
    let halves = [("a.m.", "AM"), ("p.m.", "PM"), ("am", "AM"), ("pm", "PM")];
    halves.into_iter().find_map(|(ending, half)| {
        let begin = text.len().checked_sub(ending.len())?;
        let (clock, found) = text.split_at_checked(begin)?;
        found.eq_ignore_ascii_case(ending).then(|| (clock.trim_end(), half))
    })
}

/// `HH:MM`, with or without seconds, `HHMM`, or an hour, which some programs write as `6.0`.
fn plain(text: &str) -> Option<Time> {
    if let [h1, h2, m1, m2] = *text.as_bytes()
        && text.bytes().all(|byte| byte.is_ascii_digit())
    {
        let two = |tens: u8, ones: u8| u32::from(tens - b'0') * 10 + u32::from(ones - b'0');
        let (hour, minute) = (two(h1, h2), two(m1, m2));
        return (minute < 60).then(|| Time::from_seconds(hour * 3600 + minute * 60));
    }
    if let Some(hour) = Cell::text(text.as_bytes()).whole() {
        return hours(u32::try_from(hour).ok()?);
    }
    text.parse().or_else(|_| format!("{text}:00").parse()).ok()
}

/// The time of an hour of the day, within the range of times.
fn hours(hour: u32) -> Option<Time> {
    (hour < 100).then(|| Time::from_seconds(hour * 3600))
}

#[cfg(test)]
mod tests {
    use super::span;
    use crate::cell::Cell;

    fn read(text: &str) -> Option<(String, Option<String>)> {
        let (begin, end) = span(Cell::text(text.as_bytes()))?;
        Some((begin.to_string(), end.map(|end| end.to_string())))
    }

    #[test]
    fn times_are_read_in_every_form_that_planners_use() {
        for (text, time) in [
            ("6", "06:00:00"),
            ("6.0", "06:00:00"),
            ("06", "06:00:00"),
            ("25", "25:00:00"),
            ("6:30", "06:30:00"),
            ("06:30:15", "06:30:15"),
            ("0600", "06:00:00"),
            ("1430", "14:30:00"),
            ("6:00 AM", "06:00:00"),
            ("6 am", "06:00:00"),
            ("6PM", "18:00:00"),
            ("06:15:30 p.m.", "18:15:30"),
            ("12:00 AM", "00:00:00"),
            ("12:30 PM", "12:30:00"),
        ] {
            assert_eq!(read(text), Some((time.to_owned(), None)), "{text}");
        }
    }

    #[test]
    fn a_span_has_its_end() {
        for (text, begin, end) in [
            ("06:00-07:00", "06:00:00", "07:00:00"),
            ("06:00 - 07:30", "06:00:00", "07:30:00"),
            ("6-7", "06:00:00", "07:00:00"),
            ("0600-0700", "06:00:00", "07:00:00"),
            ("06:00–07:00", "06:00:00", "07:00:00"),
            ("6:00 AM - 7:00 AM", "06:00:00", "07:00:00"),
            ("6-7 pm", "18:00:00", "19:00:00"),
            ("11:00 AM to 12:00 PM", "11:00:00", "12:00:00"),
            ("23:00-00:00", "23:00:00", "24:00:00"),
        ] {
            assert_eq!(read(text), Some((begin.to_owned(), Some(end.to_owned()))), "{text}");
        }
    }

    #[test]
    fn what_is_no_time_is_refused() {
        for text in [
            "",
            "noon",
            "600",
            "0660",
            "13:00 PM",
            "0 AM",
            "-1",
            "6:5",
            "06:00-",
            "6.5",
            "2015-06-01",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
