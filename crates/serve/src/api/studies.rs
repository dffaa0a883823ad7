//! Starts, lists, reads and ends studies.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;
use sha2::{Digest as _, Sha256};
use utoipa::ToSchema;
use vertifleet_report::REPLAY_FRAME_SCRIPT;

use super::answer::json;
use super::days::new_id;
use super::extract::{Named, UPLOAD, parse};
use super::write::Idempotent;
use crate::access::Actor;
use crate::error::Error;
use crate::service::Service;
use crate::studies::{NewStudy, StudyInfo};

/// All studies.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct StudyList {
    /// The latest first, without results.
    studies: Vec<StudyInfo>,
}

/// Lists the studies since the service started, the latest first. It keeps the last 20 that have
/// ended, in memory. The result of a study follows from its request, so it can be computed again.
#[utoipa::path(operation_id = "list_studies", get, path = "/v1/studies", tag = "studies", responses((status = 200, body = StudyList)))]
pub(super) async fn list(State(service): State<Arc<Service>>) -> Response {
    json(StatusCode::OK, &StudyList { studies: service.studies.list() })
}

/// Plays policies on many days of a network, in the background. One study plays at a time, and
/// eight may wait. The service keeps it until it stops.
#[utoipa::path(operation_id = "make_study", post, path = "/v1/studies", tag = "studies", request_body = NewStudy, responses((status = 201, body = StudyInfo)))]
pub(super) async fn create(
    State(service): State<Arc<Service>>,
    Idempotent { writer, body }: Idempotent<UPLOAD>,
) -> Result<Response, Error> {
    if let Some(known) = service.studies.asked_before(writer.idempotency.as_ref())? {
        return Ok(json(StatusCode::CREATED, &known));
    }
    let turn = (&service.turns.outlooks, &writer.actor);
    let asked = parse::<NewStudy>(&body)?;
    let asked = asked.check(&service.days.store, &service.policies, turn).await?;
    let study = service.studies.add(new_id(), writer.idempotency, asked)?;
    Ok(json(StatusCode::CREATED, &study))
}

/// Reads a study: its progress, and its result once it has finished.
#[utoipa::path(operation_id = "read_study", get, path = "/v1/studies/{study}", tag = "studies", params(("study" = String, Path)), responses((status = 200, body = StudyInfo)))]
pub(super) async fn read(
    State(service): State<Arc<Service>>,
    Named(study): Named<String>,
) -> Result<Response, Error> {
    Ok(json(StatusCode::OK, &service.studies.read(&study)?))
}

/// The result of a study as the page of a report, which also opens without the service.
#[utoipa::path(operation_id = "study_report", get, path = "/v1/studies/{study}/report", tag = "studies", params(("study" = String, Path)), responses((status = 200, content_type = "text/html", body = String)))]
pub(super) async fn report(
    State(service): State<Arc<Service>>,
    Named(study): Named<String>,
    actor: Actor,
) -> Result<Response, Error> {
    let turns = service.turns.outlooks.clone();
    let page = turns.work(&actor, None, move |_| service.studies.page(&study)).await?;
    let headers = [
        (header::CONTENT_TYPE, HeaderValue::from_static("text/html; charset=utf-8")),
        (header::CONTENT_SECURITY_POLICY, policy_of(&page)),
    ];
    Ok((headers, page).into_response())
}

/// The first days of a study as each policy played them: the scenarios, and a trace for each
/// policy. The console replays them. At most three days, and only the first where they are large.
#[utoipa::path(operation_id = "study_replay", get, path = "/v1/studies/{study}/replay", tag = "studies", params(("study" = String, Path)), responses((status = 200, body = StudyReplay)))]
pub(super) async fn replay(
    State(service): State<Arc<Service>>,
    Named(study): Named<String>,
    actor: Actor,
) -> Result<Response, Error> {
    let turns = service.turns.outlooks.clone();
    let replay = turns.work(&actor, None, move |_| service.studies.replay(&study)).await?;
    Ok(([(header::CONTENT_TYPE, "application/json")], replay).into_response())
}

/// The first days of a study as each policy played them.
#[derive(ToSchema)]
#[expect(dead_code, reason = "the study writes it, and this describes it")]
pub(crate) struct StudyReplay {
    /// The days.
    days: Vec<ReplayedDay>,
}

/// A day that policies played.
#[derive(ToSchema)]
#[expect(dead_code, reason = "the study writes it, and this describes it")]
pub(crate) struct ReplayedDay {
    /// The name of its scenario.
    name: String,
    /// The scenario, as its file has it.
    #[schema(value_type = Object)]
    scenario: (),
    /// The day as each policy played it.
    plays: Vec<Play>,
}

/// A day as a policy played it.
#[derive(ToSchema)]
#[expect(dead_code, reason = "the study writes it, and this describes it")]
pub(crate) struct Play {
    /// The policy.
    policy: String,
    /// The trace, as its file has it, with amounts to the cent.
    trace: String,
    /// The profit of the day, dollars.
    profit_usd: f64,
}

/// Ends a study if it plays or waits, and removes it.
#[utoipa::path(operation_id = "delete_study", delete, path = "/v1/studies/{study}", tag = "studies", params(("study" = String, Path)), responses((status = 204)))]
pub(super) async fn delete(
    State(service): State<Arc<Service>>,
    Named(study): Named<String>,
) -> Result<StatusCode, Error> {
    service.studies.delete(&study)?;
    Ok(StatusCode::NO_CONTENT)
}

/// The content security policy of a page: its own style sheet and script, and those of the replay
/// in it, which inherits the policy. The page has no access to the service or to the data of the
/// console.
fn policy_of(page: &str) -> HeaderValue {
    let style = page.split_once("<style>").and_then(|(_, rest)| rest.split_once("</style>"));
    let style = style.map_or("", |(style, _)| style);
    let [replay, look] = vertifleet_console::replay_script_and_style();
    let [style, look, script, replay] = [style, look, REPLAY_FRAME_SCRIPT, replay]
        .map(|text| BASE64_STANDARD.encode(Sha256::digest(text)));
    let policy = format!(
        "default-src 'none'; style-src 'sha256-{style}' 'sha256-{look}'; \
         script-src 'sha256-{script}' 'sha256-{replay}'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'; sandbox allow-scripts"
    );
    HeaderValue::try_from(policy).expect("letters and marks are a header")
}
