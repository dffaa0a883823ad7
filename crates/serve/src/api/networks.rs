//! Lists, reads, stores, checks and removes networks.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use vertifleet_core::Stop;

use super::answer::json;
use super::extract::{Body, Named, UPLOAD, parse};
use crate::access::Actor;
use crate::clock::now_ms;
use crate::error::Error;
use crate::networks::{self, NetworkInfo};
use crate::service::Service;

/// A network to upload.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewNetwork {
    /// The text of its network file, including its table of demand.
    toml: String,
}

/// All networks.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct NetworkList {
    /// Those that the program ships, then those that were uploaded, by their names.
    networks: Vec<NetworkInfo>,
}

/// Lists the networks from which days can be made.
#[utoipa::path(operation_id = "list_networks", get, path = "/v1/networks", tag = "networks", responses((status = 200, body = NetworkList)))]
pub(super) async fn list(State(service): State<Arc<Service>>) -> Result<Response, Error> {
    let networks = networks::list(&service.days.store).await?;
    Ok(json(StatusCode::OK, &NetworkList { networks }))
}

/// Reads a network, with its file.
#[utoipa::path(operation_id = "read_network", get, path = "/v1/networks/{network}", tag = "networks", params(("network" = String, Path)), responses((status = 200, body = NetworkInfo)))]
pub(super) async fn read(
    State(service): State<Arc<Service>>,
    Named(name): Named<String>,
) -> Result<Response, Error> {
    let (network, is_shipped) = networks::find(&service.days.store, &name).await?;
    let toml = Some(network.toml().to_owned());
    Ok(json(StatusCode::OK, &NetworkInfo { toml, ..NetworkInfo::of(&network, is_shipped) }))
}

/// Stores a network under its name, and replaces one that was uploaded before. Existing days keep
/// the network that they were made from.
#[utoipa::path(operation_id = "put_network", put, path = "/v1/networks/{network}", tag = "networks", params(("network" = String, Path)), request_body = NewNetwork, responses((status = 200, body = NetworkInfo)))]
pub(super) async fn put(
    State(service): State<Arc<Service>>,
    Named(name): Named<String>,
    actor: Actor,
    Body(body): Body<UPLOAD>,
) -> Result<Response, Error> {
    let (store, named) = (service.days.store.clone(), name.clone());
    let put = async move {
        let NewNetwork { toml } = parse(&body)?;
        networks::put(&store, &named, toml, now_ms()).await
    };
    let info = service.turns.readings.run(&actor, put).await?;
    service.days.store.record(&actor.name, "network uploaded", &name, now_ms()).await?;
    Ok(json(StatusCode::OK, &info))
}

/// Removes a network that was uploaded. Existing days keep the network that they were made from.
#[utoipa::path(operation_id = "delete_network", delete, path = "/v1/networks/{network}", tag = "networks", params(("network" = String, Path)), responses((status = 204)))]
pub(super) async fn delete(
    State(service): State<Arc<Service>>,
    Named(name): Named<String>,
    actor: Actor,
) -> Result<StatusCode, Error> {
    if !service.days.store.delete_network(&name).await? {
        return Err(Error::not_found("uploaded network", &name));
    }
    service.days.store.record(&actor.name, "network deleted", &name, now_ms()).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Checks a network without storing it.
#[utoipa::path(operation_id = "validate_network", post, path = "/v1/networks/validate", tag = "networks", request_body = NewNetwork, responses((status = 200, body = NetworkInfo)))]
pub(super) async fn validate(
    State(service): State<Arc<Service>>,
    actor: Actor,
    Body(body): Body<UPLOAD>,
) -> Result<Response, Error> {
    let validate = move |_: &Stop| {
        let NewNetwork { toml } = parse(&body)?;
        Ok(json(StatusCode::OK, &NetworkInfo::of(&networks::read(&toml)?, false)))
    };
    service.turns.readings.work(&actor, None, validate).await
}
