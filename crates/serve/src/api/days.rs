//! Creates, lists, reads, archives, reopens and deletes days.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::VertiportIx;
use vertifleet_sim::DayTotals;
use vertifleet_sim::live::{LiveDay, Phase};

use super::answer::{Times, at_event, json, written};
use super::extract::{EventNumber, Named, PageSize, UPLOAD, Validated, parse};
use super::new_day::NewDay;
use super::write::Idempotent;
use crate::access::Actor;
use crate::clock::now_ms;
use crate::day_cell::DayCell;
use crate::days::Writer;
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::moment::Moment;
use crate::outlook::Totals;
use crate::service::Service;
use crate::store::StoredDay;

/// The policy that decides on a day if none is named.
pub(super) const DEFAULT_POLICY: &str = "gcaps-x";

/// A day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayInfo {
    /// Its id.
    id: String,
    /// Its display name.
    name: String,
    /// Its date, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    date: Option<String>,
    /// The time zone of its clock, if it has a date.
    #[serde(skip_serializing_if = "Option::is_none")]
    time_zone: Option<String>,
    /// When it was made, milliseconds of the Unix clock.
    created_ms: i64,
    /// Whether it is closed to writes.
    archived: bool,
    /// The default policy of its decisions.
    policy: String,
    /// The number of its events, for a request that names the day.
    #[serde(skip_serializing_if = "Option::is_none")]
    seq: Option<u64>,
    /// Its progress, for days that are listed with it and are not archived.
    #[serde(skip_serializing_if = "Option::is_none")]
    progress: Option<DayProgress>,
}

/// The progress of a day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayProgress {
    /// The latest time that was reported.
    now: Moment,
    /// Whether nothing is left to decide and every aircraft is on the ground.
    is_over: bool,
    /// Aircraft that wait for a decision.
    waiting: usize,
    /// Profit of the flights that have been dispatched, less the fixed costs of the fleet; dollars.
    profit_usd: f64,
}

/// A list of days.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayList {
    /// The days, in the order in which they were made.
    days: Vec<DayInfo>,
    /// The cursor of the next page, if there is one.
    next: Option<String>,
}

/// The query of a list of days.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct Listed {
    /// The cursor at the end of an earlier page.
    #[serde(default)]
    after: String,
    /// The number of entries, at most 1,000; without it, 100.
    #[param(inline)]
    limit: Option<PageSize<1_000>>,
    /// Whether each day that is not archived comes with its progress. The service reads a day that
    /// has not been used for long from the store for this.
    #[serde(default)]
    progress: bool,
}

/// The state of a day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayState {
    /// The number of the latest event.
    seq: u64,
    /// The latest time that was reported.
    now: Moment,
    /// Every aircraft.
    aircraft: Vec<AircraftState>,
    /// Every vertiport.
    vertiports: Vec<VertiportState>,
    /// The account so far.
    #[schema(value_type = Totals)]
    totals: DayTotals,
    /// Notices for people.
    notices: Vec<NoticeState>,
}

/// An aircraft.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct AircraftState {
    /// Its id.
    id: String,
    /// Its current phase.
    phase: PhaseName,
    /// The vertiport where it stands or will land.
    place: String,
    /// When it landed there or is expected to.
    arrival: Moment,
    /// When it is expected to be ready.
    ready: Moment,
    /// Whether it waits for a decision.
    needs_decision: bool,
    /// Whether it is out of service.
    out_of_service: bool,
    /// When it is expected back in service, if that is known.
    out_until: Option<Moment>,
    /// What its battery holds now, kWh; only on the ground, on days that charge as needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    charge_kwh: Option<f64>,
    /// What its battery will hold when it lands, kWh, if it was dispatched; only on days that
    /// charge as needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    lands_with_kwh: Option<f64>,
    /// The flight that it was dispatched on, until it has landed.
    flight: Option<FlightState>,
}

/// The phase of an aircraft.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PhaseName {
    /// It stands at its vertiport and charges, is ready or holds.
    Standing,
    /// It has been dispatched and has not departed.
    SentOff,
    /// It is in the air.
    InTheAir,
}

/// A flight that has not landed.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct FlightState {
    /// The vertiport of departure.
    from: String,
    /// The vertiport of destination.
    to: String,
    /// When the decision was taken.
    decided: Moment,
    /// When the battery suffices, so that it takes off unless it is delayed; only on days that
    /// charge as needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    takeoff: Option<Moment>,
    /// Passengers on board.
    passengers: u16,
}

/// A route that is closed to new flights.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct ClosedRoute {
    /// Its destination.
    to: String,
    /// When it opens, if that is known.
    until: Option<Moment>,
}

/// A vertiport.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct VertiportState {
    /// Its id.
    id: String,
    /// Its stands, or its chargers if they are counted separately.
    stands: u16,
    /// Aircraft that occupy them, standing there or on their way.
    taken: u16,
    /// The routes from here that are closed.
    closed: Vec<ClosedRoute>,
}

/// A notice for people.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct NoticeState {
    /// The event that it came with; null if it describes the current state.
    seq: Option<u64>,
    /// The notice in words.
    text: String,
}

impl DayInfo {
    fn of(stored: &StoredDay, seq: Option<u64>) -> Self {
        let StoredDay { id, name, created_ms, archived, policy, date, time_zone } = stored.clone();
        let [date, time_zone] =
            [date, time_zone].map(|text| Some(text).filter(|text| !text.is_empty()));
        Self { id, name, date, time_zone, created_ms, archived, policy, seq, progress: None }
    }
}

impl DayProgress {
    fn of(live: &mut LiveDay) -> Self {
        Self {
            now: live.now().into(),
            is_over: live.is_over(),
            waiting: live.aircraft().filter(|aircraft| aircraft.needs_decision).count(),
            profit_usd: live.totals().profit_usd,
        }
    }
}

/// Lists the days.
#[utoipa::path(operation_id = "list_days", get, path = "/v1/days", tag = "days", params(Listed), responses((status = 200, body = DayList)))]
pub(super) async fn list(
    State(service): State<Arc<Service>>,
    Validated(Listed { after, limit, progress }): Validated<Listed>,
) -> Result<Response, Error> {
    let PageSize(limit) = limit.unwrap_or(PageSize(100));
    let stored = service.days.store.days(&after, limit).await?;
    let next = (stored.len() == limit as usize).then(|| stored[stored.len() - 1].id.clone());
    let mut days: Vec<_> = stored.iter().map(|day| DayInfo::of(day, None)).collect();
    if progress {
        for day in days.iter_mut().filter(|day| !day.archived) {
            day.progress = progress_of(&service, &day.id).await?;
        }
    }
    Ok(json(StatusCode::OK, &DayList { days, next }))
}

/// The progress of a day. `None` if the day was deleted in the meantime, or is damaged; a request
/// for the day itself then reports the damage.
async fn progress_of(service: &Service, id: &str) -> Result<Option<DayProgress>, Error> {
    let day = match service.days.get(id).await {
        Err(Error::NotFound { .. } | Error::BadData { .. }) => return Ok(None),
        found => found?,
    };
    let (seq, progress) = {
        let mut state = day.state();
        (state.seq(), DayProgress::of(state.live_mut()))
    };
    day.stored_up_to(seq).await?;
    Ok(Some(progress))
}

/// Makes a day.
#[utoipa::path(
    operation_id = "make_day", post, path = "/v1/days", tag = "days", request_body = NewDay,
    responses((status = 201, body = DayInfo))
)]
pub(super) async fn create(
    State(service): State<Arc<Service>>,
    Idempotent { writer, body }: Idempotent<UPLOAD>,
) -> Result<Response, Error> {
    let made_by = Arc::clone(&service);
    let read = async move {
        let asked: NewDay = parse(&body)?;
        let (scenario, zone) = asked.scenario(&made_by).await?;
        Ok((asked, scenario, zone))
    };
    let (asked, scenario, zone) = service.turns.readings.run(&writer.actor, read).await?;
    let policy = asked.policy.clone().unwrap_or_else(|| DEFAULT_POLICY.to_owned());
    service.policies.resolve(&policy, &scenario).await?;
    let (date, time_zone) = asked.calendar(zone)?;
    let stored = StoredDay {
        id: new_id(),
        name: asked.name_of(&scenario)?,
        created_ms: now_ms(),
        archived: false,
        policy,
        date,
        time_zone,
    };
    let info = DayInfo::of(&stored, Some(0));
    let most = service.limits.days;
    if service.days.store.number_of_days().await? >= most {
        return Err(Error::TooMuch { what: "days", most });
    }
    let (actor, id, _busy) = (writer.actor, stored.id.clone(), writer.busy);
    let answer = writer.idempotency.map(|asked| asked.answered_with(&info));
    service.days.add(stored, scenario, answer.as_ref()).await?;
    service.days.store.record(&actor.name, "day made", &id, now_ms()).await?;
    let mut answer = at_event(StatusCode::CREATED, 0, &info);
    let place = format!("/v1/days/{id}");
    let place = HeaderValue::from_str(&place).expect("an id has digits and letters");
    answer.headers_mut().insert(header::LOCATION, place);
    Ok(answer)
}

/// An id that sorts by the time of creation.
pub(super) fn new_id() -> String {
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
    Ok(at_event(StatusCode::OK, seq, &DayInfo::of(&day.stored, Some(seq))))
}

/// Closes a day to writes. It can still be read, and reopened.
#[utoipa::path(operation_id = "archive_day", post, path = "/v1/days/{day}/archive", tag = "days", params(("day" = String, Path)), responses((status = 204)))]
pub(super) async fn archive(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    writer: Writer,
) -> Result<StatusCode, Error> {
    service.days.set_archived(&day, true, &writer).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Reopens a day that was archived.
#[utoipa::path(operation_id = "unarchive_day", post, path = "/v1/days/{day}/unarchive", tag = "days", params(("day" = String, Path)), responses((status = 204)))]
pub(super) async fn unarchive(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    writer: Writer,
) -> Result<StatusCode, Error> {
    service.days.set_archived(&day, false, &writer).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Removes a day with its events.
#[utoipa::path(operation_id = "delete_day", delete, path = "/v1/days/{day}", tag = "days", params(("day" = String, Path)), responses((status = 204)))]
pub(super) async fn delete(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    writer: Writer,
) -> Result<StatusCode, Error> {
    service.days.delete(&day, &writer).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// The query of a state.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct At {
    /// The number of the event after which the state is read; without it, the latest. If the day
    /// has no such event, the answer is 404 (V602).
    #[param(inline)]
    seq: Option<EventNumber>,
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
}

/// The state of a day, now or after any of its events.
#[utoipa::path(operation_id = "day_state", get, path = "/v1/days/{day}/state", tag = "days", params(("day" = String, Path), At), responses((status = 200, body = DayState)))]
pub(super) async fn state(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    actor: Actor,
    Validated(at): Validated<At>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let state = match at.seq {
        None => DayState::of(&mut day.state()),
        Some(EventNumber(seq)) => DayState::of(&mut service.days.at(&actor, &day, seq).await?),
    };
    at.times.answer(&day, state.seq, &state).await
}

/// The closed routes from each vertiport, with the time at which each opens.
fn closed(live: &mut LiveDay) -> Vec<Vec<(VertiportIx, Option<Moment>)>> {
    let all = VertiportIx::all(live.scenario().vertiports.len());
    let masks: Vec<_> = all.clone().map(|from| live.view().closed(from)).collect();
    let opens = |from, to| live.opens(from, to).map(Moment::from);
    all.zip(masks)
        .map(|(from, mask)| mask.iter().map(|to| (to, opens(from, to))).collect())
        .collect()
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
                    Phase::Standing => PhaseName::Standing,
                    Phase::SentOff { .. } => PhaseName::SentOff,
                    Phase::InTheAir { .. } => PhaseName::InTheAir,
                },
                place: id(now.place),
                arrival: now.arrival.into(),
                ready: now.ready.into(),
                needs_decision: now.needs_decision,
                out_of_service: now.is_out,
                out_until: now.out_until.map(Moment::from),
                charge_kwh: now.charge_kwh,
                lands_with_kwh: now.lands_with_kwh,
                flight: live.flight(now.aircraft).map(|row| FlightState {
                    from: id(row.from),
                    to: id(row.to),
                    decided: row.time.into(),
                    takeoff: now.lands_with_kwh.map(|_| row.takeoff.into()),
                    passengers: row.passengers,
                }),
            })
            .collect();
        let totals = live.totals();
        let closed = closed(live);
        let view = live.view();
        let vertiports = VertiportIx::all(view.vertiports())
            .map(|vertiport| VertiportState {
                id: id(vertiport),
                stands: view.stands(vertiport),
                taken: view.stands_taken()[vertiport.at()],
                closed: closed[vertiport.at()]
                    .iter()
                    .map(|&(to, until)| ClosedRoute { to: id(to), until })
                    .collect(),
            })
            .collect();
        Self { seq, now: live.now().into(), aircraft, vertiports, totals, notices }
    }
}

/// The scenario at the beginning of the day, in the format of scenario files.
#[utoipa::path(operation_id = "day_scenario", get, path = "/v1/days/{day}/scenario", tag = "days", params(("day" = String, Path)), responses((status = 200, body = Object)))]
pub(super) async fn scenario(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let scenario = Arc::clone(day.state().live().scenario());
    Ok(written(StatusCode::OK, scenario.to_json()))
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
