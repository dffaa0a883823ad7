//! Reports of departures, flights, landings and charging.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, Time, VertiportIx};

use crate::live::notice::Notice;
use crate::live::report::ReportError;
use crate::live::{LiveAircraft, LiveDay, LiveDecision, OutOfService, Phase};
use crate::{Decision, TraceRow};

impl LiveDay {
    pub(super) fn depart(
        &mut self,
        aircraft: AircraftIx,
        time: Time,
        (to, passengers): (Option<VertiportIx>, Option<u16>),
        notices: &mut Vec<Notice>,
    ) -> Result<(), ReportError> {
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
            return Err(ReportError::Unknown("route"));
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
        if state.phase != Phase::Standing || time < self.decisions[flight].before.arrival {
            // Of an aircraft without a decision, it is known that it was not ready.
            let too_soon = self.departed_too_soon(flight, time);
            notices.retain(|notice| {
                too_soon.is_none() || !matches!(notice, Notice::DepartedUnready { .. })
            });
            notices.extend(too_soon);
        }
        notices.extend(self.lacks_energy(flight, time));
        self.aircraft[aircraft.at()].phase = Phase::InTheAir { flight, departed: time };
        self.aircraft[aircraft.at()].undoable = None;
        if let Some(passengers) = passengers {
            self.correct_passengers(flight, passengers);
        }
        self.note_delay(flight, time);
        if time != departs {
            self.set_takeoff(flight, time);
            let flight_s = self.decisions[flight].row.arrival.since(departs);
            self.set_arrival(aircraft, flight, time + flight_s);
        }
        Ok(())
    }

    /// Why an aircraft should not have departed on any flight.
    fn not_ready(&self, aircraft: AircraftIx, time: Time) -> Option<Notice> {
        let LiveAircraft { phase, prepared, out, .. } = self.aircraft[aircraft.at()];
        // An aircraft that was sent off may depart, even if things have changed since.
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
        (time < prepared)
            .then(|| Notice::DepartedUnready { aircraft: self.id(aircraft), ready: prepared })
    }

    fn check_seats(
        &self,
        aircraft: AircraftIx,
        passengers: Option<u16>,
    ) -> Result<(), ReportError> {
        let kind = self.scenario().aircraft[aircraft.at()].kind;
        let seats = self.scenario().aircraft_types[kind.at()].seats;
        match passengers {
            Some(passengers) if passengers > seats => {
                Err(ReportError::NoSeats { aircraft: self.id(aircraft), passengers, seats })
            }
            _ => Ok(()),
        }
    }

    /// Sends an aircraft off that has departed without a decision of ours, even against the rules.
    fn send_off(&mut self, aircraft: AircraftIx, time: Time, to: VertiportIx) -> Option<Notice> {
        let time = time.max(self.now);
        let at = self.known.place[aircraft.at()];
        let index = u32::try_from(self.decisions.len()).unwrap_or(u32::MAX);
        let decision = Decision { time, aircraft, at, index };
        let before = self.before(aircraft);
        self.known.advance_to(time);
        let waiting = self.known.demand.waiting(at, to);
        let breaks = !self.known.feasible(&decision).contains(to);
        let notice = breaks.then(|| Notice::AgainstTheRules {
            aircraft: self.id(aircraft),
            refusal: self.known.refusal(&decision, to),
        });
        let row = self.known.fly(&decision, to);
        self.enter(row, before, waiting);
        notice
    }

    /// Corrects how many passengers a flight has on board. Those who had waited are on board before
    /// others.
    fn correct_passengers(&mut self, flight: usize, passengers: u16) {
        let LiveDecision { row, period, waited, .. } = self.decisions[flight];
        let pair = (row.from, row.to);
        if passengers == row.passengers {
            return;
        }
        self.put_back(flight);
        let demand = &mut self.known.demand;
        let waiting = match demand.waiting_in() {
            Some(now) if now == period => demand.waiting(pair.0, pair.1),
            // They have left by now, except for those who are on board.
            _ => waited.into(),
        };
        let waited = u16::try_from(waiting).map_or(passengers, |all| all.min(passengers));
        let decision = &mut self.decisions[flight];
        (decision.row.passengers, decision.waited) = (passengers, waited);
        for (period, passengers) in decision.parties() {
            let own = demand.own(period, pair.0, pair.1).saturating_sub(passengers.into());
            demand.set_own(period, pair.0, pair.1, own);
            self.boarded[demand.at(period, pair.0, pair.1)] += u32::from(passengers);
        }
        let scenario = Arc::clone(&self.known.scenario);
        let row = &mut self.decisions[flight].row;
        row.revenue_usd = f64::from(passengers) * scenario.fare_usd.in_period(period)[pair];
        row.passenger_cost_usd = f64::from(passengers) * scenario.passenger_cost_usd[pair];
        self.is_stale = true;
    }

    /// Sets when a flight lands, and with it when its aircraft is prepared and what that costs.
    fn set_arrival(&mut self, aircraft: AircraftIx, flight: usize, arrival: Time) {
        let row = &mut self.decisions[flight].row;
        let charge_s = row.ready.since(row.arrival);
        (row.arrival, row.ready) = (arrival, arrival + charge_s);
        let scenario = &self.known.scenario;
        row.energy_cost_usd =
            row.energy_kwh * scenario.energy_price_usd[scenario.period_at(arrival)];
        let prepared = row.ready;
        self.known.arrival[aircraft.at()] = arrival;
        self.set_prepared(aircraft, prepared);
        self.is_stale = true;
    }

    pub(super) fn land(
        &mut self,
        aircraft: AircraftIx,
        time: Time,
        (at, charge_kwh): (Option<VertiportIx>, Option<f64>),
        notices: &mut Vec<Notice>,
    ) -> Result<(), ReportError> {
        let state = self.state(aircraft)?;
        if let Some(at) = at {
            self.check_vertiport(at)?;
        }
        let expected_at = self.known.place[aircraft.at()];
        let at = at.unwrap_or(expected_at);
        let charged_too_high = self.charged_too_high(aircraft, time, at, charge_kwh);
        match state.phase {
            Phase::Standing if at == expected_at => {
                return Err(self.wrong_place(aircraft, "land"));
            }
            Phase::Standing => {
                notices.push(Notice::NotFlown {
                    aircraft: self.id(aircraft),
                    at: self.vertiport_id(at),
                });
                self.keep_charge(aircraft, time);
                self.move_to(aircraft, at);
                self.known.arrival[aircraft.at()] = time;
                self.set_prepared(aircraft, state.prepared.max(time));
            }
            Phase::SentOff { flight, .. } | Phase::InTheAir { flight, .. } => {
                self.end_flight(aircraft, flight, time, at, notices);
            }
        }
        let state = &mut self.aircraft[aircraft.at()];
        (state.phase, state.undoable) = (Phase::Standing, None);
        if at != expected_at {
            notices.extend(self.more_than_stands(at));
        }
        notices.extend(charged_too_high);
        Ok(())
    }

    /// Lets a flight end at a vertiport.
    fn end_flight(
        &mut self,
        aircraft: AircraftIx,
        flight: usize,
        time: Time,
        at: VertiportIx,
        notices: &mut Vec<Notice>,
    ) {
        let departed = matches!(self.aircraft[aircraft.at()].phase, Phase::InTheAir { .. });
        let expected_at = self.known.place[aircraft.at()];
        let latest_takeoff = self.latest_takeoff(aircraft, time, at);
        let too_fast = self.landed_too_soon(aircraft, time, at);
        // The report of a departure came with the notice of the planned flight. Without one, a
        // flight that is too fast even from its decision on is not a matter of energy.
        let is_energy_open = if departed { at != expected_at } else { too_fast.is_none() };
        notices.extend(too_fast);
        if at != expected_at {
            notices.push(Notice::Diverted {
                aircraft: self.id(aircraft),
                at: self.vertiport_id(at),
                to: self.vertiport_id(expected_at),
            });
            self.divert(aircraft, flight, at);
        }
        if let Some((_, takeoff)) = latest_takeoff
            && is_energy_open
            && at != self.decisions[flight].row.from
        {
            notices.extend(self.lacks_energy_for(flight, at, takeoff));
        }
        if self.decisions[flight].row.arrival != time {
            self.set_arrival(aircraft, flight, time);
        }
    }

    fn move_to(&mut self, aircraft: AircraftIx, at: VertiportIx) {
        self.known.stands.leave(aircraft, self.known.place[aircraft.at()]);
        self.known.stands.take(aircraft, at, false);
        self.known.place[aircraft.at()] = at;
        self.plug_in(aircraft);
    }

    /// Lets a flight end at another vertiport. It takes the energy of the flight there, or what it
    /// was to take if it came back; everything else of its account stays.
    fn divert(&mut self, aircraft: AircraftIx, flight: usize, at: VertiportIx) {
        self.move_to(aircraft, at);
        let LiveDecision { row, .. } = self.decisions[flight];
        if at != row.from {
            let kind = self.scenario().aircraft[aircraft.at()].kind;
            let leg = *self.known.legs.leg(kind, row.from, at);
            let row = &mut self.decisions[flight].row;
            row.energy_kwh = leg.energy_kwh;
            row.ready = row.arrival + leg.ground_s;
            let (Phase::SentOff { departs: takeoff, .. }
            | Phase::InTheAir { departed: takeoff, .. }) = self.aircraft[aircraft.at()].phase
            else {
                unreachable!("a flight is diverted while it is on its way");
            };
            self.set_takeoff(flight, takeoff);
        }
        self.set_arrival(aircraft, flight, row.arrival);
    }

    pub(super) fn charge(
        &mut self,
        aircraft: AircraftIx,
        ready: Time,
        report: &'static str,
        notices: &mut Vec<Notice>,
    ) -> Result<(), ReportError> {
        if self.state(aircraft)?.phase != Phase::Standing {
            return Err(self.wrong_place(aircraft, report));
        }
        notices.extend(self.ready_too_soon(aircraft, ready));
        self.set_prepared(aircraft, ready);
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

    pub(super) fn delay(
        &mut self,
        aircraft: AircraftIx,
        until: Time,
        notices: &mut Vec<Notice>,
    ) -> Result<(), ReportError> {
        match self.state(aircraft)?.phase {
            Phase::Standing => self.charge(aircraft, until, "be delayed", notices)?,
            Phase::SentOff { flight, departs } => {
                notices.extend(self.lacks_energy(flight, until));
                self.note_delay(flight, until);
                let flight_s = self.decisions[flight].row.arrival.since(departs);
                self.aircraft[aircraft.at()].phase = Phase::SentOff { flight, departs: until };
                self.set_takeoff(flight, until);
                self.set_arrival(aircraft, flight, until + flight_s);
            }
            Phase::InTheAir { flight, .. } => {
                let at = self.known.place[aircraft.at()];
                notices.extend(self.landed_too_soon(aircraft, until, at));
                self.set_arrival(aircraft, flight, until);
            }
        }
        Ok(())
    }

    /// Takes note of how late a flight departs, by which others are expected to.
    fn note_delay(&mut self, flight: usize, departs: Time) {
        let TraceRow { time, from, takeoff, .. } = self.decisions[flight].row;
        let vertiports = self.scenario().vertiports.len();
        self.known.delays.note(time, from, departs.since(takeoff), vertiports);
    }
}
