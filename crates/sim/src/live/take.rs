//! Takes reports in: each is checked, and then changes what is known.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, Closure, Route, Scenario, Time, VertiportIx};

use super::report::{Booking, Notice, Report, Routes, Unfit};
use super::{Before, LiveAircraft, LiveDay, LiveDecision, OutOfService, Phase};
use crate::{Decision, TraceRow};

/// A report that moves the clock on further must say that it means to.
const LONGEST_STEP_S: u32 = 4 * 3_600;
/// At most this many passengers of a pair wait in a period.
const MOST_PASSENGERS: u32 = 1_000_000;

impl LiveDay {
    /// Whether a report may be a slip of the pen: it lies hours after everything that the day has heard of, something that
    /// it tells was over before, a flight landed before it departed, or a hold is taken back when nothing can be decided in
    /// its place any more. Since the clock never runs back, the first does harm that cannot be undone.
    ///
    /// # Errors
    /// Returns [`Unfit::TooFarAhead`], [`Unfit::Backwards`], [`Unfit::BeforeDeparture`] or [`Unfit::Over`].
    pub fn check_times(&self, time: Time, report: &Report) -> Result<(), Unfit> {
        match *report {
            Report::Clock => Ok(()),
            _ if time > self.now + LONGEST_STEP_S => {
                Err(Unfit::TooFarAhead { time, now: self.now })
            }
            Report::Delayed { until, .. }
            | Report::Charging { ready: until, .. }
            | Report::OutOfService { until: Some(until), .. }
            | Report::Closed { until: Some(until), .. }
                if until < time =>
            {
                Err(Unfit::Backwards { time, until })
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
                Err(Unfit::BeforeDeparture { aircraft, time, departed })
            }
            Report::Undone { aircraft } => {
                let end = self.scenario().operations.end;
                let latest =
                    self.state(aircraft)?.undoable.map(|latest| &self.decisions[latest].row);
                let is_hold = latest.is_some_and(|row| row.from == row.to);
                if is_hold && time.max(self.now) > end { Err(Unfit::Over { end }) } else { Ok(()) }
            }
            _ => Ok(()),
        }
    }

    /// Takes a report in. `time` is when it happened; reports may come late, but the day's clock never runs back.
    /// Returns what people should look at.
    ///
    /// # Errors
    /// Returns an [`Unfit`] if the report makes no sense or is a decision that breaks a rule. Nothing has changed then.
    pub fn take(&mut self, time: Time, report: &Report) -> Result<Vec<Notice>, Unfit> {
        let mut notices = Vec::new();
        match *report {
            Report::Decided { aircraft, to } => self.decide(aircraft, time, to)?,
            Report::Undone { aircraft } => self.undo(aircraft)?,
            Report::Departed { aircraft, to, passengers } => {
                self.depart(aircraft, time, (to, passengers), &mut notices)?;
            }
            Report::Landed { aircraft, at } => self.land(aircraft, time, at, &mut notices)?,
            Report::Charging { aircraft, ready } => self.charge(aircraft, ready, "be charging")?,
            Report::Ready { aircraft } => self.charge(aircraft, time, "be ready")?,
            Report::Delayed { aircraft, until } => self.delay(aircraft, until)?,
            Report::OutOfService { aircraft, until } => {
                let until = until.map_or(OutOfService::UntilReported, OutOfService::Until);
                self.set_out(aircraft, Some(until))?;
            }
            Report::BackInService { aircraft } => {
                if self.state(aircraft)?.out.is_none() {
                    return Err(Unfit::InService { aircraft: self.id(aircraft) });
                }
                self.set_out(aircraft, None)?;
            }
            Report::Closed { routes, until } => self.close(time, routes, until)?,
            Report::Reopened { routes } => self.reopen(time, routes)?,
            Report::Demand { period, ref pairs } => self.set_demand(period, pairs)?,
            Report::Booked { booking } => self.book(booking)?,
            Report::Cancelled { booking } => self.cancel(booking)?,
            Report::Clock => {}
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

    fn state(&self, aircraft: AircraftIx) -> Result<LiveAircraft, Unfit> {
        self.aircraft.get(aircraft.at()).copied().ok_or(Unfit::Unknown("aircraft"))
    }

    fn check_vertiport(&self, vertiport: VertiportIx) -> Result<(), Unfit> {
        let is_known = vertiport.at() < self.scenario().vertiports.len();
        is_known.then_some(()).ok_or(Unfit::Unknown("vertiport"))
    }

    fn id(&self, aircraft: AircraftIx) -> String {
        self.scenario().aircraft[aircraft.at()].id.clone()
    }

    fn vertiport_id(&self, vertiport: VertiportIx) -> String {
        self.scenario().vertiports[vertiport.at()].id.clone()
    }

    fn wrong_place(&self, aircraft: AircraftIx, report: &'static str) -> Unfit {
        let is = match self.aircraft[aircraft.at()].phase {
            Phase::Standing => "stands at its vertiport",
            Phase::SentOff { .. } => "has been sent off and has not departed",
            Phase::InTheAir { .. } => "is in the air",
        };
        Unfit::WrongPlace { aircraft: self.id(aircraft), is, report }
    }

    /// Sets when an aircraft is charged, and with it when it is ready.
    fn set_charged(&mut self, aircraft: AircraftIx, charged: Time) {
        self.aircraft[aircraft.at()].charged = charged;
        let state = self.aircraft[aircraft.at()];
        self.known.queue.set(aircraft, self.in_service(&state, charged));
    }

    fn decide(&mut self, aircraft: AircraftIx, time: Time, to: VertiportIx) -> Result<(), Unfit> {
        self.state(aircraft)?;
        if time < self.now {
            return Err(Unfit::Past { time, now: self.now });
        }
        let decision = self.decision(aircraft, time)?;
        let before = self.before(aircraft);
        let clock = (self.known.period, self.known.closures.clone());
        self.known.advance_to(time);
        match self.known.carry_out(&decision, to) {
            Ok(row) => {
                self.enter(row, before);
                Ok(())
            }
            Err(refusal) => {
                (self.known.period, self.known.closures) = clock;
                Err(refusal.into())
            }
        }
    }

    /// An aircraft as it is before a decision.
    fn before(&self, aircraft: AircraftIx) -> Before {
        Before {
            charged: self.aircraft[aircraft.at()].charged,
            arrival: self.known.arrival[aircraft.at()],
            waited: self.known.stands.waits(aircraft),
        }
    }

    /// Enters a decision that the simulator has carried out.
    fn enter(&mut self, row: TraceRow, before: Before) {
        let (period, flight) = (self.known.period, self.decisions.len());
        self.decisions.push(LiveDecision { row, period, before, is_undone: false });
        self.set_charged(row.aircraft, row.ready);
        let state = &mut self.aircraft[row.aircraft.at()];
        state.undoable = Some(flight);
        if row.from != row.to {
            state.phase = Phase::SentOff { flight, departs: row.time };
            let at = self.known.demand.at(period, row.from, row.to);
            self.boarded[at] += u32::from(row.passengers);
        }
        self.is_stale = true;
    }

    fn undo(&mut self, aircraft: AircraftIx) -> Result<(), Unfit> {
        let state = self.state(aircraft)?;
        let nothing = || Unfit::NothingToUndo { aircraft: self.id(aircraft) };
        let latest = state.undoable.ok_or_else(nothing)?;
        let LiveDecision { row, period, before, .. } = self.decisions[latest];
        self.decisions[latest].is_undone = true;
        if row.from != row.to {
            self.put_back(period, (row.from, row.to), row.passengers);
        }
        self.known.stands.leave(aircraft, row.to);
        self.known.stands.take(aircraft, row.from, before.waited);
        self.known.place[aircraft.at()] = row.from;
        self.known.arrival[aircraft.at()] = before.arrival;
        let state = &mut self.aircraft[aircraft.at()];
        (state.phase, state.undoable) = (Phase::Standing, None);
        self.set_charged(aircraft, before.charged);
        self.is_stale = true;
        Ok(())
    }

    /// Lets passengers who were taken on board want to fly again.
    fn put_back(&mut self, period: usize, (from, to): (VertiportIx, VertiportIx), passengers: u16) {
        let demand = &mut self.known.demand;
        let at = demand.at(period, from, to);
        demand.set(period, from, to, demand.left(period, from, to) + u32::from(passengers));
        self.boarded[at] -= u32::from(passengers);
    }

    fn depart(
        &mut self,
        aircraft: AircraftIx,
        time: Time,
        (to, passengers): (Option<VertiportIx>, Option<u16>),
        notices: &mut Vec<Notice>,
    ) -> Result<(), Unfit> {
        let state = self.state(aircraft)?;
        if let Some(to) = to {
            self.check_vertiport(to)?;
        }
        let from = match state.phase {
            Phase::Standing => self.known.place[aircraft.at()],
            Phase::SentOff { flight, .. } => self.decisions[flight].row.from,
            Phase::InTheAir { .. } => return Err(self.wrong_place(aircraft, "depart")),
        };
        let sent_to = (state.phase != Phase::Standing).then(|| self.known.place[aircraft.at()]);
        let to = to.or(sent_to).ok_or_else(|| self.wrong_place(aircraft, "depart"))?;
        if to == from {
            return Err(Unfit::Unknown("route"));
        }
        self.check_seats(aircraft, passengers)?;
        notices.extend(self.not_ready(aircraft, time));
        if sent_to != Some(to) {
            if sent_to.is_some() {
                self.undo(aircraft)?;
            }
            notices.extend(self.send_off(aircraft, time, to));
        }
        let Phase::SentOff { flight, departs } = self.aircraft[aircraft.at()].phase else {
            unreachable!("it has been sent off by now");
        };
        self.aircraft[aircraft.at()].phase = Phase::InTheAir { flight, departed: time };
        self.aircraft[aircraft.at()].undoable = None;
        if let Some(passengers) = passengers {
            self.correct_passengers(flight, passengers);
        }
        self.note_delay(flight, time);
        if time != departs {
            let flight_s = self.decisions[flight].row.arrival.since(departs);
            self.set_arrival(aircraft, flight, time + flight_s);
        }
        Ok(())
    }

    /// Why an aircraft should not have departed, whatever its flight.
    fn not_ready(&self, aircraft: AircraftIx, time: Time) -> Option<Notice> {
        let LiveAircraft { phase, charged, out, .. } = self.aircraft[aircraft.at()];
        // Whoever has been sent off may depart, whatever has happened since.
        if phase != Phase::Standing {
            return None;
        }
        let is_out = match out {
            None => false,
            Some(OutOfService::UntilReported) => true,
            Some(OutOfService::Until(until)) => time < until,
        };
        if is_out {
            return Some(Notice::DepartedOutOfService { aircraft: self.id(aircraft) });
        }
        (time < charged)
            .then(|| Notice::DepartedUnready { aircraft: self.id(aircraft), ready: charged })
    }

    fn check_seats(&self, aircraft: AircraftIx, passengers: Option<u16>) -> Result<(), Unfit> {
        let kind = self.scenario().aircraft[aircraft.at()].kind;
        let seats = self.scenario().aircraft_types[kind.at()].seats;
        match passengers {
            Some(passengers) if passengers > seats => {
                Err(Unfit::NoSeats { aircraft: self.id(aircraft), passengers, seats })
            }
            _ => Ok(()),
        }
    }

    /// Sends an aircraft off that has departed without a decision of ours, whatever the rules say.
    fn send_off(&mut self, aircraft: AircraftIx, time: Time, to: VertiportIx) -> Option<Notice> {
        let time = time.max(self.now);
        let at = self.known.place[aircraft.at()];
        let index = u32::try_from(self.decisions.len()).unwrap_or(u32::MAX);
        let decision = Decision { time, aircraft, at, index };
        let before = self.before(aircraft);
        self.known.advance_to(time);
        let breaks = !self.known.feasible(&decision).contains(to);
        let notice = breaks.then(|| Notice::AgainstTheRules(self.known.refusal(&decision, to)));
        let row = self.known.fly(&decision, to);
        self.enter(row, before);
        notice
    }

    /// Corrects how many passengers a flight has on board.
    fn correct_passengers(&mut self, flight: usize, passengers: u16) {
        let LiveDecision { row, period, .. } = &self.decisions[flight];
        let (period, pair, expected) = (*period, (row.from, row.to), row.passengers);
        if passengers == expected {
            return;
        }
        self.put_back(period, pair, expected);
        let demand = &mut self.known.demand;
        let left = demand.left(period, pair.0, pair.1).saturating_sub(passengers.into());
        demand.set(period, pair.0, pair.1, left);
        self.boarded[demand.at(period, pair.0, pair.1)] += u32::from(passengers);
        let scenario = Arc::clone(&self.known.scenario);
        let row = &mut self.decisions[flight].row;
        row.passengers = passengers;
        row.revenue_usd = f64::from(passengers) * scenario.fare_usd.in_period(period)[pair];
        row.passenger_cost_usd = f64::from(passengers) * scenario.passenger_cost_usd[pair];
        self.is_stale = true;
    }

    /// Sets when a flight lands, and with it when its aircraft is charged and what that costs.
    fn set_arrival(&mut self, aircraft: AircraftIx, flight: usize, arrival: Time) {
        let row = &mut self.decisions[flight].row;
        let charge_s = row.ready.since(row.arrival);
        (row.arrival, row.ready) = (arrival, arrival + charge_s);
        let scenario = &self.known.scenario;
        row.energy_cost_usd =
            row.energy_kwh * scenario.energy_price_usd[scenario.period_at(arrival)];
        let charged = row.ready;
        self.known.arrival[aircraft.at()] = arrival;
        self.set_charged(aircraft, charged);
        self.is_stale = true;
    }

    fn land(
        &mut self,
        aircraft: AircraftIx,
        time: Time,
        at: Option<VertiportIx>,
        notices: &mut Vec<Notice>,
    ) -> Result<(), Unfit> {
        let state = self.state(aircraft)?;
        if let Some(at) = at {
            self.check_vertiport(at)?;
        }
        let expected_at = self.known.place[aircraft.at()];
        let at = at.unwrap_or(expected_at);
        match state.phase {
            Phase::Standing if at == expected_at => {
                return Err(self.wrong_place(aircraft, "land"));
            }
            Phase::Standing => {
                notices.push(Notice::NotFlown {
                    aircraft: self.id(aircraft),
                    at: self.vertiport_id(at),
                });
                self.move_to(aircraft, at);
                self.known.arrival[aircraft.at()] = time;
                self.set_charged(aircraft, state.charged.max(time));
            }
            Phase::SentOff { flight, .. } | Phase::InTheAir { flight, .. } => {
                if at != expected_at {
                    notices.push(Notice::Diverted {
                        aircraft: self.id(aircraft),
                        at: self.vertiport_id(at),
                        to: self.vertiport_id(expected_at),
                    });
                    self.divert(aircraft, flight, at);
                }
                if self.decisions[flight].row.arrival != time {
                    self.set_arrival(aircraft, flight, time);
                }
            }
        }
        let state = &mut self.aircraft[aircraft.at()];
        (state.phase, state.undoable) = (Phase::Standing, None);
        if at != expected_at {
            notices.extend(self.more_than_stands(at));
        }
        Ok(())
    }

    fn move_to(&mut self, aircraft: AircraftIx, at: VertiportIx) {
        self.known.stands.leave(aircraft, self.known.place[aircraft.at()]);
        self.known.stands.take(aircraft, at, false);
        self.known.place[aircraft.at()] = at;
    }

    /// Lets a flight end at another vertiport. It takes the energy of the flight there, or what it was to take if it came
    /// back; everything else of its account stays.
    fn divert(&mut self, aircraft: AircraftIx, flight: usize, at: VertiportIx) {
        self.move_to(aircraft, at);
        let LiveDecision { row, .. } = self.decisions[flight];
        if at != row.from {
            let kind = self.scenario().aircraft[aircraft.at()].kind;
            let leg = *self.known.legs.leg(kind, row.from, at);
            let row = &mut self.decisions[flight].row;
            row.energy_kwh = leg.energy_kwh;
            row.ready = row.arrival + leg.charge_s;
        }
        self.set_arrival(aircraft, flight, row.arrival);
    }

    fn charge(
        &mut self,
        aircraft: AircraftIx,
        ready: Time,
        report: &'static str,
    ) -> Result<(), Unfit> {
        if self.state(aircraft)?.phase != Phase::Standing {
            return Err(self.wrong_place(aircraft, report));
        }
        self.set_charged(aircraft, ready);
        self.aircraft[aircraft.at()].undoable = None;
        let latest = self
            .decisions
            .iter_mut()
            .rev()
            .find(|one| one.row.aircraft == aircraft && !one.is_undone);
        if let Some(LiveDecision { row, .. }) = latest
            && row.from != row.to
        {
            row.ready = ready;
        }
        Ok(())
    }

    fn delay(&mut self, aircraft: AircraftIx, until: Time) -> Result<(), Unfit> {
        match self.state(aircraft)?.phase {
            Phase::Standing => self.charge(aircraft, until, "be delayed")?,
            Phase::SentOff { flight, departs } => {
                self.note_delay(flight, until);
                let flight_s = self.decisions[flight].row.arrival.since(departs);
                self.aircraft[aircraft.at()].phase = Phase::SentOff { flight, departs: until };
                self.set_arrival(aircraft, flight, until + flight_s);
            }
            Phase::InTheAir { flight, .. } => self.set_arrival(aircraft, flight, until),
        }
        Ok(())
    }

    /// Takes note of how late a flight departs, by which others are expected to.
    fn note_delay(&mut self, flight: usize, departs: Time) {
        let TraceRow { time, from, .. } = self.decisions[flight].row;
        let vertiports = self.scenario().vertiports.len();
        self.known.delays.note(time, from, departs.since(time), vertiports);
    }

    fn set_out(&mut self, aircraft: AircraftIx, out: Option<OutOfService>) -> Result<(), Unfit> {
        let state = self.state(aircraft)?;
        self.aircraft[aircraft.at()].out = out;
        self.set_charged(aircraft, state.charged);
        Ok(())
    }

    fn close(&mut self, time: Time, routes: Routes, until: Option<Time>) -> Result<(), Unfit> {
        let size = self.check_routes(routes)?;
        let pairs = routes.pairs(size);
        let Some(end) = until else {
            for (from, to) in pairs {
                self.known.closures.report(from, to, true, size);
            }
            return Ok(());
        };
        let closure = |&(from, to): &(VertiportIx, VertiportIx)| {
            let route = Route { from, to, both_ways: false };
            Closure { route, start: time, end, known: true }
        };
        self.closures.extend(pairs.iter().map(closure));
        self.announce(time, &pairs);
        Ok(())
    }

    fn reopen(&mut self, time: Time, routes: Routes) -> Result<(), Unfit> {
        let size = self.check_routes(routes)?;
        let pairs = routes.pairs(size);
        let time = time.max(self.now);
        let in_force = |closure: &Closure| {
            let pair = (closure.route.from, closure.route.to);
            (closure.start..closure.end).contains(&time) && pairs.contains(&pair)
        };
        if self.closures.iter().any(in_force) {
            self.closures.retain(|closure| !in_force(closure));
            self.announce(time, &pairs);
            return Ok(());
        }
        for (from, to) in pairs {
            self.known.closures.report(from, to, false, size);
        }
        Ok(())
    }

    /// Makes all closures known whose end is.
    fn announce(&mut self, time: Time, told: &[(VertiportIx, VertiportIx)]) {
        let (now, size) = (self.now.max(time), self.scenario().vertiports.len());
        self.known.closures.announce(&self.closures, told, now, size);
        self.known.eventful = true;
        self.forget();
    }

    /// Makes the day another one for policies that remember it, because what they remember no longer holds: they read
    /// stands and known closures once a day.
    fn forget(&mut self) {
        self.known.scenario = Arc::new(Scenario::clone(&self.known.scenario));
    }

    fn check_routes(&self, routes: Routes) -> Result<usize, Unfit> {
        match routes {
            Routes::Way { from, to } if from == to => return Err(Unfit::Unknown("route")),
            Routes::Way { from, to } => {
                self.check_vertiport(from)?;
                self.check_vertiport(to)?;
            }
            Routes::Of(vertiport) => self.check_vertiport(vertiport)?,
        }
        Ok(self.scenario().vertiports.len())
    }

    fn period_start(&self, period: usize) -> Result<Time, Unfit> {
        self.scenario().periods.get(period).copied().ok_or(Unfit::Unknown("period"))
    }

    fn check_period(&self, period: usize) -> Result<(), Unfit> {
        let start = self.period_start(period)?;
        if period < self.known.period {
            return Err(Unfit::PeriodOver { start, now: self.now });
        }
        Ok(())
    }

    fn set_demand(
        &mut self,
        period: usize,
        pairs: &[(VertiportIx, VertiportIx, u32)],
    ) -> Result<(), Unfit> {
        self.period_start(period)?;
        for &(from, to, passengers) in pairs {
            self.check_routes(Routes::Way { from, to })?;
            if passengers > MOST_PASSENGERS {
                return Err(Unfit::TooMany { most: MOST_PASSENGERS });
            }
        }
        for &(from, to, passengers) in pairs {
            self.known.demand.set(period, from, to, passengers);
        }
        self.is_stale = true;
        Ok(())
    }

    fn book(&mut self, booking: Booking) -> Result<(), Unfit> {
        let left = self.left(booking)?;
        self.set_left(booking, left.saturating_add(booking.passengers))
    }

    fn cancel(&mut self, booking: Booking) -> Result<(), Unfit> {
        let (left, cancelled) = (self.left(booking)?, booking.passengers);
        let still = left.checked_sub(cancelled).ok_or(Unfit::NotSoMany { cancelled, left })?;
        self.set_left(booking, still)
    }

    fn left(&self, Booking { period, from, to, .. }: Booking) -> Result<u32, Unfit> {
        self.check_period(period)?;
        self.check_routes(Routes::Way { from, to })?;
        Ok(self.known.demand.left(period, from, to))
    }

    fn set_left(&mut self, booking: Booking, left: u32) -> Result<(), Unfit> {
        self.set_demand(booking.period, &[(booking.from, booking.to, left)])
    }
}
