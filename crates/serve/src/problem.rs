//! Errors as answers: problem details (RFC 9457) with the project's codes.

use axum::Extension;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::Coded;
use vertifleet_sim::live::ReportError;

use crate::error::Error;
use crate::latest_events::Happened;

/// An error in an answer (RFC 9457).
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Problem {
    /// Names the kind of error: `urn:vertifleet:` and the code.
    #[serde(rename = "type")]
    pub(crate) kind: String,
    /// The HTTP status in words.
    pub(crate) title: String,
    /// The HTTP status.
    pub(crate) status: u16,
    /// The cause of this error.
    pub(crate) detail: String,
    /// The stable code, which the index of errors explains.
    pub(crate) code: String,
    /// The remedy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) hint: Option<String>,
    /// The event of another client that came first, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) happened: Option<Box<Happened>>,
    /// The number of the event that was to be corrected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) event: Option<u64>,
    /// The number of the later event that depends on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) blocked_by: Option<u64>,
}

impl Problem {
    /// The answer to a request that cannot be carried out.
    pub(crate) fn of(error: &Error) -> Self {
        let status = error.status();
        let code = error.code().to_string();
        let correction = correction(error);
        Self {
            kind: format!("urn:vertifleet:{code}"),
            title: status.canonical_reason().unwrap_or_default().to_owned(),
            status: status.as_u16(),
            detail: error.to_string(),
            code,
            hint: error.hint().map(str::to_owned),
            happened: happened(error).cloned().map(Box::new),
            event: correction.map(|(event, _)| event),
            blocked_by: correction.and_then(|(_, later)| later),
        }
    }
}

fn happened(error: &Error) -> Option<&Happened> {
    match error {
        Error::InList { cause, .. } => happened(cause),
        Error::Overtaken { happened, .. } => Some(happened),
        _ => None,
    }
}

/// The number of the event that cannot be corrected, and that of the later one.
fn correction(error: &Error) -> Option<(u64, Option<u64>)> {
    match error {
        Error::InList { cause, .. } => correction(cause),
        Error::CannotCorrect(ReportError::CannotCorrect { event, .. }) => Some((*event, None)),
        Error::CannotCorrect(ReportError::NeededLater { event, later, .. }) => {
            Some((*event, Some(*later)))
        }
        _ => None,
    }
}

impl IntoResponse for Error {
    fn into_response(self) -> Response {
        let status = self.status();
        if status >= StatusCode::INTERNAL_SERVER_ERROR {
            tracing::error!(error = %self, "a request failed");
        }
        let body = serde_json::to_string(&Problem::of(&self)).expect("plain data can be written");
        let kind = [(header::CONTENT_TYPE, "application/problem+json")];
        // For the metrics of requests, which contain the code.
        let mut answer = (status, Extension(self.code()), kind, body).into_response();
        let told = match status {
            StatusCode::UNAUTHORIZED => Some((header::WWW_AUTHENTICATE, "Bearer")),
            StatusCode::TOO_MANY_REQUESTS | StatusCode::SERVICE_UNAVAILABLE => {
                Some((header::RETRY_AFTER, "1"))
            }
            _ => None,
        };
        answer
            .headers_mut()
            .extend(told.map(|(name, text)| (name, HeaderValue::from_static(text))));
        answer
    }
}
