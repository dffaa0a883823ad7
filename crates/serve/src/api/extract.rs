//! The parts of a request, with the service's own errors where they cannot be read.

use std::convert::Infallible;

use axum::body::Bytes;
use axum::extract::rejection::{BytesRejection, PathRejection, QueryRejection};
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, StatusCode};
use serde::de::DeserializeOwned;

use crate::access::Actor;
use crate::error::Error;

/// What stands after the question mark.
pub(super) struct Asked<T>(pub(super) T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Asked<T> {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Error> {
        let asked = Query::try_from_uri(&parts.uri);
        let wrong = |error: QueryRejection| Error::BadRequest { rule: error.body_text() };
        asked.map(|Query(asked)| Self(asked)).map_err(wrong)
    }
}

/// The ids in the path.
pub(super) struct Named<T>(pub(super) T);

impl<S: Send + Sync, T: DeserializeOwned + Send> FromRequestParts<S> for Named<T> {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Error> {
        let wrong = |error: PathRejection| Error::BadRequest { rule: error.body_text() };
        Path::from_request_parts(parts, state).await.map(|Path(ids)| Self(ids)).map_err(wrong)
    }
}

/// Whoever asks, and how.
pub(crate) struct Sender {
    /// The name of the token; empty without tokens.
    pub(crate) actor: String,
    /// The headers of the request.
    pub(crate) headers: HeaderMap,
    /// Its path.
    pub(crate) path: String,
}

impl<S: Send + Sync> FromRequestParts<S> for Sender {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        let Actor(actor) = parts.extensions.get().cloned().unwrap_or_default();
        Ok(Self { actor, headers: parts.headers.clone(), path: parts.uri.path().to_owned() })
    }
}

/// The body.
pub(super) struct Body(pub(super) Bytes);

impl<S: Send + Sync> FromRequest<S> for Body {
    type Rejection = Error;

    async fn from_request(request: Request, state: &S) -> Result<Self, Error> {
        let wrong = |error: BytesRejection| match error.status() {
            StatusCode::PAYLOAD_TOO_LARGE => {
                Error::TooMuch { what: "bytes in a body", most: super::LONGEST_BODY as u64 }
            }
            _ => Error::BadRequest { rule: error.body_text() },
        };
        Bytes::from_request(request, state).await.map(Self).map_err(wrong)
    }
}
