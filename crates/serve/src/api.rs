//! The paths of the service.

mod answer;
mod day_state;
mod days;
mod decisions;
mod demand;
mod describe;
mod events;
mod extract;
mod ledger;
mod middleware;
mod networks;
mod new_day;
mod outlooks;
mod policies;
mod service;
mod stream;
mod studies;
mod write;

use std::sync::Arc;

use axum::Router;
use axum::middleware::{from_fn, from_fn_with_state};
use axum::routing::{get, post};
use tower_http::catch_panic::CatchPanicLayer;

pub use self::describe::openapi;
use self::middleware::{
    admit, again_after_conflict, in_time, measure, panicked, with_headers, with_whole_body,
};
use crate::console::Console;
use crate::error::Error;
use crate::service::Service;

/// All paths.
pub(crate) fn router(service: Arc<Service>, console: Console) -> Router {
    Router::new()
        .route("/v1/days", get(days::list).post(days::create))
        .route("/v1/days/{day}", get(days::read).delete(days::delete))
        .route("/v1/days/{day}/archive", post(days::archive))
        .route("/v1/days/{day}/unarchive", post(days::unarchive))
        .route("/v1/days/{day}/state", get(day_state::state))
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
