//! Errors as answers: problem details (RFC 9457) with the project's codes.

use axum::Extension;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::Coded;

use crate::error::Error;

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
}

impl Problem {
    /// The answer to a request that cannot be carried out.
    pub(crate) fn of(error: &Error) -> Self {
        let status = error.status();
        let code = error.code().to_string();
        Self {
            kind: format!("urn:vertifleet:{code}"),
            title: status.canonical_reason().unwrap_or_default().to_owned(),
            status: status.as_u16(),
            detail: error.to_string(),
            code,
            hint: error.hint().map(str::to_owned),
        }
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
