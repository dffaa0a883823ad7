//! Outlooks: the expected rest of the day, now or under changed conditions.

use std::sync::Arc;
use std::time::Instant;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;
use vertifleet_core::Stop;

use super::answer::{Times, Written, json};
use super::decisions::QUICK_POLICY;
use super::events::MOST_EVENTS;
use super::extract::{Body, EventNumber, Named, Validated, parse};
use crate::access::Actor;
use crate::day_cell::DayCell;
use crate::error::Error;
use crate::moment::by_calendar;
use crate::outlook::{Comparison, NamedPolicy, Outlook, Patience, WhatIf};
use crate::service::Service;

/// The query of an outlook.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct By {
    /// The policy that decides from now on; without it, the day's.
    policy: Option<String>,
    /// The number of the event after which the outlook begins: 0 returns the plan of the morning.
    /// Without it, the latest. If the day has no such event, the answer is 404 (V602).
    #[param(inline)]
    seq: Option<EventNumber>,
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
}

/// The expected rest of the day, now or after any of its events, if a policy takes every decision
/// from then on.
#[utoipa::path(
    operation_id = "day_outlook", get, path = "/v1/days/{day}/outlook", tag = "outlooks", params(("day" = String, Path), By),
    responses((status = 200, body = Outlook))
)]
pub(super) async fn outlook(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    actor: Actor,
    Validated(By { policy, seq, times }): Validated<By>,
) -> Result<Response, Error> {
    let until = patience(&service);
    let day = service.days.get(&day).await?;
    let mut state = match seq {
        None => day.state().clone(),
        Some(EventNumber(seq)) => service.days.at(&actor, &day, seq).await?,
    };
    let policy = named(&service, &day, policy).await?;
    let quick = named(&service, &day, Some(QUICK_POLICY.to_owned())).await?;
    let work =
        move |stop: &Stop| Outlook::in_time(&mut state, &policy, &quick, Patience { stop, until });
    let outlook = service.turns.outlooks.work(&actor, None, work).await?;
    times.answer(&day, outlook.seq, &outlook).await
}

/// The time limit of a policy that has not played the rest of a day; a quick one then gets the same
/// time.
fn patience(service: &Service) -> Instant {
    Instant::now() + service.limits.request / 2
}

/// The policy with a name, or the day's.
async fn named(
    service: &Service,
    day: &DayCell,
    name: Option<String>,
) -> Result<NamedPolicy, Error> {
    let name = name.unwrap_or_else(|| day.stored.policy.clone());
    let scenario = Arc::clone(day.state().live().scenario());
    let resolved = service.policies.resolve(&name, &scenario).await?;
    Ok(NamedPolicy { name, resolved })
}

/// Compares the outlook with that after hypothetical events, with another policy, or with other
/// stands or more aircraft. Nothing changes.
#[utoipa::path(
    operation_id = "what_if", post, path = "/v1/days/{day}/what-if", tag = "outlooks", params(("day" = String, Path), Written),
    request_body = Option<WhatIf>,
    responses((status = 200, body = Comparison))
)]
pub(super) async fn what_if(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    actor: Actor,
    Validated(Written { times }): Validated<Written>,
    Body(body): Body,
) -> Result<Response, Error> {
    let until = patience(&service);
    let day = service.days.get(&day).await?;
    let asked: Option<WhatIf> = by_calendar(day.calendar(), || parse(&body))?;
    let asked = asked.unwrap_or_default();
    if asked.events.len() > MOST_EVENTS {
        return Err(Error::TooMuch { what: "events in a what-if", most: MOST_EVENTS as u64 });
    }
    let mut state = day.state().clone();
    day.stored_up_to(state.seq()).await?;
    let otherwise = if asked.begins_otherwise() {
        let scenario = asked.scenario(state.live().scenario())?;
        let days = &service.days;
        let again = days.replayed(&actor, &day, Arc::new(scenario), state.seq()).await;
        Some(again.map_err(Error::of_what_if)?)
    } else {
        None
    };
    let ours = named(&service, &day, None).await?;
    let theirs = named(&service, &day, asked.policy.clone()).await?;
    let quick = named(&service, &day, Some(QUICK_POLICY.to_owned())).await?;
    let compare = move |stop: &Stop| {
        let patience = Patience { stop, until };
        asked.compare(&mut state, otherwise, [&ours, &theirs, &quick], patience)
    };
    let compared = service.turns.outlooks.work(&actor, None, compare).await?;
    times.of(&day, || Ok(json(StatusCode::OK, &compared)))
}
