//! Days: made, listed, read, archived, deleted.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::{DaySeed, Network, Scenario, VertiportIx};
use vertifleet_sim::DayTotals;
use vertifleet_sim::live::Phase;

use super::extract::{Asked, Body, Named, Sender};
use super::{at_event, json, written};
use crate::days::{DayCell, now_ms};
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::moment::Moment;
use crate::service::{Service, Write, parse};
use crate::store::StoredDay;

/// The policy that decides on a day if none is named.
const DEFAULT_POLICY: &str = "gcaps-x";

/// A day to be made: from a network and a seed, or from a scenario.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewDay {
    /// A network that the program ships, or that was uploaded.
    network: Option<String>,
    /// The seed of the day.
    seed: Option<u64>,
    /// A whole scenario, as a scenario file has it.
    #[schema(value_type = Option<Object>)]
    scenario: Option<Box<RawValue>>,
    /// The policy that decides when none is asked for.
    policy: Option<String>,
}

/// A day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayInfo {
    /// Its id.
    id: String,
    /// The name of its scenario.
    name: String,
    /// When it was made, milliseconds of the Unix clock.
    created_ms: i64,
    /// Whether it is closed to writes.
    archived: bool,
    /// The policy that decides when none is asked for.
    policy: String,
    /// The number of its events, for a day that was asked for by its id.
    #[serde(skip_serializing_if = "Option::is_none")]
    seq: Option<u64>,
}

/// A list of days.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayList {
    /// The days, in the order in which they were made.
    days: Vec<DayInfo>,
    /// The cursor of the next page, if there is one.
    next: Option<String>,
}

/// A page of a list.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct Page {
    /// The cursor that an earlier page ended with.
    #[serde(default)]
    after: String,
    /// The number of entries, at most 1,000.
    limit: Option<u32>,
}

impl Page {
    const MOST: u32 = 1_000;
}

/// What is known of a day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayState {
    /// The number of the latest event.
    seq: u64,
    /// The latest time that the day has heard of.
    now: Moment,
    /// Every aircraft.
    aircraft: Vec<AircraftState>,
    /// Every vertiport.
    vertiports: Vec<VertiportState>,
    /// The account so far.
    #[schema(value_type = Object)]
    totals: DayTotals,
    /// What people should look at.
    notices: Vec<NoticeState>,
}

/// An aircraft.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct AircraftState {
    /// Its id.
    id: String,
    /// `standing`, `sent_off` or `in_the_air`.
    phase: &'static str,
    /// The vertiport where it stands or will land.
    place: String,
    /// When it landed there or is expected to.
    arrival: Moment,
    /// When it is expected to be ready.
    ready: Moment,
    /// Whether it is out of service.
    out_of_service: bool,
}

/// A vertiport.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct VertiportState {
    /// Its id.
    id: String,
    /// Its stands, or its chargers where they are counted apart.
    stands: u16,
    /// Aircraft that take them, standing there or on their way.
    taken: u16,
    /// The vertiports to which flights from here are closed.
    closed_to: Vec<String>,
}

/// Something that people should look at.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct NoticeState {
    /// The event that it came with; absent if it holds now, whatever it came from.
    seq: Option<u64>,
    /// What it is.
    text: String,
}

impl DayInfo {
    fn of(stored: &StoredDay, seq: Option<u64>) -> Self {
        let StoredDay { id, name, created_ms, archived, policy } = stored.clone();
        Self { id, name, created_ms, archived, policy, seq }
    }
}

/// Lists the days.
#[utoipa::path(operation_id = "list_days", get, path = "/v1/days", tag = "days", params(Page), responses((status = 200, body = DayList)))]
pub(super) async fn list(
    State(service): State<Arc<Service>>,
    Asked(page): Asked<Page>,
) -> Result<Response, Error> {
    let limit = page.limit.unwrap_or(100).clamp(1, Page::MOST);
    let days = service.days.store().days(&page.after, limit).await?;
    let next = (days.len() == limit as usize).then(|| days[days.len() - 1].id.clone());
    let days = days.iter().map(|day| DayInfo::of(day, None)).collect();
    Ok(json(StatusCode::OK, &DayList { days, next }))
}

/// Makes a day.
#[utoipa::path(
    operation_id = "make_day", post, path = "/v1/days", tag = "days", request_body = NewDay,
    responses((status = 201, body = DayInfo), (status = 400, body = crate::problem::Problem))
)]
pub(super) async fn create(
    State(service): State<Arc<Service>>,
    sender: Sender,
    Body(body): Body,
) -> Result<Response, Error> {
    let writer = match service.write(&sender, &body).await? {
        Write::Done(answer) => return Ok(written(StatusCode::CREATED, answer)),
        Write::New(writer) => writer,
    };
    let asked: NewDay = parse(&body)?;
    let policy = asked.policy.clone().unwrap_or_else(|| DEFAULT_POLICY.to_owned());
    let scenario = scenario(&asked)?.expected();
    crate::decide::resolve(&policy, &scenario)?;
    let stored = StoredDay {
        id: new_id(),
        name: scenario.name.clone(),
        created_ms: now_ms(),
        archived: false,
        policy,
    };
    let info = DayInfo::of(&stored, Some(0));
    let (actor, id, _busy) = (writer.actor, stored.id.clone(), writer.busy);
    let answer = writer.idempotency.map(|asked| asked.answered_with(&info));
    service.days.add(stored, scenario, answer.as_ref()).await?;
    service.days.store().record(&actor, "day made", &id, now_ms()).await?;
    Ok(at_event(StatusCode::CREATED, 0, &info))
}

fn scenario(asked: &NewDay) -> Result<Scenario, Error> {
    match (&asked.network, &asked.scenario) {
        (Some(network), None) => {
            let network =
                Network::shipped(network).ok_or_else(|| Error::not_found("network", network))?;
            Ok(network.draw(DaySeed::comparison(asked.seed.unwrap_or(1))?))
        }
        (None, Some(_)) if asked.seed.is_some() => {
            let rule = "`seed` goes with `network`: a scenario is drawn already".to_owned();
            Err(Error::BadRequest { rule })
        }
        (None, Some(scenario)) => Ok(Scenario::from_json(scenario.get().as_bytes(), "scenario")?),
        _ => Err(Error::BadRequest { rule: "name a `network` or give a `scenario`".to_owned() }),
    }
}

/// An id that sorts by the time at which it was made.
fn new_id() -> String {
    let random = std::hash::BuildHasher::hash_one(&std::hash::RandomState::new(), now_ms());
    format!("{:011x}{:08x}", now_ms(), random >> 32)
}

/// Reads a day.
#[utoipa::path(operation_id = "read_day", get, path = "/v1/days/{day}", tag = "days", params(("day" = String, Path)), responses((status = 200, body = DayInfo)))]
pub(super) async fn read(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let seq = day.state().seq();
    day.stored_up_to(seq).await?;
    Ok(at_event(StatusCode::OK, seq, &DayInfo::of(day.stored(), Some(seq))))
}

/// Closes a day to writes.
#[utoipa::path(operation_id = "archive_day", post, path = "/v1/days/{day}/archive", tag = "days", params(("day" = String, Path)), responses((status = 204)))]
pub(super) async fn archive(
    State(service): State<Arc<Service>>,
    sender: Sender,
    Named(day): Named<String>,
) -> Result<StatusCode, Error> {
    service.days.archive(&day).await?;
    service.days.store().record(&sender.actor, "day archived", &day, now_ms()).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Removes a day with its events.
#[utoipa::path(operation_id = "delete_day", delete, path = "/v1/days/{day}", tag = "days", params(("day" = String, Path)), responses((status = 204)))]
pub(super) async fn delete(
    State(service): State<Arc<Service>>,
    sender: Sender,
    Named(day): Named<String>,
) -> Result<StatusCode, Error> {
    service.days.delete(&day).await?;
    service.days.store().record(&sender.actor, "day deleted", &day, now_ms()).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// The state to be read.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct At {
    /// The number of the event after which the state is asked for; without it, the latest.
    seq: Option<u64>,
}

/// What is known of a day, now or after any of its events.
#[utoipa::path(operation_id = "day_state", get, path = "/v1/days/{day}/state", tag = "days", params(("day" = String, Path), At), responses((status = 200, body = DayState)))]
pub(super) async fn state(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    Asked(at): Asked<At>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let state = match at.seq {
        None => DayState::of(&mut day.state()),
        Some(seq) => DayState::of(&mut service.days.at(&day, seq).await?),
    };
    day.stored_up_to(state.seq).await?;
    Ok(at_event(StatusCode::OK, state.seq, &state))
}

impl DayState {
    fn of(day: &mut DispatchDay) -> Self {
        let notices = day.notices().map(|(seq, text)| NoticeState { seq, text }).collect();
        let (seq, live) = (day.seq(), day.live_mut());
        let scenario = Arc::clone(live.scenario());
        let id = |vertiport: VertiportIx| scenario.vertiports[vertiport.at()].id.clone();
        let aircraft = live
            .aircraft()
            .map(|now| AircraftState {
                id: scenario.aircraft[now.aircraft.at()].id.clone(),
                phase: match now.phase {
                    Phase::Standing => "standing",
                    Phase::SentOff { .. } => "sent_off",
                    Phase::InTheAir { .. } => "in_the_air",
                },
                place: id(now.place),
                arrival: now.arrival.into(),
                ready: now.ready.into(),
                out_of_service: now.is_out,
            })
            .collect();
        let totals = live.totals();
        let view = live.view();
        let vertiports = VertiportIx::all(view.vertiports())
            .map(|vertiport| VertiportState {
                id: id(vertiport),
                stands: view.stands(vertiport),
                taken: view.stands_taken()[vertiport.at()],
                closed_to: view.closed(vertiport).iter().map(id).collect(),
            })
            .collect();
        Self { seq, now: live.now().into(), aircraft, vertiports, totals, notices }
    }
}

/// The decisions so far as CSV: the trace of the day.
#[utoipa::path(operation_id = "day_trace", get, path = "/v1/days/{day}/trace.csv", tag = "days", params(("day" = String, Path)), responses((status = 200, content_type = "text/csv")))]
pub(super) async fn trace(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let (seq, csv) = trace_csv(&day);
    day.stored_up_to(seq).await?;
    Ok(([(header::CONTENT_TYPE, "text/csv; charset=utf-8")], csv).into_response())
}

fn trace_csv(day: &DayCell) -> (u64, String) {
    let state = day.state();
    (state.seq(), state.live().trace().to_csv(state.live().scenario()))
}
