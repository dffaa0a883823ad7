//! Writes: the sender, the conditions, and the key by which a write is carried out once.

use std::hash::Hasher as _;
use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::{FromRequest, FromRequestParts, Request};
use axum::http::HeaderMap;
use axum::http::request::Parts;
use axum::response::{IntoResponse as _, Response};
use siphasher::sip128::{Hasher128 as _, SipHasher24};

use super::answer::again;
use super::extract::{SHORT, read_body};
use crate::access::Actor;
use crate::days::Writer;
use crate::error::Error;
use crate::keys::Idempotency;
use crate::service::Service;

/// The longest key of a request.
const LONGEST_KEY: usize = 128;

impl<S: Send + Sync> FromRequestParts<S> for Writer {
    type Rejection = Error;

    /// The sender of a request, with `If-Match`.
    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Error> {
        let Ok(actor) = Actor::from_request_parts(parts, state).await;
        Ok(Self { actor, if_match: if_match(&parts.headers)?, ..Self::default() })
    }
}

/// A write that is carried out once for each `Idempotency-Key`, with its body of at most `MOST`
/// bytes. A repeated one does not reach its handler: it gets the stored answer.
pub(super) struct Idempotent<const MOST: usize = SHORT> {
    pub(super) writer: Writer,
    pub(super) body: Bytes,
}

impl<const MOST: usize> FromRequest<Arc<Service>> for Idempotent<MOST> {
    type Rejection = Response;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Response> {
        let write = Self::read(request, service).await.map_err(Error::into_response)?;
        write.map_err(again)
    }
}

impl<const MOST: usize> Idempotent<MOST> {
    /// The write, or the answer that it received before.
    async fn read(request: Request, service: &Arc<Service>) -> Result<Result<Self, String>, Error> {
        let (mut parts, body) = request.into_parts();
        let mut writer = Writer::from_request_parts(&mut parts, service).await?;
        let body = read_body::<MOST>(body, &writer.actor, service).await?;
        let Some(key) = text(&parts.headers, "idempotency-key")? else {
            return Ok(Ok(Self { writer, body }));
        };
        if key.is_empty() || key.len() > LONGEST_KEY {
            let rule = format!("Idempotency-Key must have 1 to {LONGEST_KEY} characters");
            return Err(Error::BadRequest { rule });
        }
        // Keys are separate for each token. The length separates a name from a key unambiguously.
        let name = &writer.actor.name;
        let own = format!("{}:{name}:{key}", name.len());
        let (busy, may_be_known) = service.keys.take(&own)?;
        let request = sum(parts.uri.path(), &body);
        if may_be_known && let Some(known) = service.days.store.answer(&own).await? {
            if known.request != request {
                return Err(Error::KeyReused { key: key.to_owned() });
            }
            return Ok(Err(known.answer));
        }
        writer.idempotency = Some(Idempotency { key: own, request });
        writer.busy = Some(Arc::new(busy));
        Ok(Ok(Self { writer, body }))
    }
}

fn text<'a>(headers: &'a HeaderMap, name: &str) -> Result<Option<&'a str>, Error> {
    let wrong = |_| Error::BadRequest { rule: format!("the header {name} must be plain text") };
    headers.get(name).map(|value| value.to_str().map_err(wrong)).transpose()
}

/// The number in `If-Match`, with or without quotes.
fn if_match(headers: &HeaderMap) -> Result<Option<u64>, Error> {
    let wrong = |_| Error::BadRequest {
        rule: "If-Match must be the number of an event, as ETag has it".to_owned(),
    };
    text(headers, "if-match")?.map(|text| text.trim_matches('"').parse().map_err(wrong)).transpose()
}

/// A short checksum of a request, to distinguish requests.
fn sum(path: &str, body: &[u8]) -> String {
    let mut hasher = SipHasher24::new();
    hasher.write(path.as_bytes());
    hasher.write_u8(0);
    hasher.write(body);
    let hash = hasher.finish128();
    format!("{:016x}{:016x}", hash.h1, hash.h2)
}
