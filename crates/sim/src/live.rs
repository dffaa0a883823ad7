//! A live day: reports of what happened replace what the simulator expects.
//!
//! Until an event is reported, the simulator computes what to expect, by the same code as on other
//! days: an aircraft that was sent off departs at once, lands after the flight's time and is ready
//! when it is prepared. If the reports match these expectations, the live day is the simulated day,
//! to the cent. Reports are taken one after the other ([`LiveDay::take`]), so a day is a function
//! of its scenario and its reports.

mod charges;
mod closed_routes;
mod log;
mod notice;
mod possible;
mod present_notices;
mod remaining_day;
mod report;
mod reporter;
mod take;

use std::collections::BTreeMap;
use std::sync::Arc;

use vertifleet_core::{AircraftIx, Battery, Closure, Route, Scenario, Time, VertiportIx};

use self::log::Accepted;
use crate::{DayTotals, Decision, Imagined, Landed, Simulation, Trace, TraceRow, View};

pub use closed_routes::ClosedRoute;
pub use notice::Notice;
pub use remaining_day::RemainingDay;
pub use report::{Booking, Report, ReportError, Routes};
pub use reporter::Reporter;

/// A day that happens.
#[derive(Debug, Clone)]
pub struct LiveDay {
    /// Everything that is known. Its queue holds the time at which each aircraft is expected to be
    /// ready, which may lie before now if the aircraft has not decided.
    known: Simulation,
    /// The latest time of a report, or the start of operations.
    now: Time,
    aircraft: Vec<LiveAircraft>,
    /// Every decision, in order; those that were undone are marked.
    decisions: Vec<LiveDecision>,
    /// Passengers who have been taken on board, in the layout of the demand, by the period in which
    /// they wanted to fly.
    boarded: Vec<u32>,
    /// Closures whose end is known, those of the scenario among them, each one way.
    closures: Vec<Closure>,
    /// Every report that was accepted, in order.
    log: Vec<Accepted>,
    /// The routes that are closed until they are reported open, with the time since when.
    closed_since: BTreeMap<(VertiportIx, VertiportIx), Time>,
    /// Whether the account and the demand of the whole day have to be added up again.
    is_stale: bool,
}

#[derive(Debug, Clone, Copy)]
struct LiveAircraft {
    phase: Phase,
    /// When it is prepared for its next decision, whether or not it is in service then: its
    /// turnaround is over and, on days that charge to full, its battery full.
    prepared: Time,
    /// Since when it cannot fly: until a time, or until it is reported back.
    out: Option<OutOfService>,
    /// Its latest decision, if it can be undone.
    undoable: Option<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OutOfService {
    Until(Time),
    UntilReported,
}

/// Where an aircraft is in its round of deciding, flying and charging.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// It stands at its vertiport and charges, is ready or holds.
    Standing,
    /// It has been sent off and has not departed.
    SentOff {
        /// The position of its flight among the day's decisions.
        flight: usize,
        /// When it is expected to depart.
        departs: Time,
    },
    /// It is in the air.
    InTheAir {
        /// The position of its flight among the day's decisions.
        flight: usize,
        /// When it departed.
        departed: Time,
    },
}

impl Phase {
    /// The state of an aircraft on its way; `None` if it stands.
    fn on_its_way(self) -> Option<&'static str> {
        match self {
            Self::Standing => None,
            Self::SentOff { .. } => Some("has been sent off, and has not been reported departed"),
            Self::InTheAir { .. } => Some("is in the air, and has not been reported landed"),
        }
    }
}

/// A decision with the state that is needed to undo it.
#[derive(Debug, Clone)]
struct LiveDecision {
    row: TraceRow,
    period: usize,
    /// How many of its passengers had waited since the period before.
    waited: u16,
    before: Before,
    is_undone: bool,
}

impl LiveDecision {
    /// The passengers of a flight by the period in which they wanted to fly; none for a hold.
    fn parties(&self) -> impl Iterator<Item = (usize, u16)> + use<> {
        let waited = self.period.checked_sub(1).map(|before| (before, self.waited));
        [waited, Some((self.period, self.row.passengers - self.waited))].into_iter().flatten()
    }
}

/// An aircraft before a decision: when it was prepared, when it had landed and with which charge,
/// and whether it waited without a charger.
#[derive(Debug, Clone, Copy)]
struct Before {
    prepared: Time,
    arrival: Time,
    /// An empty one on days that charge to full.
    battery: Battery,
    waited: bool,
}

impl Before {
    /// Its landing.
    fn landed(&self) -> Landed {
        Landed { arrival: self.arrival, battery: self.battery }
    }
}

/// The known state of an aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AircraftNow {
    /// The aircraft.
    pub aircraft: AircraftIx,
    /// Its activity.
    pub phase: Phase,
    /// The vertiport where it stands or will land.
    pub place: VertiportIx,
    /// When it landed there or is expected to land.
    pub arrival: Time,
    /// When it is expected to be ready; after the end of operations if it is out of service until
    /// further notice.
    pub ready: Time,
    /// Whether it is out of service.
    pub is_out: bool,
    /// When it is expected back in service, if that is known.
    pub out_until: Option<Time>,
    /// Whether it waits for a decision.
    pub needs_decision: bool,
    /// What its battery holds now, kWh; `None` in the air, and on days that charge to full.
    pub charge_kwh: Option<f64>,
    /// What its battery will hold when it lands, kWh, if it is on its way; `None` on days that
    /// charge to full.
    pub lands_with_kwh: Option<f64>,
}

/// A closure as one for each direction that it closes.
fn one_way(closure: &Closure) -> impl Iterator<Item = Closure> + use<> {
    let Closure { route: Route { from, to, both_ways }, .. } = *closure;
    let one = |(from, to)| Closure { route: Route { from, to, both_ways: false }, ..*closure };
    [Some(one((from, to))), both_ways.then(|| one((to, from)))].into_iter().flatten()
}

impl LiveDay {
    /// A day before its first report. Of the scenario it takes what is expected: the forecast where
    /// the demand differs from it, and closures that are known; other disturbances have to be
    /// reported.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let scenario =
            if scenario.disturbances.is_none() { scenario } else { Arc::new(scenario.expected()) };
        let known = Simulation::new(Arc::clone(&scenario));
        let start = scenario.operations.start;
        let standing = |aircraft| LiveAircraft {
            phase: Phase::Standing,
            prepared: known.queue.ready_at(aircraft),
            out: None,
            undoable: None,
        };
        Self {
            now: start,
            aircraft: AircraftIx::all(scenario.aircraft.len()).map(standing).collect(),
            decisions: Vec::new(),
            boarded: vec![0; known.demand.cells()],
            closures: scenario.disturbances.closures.iter().flat_map(one_way).collect(),
            log: Vec::new(),
            closed_since: BTreeMap::new(),
            is_stale: false,
            known: known.without_surprises(),
        }
    }

    /// The scenario as it is expected.
    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.known.scenario
    }

    /// The latest time of a report, or the start of operations.
    pub fn now(&self) -> Time {
        self.now
    }

    /// Whether nothing is left to decide and every aircraft is on the ground.
    pub fn is_over(&self) -> bool {
        let end = self.scenario().operations.end;
        let decides_no_more = |aircraft: AircraftNow| {
            aircraft.phase == Phase::Standing && (self.now > end || aircraft.ready > end)
        };
        self.aircraft().all(decides_no_more)
    }

    /// Every aircraft.
    pub fn aircraft(&self) -> impl Iterator<Item = AircraftNow> + '_ {
        AircraftIx::all(self.aircraft.len()).map(|aircraft| self.aircraft_now(aircraft))
    }

    /// An aircraft.
    ///
    /// # Panics
    /// Panics if the day has no such aircraft.
    pub fn aircraft_now(&self, aircraft: AircraftIx) -> AircraftNow {
        let state = &self.aircraft[aircraft.at()];
        AircraftNow {
            aircraft,
            phase: state.phase,
            place: self.known.place[aircraft.at()],
            arrival: self.known.arrival[aircraft.at()],
            ready: self.known.queue.ready_at(aircraft),
            is_out: Self::is_out(*state, self.now),
            out_until: match state.out {
                Some(OutOfService::Until(until)) if self.now < until => Some(until),
                _ => None,
            },
            needs_decision: self.decision(aircraft, self.now).is_ok(),
            charge_kwh: self.charge_kwh(aircraft),
            lands_with_kwh: self.lands_with_kwh(aircraft),
        }
    }

    fn is_out(aircraft: LiveAircraft, time: Time) -> bool {
        match aircraft.out {
            None => false,
            Some(OutOfService::Until(until)) => time < until,
            Some(OutOfService::UntilReported) => true,
        }
    }

    /// The decision of an aircraft at a time, or now if that is later.
    ///
    /// # Errors
    /// Returns a [`ReportError`] if the aircraft is not ready then, or if operations are over.
    pub fn decision(&self, aircraft: AircraftIx, time: Time) -> Result<Decision, ReportError> {
        let id =
            self.scenario().aircraft.get(aircraft.at()).ok_or(ReportError::Unknown("aircraft"))?;
        let time = time.max(self.now);
        let end = self.scenario().operations.end;
        if time > end {
            return Err(ReportError::Over { end });
        }
        let state = &self.aircraft[aircraft.at()];
        let ready = self.known.queue.ready_at(aircraft);
        let aircraft_id = || id.id.clone();
        if let Some(is) = state.phase.on_its_way() {
            return Err(ReportError::OnItsWay { aircraft: aircraft_id(), is });
        }
        if Self::is_out(*state, time) {
            let until = match state.out {
                Some(OutOfService::Until(until)) => Some(until),
                _ => None,
            };
            return Err(ReportError::OutOfService { aircraft: aircraft_id(), until });
        }
        if ready > time {
            return Err(ReportError::NotReady { aircraft: aircraft_id(), ready, time });
        }
        let index = u32::try_from(self.decisions.len()).unwrap_or(u32::MAX);
        Ok(Decision { time, aircraft, at: self.known.place[aircraft.at()], index })
    }

    /// The day as a policy observes it at a [decision](Self::decision). It is written into `room`,
    /// which keeps its memory from one decision to the next.
    pub fn view_at<'room>(
        &mut self,
        decision: &Decision,
        room: &'room mut Option<Simulation>,
    ) -> View<'room> {
        self.add_up();
        if let Some(room) = room {
            room.clone_from(&self.known);
        }
        let day = room.get_or_insert_with(|| self.known.clone());
        self.expect_from(day, decision.time, Some(decision.aircraft));
        day.view()
    }

    /// The rest of the day as it is expected now, to be played out.
    pub fn rest(&mut self) -> Imagined {
        self.add_up();
        let mut day = self.known.clone();
        self.expect_from(&mut day, self.now, None);
        Imagined::of_expected(day)
    }

    /// Lets a copy of the known state continue from a time: nothing that has not happened yet
    /// happens earlier. If an aircraft decides then, it is the first.
    fn expect_from(&self, day: &mut Simulation, time: Time, first: Option<AircraftIx>) {
        day.advance_to(time);
        for aircraft in AircraftIx::all(self.aircraft.len()) {
            let state = &self.aircraft[aircraft.at()];
            let known = self.known.queue.ready_at(aircraft);
            let ready = match state.phase {
                Phase::Standing if Some(aircraft) == first => time,
                Phase::Standing => {
                    let waits_for_first = first.is_some_and(|first| aircraft < first);
                    known.max(time + u32::from(waits_for_first))
                }
                Phase::SentOff { flight, departs } => {
                    if departs < time {
                        self.charge_until(&mut day.batteries, flight, time);
                    }
                    self.late(day, aircraft, time.since(departs), known)
                }
                Phase::InTheAir { .. } => {
                    let late_s = time.since(self.known.arrival[aircraft.at()]);
                    self.late(day, aircraft, late_s, known)
                }
            };
            if ready != known || Some(aircraft) == first {
                day.queue.set(aircraft, ready);
            }
        }
    }

    /// Lets an aircraft land later than it is known to; returns when it is ready.
    fn late(&self, day: &mut Simulation, aircraft: AircraftIx, late_s: u32, known: Time) -> Time {
        if late_s == 0 {
            return known;
        }
        let state = &self.aircraft[aircraft.at()];
        day.arrival[aircraft.at()] = self.known.arrival[aircraft.at()] + late_s;
        self.in_service(state, state.prepared + late_s)
    }

    /// When an aircraft is ready that is prepared at a time: it must also be in service.
    fn in_service(&self, aircraft: &LiveAircraft, prepared: Time) -> Time {
        match aircraft.out {
            None => prepared,
            Some(OutOfService::Until(until)) => prepared.max(until),
            Some(OutOfService::UntilReported) => prepared.max(self.scenario().operations.end + 1),
        }
    }

    /// Adds the account and the demand of the whole day up, if a report has changed what was in
    /// them.
    fn add_up(&mut self) {
        if !std::mem::take(&mut self.is_stale) {
            return;
        }
        let scenario = Arc::clone(&self.known.scenario);
        let mut ledger = crate::Ledger::at_start(&scenario);
        for LiveDecision { row, .. } in self.decisions.iter().filter(|one| !one.is_undone) {
            if row.from == row.to {
                ledger.holds += 1;
                continue;
            }
            let kind = scenario.aircraft[row.aircraft.at()].kind;
            let seats = scenario.aircraft_types[kind.at()].seats;
            ledger.enter_flight(row, scenario.distance_mi[(row.from, row.to)], seats);
        }
        self.known.ledger = ledger;
        self.known.demand.set_total(&self.boarded);
        let pairs = scenario.vertiports.len().pow(2);
        let left = self.known.demand.all_own();
        let of_period = |(period, (left, boarded)): (usize, (&[u32], &[u32]))| {
            let fares = scenario.fare_usd.in_period(period).cells();
            let wanted = left.iter().zip(boarded).map(|(left, boarded)| f64::from(left + boarded));
            wanted.zip(fares).map(|(wanted, &fare)| wanted * fare).collect::<Vec<f64>>()
        };
        let periods = left.chunks_exact(pairs).zip(self.boarded.chunks_exact(pairs)).enumerate();
        self.known.potential_usd = periods.flat_map(of_period).sum();
    }

    /// The day's numbers so far.
    pub fn totals(&mut self) -> DayTotals {
        self.add_up();
        self.known.totals()
    }

    /// The day as it is known, with the account so far; the time of its view is the latest
    /// report's.
    pub fn view(&mut self) -> View<'_> {
        self.add_up();
        self.known.view()
    }

    /// The decisions so far that were not undone, with what came of them or is expected to.
    pub fn trace(&self) -> Trace {
        let kept = self.decisions.iter().filter(|decision| !decision.is_undone);
        Trace { rows: kept.map(|decision| decision.row).collect() }
    }

    /// The flight of an aircraft that has been sent off or is in the air.
    pub fn flight(&self, aircraft: AircraftIx) -> Option<&TraceRow> {
        match self.aircraft.get(aircraft.at())?.phase {
            Phase::Standing => None,
            Phase::SentOff { flight, .. } | Phase::InTheAir { flight, .. } => {
                Some(&self.decisions[flight].row)
            }
        }
    }

    /// Passengers of a period who have been taken on board, `[from][to]` row by row. Those who
    /// waited into the next period count in their own.
    pub fn boarded_in(&self, period: usize) -> &[u32] {
        let pairs = self.scenario().vertiports.len().pow(2);
        &self.boarded[period * pairs..][..pairs]
    }
}
