//! A schedule: the flights of each aircraft. Holds, passengers on board and stands taken follow
//! from them.

use vertifleet_core::{AircraftIx, VertiportIx};

use super::chargers::{Stay, WaitingStands};
use super::day::Day;
use super::hop::Landing;
use super::passengers::{Departure, Passengers};
use super::problem::Problem;
use super::stand_times::{Moment, StandTimes};

/// One flight of an aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Flight {
    /// The second of its decision, at which the aircraft takes off unless it waits for charge.
    pub(super) take_off_s: u32,
    pub(super) from: VertiportIx,
    pub(super) to: VertiportIx,
    pub(super) landing: Landing,
}

/// The flights of one aircraft. An itinerary is *whole* once it reaches the end of the plan. Before
/// that its aircraft vanishes when it is ready after its last flight, and its stand is free from
/// then on.
#[derive(Debug, Clone)]
pub(super) struct Itinerary {
    place: VertiportIx,
    start: Landing,
    pub(super) flights: Vec<Flight>,
    whole: bool,
}

/// The flights of the fleet, with the stands that they take, the demand that they leave and their
/// profit.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    itineraries: Vec<Itinerary>,
    pub(super) stands: StandTimes,
    /// The stands of vertiports with chargers. For these, `stands` has the chargers.
    pub(super) waiting_stands: Option<WaitingStands>,
    pub(super) passengers: Passengers,
    value_usd: f64,
}

impl Schedule {
    /// A schedule without flights, in which every itinerary has to be completed.
    pub(super) fn unplanned(problem: &Problem) -> Self {
        let Problem { day, places, demand, .. } = problem;
        let mut stands = StandTimes::empty(&day.stands);
        let mut itineraries = Vec::with_capacity(places.len());
        for (aircraft, &place) in day.fleet().zip(places) {
            stands.take_at_first(place);
            let start = day.start(aircraft);
            // An aircraft that never decides stays where it is.
            let whole = start.ready_s > day.end_s;
            if !whole {
                stands.free(place, Moment::of(start.ready_s, aircraft));
            }
            itineraries.push(Itinerary { place, start, flights: Vec::new(), whole });
        }
        let mut schedule = Self {
            itineraries,
            stands,
            waiting_stands: WaitingStands::of(day),
            passengers: Passengers::of(day, demand),
            value_usd: 0.0 - day.fixed_cost_usd,
        };
        schedule.count_chargers(day);
        schedule
    }

    /// Profit of the schedule, dollars.
    #[inline]
    pub(super) fn value_usd(&self) -> f64 {
        self.value_usd
    }

    #[inline]
    pub(super) fn flights(&self, aircraft: AircraftIx) -> &[Flight] {
        &self.itineraries[aircraft.at()].flights
    }

    /// Whether the aircraft's itinerary reaches the end of the plan.
    #[inline]
    pub(super) fn is_whole(&self, aircraft: AircraftIx) -> bool {
        self.itineraries[aircraft.at()].whole
    }

    /// The vertiport of the aircraft after its last flight, and its landing there.
    pub(super) fn open_end(&self, aircraft: AircraftIx) -> (VertiportIx, Landing) {
        let itinerary = &self.itineraries[aircraft.at()];
        let last = itinerary.flights.last();
        last.map_or((itinerary.place, itinerary.start), |last| (last.to, last.landing))
    }

    /// Removes the flights from the one at `first` on from a whole itinerary, and appends them to
    /// `taken_out`.
    pub(super) fn cut(
        &mut self,
        problem: &Problem,
        aircraft: AircraftIx,
        first: usize,
        taken_out: &mut Vec<Flight>,
    ) {
        debug_assert!(self.is_whole(aircraft), "an itinerary is cut once");
        let day = &problem.day;
        let begin = taken_out.len();
        taken_out.extend_from_slice(&self.flights(aircraft)[first..]);
        for &flight in &taken_out[begin..] {
            let moment = Moment::of(flight.take_off_s, aircraft);
            self.stands.take_back(flight.from, moment);
            self.stands.take_back(flight.to, moment);
            self.value_usd += self.enter_account(day, aircraft, flight, -1);
        }
        self.itineraries[aircraft.at()].flights.truncate(first);
        let (place, Landing { ready_s, .. }) = self.open_end(aircraft);
        if ready_s <= day.end_s {
            self.stands.free(place, Moment::of(ready_s, aircraft));
            self.itineraries[aircraft.at()].whole = false;
        }
        self.count_chargers(day);
    }

    /// Appends flights to an itinerary that is not whole, which makes it whole.
    pub(super) fn complete(&mut self, problem: &Problem, aircraft: AircraftIx, flights: &[Flight]) {
        self.append(&problem.day, aircraft, flights);
        self.count_chargers(&problem.day);
    }

    /// A schedule with these flights of each aircraft, which make every itinerary whole.
    pub(super) fn of(problem: &Problem, flights: &[Vec<Flight>]) -> Self {
        let mut schedule = Self::unplanned(problem);
        for (aircraft, flights) in problem.day.fleet().zip(flights) {
            schedule.append(&problem.day, aircraft, flights);
        }
        schedule.count_chargers(&problem.day);
        schedule
    }

    fn append(&mut self, day: &Day, aircraft: AircraftIx, flights: &[Flight]) {
        if self.is_whole(aircraft) {
            debug_assert!(flights.is_empty(), "a whole itinerary takes no more flights");
            return;
        }
        let (place, Landing { ready_s, .. }) = self.open_end(aircraft);
        self.stands.take_back(place, Moment::of(ready_s, aircraft));
        for &flight in flights {
            let moment = Moment::of(flight.take_off_s, aircraft);
            self.stands.free(flight.from, moment);
            self.stands.take(flight.to, moment);
            self.value_usd += self.enter_account(day, aircraft, flight, 1);
        }
        let itinerary = &mut self.itineraries[aircraft.at()];
        itinerary.flights.extend_from_slice(flights);
        itinerary.whole = true;
    }

    /// A vertiport that has more aircraft than chargers at some moment, if there is one.
    pub(super) fn overfull(&self) -> Option<VertiportIx> {
        self.waiting_stands.as_ref().and_then(|waiting| waiting.overfull)
    }

    /// Counts the places of vertiports with chargers again.
    fn count_chargers(&mut self, day: &Day) {
        let Some(mut waiting) = self.waiting_stands.take() else { return };
        let stays: Vec<Stay> = day.fleet().flat_map(|aircraft| self.stays(day, aircraft)).collect();
        waiting.count(day, &stays, &mut self.stands);
        self.waiting_stands = Some(waiting);
    }

    /// The stays of an aircraft. If its itinerary is not whole, it leaves the last one when it is
    /// ready.
    fn stays(&self, day: &Day, aircraft: AircraftIx) -> Vec<Stay> {
        let Itinerary { place, start, flights, whole } = &self.itineraries[aircraft.at()];
        let (comes, leaves) = (Moment::FIRST, Moment::NEVER);
        let full_s = |at: VertiportIx, landing: Landing| {
            let batteries = day.batteries.as_ref();
            let kind = day.kind(aircraft);
            batteries.map_or(0, |batteries| batteries.full_s(kind, at, landing.arrival))
        };
        let (ready_s, full) = (start.ready_s, full_s(*place, *start));
        let first = Stay { aircraft, at: *place, comes, ready_s, full_s: full, leaves };
        let mut stays = vec![first];
        for flight in flights {
            let moment = Moment::of(flight.take_off_s, aircraft);
            if let Some(last) = stays.last_mut() {
                last.leaves = moment;
            }
            let (at, ready_s) = (flight.to, flight.landing.ready_s);
            let full_s = full_s(at, flight.landing);
            stays.push(Stay { aircraft, at, comes: moment, ready_s, full_s, leaves });
        }
        if let Some(last) = stays.last_mut().filter(|_| !whole) {
            last.leaves = Moment::of(last.ready_s, aircraft);
        }
        stays
    }

    /// Adds a flight to the account (`sign` 1) or removes it (-1). Returns by how much the profit
    /// grows, dollars.
    fn enter_account(&mut self, day: &Day, aircraft: AircraftIx, flight: Flight, sign: i64) -> f64 {
        let hop = day.hop(day.kind(aircraft), flight.from, flight.to);
        let period = day.period_from(0, flight.take_off_s);
        let cell = day.cell(period, flight.from, flight.to);
        let departure = Departure { cell, period, take_off_s: flight.take_off_s };
        let margin_usd = self.passengers.add(day, departure, sign * day.seats(aircraft));
        let cost_usd = day.flying_cost_usd(hop, period, flight.landing.arrival.second);
        margin_usd - sign as f64 * cost_usd
    }

    /// Sets the profit to an earlier amount, so that undoing a change leaves no rounding error
    /// behind.
    pub(super) fn set_value_usd(&mut self, value_usd: f64) {
        self.value_usd = value_usd;
    }
}
