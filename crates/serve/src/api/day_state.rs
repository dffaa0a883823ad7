//! The state of a day, now or after any of its events.

use std::sync::Arc;

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::VertiportIx;
use vertifleet_sim::DayTotals;
use vertifleet_sim::live::{LiveDay, Phase};

use super::answer::Times;
use super::extract::{EventNumber, Named, Validated};
use crate::access::Actor;
use crate::dispatch_day::{Acknowledgement, DispatchDay};
use crate::error::Error;
use crate::moment::Moment;
use crate::notice::EventNotice;
use crate::outlook::Totals;
use crate::service::Service;

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
    /// The routes that are closed now, and those that are known to close later.
    closures: Vec<ClosureState>,
    /// The alerts that people have seen, each by its latest acknowledgement, the oldest first; the
    /// latest 1,000.
    acknowledged: Vec<Acknowledgement>,
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
    /// What its battery will hold when it lands, kWh, if it was dispatched; below 0 if it lacks
    /// energy for its flight. Only on days that charge as needed.
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

/// A time in which a route is closed, in one direction.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct ClosureState {
    /// The vertiport of departure.
    from: String,
    /// The vertiport of destination.
    to: String,
    /// Since when it is closed, or when it will close.
    start: Moment,
    /// When it opens; null if only a report opens it.
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
    /// The kind, as in the notices of events.
    code: String,
    /// The notice in words.
    text: String,
    /// The aircraft, if it is about one.
    #[serde(skip_serializing_if = "Option::is_none")]
    aircraft: Option<String>,
    /// The vertiport, if it is about one.
    #[serde(skip_serializing_if = "Option::is_none")]
    vertiport: Option<String>,
}

impl NoticeState {
    fn of((seq, notice): (Option<u64>, EventNotice)) -> Self {
        let EventNotice { code, text, aircraft, vertiport } = notice;
        Self { seq, code, text, aircraft, vertiport }
    }
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
        let notices = day.notices().map(NoticeState::of).collect();
        let acknowledged = day.acknowledged();
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
        let closures = live
            .closed_routes()
            .map(|route| ClosureState {
                from: id(route.from),
                to: id(route.to),
                start: route.start.into(),
                until: route.until.map(Moment::from),
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
        let now = live.now().into();
        Self { seq, now, aircraft, vertiports, totals, closures, acknowledged, notices }
    }
}
