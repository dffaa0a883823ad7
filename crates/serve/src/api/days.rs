//! Days: made, listed, read, archived, deleted.

use std::collections::BTreeMap;
use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::{DaySeed, Matrix, Scenario, VertiportIx};
use vertifleet_sim::DayTotals;
use vertifleet_sim::live::{LiveDay, Phase};

use super::answer::{Times, again, at_event, json, written};
use super::extract::{Asked, Named, Sender, Upload};
use crate::api::Totals;
use crate::calendar::Calendar;
use crate::days::{DayCell, now_ms};
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::event::Ids;
use crate::moment::Moment;
use crate::networks;
use crate::service::{Service, Write, parse};
use crate::store::StoredDay;

/// The policy that decides on a day if none is named.
pub(super) const DEFAULT_POLICY: &str = "gcaps-x";

/// A day to be made: from a network, or from a scenario.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewDay {
    /// A network that the program ships, or that was uploaded.
    network: Option<String>,
    /// The seed with which the day is drawn from the network: its forecast and where aircraft stand in the morning, unless
    /// they are given. 1 if it is absent.
    seed: Option<u64>,
    /// A whole scenario, as a scenario file has it.
    #[schema(value_type = Option<Object>)]
    scenario: Option<Box<RawValue>>,
    /// The passengers who are expected, in place of those of the network or the scenario. Nobody flies where no row is.
    forecast: Option<Vec<ForecastRow>>,
    /// Where aircraft stand in the morning: the vertiport of each by the id of the aircraft. The others stand where the
    /// network or the scenario has them.
    #[serde(default)]
    aircraft: BTreeMap<String, String>,
    #[schema(min_length = 1, max_length = 80)]
    /// What people call the day; without it, the name of its scenario, or of its network with the date.
    name: Option<String>,
    /// Its date, for example `2026-11-23`, from 1970 to 2199. Times may then be written in ISO 8601.
    #[schema(pattern = "^(19[7-9][0-9]|2[01][0-9]{2})-[0-9]{2}-[0-9]{2}$")]
    date: Option<String>,
    /// The time zone of its clock by its name in the IANA database; without it, that of the network.
    time_zone: Option<String>,
    /// The policy that decides when none is asked for.
    policy: Option<String>,
}

/// Passengers who are expected to fly from one vertiport to another in one period.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ForecastRow {
    /// A time within the period, without a date.
    period: Moment,
    /// Where they leave.
    from: String,
    /// Where they fly to.
    to: String,
    /// Their number.
    passengers: u32,
}

/// A day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DayInfo {
    /// Its id.
    id: String,
    /// What people call it.
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
    #[schema(value_type = Totals)]
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
    #[schema(value_type = PhaseName)]
    phase: &'static str,
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
    /// The flight that it has been sent off on, until it has landed.
    flight: Option<FlightState>,
}

/// What an aircraft does.
#[derive(ToSchema)]
#[schema(rename_all = "snake_case")]
#[expect(dead_code, reason = "it stands for the values of a text in the description")]
pub(crate) enum PhaseName {
    /// It stands at its vertiport and charges, is ready or holds.
    Standing,
    /// It has been sent off and has not departed.
    SentOff,
    /// It is in the air.
    InTheAir,
}

/// A flight that has not landed.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct FlightState {
    /// Where it leaves.
    from: String,
    /// Where it flies to.
    to: String,
    /// When it was decided.
    decided: Moment,
    /// Passengers on board.
    passengers: u16,
}

/// A route that is closed to new flights.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct ClosedRoute {
    /// Where it leads.
    to: String,
    /// When it opens, if that is known.
    until: Option<Moment>,
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
    /// The routes from here that are closed.
    closed: Vec<ClosedRoute>,
}

/// Something that people should look at.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct NoticeState {
    /// The event that it came with; null if it holds now, whatever it came from.
    seq: Option<u64>,
    /// What it is.
    text: String,
}

impl DayInfo {
    fn of(stored: &StoredDay, seq: Option<u64>) -> Self {
        let StoredDay { id, name, created_ms, archived, policy, date, time_zone } = stored.clone();
        let [date, time_zone] =
            [date, time_zone].map(|text| Some(text).filter(|text| !text.is_empty()));
        Self { id, name, date, time_zone, created_ms, archived, policy, seq }
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
    responses((status = 201, body = DayInfo))
)]
pub(super) async fn create(
    State(service): State<Arc<Service>>,
    sender: Sender,
    Upload(body): Upload,
) -> Result<Response, Error> {
    let writer = match service.write(&sender, &body).await? {
        Write::Done(answer) => return Ok(again(answer)),
        Write::New(writer) => writer,
    };
    let asked: NewDay = parse(&body)?;
    let policy = asked.policy.clone().unwrap_or_else(|| DEFAULT_POLICY.to_owned());
    let (scenario, zone) = asked.scenario(&service).await?;
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
    if service.days.store().number_of_days().await? >= most {
        return Err(Error::TooMuch { what: "days", most });
    }
    let (actor, id, _busy) = (writer.actor, stored.id.clone(), writer.busy);
    let answer = writer.idempotency.map(|asked| asked.answered_with(&info));
    service.days.add(stored, scenario, answer.as_ref()).await?;
    service.days.store().record(&actor, "day made", &id, now_ms()).await?;
    let mut answer = at_event(StatusCode::CREATED, 0, &info);
    let place = format!("/v1/days/{id}");
    let place = HeaderValue::from_str(&place).expect("an id has digits and letters");
    answer.headers_mut().insert(header::LOCATION, place);
    Ok(answer)
}

/// The longest name of a day.
const LONGEST_NAME: usize = 80;

impl NewDay {
    /// The day as it is expected before it begins, and the time zone of its network.
    async fn scenario(&self, service: &Service) -> Result<(Scenario, Option<String>), Error> {
        let (scenario, zone) = match (&self.network, &self.scenario) {
            (Some(network), None) => {
                let (network, _) = networks::find(service.days.store(), network).await?;
                let seed = DaySeed::comparison(self.seed.unwrap_or(1))?;
                (network.draw(seed), network.time_zone().map(str::to_owned))
            }
            (None, Some(_)) if self.seed.is_some() => {
                let rule = "`seed` goes with `network`: a scenario is drawn already".to_owned();
                return Err(Error::BadRequest { rule });
            }
            (None, Some(scenario)) => {
                (Scenario::from_json(scenario.get().as_bytes(), "scenario")?, None)
            }
            _ => {
                let rule = "name a `network` or give a `scenario`".to_owned();
                return Err(Error::BadRequest { rule });
            }
        };
        Ok((self.changed(scenario.expected())?, zone))
    }

    /// The day with the forecast and the places of aircraft that were given.
    fn changed(&self, scenario: Scenario) -> Result<Scenario, Error> {
        if self.forecast.is_none() && self.aircraft.is_empty() {
            return Ok(scenario);
        }
        let ids = Ids::of(&scenario);
        let mut day = scenario.into_day();
        if let Some(rows) = &self.forecast {
            for table in &mut day.demand {
                *table = Matrix::from_fn(table.size(), |_, _| 0);
            }
            for ForecastRow { period, from, to, passengers } in rows {
                let period = ids.period(period.time())?;
                let pair = (ids.vertiport(from)?, ids.vertiport(to)?);
                let cell = &mut day.demand[period][pair];
                *cell = cell.saturating_add(*passengers);
            }
        }
        for (aircraft, vertiport) in &self.aircraft {
            day.aircraft[ids.aircraft(aircraft)?.at()].at = ids.vertiport(vertiport)?;
        }
        Ok(day.check("the day")?)
    }

    /// Its date and its time zone, both empty if it has no date.
    fn calendar(&self, of_network: Option<String>) -> Result<(String, String), Error> {
        let wrong = |rule: &str| Error::BadRequest { rule: rule.to_owned() };
        let Some(date) = &self.date else {
            return match self.time_zone {
                None => Ok(Default::default()),
                Some(_) => Err(wrong("`time_zone` goes with `date`")),
            };
        };
        let zone = self.time_zone.clone().or(of_network);
        let zone = zone.ok_or_else(|| {
            wrong("a day with a `date` needs a `time_zone`: its network has none")
        })?;
        Calendar::new(date, &zone)?;
        Ok((date.clone(), zone))
    }

    fn name_of(&self, scenario: &Scenario) -> Result<String, Error> {
        let Some(name) = &self.name else {
            let dated = self.network.as_ref().zip(self.date.as_ref());
            let dated = dated.map(|(network, date)| format!("{network} {date}"));
            return Ok(dated.unwrap_or_else(|| scenario.name.clone()));
        };
        let length = name.chars().count();
        if length == 0 || length > LONGEST_NAME || name.contains(char::is_control) {
            let rule = format!("the `name` of a day has 1 to {LONGEST_NAME} characters");
            return Err(Error::BadRequest { rule });
        }
        Ok(name.clone())
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
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
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
    at.times.of(&day, || Ok(at_event(StatusCode::OK, state.seq, &state)))
}

/// The routes from each vertiport that are closed, with the time at which each opens.
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
                    Phase::Standing => "standing",
                    Phase::SentOff { .. } => "sent_off",
                    Phase::InTheAir { .. } => "in_the_air",
                },
                place: id(now.place),
                arrival: now.arrival.into(),
                ready: now.ready.into(),
                needs_decision: now.needs_decision,
                out_of_service: now.is_out,
                out_until: now.out_until.map(Moment::from),
                flight: live.flight(now.aircraft).map(|row| FlightState {
                    from: id(row.from),
                    to: id(row.to),
                    decided: row.time.into(),
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

/// The scenario that the day began with, as a scenario file has it.
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
