//! Notices in JSON: their kind for programs, and their text for people.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use vertifleet_sim::live::Notice;

/// The code of a notice that an earlier version of the program stored as text alone.
const OTHER: &str = "other";

/// A notice for people: a part of an event that they should look at. The event was accepted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub(crate) struct EventNotice {
    /// The kind: `more_than_stands`, `against_the_rules`, `departed_out_of_service`,
    /// `departed_unready`, `departed_before_landing`, `without_energy`, `below_reserve`,
    /// `too_fast`, `charge_too_high`, `ready_too_soon`, `diverted`, `not_flown`, `overdue`, or
    /// `other` in logs of earlier versions. Later versions may add kinds.
    pub(crate) code: String,
    /// The notice in words.
    pub(crate) text: String,
    /// The aircraft, if it is about one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) aircraft: Option<String>,
    /// The vertiport, if it is about one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) vertiport: Option<String>,
}

impl From<&Notice> for EventNotice {
    fn from(notice: &Notice) -> Self {
        Self {
            code: notice.code().to_owned(),
            text: notice.to_string(),
            aircraft: notice.aircraft().map(str::to_owned),
            vertiport: notice.vertiport().map(str::to_owned),
        }
    }
}

/// The notices of an event as JSON.
pub(crate) fn to_json(notices: &[Notice]) -> String {
    let notices: Vec<EventNotice> = notices.iter().map(EventNotice::from).collect();
    serde_json::to_string(&notices).expect("plain data can be written")
}

/// The stored notices of an event. Earlier versions stored texts alone.
pub(crate) fn stored(json: &str) -> Cow<'_, str> {
    if !json.starts_with("[\"") {
        return Cow::Borrowed(json);
    }
    let Ok(texts) = serde_json::from_str::<Vec<String>>(json) else { return Cow::Borrowed(json) };
    let notice =
        |text| EventNotice { code: OTHER.to_owned(), text, aircraft: None, vertiport: None };
    let notices: Vec<EventNotice> = texts.into_iter().map(notice).collect();
    Cow::Owned(serde_json::to_string(&notices).expect("plain data can be written"))
}

#[cfg(test)]
mod tests {
    use super::stored;

    #[test]
    fn notices_of_earlier_versions_get_a_code() {
        assert_eq!(stored("[]"), "[]");
        let new = r#"[{"code":"diverted","text":"a"}]"#;
        assert_eq!(stored(new), new);
        let old = r#"["vertiport \"V1\" is full"]"#;
        assert_eq!(stored(old), r#"[{"code":"other","text":"vertiport \"V1\" is full"}]"#);
    }
}
