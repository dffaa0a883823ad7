//! Accepts reports: each is checked, and then changes what is known.

mod closures_and_demand;
mod flights;

use vertifleet_core::{AircraftIx, Time, VertiportIx};

use super::notice::Notice;
use super::report::{Report, ReportError};
use super::{Before, LiveAircraft, LiveDay, LiveDecision, OutOfService, Phase};
use crate::TraceRow;

/// The longest step by which a report may move the day on, except for one of the clock.
const LONGEST_STEP_S: u32 = 4 * 3_600;

impl LiveDay {
    /// Refuses a report that is probably a mistake: its time is hours after all others, what it
    /// reports was over before, a flight landed before it departed, or a hold is taken back when
    /// nothing can be decided in its place any more. Since the clock never runs back, a time that
    /// is too late does harm that cannot be undone.
    ///
    /// # Errors
    /// Returns [`ReportError::TooFarAhead`], [`ReportError::AfterTheDay`],
    /// [`ReportError::Backwards`], [`ReportError::BeforeDeparture`] or [`ReportError::Over`].
    pub fn check_times(&self, time: Time, report: &Report) -> Result<(), ReportError> {
        match *report {
            // The clock itself may jump, but not to a time when all aircraft of the day are done.
            Report::Clock => {
                let latest = self.now.max(self.scenario().operations.end);
                if time > latest + LONGEST_STEP_S {
                    return Err(ReportError::AfterTheDay { time, latest });
                }
                Ok(())
            }
            _ if time > self.now + LONGEST_STEP_S => {
                Err(ReportError::TooFarAhead { time, now: self.now })
            }
            Report::Delayed { until, .. }
            | Report::Charging { ready: until, .. }
            | Report::OutOfService { until: Some(until), .. }
            | Report::Closed { until: Some(until), .. }
                if until < time =>
            {
                Err(ReportError::Backwards { time, until })
            }
            Report::Landed { aircraft, .. } => {
                let departed = match self.state(aircraft)?.phase {
                    Phase::Standing => return Ok(()),
                    Phase::SentOff { flight, .. } => self.decisions[flight].row.time,
                    Phase::InTheAir { departed, .. } => departed,
                };
                if time >= departed {
                    return Ok(());
                }
                let aircraft = self.id(aircraft);
                Err(ReportError::BeforeDeparture { aircraft, time, departed })
            }
            Report::Undone { aircraft } => {
                let end = self.scenario().operations.end;
                let latest =
                    self.state(aircraft)?.undoable.map(|latest| &self.decisions[latest].row);
                let is_hold = latest.is_some_and(|row| row.from == row.to);
                if is_hold && time.max(self.now) > end {
                    Err(ReportError::Over { end })
                } else {
                    Ok(())
                }
            }
            _ => Ok(()),
        }
    }

    /// Applies a report, and returns the notices for people.
    ///
    /// # Errors
    /// Returns a [`ReportError`] if the report makes no sense or is a decision that breaks a rule.
    /// Nothing has changed then.
    pub(super) fn apply(
        &mut self,
        time: Time,
        report: &Report,
    ) -> Result<Vec<Notice>, ReportError> {
        let mut notices = Vec::new();
        match *report {
            Report::Decided { aircraft, to } => self.decide(aircraft, time, to)?,
            Report::Undone { aircraft } => self.undo(aircraft)?,
            Report::Departed { aircraft, to, passengers } => {
                self.depart(aircraft, time, (to, passengers), &mut notices)?;
            }
            Report::Landed { aircraft, at, charge_kwh } => {
                self.check_charge(aircraft, charge_kwh)?;
                self.land(aircraft, time, (at, charge_kwh), &mut notices)?;
                self.correct_charge(aircraft, charge_kwh);
            }
            Report::Charging { aircraft, ready } => {
                self.charge(aircraft, ready, "be charging", &mut notices)?;
            }
            Report::Ready { aircraft } => self.charge(aircraft, time, "be ready", &mut notices)?,
            Report::Delayed { aircraft, until } => self.delay(aircraft, until, &mut notices)?,
            Report::OutOfService { aircraft, until } => {
                let until = until.map_or(OutOfService::UntilReported, OutOfService::Until);
                self.set_out(aircraft, Some(until))?;
            }
            Report::BackInService { aircraft } => {
                if self.state(aircraft)?.out.is_none() {
                    return Err(ReportError::InService { aircraft: self.id(aircraft) });
                }
                self.set_out(aircraft, None)?;
            }
            Report::Closed { routes, until } => self.close(time, routes, until)?,
            Report::Reopened { routes } => self.reopen(time, routes)?,
            Report::Demand { period, ref pairs } => self.set_demand(period, pairs)?,
            Report::Booked { booking } => self.book(booking)?,
            Report::Cancelled { booking } => self.cancel(booking)?,
            Report::Clock | Report::Acknowledged => {}
            Report::Corrected { .. } => unreachable!("a correction computes the day again"),
            Report::Stands { vertiport, stands } => {
                self.check_vertiport(vertiport)?;
                self.forget();
                self.known.stands.set_limit(vertiport, stands);
                notices.extend(self.more_than_stands(vertiport));
            }
        }
        self.now = self.now.max(time);
        self.known.advance_to(self.now);
        Ok(notices)
    }

    fn state(&self, aircraft: AircraftIx) -> Result<LiveAircraft, ReportError> {
        self.aircraft.get(aircraft.at()).copied().ok_or(ReportError::Unknown("aircraft"))
    }

    fn check_vertiport(&self, vertiport: VertiportIx) -> Result<(), ReportError> {
        let is_known = vertiport.at() < self.scenario().vertiports.len();
        is_known.then_some(()).ok_or(ReportError::Unknown("vertiport"))
    }

    pub(super) fn id(&self, aircraft: AircraftIx) -> String {
        self.scenario().aircraft[aircraft.at()].id.clone()
    }

    pub(super) fn vertiport_id(&self, vertiport: VertiportIx) -> String {
        self.scenario().vertiports[vertiport.at()].id.clone()
    }

    fn wrong_place(&self, aircraft: AircraftIx, report: &'static str) -> ReportError {
        let is = match self.aircraft[aircraft.at()].phase {
            Phase::Standing => "stands at its vertiport",
            Phase::SentOff { .. } => "has been sent off and has not departed",
            Phase::InTheAir { .. } => "is in the air",
        };
        ReportError::WrongPlace { aircraft: self.id(aircraft), is, report }
    }

    /// Sets when an aircraft is prepared, and with it when it is ready.
    fn set_prepared(&mut self, aircraft: AircraftIx, prepared: Time) {
        self.aircraft[aircraft.at()].prepared = prepared;
        let state = self.aircraft[aircraft.at()];
        self.known.queue.set(aircraft, self.in_service(&state, prepared));
    }

    fn decide(
        &mut self,
        aircraft: AircraftIx,
        time: Time,
        to: VertiportIx,
    ) -> Result<(), ReportError> {
        self.state(aircraft)?;
        if time < self.now {
            return Err(ReportError::Past { time, now: self.now });
        }
        let decision = self.decision(aircraft, time)?;
        let before = self.before(aircraft);
        let clock = (self.known.period, self.known.next_change, self.known.closures.clone());
        let demand = (self.known.next_change <= time).then(|| self.known.demand.clone());
        self.known.advance_to(time);
        let waiting = self.known.demand.waiting(decision.at, to);
        match self.known.carry_out(&decision, to) {
            Ok(row) => {
                self.enter(row, before, waiting);
                Ok(())
            }
            Err(refusal) => {
                let known = &mut self.known;
                (known.period, known.next_change, known.closures) = clock;
                if let Some(demand) = demand {
                    known.demand = demand;
                }
                Err(refusal.into())
            }
        }
    }

    /// An aircraft as it is before a decision.
    fn before(&self, aircraft: AircraftIx) -> Before {
        Before {
            prepared: self.aircraft[aircraft.at()].prepared,
            arrival: self.known.arrival[aircraft.at()],
            battery: self.known.batteries.kept(aircraft),
            waited: self.known.stands.waits(aircraft),
        }
    }

    /// Enters a decision that the simulator has carried out. `waiting` is the number of passengers
    /// of the pair who waited before it.
    fn enter(&mut self, row: TraceRow, before: Before, waiting: u32) {
        let (period, flight) = (self.known.period, self.decisions.len());
        let waited = u16::try_from(waiting).map_or(row.passengers, |all| all.min(row.passengers));
        self.decisions.push(LiveDecision { row, period, waited, before, is_undone: false });
        self.set_prepared(row.aircraft, row.ready);
        let state = &mut self.aircraft[row.aircraft.at()];
        state.undoable = Some(flight);
        if row.from != row.to {
            state.phase = Phase::SentOff { flight, departs: row.takeoff };
            for (period, passengers) in self.decisions[flight].parties() {
                let at = self.known.demand.at(period, row.from, row.to);
                self.boarded[at] += u32::from(passengers);
            }
        }
        self.is_stale = true;
    }

    fn undo(&mut self, aircraft: AircraftIx) -> Result<(), ReportError> {
        let state = self.state(aircraft)?;
        let nothing = || ReportError::NothingToUndo { aircraft: self.id(aircraft) };
        let latest = state.undoable.ok_or_else(nothing)?;
        let LiveDecision { row, before, .. } = self.decisions[latest];
        self.decisions[latest].is_undone = true;
        self.put_back(latest);
        self.known.stands.leave(aircraft, row.to);
        self.known.stands.take(aircraft, row.from, before.waited);
        self.known.place[aircraft.at()] = row.from;
        self.known.arrival[aircraft.at()] = before.arrival;
        self.known.batteries.restore(aircraft, before.battery);
        let state = &mut self.aircraft[aircraft.at()];
        (state.phase, state.undoable) = (Phase::Standing, None);
        self.set_prepared(aircraft, before.prepared);
        self.is_stale = true;
        Ok(())
    }

    /// Lets the passengers of a flight want to fly again.
    fn put_back(&mut self, flight: usize) {
        let decision = &self.decisions[flight];
        let TraceRow { from, to, .. } = decision.row;
        let demand = &mut self.known.demand;
        for (period, passengers) in decision.parties() {
            let own = demand.own(period, from, to) + u32::from(passengers);
            demand.set_own(period, from, to, own);
            self.boarded[demand.at(period, from, to)] -= u32::from(passengers);
        }
    }

    fn set_out(
        &mut self,
        aircraft: AircraftIx,
        out: Option<OutOfService>,
    ) -> Result<(), ReportError> {
        let state = self.state(aircraft)?;
        self.aircraft[aircraft.at()].out = out;
        self.set_prepared(aircraft, state.prepared);
        Ok(())
    }
}
