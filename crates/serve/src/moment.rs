//! Times in requests: seconds since midnight, or `HH:MM:SS`.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use utoipa::{PartialSchema, ToSchema, openapi};
use vertifleet_core::Time;

/// A time of the day that is being dispatched, as seconds since midnight or as `HH:MM:SS`, which may pass 24:00:00. It is
/// written as `HH:MM:SS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Moment(Time);

/// No day lasts longer, seconds.
const LATEST_S: u32 = 100 * 3600;

impl Moment {
    /// The time.
    pub(crate) fn time(self) -> Time {
        self.0
    }
}

impl From<Time> for Moment {
    fn from(time: Time) -> Self {
        Self(time)
    }
}

impl Serialize for Moment {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
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
        let seconds = u32::try_from(seconds).ok().filter(|&seconds| seconds < LATEST_S);
        let wrong = || E::custom("a time must lie before 100:00:00");
        seconds.map(|seconds| Moment(Time::from_seconds(seconds))).ok_or_else(wrong)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Moment, E> {
        let time: Time = text.parse().map_err(E::custom)?;
        self.visit_u64(time.seconds().into())
    }
}

impl PartialSchema for Moment {
    fn schema() -> openapi::RefOr<openapi::schema::Schema> {
        openapi::ObjectBuilder::new()
            .schema_type(openapi::schema::SchemaType::from_iter([
                openapi::Type::String,
                openapi::Type::Integer,
            ]))
            .description(Some(
                "A time of the day, as HH:MM:SS or as seconds since midnight; before 100:00:00.",
            ))
            .examples([serde_json::json!("07:10:00"), serde_json::json!(25_800)])
            .into()
    }
}

impl ToSchema for Moment {}
