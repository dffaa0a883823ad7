//! Proposes and takes decisions.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::Stop;

use super::answer::{Times, at_event};
use super::events::notices_of;
use super::extract::{Named, Validated, parse};
use super::write::Idempotent;
use crate::access::Actor;
use crate::day_cell::DayCell;
use crate::days::{Writer, last_seq};
use crate::decide::Proposal;
use crate::error::Error;
use crate::event::{Event, EventKind, reason};
use crate::moment::{Moment, by_calendar};
use crate::notice::EventNotice;
use crate::service::Service;
use crate::taken_event::TakenEvent;

/// Largest number of evaluations for one decision while events arrive in between.
const TRIES: u32 = 5;
/// Time limit for the proposal of a policy that a person overrules.
const OVERRULED_TIMEOUT: Duration = Duration::from_millis(100);
/// The policy that decides when the requested one is late.
pub(super) const QUICK_POLICY: &str = "greedy";

/// The query of a decision.
#[derive(Debug, Clone, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct DecisionQuery {
    /// The policy; without it, the day's.
    policy: Option<String>,
    /// The time of the decision; without it, or if it is in the past, now.
    #[param(value_type = Option<Moment>, inline)]
    time: Option<String>,
    /// Time limit of the answer, milliseconds. If the policy is not ready then, a faster one
    /// answers.
    #[param(format = Int64, maximum = 4_294_967_295u32)]
    deadline_ms: Option<u32>,
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
}

/// The inputs of a policy's evaluation.
#[derive(Debug, Clone)]
struct Question {
    /// The caller.
    actor: Actor,
    aircraft: String,
    policy: Option<String>,
    time: Option<Moment>,
    deadline_ms: Option<u32>,
}

/// A decision to be taken.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewDecision {
    /// The aircraft.
    aircraft: String,
    /// The vertiport, if a person chooses; without it, the policy does.
    to: Option<String>,
    /// Why a person chose.
    #[serde(default, deserialize_with = "reason")]
    #[schema(max_length = 1_000)]
    reason: Option<String>,
    /// The policy; without it, the day's.
    policy: Option<String>,
    /// The time of the decision; without it, or if it is in the past, now.
    time: Option<Moment>,
    /// Time limit of the policy, milliseconds. If it is not ready then, a faster one decides.
    #[schema(format = Int64, maximum = 4_294_967_295u32)]
    deadline_ms: Option<u32>,
}

/// A decision that was taken.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct TakenDecision {
    /// The number of its event.
    seq: u64,
    /// The destination of the aircraft; its own vertiport means hold.
    to: String,
    /// Notices for people.
    #[schema(value_type = Vec<EventNotice>)]
    notices: Box<RawValue>,
    /// The proposal of the policy, with its reasons; null if a person chose.
    proposal: Option<Proposal>,
}

/// Proposes a decision for an aircraft that is ready, with reasons. Nothing changes.
#[utoipa::path(
    operation_id = "propose_decision", get, path = "/v1/days/{day}/aircraft/{aircraft}/decision", tag = "decisions",
    params(("day" = String, Path), ("aircraft" = String, Path), DecisionQuery),
    responses((status = 200, body = Proposal))
)]
pub(super) async fn propose(
    State(service): State<Arc<Service>>,
    Named((day, aircraft)): Named<(String, String)>,
    actor: Actor,
    Validated(asked): Validated<DecisionQuery>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let DecisionQuery { policy, time, deadline_ms, times } = asked;
    let time = time.map(|text| by_calendar(day.calendar(), || Moment::parse(&text))).transpose();
    let time = time.map_err(|rule| Error::BadRequest { rule })?;
    let question = Question { actor, aircraft, policy, time, deadline_ms };
    let proposal = proposed(&service, &day, question).await?;
    times.answer(&day, proposal.seq, &proposal).await
}

/// Takes a decision: by the day's policy, by the one that is named, or by a person. It is durable
/// before the answer is sent.
#[utoipa::path(
    operation_id = "take_decision", post, path = "/v1/days/{day}/decisions", tag = "decisions", params(("day" = String, Path)),
    request_body = NewDecision,
    responses(
        (status = 201, body = TakenDecision)
    )
)]
pub(super) async fn decide(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    Idempotent { writer, body }: Idempotent,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let asked: NewDecision = by_calendar(day.calendar(), || parse(&body))?;
    // Skip the evaluation if the day has advanced.
    {
        let state = day.state();
        let explained = |moved| state.latest().explain_decision(moved, &asked.aircraft);
        writer.check(state.seq()).map_err(explained)?;
    }
    let taken = match asked.to.clone() {
        Some(to) => by_hand(&service, &day, writer, asked, to).await?,
        None => by_policy(&service, &day, writer, asked).await?,
    };
    Ok(at_event(StatusCode::CREATED, taken.seq, &taken))
}

/// Takes the decision of a person.
async fn by_hand(
    service: &Service,
    day: &Arc<DayCell>,
    writer: Writer,
    NewDecision { aircraft, reason, policy, time, deadline_ms, .. }: NewDecision,
    to: String,
) -> Result<TakenDecision, Error> {
    let policy = policy.unwrap_or_else(|| day.stored.policy.clone());
    // For the record only, so it must not delay a person. An error shows when the event is applied.
    let deadline = deadline_ms.map_or(OVERRULED_TIMEOUT, |ms| Duration::from_millis(ms.into()));
    let overruled = ask(service, day, (&writer.actor, &aircraft), policy, time);
    let overruled = tokio::time::timeout(deadline, overruled).await;
    let instead_of = overruled.ok().and_then(Result::ok).map(|proposal| proposal.to);
    let instead_of = instead_of.filter(|proposed| *proposed != to);
    let what = EventKind::Decided { aircraft, to, policy: None, instead_of, reason };
    let now = day.state().live().now();
    let time = time.filter(|time| time.time() >= now);
    take(service, day, writer, Event { time, what }, None).await
}

/// Takes the decision of a policy. It is valid for the state that it was computed for: if an event
/// arrives in between, the policy decides again, unless the writer required that state.
async fn by_policy(
    service: &Service,
    day: &Arc<DayCell>,
    writer: Writer,
    NewDecision { aircraft, reason, policy, time, deadline_ms, .. }: NewDecision,
) -> Result<TakenDecision, Error> {
    let actor = writer.actor.clone();
    let question = Question { actor, aircraft: aircraft.clone(), policy, time, deadline_ms };
    let mut tries = 0;
    loop {
        tries += 1;
        let day = service.days.get(day.id()).await?;
        let proposal = proposed(service, &day, question.clone()).await?;
        let what = EventKind::Decided {
            aircraft: aircraft.clone(),
            to: proposal.to.clone(),
            policy: Some(proposal.policy.clone()),
            instead_of: None,
            reason: reason.clone(),
        };
        let event = Event { time: Some(proposal.time), what };
        let if_match = writer.if_match.or(Some(proposal.seq));
        let once = Writer { if_match, ..writer.clone() };
        match take(service, &day, once, event, Some(proposal)).await {
            Err(Error::Moved { .. } | Error::Conflict)
                if writer.if_match.is_none() && tries < TRIES => {}
            outcome => return outcome,
        }
    }
}

async fn take(
    service: &Service,
    day: &Arc<DayCell>,
    writer: Writer,
    event: Event,
    proposal: Option<Proposal>,
) -> Result<TakenDecision, Error> {
    let EventKind::Decided { to, .. } = &event.what else { unreachable!("it is a decision") };
    let to = to.clone();
    let answer = |events: &[TakenEvent]| TakenDecision {
        seq: last_seq(events),
        to: to.clone(),
        notices: notices_of(&events[0]),
        proposal: proposal.clone(),
    };
    service.days.append(day, writer, vec![event], answer).await
}

/// Evaluates the policy, and if it is late, a quick one.
async fn proposed(
    service: &Service,
    day: &Arc<DayCell>,
    Question { actor, aircraft, policy, time, deadline_ms }: Question,
) -> Result<Proposal, Error> {
    let whom = (&actor, aircraft.as_str());
    let policy = policy.unwrap_or_else(|| day.stored.policy.clone());
    let answer = ask(service, day, whom, policy.clone(), time);
    let in_time = match deadline_ms {
        None => Some(answer.await?),
        Some(deadline_ms) => {
            let deadline = Duration::from_millis(deadline_ms.into());
            tokio::time::timeout(deadline, answer).await.ok().transpose()?
        }
    };
    let proposal = if let Some(proposal) = in_time {
        proposal
    } else {
        let quick = ask(service, day, whom, QUICK_POLICY.to_owned(), time);
        Proposal { too_late: Some(policy), ..quick.await? }
    };
    let seconds = Duration::from_micros(proposal.took_us).as_secs_f64();
    service.days.metrics.decided(&proposal.policy, seconds);
    Ok(proposal)
}

/// Evaluates a policy on a separate thread, since it may take a while. A request that waits for its
/// turn uses no thread, so a client that gives up leaves no pending work.
async fn ask(
    service: &Service,
    day: &Arc<DayCell>,
    (actor, aircraft): (&Actor, &str),
    policy: String,
    time: Option<Moment>,
) -> Result<Proposal, Error> {
    let scenario = Arc::clone(day.state().live().scenario());
    let decider = day.deciders.get(&policy, &scenario, &service.policies).await?;
    let key = Some(decider.key());
    let turns = if policy == QUICK_POLICY {
        &service.turns.quick_decisions
    } else if decider.is_new() {
        &service.turns.first_decisions
    } else {
        &service.turns.decisions
    };
    let day = Arc::clone(day);
    let aircraft = aircraft.to_owned();
    let (others, renewals) = (turns.clone(), Arc::clone(&service.renewals));
    let ask = move |_: &Stop| {
        let busy = renewals.if_busy(others.are_awaited());
        decider.propose(|| day.state(), &aircraft, time.map(Moment::time), &policy, busy)
    };
    turns.work(actor, key, ask).await
}
