//! The paths of the service.

mod days;
mod decisions;
mod events;
mod extract;
mod outlooks;
mod stream;

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Serialize;
use tower_http::catch_panic::CatchPanicLayer;
use utoipa::OpenApi;

pub(crate) use self::extract::Sender;
use crate::access::admit;
use crate::error::Error;
use crate::metrics::{measure, show};
use crate::service::Service;

/// The longest body of a request: a scenario with the demand of a large network.
const LONGEST_BODY: usize = 64 << 20;

/// No request takes longer.
const LONGEST: Duration = Duration::from_secs(30);

/// The description of the API.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "Vertifleet dispatch service",
        description = "Live days of fleets of electric air taxis: events, decisions with reasons, outlooks.",
        license(name = "MIT OR Apache-2.0")
    ),
    paths(
        days::list, days::create, days::read, days::archive, days::delete, days::state,
        days::trace, events::list, events::append, decisions::propose, decisions::decide,
        outlooks::outlook, outlooks::what_if, stream::stream
    ),
    tags(
        (name = "days", description = "Days and their state"),
        (name = "events", description = "What happens on a day"),
        (name = "decisions", description = "Where an aircraft flies next, and why"),
        (name = "outlooks", description = "How a day goes on, and what it would be otherwise")
    )
)]
struct Api;

/// The description of the API as indented JSON (`OpenAPI` 3.1).
pub fn openapi() -> String {
    Api::openapi().to_pretty_json().expect("plain data can be written") + "\n"
}

/// All paths.
pub(crate) fn router(service: Arc<Service>) -> Router {
    Router::new()
        .route("/v1/days", get(days::list).post(days::create))
        .route("/v1/days/{day}", get(days::read).delete(days::delete))
        .route("/v1/days/{day}/archive", post(days::archive))
        .route("/v1/days/{day}/state", get(days::state))
        .route("/v1/days/{day}/trace.csv", get(days::trace))
        .route("/v1/days/{day}/events", get(events::list).post(events::append))
        .route("/v1/days/{day}/stream", get(stream::stream))
        .route("/v1/days/{day}/aircraft/{aircraft}/decision", get(decisions::propose))
        .route("/v1/days/{day}/decisions", post(decisions::decide))
        .route("/v1/days/{day}/outlook", get(outlooks::outlook))
        .route("/v1/days/{day}/what-if", post(outlooks::what_if))
        .route("/healthz", get(|| async { "ok\n" }))
        .route("/readyz", get(ready))
        .route("/metrics", get(show))
        .route("/openapi.json", get(described))
        .fallback(|uri: axum::http::Uri| async move { Error::not_found("path", uri.path()) })
        .method_not_allowed_fallback(|method: axum::http::Method| async move {
            Error::NotAllowed { method: method.to_string() }
        })
        .layer(DefaultBodyLimit::max(LONGEST_BODY))
        .layer(from_fn_with_state(Arc::clone(&service), admit))
        .layer(CatchPanicLayer::custom(panicked))
        .layer(from_fn_with_state(Arc::clone(&service), measure))
        .layer(from_fn(in_time))
        .layer(from_fn(with_headers))
        .with_state(service)
}

/// The answer after a panic. What happened is in the log, under the number that the client gets.
#[expect(clippy::needless_pass_by_value, reason = "the signature of the layer")]
fn panicked(panic: Box<dyn std::any::Any + Send>) -> Response {
    let said = panic.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic");
    let id = crate::days::now_ms();
    tracing::error!(id, said, "a request failed inside");
    Error::Internal { cause: format!("the log has more under {id}") }.into_response()
}

/// Ends a request that takes too long to be read or answered. Streams are answered at once, and go on.
async fn in_time(request: axum::extract::Request, next: Next) -> Result<Response, Error> {
    let answer = tokio::time::timeout(LONGEST, next.run(request)).await;
    answer.map_err(|_| Error::TooSlow { limit_s: LONGEST.as_secs() })
}

/// Adds the headers that keep browsers from guessing and from showing answers inside other pages.
async fn with_headers(request: axum::extract::Request, next: Next) -> Response {
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

async fn ready(
    axum::extract::State(service): axum::extract::State<Arc<Service>>,
) -> Result<&'static str, Error> {
    service.days.store().check().await?;
    Ok("ready\n")
}

async fn described() -> Response {
    ([(header::CONTENT_TYPE, "application/json")], openapi()).into_response()
}

/// An answer in JSON.
fn json(status: StatusCode, answer: &impl Serialize) -> Response {
    let body = serde_json::to_string(answer).expect("plain data can be written");
    written(status, body)
}

/// An answer that is JSON already.
fn written(status: StatusCode, body: String) -> Response {
    (status, [(header::CONTENT_TYPE, "application/json")], body).into_response()
}

/// An answer about a day at an event, whose number is the `ETag`.
fn at_event(status: StatusCode, seq: u64, answer: &impl Serialize) -> Response {
    let mut response = json(status, answer);
    let tag = format!("\"{seq}\"").parse().expect("a number in quotes is a header");
    response.headers_mut().insert(header::ETAG, tag);
    response
}
