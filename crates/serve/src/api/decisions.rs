//! Decisions: proposed, and taken.

use std::sync::{Arc, PoisonError};
use std::time::Duration;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::extract::{Asked, Body, Named, Sender};
use super::{at_event, written};
use crate::days::{DayCell, Writer};
use crate::decide::Proposal;
use crate::error::Error;
use crate::event::{Event, What};
use crate::moment::Moment;
use crate::service::{Service, Write, parse};

/// A policy is asked so often when events come in between.
const TRIES: u32 = 5;
/// Decides when the policy that was asked is late.
const QUICK_POLICY: &str = "greedy";

/// How a decision is asked for.
#[derive(Debug, Clone, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct HowAsked {
    /// The policy; without it, the day's.
    policy: Option<String>,
    /// The time of the decision; without it, or before what has happened, now.
    #[param(value_type = Option<String>)]
    time: Option<Moment>,
    /// Milliseconds within which an answer is needed. If the policy is not ready then, a faster one answers.
    deadline_ms: Option<u64>,
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
    reason: Option<String>,
    /// The policy; without it, the day's.
    policy: Option<String>,
    /// The time of the decision; without it, or before what has happened, now.
    time: Option<Moment>,
    /// Milliseconds within which the policy must answer; if it does not, a faster one decides.
    deadline_ms: Option<u64>,
}

/// A decision that was taken.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct TakenDecision {
    /// The number of its event.
    seq: u64,
    /// Where the aircraft flies; its own vertiport means hold.
    to: String,
    /// What the policy proposed, with its reasons; absent if a person chose without asking one.
    proposal: Option<Proposal>,
}

/// Proposes a decision for an aircraft that is ready, with reasons. Nothing changes.
#[utoipa::path(
    operation_id = "propose_decision", get, path = "/v1/days/{day}/aircraft/{aircraft}/decision", tag = "decisions",
    params(("day" = String, Path), ("aircraft" = String, Path), HowAsked),
    responses((status = 200, body = Proposal), (status = 422, body = crate::problem::Problem))
)]
pub(super) async fn propose(
    State(service): State<Arc<Service>>,
    Named((day, aircraft)): Named<(String, String)>,
    Asked(asked): Asked<HowAsked>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let proposal = proposed(&service, &day, aircraft, asked).await?;
    day.stored_up_to(proposal.seq).await?;
    Ok(at_event(StatusCode::OK, proposal.seq, &proposal))
}

/// Takes a decision: the day's policy chooses, or the one that is named, or a person. It is durable when the answer
/// comes.
#[utoipa::path(
    operation_id = "take_decision", post, path = "/v1/days/{day}/decisions", tag = "decisions", params(("day" = String, Path)),
    request_body = NewDecision,
    responses(
        (status = 201, body = TakenDecision),
        (status = 412, body = crate::problem::Problem, description = "the day has gone on"),
        (status = 422, body = crate::problem::Problem, description = "it breaks a rule")
    )
)]
pub(super) async fn decide(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    sender: Sender,
    Body(body): Body,
) -> Result<Response, Error> {
    let writer = match service.write(&sender, &body).await? {
        Write::Done(answer) => return Ok(written(StatusCode::CREATED, answer)),
        Write::New(writer) => writer,
    };
    let asked: NewDecision = parse(&body)?;
    let day = service.days.get(&day).await?;
    // What has moved on need not be thought about.
    writer.check(day.state().seq())?;
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
    NewDecision { aircraft, reason, time, .. }: NewDecision,
    to: String,
) -> Result<TakenDecision, Error> {
    let what = What::Decided { aircraft, to, policy: None, instead_of: None, reason };
    let now = day.state().live().now();
    let time = time.filter(|time| time.time() >= now);
    take(service, day, writer, Event { time, what }, None).await
}

/// Takes the decision of a policy. It holds for the state that it was made for: if an event comes in between, the policy
/// is asked again, unless the writer wanted this very state.
async fn by_policy(
    service: &Service,
    day: &Arc<DayCell>,
    writer: Writer,
    NewDecision { aircraft, reason, policy, time, deadline_ms, .. }: NewDecision,
) -> Result<TakenDecision, Error> {
    let asked = HowAsked { policy, time, deadline_ms };
    let mut tries = 0;
    loop {
        tries += 1;
        let day = service.days.get(day.id()).await?;
        let proposal = proposed(service, &day, aircraft.clone(), asked.clone()).await?;
        let what = What::Decided {
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
    let What::Decided { to, .. } = &event.what else { unreachable!("it is a decision") };
    let to = to.clone();
    let answer = |appended: &crate::days::Appended| TakenDecision {
        seq: appended.seq,
        to: to.clone(),
        proposal: proposal.clone(),
    };
    service.days.append(day, writer, vec![event], answer).await
}

/// Asks the policy, and if it is late, a quick one.
async fn proposed(
    service: &Service,
    day: &Arc<DayCell>,
    aircraft: String,
    asked: HowAsked,
) -> Result<Proposal, Error> {
    let policy = asked.policy.clone().unwrap_or_else(|| day.stored().policy.clone());
    let answer = ask(Arc::clone(day), aircraft.clone(), policy.clone(), asked.time);
    let in_time = match asked.deadline_ms {
        None => Some(answer.await?),
        Some(deadline_ms) => {
            let deadline = Duration::from_millis(deadline_ms);
            tokio::time::timeout(deadline, answer).await.ok().transpose()?
        }
    };
    let proposal = if let Some(proposal) = in_time {
        proposal
    } else {
        let quick = ask(Arc::clone(day), aircraft, QUICK_POLICY.to_owned(), asked.time);
        Proposal { too_late: Some(policy), ..quick.await? }
    };
    let seconds = Duration::from_micros(proposal.took_us).as_secs_f64();
    service.days.metrics().decided(&proposal.policy, seconds);
    Ok(proposal)
}

/// Asks a policy on a thread of its own, since it may take a while.
async fn ask(
    day: Arc<DayCell>,
    aircraft: String,
    policy: String,
    time: Option<Moment>,
) -> Result<Proposal, Error> {
    let ask = move || {
        let scenario = Arc::clone(day.state().live().scenario());
        let decider = day.deciders.get(&policy, &scenario)?;
        let mut decider = decider.lock().unwrap_or_else(PoisonError::into_inner);
        decider.propose(&day, &aircraft, time.map(Moment::time), &policy)
    };
    let died = |error| Error::Internal { cause: format!("{error}") };
    tokio::task::spawn_blocking(ask).await.map_err(died)?
}
