//! Times in requests and answers: seconds since midnight, `HH:MM:SS`, or ISO 8601 on days that have
//! a date.

use std::cell::RefCell;
use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use utoipa::{PartialSchema, ToSchema, openapi};
use vertifleet_core::Time;

use crate::calendar::Calendar;

thread_local! {
    /// The calendar of times while a request is read or an answer written. A type that is read from
    /// or written as JSON has no access to its day, so the calendar is here.
    static CALENDAR: RefCell<Option<Calendar>> = const { RefCell::new(None) };
}

/// Reads or writes times with the calendar of their day; without a calendar, times have no dates.
pub(crate) fn by_calendar<T>(calendar: Option<&Calendar>, work: impl FnOnce() -> T) -> T {
    struct Put(Option<Calendar>);
    impl Drop for Put {
        fn drop(&mut self) {
            CALENDAR.replace(self.0.take());
        }
    }
    let _put = Put(CALENDAR.replace(calendar.cloned()));
    work()
}

/// Whether times are being read or written by a calendar.
pub(crate) fn is_by_calendar() -> bool {
    CALENDAR.with_borrow(Option::is_some)
}

/// A time of the day that is being dispatched, as seconds since midnight or as `HH:MM:SS`, which
/// may pass 24:00:00. It is written as `HH:MM:SS`. By a calendar it is read and written in ISO 8601
/// too.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Moment(Time);

/// The pattern of the texts of times. Times that follow from the latest accepted time may be after
/// 100:00:00.
const PATTERN: &str =
    "^([0-9]{1,4}:[0-5][0-9]:[0-5][0-9]|[0-9]{1,6}|[0-9]{4}-[0-9]{2}-[0-9]{2}[Tt ].*[0-9].*)$";
/// Longest day, seconds.
const LATEST_S: u32 = 100 * 3600;

impl Moment {
    /// The time.
    pub(crate) fn time(self) -> Time {
        self.0
    }

    fn of_seconds(seconds: u64) -> Result<Self, String> {
        let seconds = u32::try_from(seconds).ok().filter(|&seconds| seconds < LATEST_S);
        let time = seconds.map(|seconds| Self(Time::from_seconds(seconds)));
        time.ok_or_else(|| "a time must lie before 100:00:00".to_owned())
    }

    /// Parses a text. The error is the rule that it breaks.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        if let Ok(seconds) = text.parse() {
            return Self::of_seconds(seconds);
        }
        // RFC 3339 permits a lower-case letter or a blank between date and time.
        let year = text.trim_ascii_start().split_once('-').map(|(year, _)| year);
        let begins_with_year = year.is_some_and(|year| year.parse::<u16>().is_ok());
        if !(begins_with_year && text.contains(['T', 't', ' '])) {
            let time = text.parse::<Time>().map_err(|error| error.to_string())?;
            return Self::of_seconds(time.seconds().into());
        }
        let shown = text.chars().take(40).collect::<String>();
        let read = CALENDAR.with_borrow(|calendar| Some(calendar.as_ref()?.read(text)));
        let read = read
            .ok_or_else(|| format!("{shown:?} has a date, but the day has none: write HH:MM:SS"))?;
        let time = read.ok_or_else(|| {
            format!("{shown:?} is no time of the day: write it as 2026-11-23T07:10:00-05:00")
        })?;
        Self::of_seconds(time.seconds().into())
    }
}

impl From<Time> for Moment {
    fn from(time: Time) -> Self {
        Self(time)
    }
}

impl Serialize for Moment {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        CALENDAR.with_borrow(|calendar| match calendar {
            Some(calendar) => serializer.serialize_str(&calendar.write(self.0)),
            None => self.0.serialize(serializer),
        })
    }
}

impl<'de> Deserialize<'de> for Moment {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Visitor)
    }
}

struct Visitor;

impl de::Visitor<'_> for Visitor {
    type Value = Moment;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a time as HH:MM:SS or as seconds since midnight, before 100:00:00")
    }

    fn visit_u64<E: de::Error>(self, seconds: u64) -> Result<Moment, E> {
        Moment::of_seconds(seconds).map_err(E::custom)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Moment, E> {
        Moment::parse(text).map_err(E::custom)
    }
}

impl PartialSchema for Moment {
    fn schema() -> openapi::RefOr<openapi::schema::Schema> {
        openapi::ObjectBuilder::new()
            .schema_type(openapi::schema::SchemaType::from_iter([
                openapi::Type::String,
                openapi::Type::Integer,
            ]))
            .pattern(Some(PATTERN))
            .minimum(Some(0))
            .maximum(Some(LATEST_S - 1))
            .description(Some(
                "A time of the day, as HH:MM:SS or as seconds since midnight, before 100:00:00; or in ISO 8601 with an offset, if the day has a date.",
            ))
            .examples([
                serde_json::json!("07:10:00"),
                serde_json::json!(25_800),
                serde_json::json!("2026-11-23T07:10:00-05:00"),
            ])
            .into()
    }
}

impl ToSchema for Moment {}
