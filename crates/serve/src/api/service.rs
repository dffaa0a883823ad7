//! The service: its properties and its health.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;

use super::answer::json;
use super::describe::openapi;
use crate::error::Error;
use crate::service::Service;
use crate::tokens::Role;

/// The properties of the service, and the rights of the sender.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct ServiceInfo {
    /// The version of the program.
    version: &'static str,
    /// The name of the token that the request came with; null without tokens.
    token: Option<String>,
    /// The role of the token: `read`, `dispatch` or `admin`.
    role: Role,
    /// The policy that decides on a day if none is named.
    policy: &'static str,
}

/// Returns the properties of the service, and the rights of the sender.
#[utoipa::path(operation_id = "service_info", get, path = "/v1", tag = "service", responses((status = 200, body = ServiceInfo)))]
pub(super) async fn info(
    State(service): State<Arc<Service>>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let token = service.access.may(&headers, Role::Read).await?;
    let role = token.as_ref().map_or(Role::Admin, |token| token.role);
    let (version, policy) = (env!("CARGO_PKG_VERSION"), super::days::DEFAULT_POLICY);
    let info = ServiceInfo { version, token: token.map(|token| token.name), role, policy };
    Ok(json(StatusCode::OK, &info))
}

/// Whether the service runs. It needs no token.
#[utoipa::path(operation_id = "healthz", get, path = "/healthz", tag = "service", responses((status = 200, content_type = "text/plain", body = String)))]
pub(super) async fn healthz() -> &'static str {
    "ok\n"
}

/// Whether the store of the service accepts writes. It needs no token.
#[utoipa::path(operation_id = "readyz", get, path = "/readyz", tag = "service", responses((status = 200, content_type = "text/plain", body = String)))]
pub(super) async fn readyz(State(service): State<Arc<Service>>) -> Result<&'static str, Error> {
    service.days.check().await?;
    Ok("ready\n")
}

/// The metrics of the service, for Prometheus.
#[utoipa::path(operation_id = "metrics", get, path = "/metrics", tag = "service", responses((status = 200, content_type = "application/openmetrics-text", body = String)))]
pub(super) async fn metrics(State(service): State<Arc<Service>>) -> Response {
    let kind = "application/openmetrics-text; version=1.0.0; charset=utf-8";
    ([(header::CONTENT_TYPE, kind)], service.days.metrics.text()).into_response()
}

/// This description.
#[utoipa::path(operation_id = "openapi", get, path = "/openapi.json", tag = "service", responses((status = 200, body = Object)))]
pub(super) async fn described() -> Response {
    ([(header::CONTENT_TYPE, "application/json")], openapi()).into_response()
}
