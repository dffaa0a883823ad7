//! Answers: their format and their headers.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use crate::day_cell::DayCell;
use crate::error::Error;
use crate::moment::by_calendar;

/// The format of times in an answer.
#[derive(Debug, Clone, Copy, Default, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Times {
    /// As `HH:MM:SS` of the day.
    #[default]
    Clock,
    /// In ISO 8601 with the offset of the place, for days that have a date.
    Iso,
}

impl Times {
    /// Formats an answer about a day.
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`] if dates are requested and the day has none, and the errors of
    /// `write`.
    pub(super) fn of<T>(
        self,
        day: &DayCell,
        write: impl FnOnce() -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.check(day)?;
        match self {
            Self::Clock => write(),
            Self::Iso => by_calendar(day.calendar(), write),
        }
    }

    /// Answers about a day at an event, once all events up to it are stored.
    ///
    /// # Errors
    /// Returns the errors of [`of`](Self::of) and [`DayCell::stored_up_to`].
    pub(super) async fn answer(
        self,
        day: &DayCell,
        seq: u64,
        answer: &(impl Serialize + Sync),
    ) -> Result<Response, Error> {
        day.stored_up_to(seq).await?;
        self.of(day, || Ok(at_event(StatusCode::OK, seq, answer)))
    }

    /// Checks that times can be written in this format.
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`] if dates are requested and the day has none.
    pub(super) fn check(self, day: &DayCell) -> Result<(), Error> {
        match (self, day.calendar()) {
            (Self::Iso, None) => {
                let rule = "times can be written in ISO 8601 for days that have a date".to_owned();
                Err(Error::BadRequest { rule })
            }
            _ => Ok(()),
        }
    }
}

/// The requested format of times.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    /// How times are written in the answer.
    #[serde(default)]
    pub(super) times: Times,
}

/// An answer in JSON.
pub(super) fn json(status: StatusCode, answer: &impl Serialize) -> Response {
    let body = serde_json::to_string(answer).expect("plain data can be written");
    written(status, body)
}

/// An answer that is already JSON.
pub(super) fn written(status: StatusCode, body: String) -> Response {
    (status, [(header::CONTENT_TYPE, "application/json")], body).into_response()
}

/// An answer about a day at an event, whose number is the `ETag`.
pub(super) fn at_event(status: StatusCode, seq: u64, answer: &impl Serialize) -> Response {
    tagged(json(status, answer), seq)
}

/// The stored answer to a write that was carried out before.
pub(super) fn again(body: String) -> Response {
    #[derive(Deserialize)]
    struct Event {
        seq: Option<u64>,
    }
    let seq = serde_json::from_str(&body).ok().and_then(|Event { seq }| seq);
    let answer = written(StatusCode::CREATED, body);
    match seq {
        Some(seq) => tagged(answer, seq),
        None => answer,
    }
}

fn tagged(mut answer: Response, seq: u64) -> Response {
    let tag = format!("\"{seq}\"");
    let tag = HeaderValue::from_str(&tag).expect("a number in quotes is a header");
    answer.headers_mut().insert(header::ETAG, tag);
    answer
}
