//! Creates, lists, reads, archives, reopens and deletes days.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::{Scenario, Stop};
use vertifleet_sim::Trace;
use vertifleet_sim::live::LiveDay;

use super::answer::{at_event, json, written};
use super::extract::{Named, PageSize, UPLOAD, Validated, parse};
use super::new_day::NewDay;
use super::write::Idempotent;
use crate::access::Actor;
use crate::clock::now_ms;
use crate::day_cell::DayCell;
use crate::days::Writer;
use crate::error::Error;
use crate::moment::Moment;
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

/// The scenario at the beginning of the day, in the format of scenario files.
#[utoipa::path(operation_id = "day_scenario", get, path = "/v1/days/{day}/scenario", tag = "days", params(("day" = String, Path)), responses((status = 200, body = Object)))]
pub(super) async fn scenario(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    actor: Actor,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let scenario = Arc::clone(day.state().live().scenario());
    // That of a large day has megabytes.
    let write = move |_: &Stop| Ok(scenario.to_json());
    let json = service.turns.readings.work(&actor, None, write).await?;
    Ok(written(StatusCode::OK, json))
}

/// The decisions so far as CSV: the trace of the day.
#[utoipa::path(operation_id = "day_trace", get, path = "/v1/days/{day}/trace.csv", tag = "days", params(("day" = String, Path)), responses((status = 200, content_type = "text/csv")))]
pub(super) async fn trace(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    actor: Actor,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let (seq, trace, scenario) = trace_of(&day);
    let write = move |_: &Stop| Ok(trace.to_csv(&scenario));
    let csv = service.turns.readings.work(&actor, None, write).await?;
    day.stored_up_to(seq).await?;
    Ok(([(header::CONTENT_TYPE, "text/csv; charset=utf-8")], csv).into_response())
}

fn trace_of(day: &DayCell) -> (u64, Trace, Arc<Scenario>) {
    let state = day.state();
    let live = state.live();
    (state.seq(), live.trace(), Arc::clone(live.scenario()))
}
