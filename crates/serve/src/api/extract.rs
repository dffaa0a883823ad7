//! The parts of a request, with the service's own errors where they cannot be read.

use std::convert::Infallible;
use std::sync::Arc;

use axum::body::{Bytes, HttpBody as _};
use axum::extract::rejection::{PathRejection, QueryRejection};
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::request::Parts;
use bytes::BytesMut;
use http_body_util::BodyExt as _;
use serde::de::{self, DeserializeOwned};
use serde::{Deserialize, Deserializer};
use utoipa::openapi::schema::{KnownFormat, ObjectBuilder, SchemaFormat, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use crate::access::Actor;
use crate::error::Error;
use crate::service::Service;

/// The query string.
pub(super) struct Validated<T>(pub(super) T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Validated<T> {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Error> {
        let asked = Query::try_from_uri(&parts.uri);
        let wrong = |error: QueryRejection| {
            let text = error.body_text();
            let text = text.strip_prefix("Failed to deserialize query string: ").unwrap_or(&text);
            Error::BadRequest { rule: in_words_of_json(text) }
        };
        asked.map(|Query(asked)| Self(asked)).map_err(wrong)
    }
}

/// The number of an event. The description promises signed numbers of 64 bits, so larger ones are
/// refused.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EventNumber(pub(super) u64);

impl EventNumber {
    fn checked(number: u64) -> Option<Self> {
        i64::try_from(number).is_ok().then_some(Self(number))
    }
}

impl<'de> Deserialize<'de> for EventNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let number = u64::deserialize(deserializer)?;
        let wrong = || de::Error::custom(format!("no event has a number such as {number}"));
        Self::checked(number).ok_or_else(wrong)
    }
}

impl PartialSchema for EventNumber {
    fn schema() -> RefOr<Schema> {
        let format = SchemaFormat::KnownFormat(KnownFormat::Int64);
        let number = ObjectBuilder::new().schema_type(Type::Integer).format(Some(format));
        number.minimum(Some(0)).into()
    }
}

impl ToSchema for EventNumber {}

/// The number of entries of a list's page, 1 to `MOST`.
#[derive(Debug, Clone, Copy)]
pub(super) struct PageSize<const MOST: u32>(pub(super) u32);

impl<'de, const MOST: u32> Deserialize<'de> for PageSize<MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let size = u32::deserialize(deserializer)?;
        let wrong = || de::Error::custom(format!("a page has 1 to {MOST} entries, not {size}"));
        (1..=MOST).contains(&size).then_some(Self(size)).ok_or_else(wrong)
    }
}

impl<const MOST: u32> PartialSchema for PageSize<MOST> {
    fn schema() -> RefOr<Schema> {
        let number = ObjectBuilder::new().schema_type(Type::Integer);
        number.minimum(Some(1)).maximum(Some(MOST)).into()
    }
}

impl<const MOST: u32> ToSchema for PageSize<MOST> {}

/// The ids in the path.
pub(super) struct Named<T>(pub(super) T);

impl<S: Send + Sync, T: DeserializeOwned + Send> FromRequestParts<S> for Named<T> {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Error> {
        let wrong = |error: PathRejection| Error::BadRequest { rule: error.body_text() };
        Path::from_request_parts(parts, state).await.map(|Path(ids)| Self(ids)).map_err(wrong)
    }
}

impl<S: Send + Sync> FromRequestParts<S> for Actor {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        Ok(parts.extensions.get().cloned().unwrap_or_default())
    }
}

/// The longest body of most requests.
pub(super) const SHORT: usize = 4 << 20;
/// Largest body of a request with a scenario, a network or weights, bytes.
pub(super) const UPLOAD: usize = 64 << 20;

/// A body of at most `MOST` bytes. Only a few large ones are read at a time.
pub(super) struct Body<const MOST: usize = SHORT>(pub(super) Bytes);

impl<const MOST: usize> FromRequest<Arc<Service>> for Body<MOST> {
    type Rejection = Error;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Error> {
        let actor = request.extensions().get().cloned().unwrap_or_default();
        read_body::<MOST>(request.into_body(), &actor, service).await.map(Self)
    }
}

/// Reads a body of at most `MOST` bytes. A body that is longer than most waits for a turn of its
/// token and holds it until it is read.
pub(super) async fn read_body<const MOST: usize>(
    mut body: axum::body::Body,
    actor: &Actor,
    service: &Service,
) -> Result<Bytes, Error> {
    let too_long = || Error::TooMuch { what: "bytes in such a body", most: MOST as u64 };
    let unreadable =
        |error| Error::BadRequest { rule: format!("its body cannot be read: {error}") };
    if body.size_hint().lower() > MOST as u64 {
        return Err(too_long());
    }
    let (mut bytes, mut turn) = (BytesMut::new(), None);
    while let Some(frame) = body.frame().await {
        // A body may end with trailers, which have no meaning here.
        let Ok(piece) = frame.map_err(unreadable)?.into_data() else { continue };
        if bytes.len() + piece.len() > MOST {
            return Err(too_long());
        }
        bytes.extend_from_slice(&piece);
        if bytes.len() > SHORT && turn.is_none() {
            turn = Some(service.uploads.take(actor, None).await);
        }
    }
    drop(turn);
    Ok(bytes.freeze())
}

/// The longest message about a body that cannot be read.
const LONGEST_RULE: usize = 400;

/// The error in some JSON, without Rust's names.
fn in_words_of_json(message: &str) -> String {
    let mut text = message.replace(" field ", " member ");
    for (name, most) in
        [("u16", u64::from(u16::MAX)), ("u32", u64::from(u32::MAX)), ("u64", u64::MAX)]
    {
        text = text.replace(
            &format!("expected {name}"),
            &format!("expected a whole number from 0 to {most}"),
        );
    }
    // The name of a type, and its number of members.
    if let Some((before, after)) = text.split_once("expected struct ") {
        let rest = after.split_once(" at ").map_or("", |(_, place)| place);
        let place = if rest.is_empty() { String::new() } else { format!(" at {rest}") };
        text = format!("{before}expected an object{place}");
    }
    text
}

/// Numbers that other programs write, but that JSON does not have.
const NO_NUMBERS: [&str; 3] = ["NaN", "-Infinity", "Infinity"];

/// The number that JSON does not have at the place of an error.
fn no_number(body: &[u8], error: &serde_json::Error) -> Option<&'static str> {
    let line = body.split(|&byte| byte == b'\n').nth(error.line().checked_sub(1)?)?;
    // The place is that of the character or the one before it.
    let starts =
        (error.column().saturating_sub(2)..=error.column()).filter_map(|at| line.get(at..));
    starts
        .flat_map(|rest| NO_NUMBERS.into_iter().filter(|name| rest.starts_with(name.as_bytes())))
        .next()
}

/// A body without the byte order mark that some programs begin a text with, or several of them.
pub(super) fn without_mark(mut body: &[u8]) -> &[u8] {
    while let Some(rest) = body.strip_prefix(b"\xef\xbb\xbf") {
        body = rest;
    }
    body
}

/// Parses the JSON object of a request. An empty body is the empty object.
///
/// # Errors
/// [`Error::BadRequest`] also for a list, which `serde` would read as members without their names.
pub(super) fn parse<T: DeserializeOwned>(body: &[u8]) -> Result<T, Error> {
    let body = match without_mark(body) {
        [] => b"{}".as_slice(),
        body => body,
    };
    if body.trim_ascii_start().starts_with(b"[") {
        return Err(Error::BadRequest { rule: "expected an object, found a list".to_owned() });
    }
    parse_any(body)
}

/// Parses the JSON of a request, which may be a list.
pub(super) fn parse_any<T: DeserializeOwned>(body: &[u8]) -> Result<T, Error> {
    serde_json::from_slice(body).map_err(|error| {
        if let Some(name) = no_number(body, &error) {
            let rule = format!(
                "{name} is no number of JSON, at line {} column {}: leave the member out, or write null",
                error.line(),
                error.column()
            );
            return Error::BadRequest { rule };
        }
        // A message may quote the request, which may be long.
        let text = in_words_of_json(&error.to_string());
        let mut rule: String = text.chars().take(LONGEST_RULE).collect();
        if rule.len() < text.len() {
            rule.push_str("...");
        }
        Error::BadRequest { rule }
    })
}
