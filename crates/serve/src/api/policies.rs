//! Lists, reads, stores, checks and removes policies.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::Stop;

use super::answer::json;
use super::extract::{Body, Named, UPLOAD};
use crate::access::Actor;
use crate::clock::now_ms;
use crate::error::Error;
use crate::policies::{self, PolicyInfo, WeightsInfo};
use crate::service::Service;

/// The bytes of a weight file.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "it stands for a body in the description")]
pub(crate) struct Weights(Vec<u8>);

/// All policies.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct PolicyList {
    /// Those of the program, then those that were uploaded, by their names.
    policies: Vec<PolicyInfo>,
}

/// Lists the policies that can decide.
#[utoipa::path(operation_id = "list_policies", get, path = "/v1/policies", tag = "policies", responses((status = 200, body = PolicyList)))]
pub(super) async fn list(State(service): State<Arc<Service>>) -> Result<Response, Error> {
    Ok(json(StatusCode::OK, &PolicyList { policies: service.policies.list().await? }))
}

/// Describes a policy.
#[utoipa::path(operation_id = "read_policy", get, path = "/v1/policies/{policy}", tag = "policies", params(("policy" = String, Path)), responses((status = 200, body = PolicyInfo)))]
pub(super) async fn read(
    State(service): State<Arc<Service>>,
    Named(name): Named<String>,
) -> Result<Response, Error> {
    Ok(json(StatusCode::OK, &service.policies.info(&name).await?))
}

/// Stores the weights of a policy, the bytes of a weight file, under a name. The name means these
/// weights permanently.
#[utoipa::path(operation_id = "put_policy", put, path = "/v1/policies/{policy}", tag = "policies", params(("policy" = String, Path, pattern = "^[a-z0-9_-][a-z0-9._-]{0,39}$")), request_body(content = Weights, content_type = "application/octet-stream"), responses((status = 200, body = PolicyInfo)))]
pub(super) async fn put(
    State(service): State<Arc<Service>>,
    Named(name): Named<String>,
    actor: Actor,
    Body(weights): Body<UPLOAD>,
) -> Result<Response, Error> {
    let (keeper, named) = (Arc::clone(&service), name.clone());
    let put = async move { keeper.policies.put(&named, &weights, now_ms()).await };
    let info = service.turns.readings.run(&actor, put).await?;
    service.days.store.record(&actor.name, "policy uploaded", &name, now_ms()).await?;
    Ok(json(StatusCode::OK, &info))
}

/// Removes a policy that was uploaded. A day that it decides on continues with it until the service
/// restarts.
#[utoipa::path(operation_id = "delete_policy", delete, path = "/v1/policies/{policy}", tag = "policies", params(("policy" = String, Path)), responses((status = 204)))]
pub(super) async fn delete(
    State(service): State<Arc<Service>>,
    Named(name): Named<String>,
    actor: Actor,
) -> Result<StatusCode, Error> {
    if !service.days.store.delete_policy(&name).await? {
        return Err(Error::not_found("uploaded policy", &name));
    }
    service.days.store.record(&actor.name, "policy deleted", &name, now_ms()).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Checks a weight file without storing it, and describes it.
#[utoipa::path(operation_id = "validate_policy", post, path = "/v1/policies/validate", tag = "policies", request_body(content = Weights, content_type = "application/octet-stream"), responses((status = 200, body = WeightsInfo)))]
pub(super) async fn validate(
    State(service): State<Arc<Service>>,
    actor: Actor,
    Body(weights): Body<UPLOAD>,
) -> Result<Response, Error> {
    let validate = move |_: &Stop| Ok(json(StatusCode::OK, &policies::validate(&weights)?));
    service.turns.readings.work(&actor, None, validate).await
}
