//! The common steps of every request, before and after its handler: access, time limit, metrics and
//! headers.

use std::any::Any;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use std::time::Instant;

use axum::body::{Body, Bytes, HttpBody};
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderValue, Method, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use hyper::body::{Frame, SizeHint};
use vertifleet_core::{Code, Coded as _};

use crate::clock::now_ms;
use crate::console;
use crate::error::Error;
use crate::service::Service;
use crate::tokens::Role;

/// Largest number of tries of a read that meets a write of another service.
const READS: u32 = 5;

/// Admits permitted requests. Health checks need no token.
pub(super) async fn admit(
    State(service): State<Arc<Service>>,
    mut request: Request,
    next: Next,
) -> Result<Response, Error> {
    if request.headers().get_all(header::HOST).iter().nth(1).is_some() {
        return Err(Error::BadRequest { rule: "it has more than one Host header".to_owned() });
    }
    let path = request.uri().path();
    if !matches!(path, "/healthz" | "/readyz") && !console::is_open(path) {
        let needed = role_for(request.method(), path);
        // HTTP/2 has the host in the address of the request.
        let named = request.uri().host().map(str::to_owned);
        let told = || request.headers().get(header::HOST)?.to_str().ok().map(str::to_owned);
        let host = named.or_else(told).unwrap_or_default();
        let actor = service.access.admit(&host, request.headers(), needed).await?;
        request.extensions_mut().insert(actor);
    }
    Ok(next.run(request).await)
}

/// The role that a request needs.
fn role_for(method: &Method, path: &str) -> Role {
    match *method {
        Method::GET | Method::HEAD | Method::OPTIONS => Role::Read,
        Method::POST if path.ends_with("/what-if") || path.ends_with("/validate") => Role::Read,
        Method::POST if !["/archive", "/unarchive"].iter().any(|end| path.ends_with(end)) => {
            Role::Dispatch
        }
        // A role that may start a study may end it.
        Method::DELETE if path.starts_with("/v1/studies/") => Role::Dispatch,
        _ => Role::Admin,
    }
}

/// Measures a request. This is the only place where requests are counted, logged, and reported to a
/// collector.
pub(super) async fn measure(
    State(service): State<Arc<Service>>,
    request: Request,
    next: Next,
) -> Response {
    let known = [Method::GET, Method::POST, Method::PUT, Method::DELETE, Method::HEAD];
    // Methods that a client invents must not create series.
    let method = request.method();
    let is_known = known.contains(method);
    let method = if is_known { method.as_str() } else { "other" }.to_owned();
    // The described path instead of the actual one, since each id would be its own series.
    let path = request.extensions().get::<MatchedPath>().cloned();
    let path = path.as_ref().map(MatchedPath::as_str);
    let span = service.spans.as_ref().map(|spans| {
        let method = if is_known { &method } else { "_OTHER" };
        spans.begin(method, path, request.headers())
    });
    let path = path.unwrap_or("unknown");
    let begun = Instant::now();
    let answer = next.run(request).await;
    let (took, status) = (begun.elapsed(), answer.status());
    service.days.metrics.answered(&method, path, status.as_u16(), took.as_secs_f64());
    let code = answer.extensions().get::<Code>().map(Code::to_string);
    let trace = span.as_ref().map(|span| span.trace().to_string());
    let (status_number, took_us) = (status.as_u16(), took.as_micros());
    tracing::info!(method, path, status = status_number, code, trace, took_us, "a request");
    if let Some(span) = span {
        span.end(status, code);
    }
    answer
}

/// The answer after a panic. The log has the details, under the number in the answer.
#[expect(clippy::needless_pass_by_value, reason = "the signature of the layer")]
pub(super) fn panicked(panic: Box<dyn Any + Send>) -> Response {
    let said = panic.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic");
    let id = now_ms();
    tracing::error!(id, said, "a request failed inside");
    Error::Internal { cause: format!("the log has more under {id}") }.into_response()
}

/// Repeats a read if another service wrote to the day at that moment, so that the day must be read
/// again.
pub(super) async fn again_after_conflict(request: Request, next: Next) -> Response {
    if request.method() != Method::GET {
        return next.run(request).await;
    }
    let (parts, _) = request.into_parts();
    let mut tries = 0;
    loop {
        tries += 1;
        let request = Request::from_parts(parts.clone(), Body::empty());
        let answer = next.clone().run(request).await;
        let is_conflict = answer.extensions().get() == Some(&Error::Conflict.code());
        if !is_conflict || tries == READS {
            return answer;
        }
    }
}

/// Ends a request that takes too long to be read or answered. Streams are answered at once, and
/// continue.
pub(super) async fn in_time(
    State(service): State<Arc<Service>>,
    request: Request,
    next: Next,
) -> Result<Response, Error> {
    let limit = service.limits.request;
    let answer = tokio::time::timeout(limit, next.run(request)).await;
    answer.map_err(|_| Error::TooSlow { limit_s: limit.as_secs() })
}

/// Closes the connection after an answer to a request whose body was not read, and announces that
/// in a header: otherwise the next request on it would be lost.
pub(super) async fn with_whole_body(request: Request, next: Next) -> Response {
    let (parts, body) = request.into_parts();
    let has_ended = Arc::new(AtomicBool::new(body.is_end_stream()));
    let body = Watched { body, has_ended: Arc::clone(&has_ended) };
    let mut answer = next.run(Request::from_parts(parts, Body::new(body))).await;
    if !has_ended.load(Ordering::Acquire) {
        answer.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    }
    answer
}

/// A body that records when it has been read to its end.
struct Watched {
    body: Body,
    has_ended: Arc<AtomicBool>,
}

impl HttpBody for Watched {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(context);
        if matches!(frame, Poll::Ready(None)) || self.body.is_end_stream() {
            self.has_ended.store(true, Ordering::Release);
        }
        frame
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// Adds the headers that stop browsers from guessing types and from showing answers inside other
/// pages.
pub(super) async fn with_headers(request: Request, next: Next) -> Response {
    let mut answer = next.run(request).await;
    let headers = answer.headers_mut();
    for (name, value) in [
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::CONTENT_SECURITY_POLICY, "default-src 'none'; frame-ancestors 'none'"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.entry(name).or_insert(HeaderValue::from_static(value));
    }
    answer
}
