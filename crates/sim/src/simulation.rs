//! The simulation of one day: it asks for decisions in their order and carries them out.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, Charging, Scenario, Time, VertiportIx, whole_mwh};

use crate::batteries::Batteries;
use crate::closures::Closures;
use crate::delays::Delays;
use crate::demand::Demand;
use crate::legs::refill_s;
use crate::outages::Outages;
use crate::queue::ReadyQueue;
use crate::room::clone_into_room;
use crate::stands::Stands;
use crate::{DayTotals, Ledger, Legs, Refusal, Shortfall, TraceRow, VertiportSet, View};

/// An aircraft that is ready for take-off and needs a vertiport to fly to. Its own vertiport means
/// *hold*.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decision {
    /// The time of the decision, which is now.
    pub time: Time,
    /// The aircraft that decides.
    pub aircraft: AircraftIx,
    /// The vertiport where it stands.
    pub at: VertiportIx,
    /// The number of decisions taken before this one today.
    pub index: u32,
}

/// When each aircraft decides first: at the start of operations, or where days charge to full, once
/// its battery is.
fn first_decisions(scenario: &Scenario) -> ReadyQueue {
    let start = scenario.operations.start;
    let mut queue = ReadyQueue::new(scenario.aircraft.len(), start);
    for aircraft in AircraftIx::all(scenario.aircraft.len()) {
        queue.set(aircraft, first_decision(scenario, aircraft));
    }
    queue
}

/// The time at which an aircraft decides first on its day.
pub fn first_decision(scenario: &Scenario, aircraft: AircraftIx) -> Time {
    let start = scenario.operations.start;
    let aircraft = &scenario.aircraft[aircraft.at()];
    let kind = &scenario.aircraft_types[aircraft.kind.at()];
    match (scenario.operations.charging, aircraft.start_charge_kwh) {
        (Charging::ToFull, Some(kwh)) => {
            start + refill_s(kind.battery_kwh - kwh, kind, &scenario.vertiports[aircraft.at.at()])
        }
        _ => start,
    }
}

/// Later than any time of a day.
const NEVER: Time = Time::from_seconds(u32::MAX);

/// A day that is being flown. The same scenario with the same decisions gives the same day, bit for
/// bit.
#[derive(Debug)]
pub struct Simulation {
    pub(crate) scenario: Arc<Scenario>,
    /// Shared by all imagined days.
    pub(crate) legs: Arc<Legs>,
    pub(crate) stands: Stands,
    pub(crate) demand: Demand,
    pub(crate) queue: ReadyQueue,
    /// The vertiport where each aircraft stands or will land.
    pub(crate) place: Vec<VertiportIx>,
    /// The time at which each aircraft landed there or will land, or the start of operations.
    pub(crate) arrival: Vec<Time>,
    pub(crate) batteries: Batteries,
    pub(crate) ledger: Ledger,
    pub(crate) closures: Closures,
    outages: Outages,
    pub(crate) delays: Delays,
    /// Whether anything unexpected may still happen. Always false on an imagined day, where unknown
    /// closures stay as they are and outages are already contained in `queue`.
    surprises: bool,
    /// Whether anything may happen without a decision: a surprise, or a known closure, which
    /// imagined days have too.
    pub(crate) eventful: bool,
    /// Time of the latest decision asked for, or the start of operations before the first. Not
    /// updated without surprises.
    now: Time,
    /// Demand period of the latest decision asked for. Time never runs back.
    pub(crate) period: usize,
    /// When the next period begins, or those leave who have waited since the one before, if that is
    /// earlier.
    pub(crate) next_change: Time,
    pub(crate) potential_usd: f64,
}

clone_into_room!(Simulation {
    scenario,
    legs,
    stands,
    demand,
    queue,
    place,
    arrival,
    batteries,
    ledger,
    closures,
    outages,
    delays,
    surprises,
    eventful,
    now,
    period,
    next_change,
    potential_usd,
});

impl Simulation {
    /// The day before its first decision.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let legs = Arc::new(Legs::of(&scenario));
        Self {
            stands: Stands::at_start(&scenario),
            demand: Demand::of(&scenario),
            queue: first_decisions(&scenario),
            place: scenario.aircraft.iter().map(|aircraft| aircraft.at).collect(),
            arrival: vec![scenario.operations.start; scenario.aircraft.len()],
            batteries: Batteries::at_start(&scenario, &legs),
            legs,
            ledger: Ledger::at_start(&scenario),
            closures: Closures::of(&scenario),
            outages: Outages::of(&scenario),
            delays: Delays::before(&scenario),
            surprises: !scenario.disturbances.is_none(),
            eventful: !scenario.disturbances.is_none(),
            now: scenario.operations.start,
            period: 0,
            next_change: scenario.periods.get(1).copied().unwrap_or(NEVER),
            potential_usd: scenario.potential_usd(),
            scenario,
        }
    }

    /// The decision to be taken now, or `None` once no aircraft has one left. Calling it again
    /// changes nothing.
    #[inline]
    pub fn next_decision(&mut self) -> Option<Decision> {
        let (aircraft, time) = self.queue.earliest();
        if time > self.scenario.operations.end {
            return None;
        }
        self.advance_to(time);
        Some(Decision {
            time,
            aircraft,
            at: self.place[aircraft.at()],
            index: self.ledger.decisions(),
        })
    }

    /// Advances to a time, which is not before the latest one.
    #[inline]
    pub(crate) fn advance_to(&mut self, time: Time) {
        if self.next_change <= time {
            self.change_demand(time);
        }
        if self.eventful {
            self.discover(time);
        }
    }

    /// Goes through the demand periods that begin up to and at `time`. The actual demand of each is
    /// known from then on. Those who are left of the period before it wait, and leave before the
    /// next one begins.
    #[cold]
    fn change_demand(&mut self, time: Time) {
        while self.next_change <= time {
            if !self.demand.leave() {
                self.period += 1;
                if self.surprises {
                    self.demand.reveal(self.period, &self.scenario.demand[self.period]);
                }
                self.demand.wait_in(self.period);
            }
            let next_period = self.scenario.periods.get(self.period + 1).copied();
            self.next_change = match self.demand.waiting_in() {
                Some(period) => {
                    self.scenario.periods[period] + self.scenario.operations.passenger_wait_s
                }
                None => next_period.unwrap_or(NEVER),
            };
        }
    }

    /// Reveals which routes have closed or opened up to and at `time`.
    #[cold]
    fn discover(&mut self, time: Time) {
        self.closures.advance(time);
        if self.surprises {
            self.now = time;
        }
    }

    /// Sends the aircraft that decides now to `choice`, where its own vertiport means hold. Returns
    /// what came of it.
    ///
    /// # Errors
    /// [`Refusal`] names the rule that the choice breaks. Nothing has changed then.
    #[inline]
    pub fn apply(&mut self, choice: VertiportIx) -> Result<TraceRow, Refusal> {
        let decision = self.next_decision().ok_or(Refusal::DayOver)?;
        self.carry_out(&decision, choice)
    }

    /// Carries a decision out, or refuses the choice.
    #[inline]
    pub(crate) fn carry_out(
        &mut self,
        decision: &Decision,
        choice: VertiportIx,
    ) -> Result<TraceRow, Refusal> {
        if choice == decision.at {
            return Ok(self.hold(decision));
        }
        let kind = self.scenario.aircraft[decision.aircraft.at()].kind;
        if self.legs.within_range(kind, decision.at).contains(choice)
            && self.stands.open().contains(choice)
            && (self.closures.is_empty() || !self.closures.from(decision.at).contains(choice))
            && (self.batteries.are_always_full() || self.takes_off_in_time(decision, choice))
        {
            return Ok(self.fly(decision, choice));
        }
        Err(self.refusal(decision, choice))
    }

    /// The rule that a choice outside the mask breaks.
    #[cold]
    pub(crate) fn refusal(&self, decision: &Decision, choice: VertiportIx) -> Refusal {
        let vertiports = &self.scenario.vertiports;
        let Some(to) = vertiports.get(choice.at()) else {
            return Refusal::NoSuchVertiport { position: choice.0, vertiports: vertiports.len() };
        };
        let to = to.id.clone();
        let decides = &self.scenario.aircraft[decision.aircraft.at()];
        let aircraft = decides.id.clone();
        if !self.scenario.is_corridor(decision.at, choice) {
            Refusal::NoCorridor { aircraft, to }
        } else if !self.legs.within_range(decides.kind, decision.at).contains(choice) {
            let kind = &self.scenario.aircraft_types[decides.kind.at()];
            let leg = self.legs.leg(decides.kind, decision.at, choice);
            let shortfall = Shortfall {
                energy_mwh: whole_mwh(leg.energy_kwh),
                reserve_mwh: whole_mwh(kind.reserve_kwh),
                battery_mwh: whole_mwh(kind.battery_kwh),
            };
            Refusal::OutOfRange { aircraft, to, shortfall: Box::new(shortfall) }
        } else if self.closures.from(decision.at).contains(choice) {
            Refusal::Closed { aircraft, to }
        } else if !self.stands.open().contains(choice) {
            Refusal::NoStandFree { aircraft, to }
        } else {
            Refusal::ChargedTooLate { aircraft, to }
        }
    }

    #[inline]
    fn hold(&mut self, decision: &Decision) -> TraceRow {
        let ready = decision.time + self.scenario.operations.hold_s;
        self.queue.set(decision.aircraft, ready);
        let mut charge_kwh = 0.0;
        if self.batteries.are_always_full() {
            self.stands.hold(decision.aircraft, decision.at);
        } else {
            charge_kwh = self.hold_charging(decision);
        }
        if self.surprises {
            self.outages.hold(decision.aircraft, ready);
        }
        self.ledger.holds += 1;
        TraceRow {
            time: decision.time,
            aircraft: decision.aircraft,
            from: decision.at,
            to: decision.at,
            passengers: 0,
            revenue_usd: 0.0,
            passenger_cost_usd: 0.0,
            energy_kwh: 0.0,
            energy_cost_usd: 0.0,
            flight_cost_usd: 0.0,
            charge_kwh,
            takeoff: decision.time,
            arrival: decision.time,
            ready,
        }
    }

    /// Lets the aircraft fly, whether or not the choice is feasible.
    #[inline]
    pub(crate) fn fly(&mut self, decision: &Decision, to: VertiportIx) -> TraceRow {
        let Decision { time, aircraft, at: from, .. } = *decision;
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        let seats = self.scenario.aircraft_types[kind.at()].seats;
        let leg = *self.legs.leg(kind, from, to);
        let pair = (from, to);

        let passengers = self.demand.board(self.period, from, to, seats);
        let (mut takeoff, mut charge_kwh) = (time, 0.0);
        if !self.batteries.are_always_full() {
            (takeoff, charge_kwh) = self.takeoff_and_charge(decision, to);
        }
        let mut arrival = takeoff + leg.flight_s;
        let mut ready = arrival + leg.ground_s;
        if self.surprises {
            (arrival, ready) = self.disturbed(decision, arrival, ready);
        } else {
            let late_s = self.delays.expected_s(time, from);
            (arrival, ready) = (arrival + late_s, ready + late_s);
        }
        let row = TraceRow {
            time,
            aircraft,
            from,
            to,
            passengers,
            revenue_usd: f64::from(passengers)
                * self.scenario.fare_usd.in_period(self.period)[pair],
            passenger_cost_usd: f64::from(passengers) * self.scenario.passenger_cost_usd[pair],
            energy_kwh: leg.energy_kwh,
            energy_cost_usd: leg.energy_kwh * self.energy_price_at(arrival),
            flight_cost_usd: self.scenario.flight_cost_usd[pair],
            charge_kwh,
            takeoff,
            arrival,
            ready,
        };
        if !self.batteries.are_always_full() {
            self.discharge(decision, to, arrival);
        }
        self.stands.transfer(aircraft, from, to);
        self.place[aircraft.at()] = to;
        self.arrival[aircraft.at()] = arrival;
        self.queue.set(aircraft, ready);
        self.ledger.enter_flight(&row, self.scenario.distance_mi[pair], seats);
        row
    }

    /// Arrival and ready times of a flight with its delay and outages, given the times without
    /// them.
    #[cold]
    fn disturbed(&mut self, decision: &Decision, arrival: Time, ready: Time) -> (Time, Time) {
        let Decision { time, aircraft, at: from, .. } = *decision;
        let start = self.scenario.operations.start;
        let table = self.scenario.disturbances.takeoff_delays.as_ref();
        let delay_s = table.map_or(0, |delays| delays.at(start, time, from));
        self.delays.note(time, from, delay_s, self.scenario.vertiports.len());
        let (arrival, ready) = (arrival + delay_s, ready + delay_s);
        if self.outages.is_empty() {
            return (arrival, ready);
        }
        (arrival, self.outages.land(aircraft, arrival, ready))
    }

    /// E in the period that contains `time`, which must not be before now; dollars per kWh.
    #[inline]
    pub(crate) fn energy_price_at(&self, time: Time) -> f64 {
        let later = &self.scenario.periods[self.period + 1..];
        let periods_on = later.iter().take_while(|&&start| start <= time).count();
        self.scenario.energy_price_usd[self.period + periods_on]
    }

    /// The vertiports that the deciding aircraft may choose: its own, and every other within range
    /// that has a free stand and to which the route is not closed.
    #[inline]
    pub(crate) fn feasible(&self, decision: &Decision) -> VertiportSet {
        let kind = self.scenario.aircraft[decision.aircraft.at()].kind;
        let mut mask = self.legs.within_range(kind, decision.at).and(self.stands.open());
        if !self.closures.is_empty() {
            mask = mask.without(&self.closures.from(decision.at));
        }
        if !self.batteries.are_always_full() {
            mask = self.charged_in_time(decision, mask);
        }
        mask.insert(decision.at);
        mask
    }

    /// The time at which an aircraft is expected to be ready, from what is known now.
    #[inline]
    pub(crate) fn expected_ready(&self, aircraft: AircraftIx) -> Time {
        if !self.surprises || self.outages.is_empty() {
            return self.queue.ready_at(aircraft);
        }
        self.outages.ready(aircraft, self.now)
    }

    /// Lets everything go as expected from now on.
    pub(crate) fn expect_no_surprises(&mut self) {
        if self.surprises && !self.outages.is_empty() {
            let (outages, now) = (&self.outages, self.now);
            self.queue.set_all(self.place.len(), |aircraft| outages.ready(aircraft, now));
        }
        self.surprises = false;
        self.closures.expect_no_surprises();
        self.eventful = !self.closures.known().is_empty();
    }

    /// The same day, going as expected from now on.
    pub(crate) fn without_surprises(mut self) -> Self {
        self.expect_no_surprises();
        self
    }

    /// The view of a policy.
    #[inline]
    pub fn view(&self) -> View<'_> {
        View::of(self)
    }

    /// The account so far.
    #[inline]
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// The day's numbers so far, which are final once the day is over.
    pub fn totals(&self) -> DayTotals {
        DayTotals::new(&self.ledger, self.potential_usd, self.demand.total())
    }

    /// The reward's denominator (§III.H), dollars.
    #[inline]
    pub fn potential_usd(&self) -> f64 {
        self.potential_usd
    }

    /// The scenario of the day.
    #[inline]
    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.scenario
    }

    pub(crate) fn legs(&self) -> &Legs {
        &self.legs
    }

    pub(crate) fn stands(&self) -> &Stands {
        &self.stands
    }

    pub(crate) fn demand(&self) -> &Demand {
        &self.demand
    }

    pub(crate) fn closures(&self) -> &Closures {
        &self.closures
    }

    pub(crate) fn places(&self) -> &[VertiportIx] {
        &self.place
    }

    pub(crate) fn arrival(&self, aircraft: AircraftIx) -> Time {
        self.arrival[aircraft.at()]
    }

    pub(crate) fn period(&self) -> usize {
        self.period
    }
}
