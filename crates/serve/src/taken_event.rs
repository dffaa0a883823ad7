//! A stored event: a row of the log, which the API also returns.
//!
//! The row contains the event as JSON text, because the checksum over the log covers texts. Answers
//! quote the text; only times with a calendar require it to be parsed and written again.

use serde::ser::{self, SerializeStruct as _};
use serde::{Serialize, Serializer};
use serde_json::value::RawValue;
use utoipa::ToSchema;

use crate::event::Event;
use crate::mark::EventMark;
use crate::moment::is_by_calendar;
use crate::notice::{self, EventNotice};

/// A stored event.
#[derive(Debug, Clone, PartialEq, Eq, ToSchema)]
pub(crate) struct TakenEvent {
    /// Its number.
    pub(crate) seq: u64,
    /// Its number with a checksum over the log up to it. Sent as `Last-Event-ID`, it ensures that a
    /// stream continues in the same log.
    #[schema(rename = "mark", value_type = String, pattern = "^[0-9]{1,19}-[0-9a-f]{8}$")]
    pub(crate) chain: u32,
    /// When the service stored it, milliseconds of the Unix clock.
    pub(crate) at_ms: i64,
    /// The name of the sender's token.
    pub(crate) actor: String,
    /// The event.
    #[schema(rename = "event", value_type = Event)]
    pub(crate) body: String,
    /// Notices for people.
    #[schema(value_type = Vec<EventNotice>)]
    pub(crate) notices: String,
}

impl TakenEvent {
    /// Its mark.
    pub(crate) fn mark(&self) -> EventMark {
        EventMark { seq: self.seq, chain: Some(self.chain) }
    }

    /// The checksum of an event after one with the checksum `before`.
    pub(crate) fn chain_after(&self, before: u32) -> u32 {
        let mut sum = crc32c::crc32c_append(before, &self.seq.to_le_bytes());
        sum = crc32c::crc32c_append(sum, &self.at_ms.to_le_bytes());
        for text in [&self.actor, &self.body, &self.notices] {
            sum = crc32c::crc32c_append(sum, &(text.len() as u64).to_le_bytes());
            sum = crc32c::crc32c_append(sum, text.as_bytes());
        }
        sum
    }
}

impl Serialize for TakenEvent {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let event: Option<Event> =
            is_by_calendar().then(|| serde_json::from_str(&self.body).ok()).flatten();
        let mut taken = serializer.serialize_struct("TakenEvent", 6)?;
        taken.serialize_field("seq", &self.seq)?;
        taken.serialize_field("mark", &self.mark().to_string())?;
        taken.serialize_field("at_ms", &self.at_ms)?;
        taken.serialize_field("actor", &self.actor)?;
        match event {
            Some(event) => taken.serialize_field("event", &event)?,
            None => taken.serialize_field("event", quoted(&self.body)?)?,
        }
        taken.serialize_field("notices", quoted(&notice::stored(&self.notices))?)?;
        taken.end()
    }
}

/// A text that was written as JSON.
fn quoted<E: ser::Error>(json: &str) -> Result<&RawValue, E> {
    serde_json::from_str(json).map_err(E::custom)
}
