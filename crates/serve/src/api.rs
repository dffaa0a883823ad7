//! The paths of the service.

mod days;
mod decisions;
mod describe;
mod events;
mod extract;
mod networks;
mod outlooks;
mod policies;
mod stream;

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::{Deserialize, Serialize};
use tower_http::catch_panic::CatchPanicLayer;
use utoipa::{IntoParams, ToSchema};

pub use self::describe::openapi;
pub(crate) use self::extract::Sender;
use crate::access::admit;
use crate::days::DayCell;
use crate::error::Error;
use crate::metrics::{measure, show};
use crate::moment::by_calendar;
use crate::service::Service;

/// The longest body of a request: a scenario with the demand of a large network.
const LONGEST_BODY: usize = 64 << 20;

/// No request takes longer.
const LONGEST: Duration = Duration::from_secs(30);

/// All paths.
pub(crate) fn router(service: Arc<Service>) -> Router {
    Router::new()
        .route("/v1/days", get(days::list).post(days::create))
        .route("/v1/days/{day}", get(days::read).delete(days::delete))
        .route("/v1/days/{day}/archive", post(days::archive))
        .route("/v1/days/{day}/state", get(days::state))
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

/// How times are written in an answer.
#[derive(Debug, Clone, Copy, Default, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum Times {
    /// As `HH:MM:SS` of the day.
    #[default]
    Clock,
    /// In ISO 8601 with the offset of the place, for days that have a date.
    Iso,
}

impl Times {
    /// Writes an answer about a day.
    fn of<T>(self, day: &DayCell, write: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        match (self, day.calendar()) {
            (Self::Clock, _) => write(),
            (Self::Iso, Some(calendar)) => by_calendar(Some(calendar), write),
            (Self::Iso, None) => {
                let rule = "times can be written in ISO 8601 for days that have a date".to_owned();
                Err(Error::BadRequest { rule })
            }
        }
    }
}

/// Which times are asked for.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Written {
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
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
