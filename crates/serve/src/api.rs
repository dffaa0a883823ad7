//! The paths of the service.

mod answer;
mod days;
mod decisions;
mod demand;
mod describe;
mod events;
mod extract;
mod ledger;
mod networks;
mod new_day;
mod outlooks;
mod policies;
mod service;
mod stream;
mod studies;

use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};

use axum::Router;
use axum::body::{Body, Bytes, HttpBody};
use axum::extract::{Request, State};
use axum::http::{HeaderValue, Method, header};
use axum::middleware::{Next, from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use hyper::body::{Frame, SizeHint};
use tower_http::catch_panic::CatchPanicLayer;
use vertifleet_core::Coded as _;

pub(crate) use self::answer::Totals;
pub use self::describe::openapi;
pub(crate) use self::extract::Sender;
use crate::access::admit;
use crate::console::Console;
use crate::error::Error;
use crate::metrics::measure;
use crate::service::Service;

/// A read that meets a write of another service is carried out this often.
const READS: u32 = 5;

/// All paths.
pub(crate) fn router(service: Arc<Service>, console: Console) -> Router {
    Router::new()
        .route("/v1/days", get(days::list).post(days::create))
        .route("/v1/days/{day}", get(days::read).delete(days::delete))
        .route("/v1/days/{day}/archive", post(days::archive))
        .route("/v1/days/{day}/unarchive", post(days::unarchive))
        .route("/v1/days/{day}/state", get(days::state))
        .route("/v1/days/{day}/demand", get(demand::demand))
        .route("/v1/days/{day}/ledger", get(ledger::ledger))
        .route("/v1/days/{day}/scenario", get(days::scenario))
        .route("/v1/days/{day}/trace.csv", get(days::trace))
        .route("/v1/days/{day}/events", get(events::list).post(events::append))
        .route("/v1/days/{day}/stream", get(stream::stream))
        .route("/v1/days/{day}/aircraft/{aircraft}/decision", get(decisions::propose))
        .route("/v1/days/{day}/decisions", post(decisions::decide))
        .route("/v1/days/{day}/outlook", get(outlooks::outlook))
        .route("/v1/days/{day}/what-if", post(outlooks::what_if))
        .route("/v1/networks", get(networks::list))
        .route("/v1/networks/validate", post(networks::validate))
        .route(
            "/v1/networks/{network}",
            get(networks::read).put(networks::put).delete(networks::delete),
        )
        .route("/v1/policies", get(policies::list))
        .route("/v1/policies/validate", post(policies::validate))
        .route(
            "/v1/policies/{policy}",
            get(policies::read).put(policies::put).delete(policies::delete),
        )
        .route("/v1/studies", get(studies::list).post(studies::create))
        .route("/v1/studies/{study}", get(studies::read).delete(studies::delete))
        .route("/v1/studies/{study}/report", get(studies::report))
        .route("/v1/studies/{study}/replay", get(studies::replay))
        .route("/v1", get(service::info))
        .route("/healthz", get(service::healthz))
        .route("/readyz", get(service::readyz))
        .route("/metrics", get(service::metrics))
        .route("/openapi.json", get(service::described))
        .merge(console.router())
        .fallback(|uri: axum::http::Uri| async move { Error::not_found("path", uri.path()) })
        .method_not_allowed_fallback(|method: axum::http::Method| async move {
            Error::NotAllowed { method: method.to_string() }
        })
        .layer(from_fn(again_after_conflict))
        .layer(from_fn_with_state(Arc::clone(&service), admit))
        .layer(CatchPanicLayer::custom(panicked))
        .layer(from_fn_with_state(Arc::clone(&service), in_time))
        .layer(from_fn_with_state(Arc::clone(&service), measure))
        .layer(from_fn(with_headers))
        .layer(from_fn(with_whole_body))
        .with_state(service)
}

/// The answer after a panic. What happened is in the log, under the number that the client gets.
#[expect(clippy::needless_pass_by_value, reason = "the signature of the layer")]
fn panicked(panic: Box<dyn std::any::Any + Send>) -> Response {
    let said = panic.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic");
    let id = crate::clock::now_ms();
    tracing::error!(id, said, "a request failed inside");
    Error::Internal { cause: format!("the log has more under {id}") }.into_response()
}

/// Carries a read out again if another service wrote to the day at that moment, so that the day has
/// to be read again.
async fn again_after_conflict(request: Request, next: Next) -> Response {
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

/// Ends a request that takes too long to be read or answered. Streams are answered at once, and go
/// on.
async fn in_time(
    State(service): State<Arc<Service>>,
    request: Request,
    next: Next,
) -> Result<Response, Error> {
    let limit = service.limits.request;
    let answer = tokio::time::timeout(limit, next.run(request)).await;
    answer.map_err(|_| Error::TooSlow { limit_s: limit.as_secs() })
}

/// Closes the connection after an answer to a request whose body was not read, and says so:
/// otherwise the next request on it would be lost.
async fn with_whole_body(request: Request, next: Next) -> Response {
    let (parts, body) = request.into_parts();
    let has_ended = Arc::new(AtomicBool::new(body.is_end_stream()));
    let body = Watched { body, has_ended: Arc::clone(&has_ended) };
    let mut answer = next.run(Request::from_parts(parts, Body::new(body))).await;
    if !has_ended.load(Ordering::Acquire) {
        answer.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    }
    answer
}

/// A body that says when it has been read to its end.
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

/// Adds the headers that keep browsers from guessing and from showing answers inside other pages.
async fn with_headers(request: Request, next: Next) -> Response {
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
