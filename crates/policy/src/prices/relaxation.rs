//! The decisions of the fleet at given prices: every aircraft takes the way through the rest of the
//! day that is worth most to it.
//!
//! One pass from the end of the day back to now computes the worth of being ready anywhere at any
//! time (`values.rs`). A second pass, forwards, follows each aircraft along its best way and counts
//! the stands and passengers that it asks for.

use vertifleet_core::{Time, TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::charged_flights::ChargedFlights;
use super::clock::{Clock, SLOT_S};
use super::fleet::{Fleet, Ready};
use super::hops::{Hops, ready_after_hold};
use super::levels::{Level, Levels, ReadyAt};
use super::ranks::Ranks;
use super::seats::Seats;
use super::values::{HOLD, ValueTable};
use super::wanted::Wanted;

/// Number of groups of aircraft that are followed side by side, so that one does not wait for the
/// memory that another looks at.
const SIDE_BY_SIDE: usize = 4;

/// Where a group of aircraft that are alike is on its way.
#[derive(Debug, Clone, Copy)]
struct Way {
    kind: TypeIx,
    place: VertiportIx,
    time_s: u32,
    level: Level,
    slot: usize,
    count: u32,
}

/// The rest of a day with prices, and what the fleet asks for at them.
#[derive(Debug, Clone)]
pub(super) struct Relaxation {
    clock: Clock,
    levels: Levels,
    charged_flights: ChargedFlights,
    hops: Hops,
    vertiports: usize,
    /// By type, vertiport, then level: when a hold ends, seconds from its decision.
    holds: Vec<ReadyAt>,
    stands: Vec<f64>,
    seats_a_flight: Option<u32>,
    /// The seats that the remaining passengers ask for, by period, then pair.
    pub(super) seats: Vec<Seats>,
    /// The pairs whose price or mean excess is not at rest.
    pub(super) wanted: Wanted,
    fleet: Fleet,
    /// The current slot, and its period.
    first_slot: usize,
    first_period: usize,
    /// Prices in dollars: of a stand by slot, then vertiport, and of a passenger by period, then
    /// pair.
    pub(super) stand_usd: Vec<f64>,
    pub(super) passenger_usd: Vec<f64>,
    /// The number asked for less the number available, in the same order.
    pub(super) stand_excess: Vec<f64>,
    pub(super) passenger_excess: Vec<f64>,
    values: ValueTable,
    /// The values of the pass that is [kept](Self::keep), and the number of decisions that the
    /// fleet takes in it.
    kept_values: ValueTable,
    kept_decisions: u32,
    /// Number of decisions that the fleet takes on its best ways.
    decisions: u32,
}

impl Relaxation {
    /// The day of a view, with prices of zero.
    pub(super) fn of(view: View<'_>) -> Self {
        let clock = Clock::of(view);
        let vertiports = view.vertiports();
        let cells = clock.slots * vertiports;
        let pairs = view.period_starts().len() * vertiports * vertiports;
        let stands = VertiportIx::all(vertiports).map(|at| f64::from(view.stands(at)));
        let levels = Levels::of(view);
        let hops = Hops::of(view, &clock, &levels, ValueTable::stride(&clock));
        let values = ValueTable::of(view, &clock, &levels);
        Self {
            hops,
            vertiports,
            holds: holds(view, &levels),
            charged_flights: ChargedFlights::of(view),
            levels,
            stands: stands.collect(),
            seats_a_flight: seats_a_flight(view),
            seats: vec![Seats::default(); pairs],
            wanted: Wanted::none_of(pairs),
            fleet: Fleet::default(),
            first_slot: 0,
            first_period: 0,
            stand_usd: vec![0.0; cells],
            passenger_usd: vec![0.0; pairs],
            stand_excess: vec![0.0; cells],
            passenger_excess: vec![0.0; pairs],
            kept_values: values.clone(),
            values,
            kept_decisions: 0,
            decisions: 0,
            clock,
        }
    }

    /// Takes the current fleet and demand from a view.
    pub(super) fn load(&mut self, view: View<'_>) {
        self.fleet.load(view, &self.levels);
        let now_s = self.fleet.first_ready_s().unwrap_or(self.clock.start_s);
        self.first_slot = self.clock.slot(now_s).min(self.clock.slots - 1);
        self.first_period = view.period();
        let (_, passenger) = self.begins();
        self.wanted.retain(|cell| cell >= passenger);
        for period in view.period()..view.period_starts().len() {
            for from in VertiportIx::all(self.vertiports) {
                self.count_seats(view, period, from);
            }
        }
        self.hops.load(view);
        self.hops.charge_all(self.first_period, &self.passenger_usd);
    }

    /// Counts what passengers from a vertiport ask for in a period.
    fn count_seats(&mut self, view: View<'_>, period: usize, from: VertiportIx) {
        let first = (period * self.vertiports + from.at()) * self.vertiports;
        let (fares_usd, costs_usd) = (view.fares_usd(period, from), view.passenger_costs_usd(from));
        for to in VertiportIx::all(self.vertiports) {
            let margin_usd = fares_usd[to.at()] - costs_usd[to.at()];
            let passengers = view.demand_left(period, from, to);
            let seats = Seats::of(passengers, self.seats_a_flight, margin_usd);
            self.seats[first + to.at()] = seats;
            self.passenger_excess[first + to.at()] = -seats.of_full_flights;
        }
    }

    /// The destinations of decisions from one time to another, by the values that are
    /// [kept](Self::keep).
    pub(super) fn ranks(&self, view: View<'_>, times: (Time, Time)) -> Ranks {
        Ranks::of(view, &self.clock, &self.kept_values, self.charging(), times)
    }

    /// The first positions in `stand_usd` and in `passenger_usd` whose prices still matter.
    pub(super) fn begins(&self) -> (usize, usize) {
        let pairs = self.vertiports * self.vertiports;
        (self.first_slot * self.vertiports, self.first_period * pairs)
    }

    /// Number of hops that a pass looks at, in all slots from now on.
    pub(super) fn hops_a_pass(&self) -> usize {
        self.hops.len() * (self.clock.slots - self.first_slot)
    }

    /// Evaluates the Lagrangian dual at the prices: the profit of the fleet after payments, plus
    /// the price of all stands and the surplus of all passengers, dollars. Also computes the
    /// excess.
    pub(super) fn evaluate(&mut self) -> f64 {
        self.charge();
        self.values.pay(&self.stand_usd, self.first_slot);
        self.values.value(&self.hops, self.first_slot);
        self.offer_usd() + self.send_fleet()
    }

    /// Deducts the prices of passengers from flights. Where no flight has asked for any, their
    /// price is still zero.
    pub(super) fn charge(&mut self) {
        let pairs = self.vertiports * self.vertiports;
        let mut period = self.first_period;
        for cell in self.wanted.all() {
            while cell >= (period + 1) * pairs {
                period += 1;
            }
            self.hops.charge(period, cell - period * pairs, self.passenger_usd[cell]);
        }
    }

    /// Keeps the worth of everything at the prices of the latest [`evaluate`](Self::evaluate), for
    /// [`kept_values`](Self::kept_values).
    pub(super) fn keep(&mut self) {
        std::mem::swap(&mut self.values, &mut self.kept_values);
        self.kept_decisions = self.decisions;
    }

    /// Sets the excess of passengers to minus the seats that they ask for, as if no aircraft took
    /// any, and that of stands to zero. Returns the price of all stands and the surplus of all
    /// passengers, dollars.
    fn offer_usd(&mut self) -> f64 {
        let (stand, _) = self.begins();
        let mut usd = 0.0;
        self.stand_excess[stand..].fill(0.0);
        for prices in self.stand_usd[stand..].chunks_exact(self.vertiports) {
            for (price_usd, stands) in prices.iter().zip(&self.stands) {
                usd += price_usd * stands;
            }
        }
        for cell in self.wanted.all() {
            let (seats, price_usd) = (self.seats[cell], self.passenger_usd[cell]);
            self.passenger_excess[cell] = -seats.at(price_usd);
            usd += seats.surplus_usd(price_usd);
        }
        usd
    }

    /// Sends every aircraft along its best way and counts what it asks for. Returns the worth of
    /// these ways, dollars.
    fn send_fleet(&mut self) -> f64 {
        let mut usd = 0.0;
        // No rent has been paid when the first slot begins.
        let begin_s = self.clock.begin_s(self.first_slot);
        for ready in self.fleet.all() {
            let Ready { kind, place, at_s: time_s, level } = *ready;
            usd += self.values.at_level_usd(kind, place, begin_s, ReadyAt { level, time_s });
        }
        self.decisions = 0;
        self.wanted.begin_pass();
        for first in (0..self.fleet.groups().len()).step_by(SIDE_BY_SIDE) {
            self.send(first);
        }
        self.wanted.settle();
        self.count_stands();
        usd
    }

    /// Sends some groups of aircraft along their best ways, from group `first` on.
    fn send(&mut self, first: usize) {
        let mut ways: [Option<Way>; SIDE_BY_SIDE] = std::array::from_fn(|number| {
            let (ready, count) = *self.fleet.groups().get(first + number)?;
            let Ready { kind, place, at_s: time_s, level } = ready;
            Some(Way { kind, place, time_s, level, slot: self.clock.slot(time_s), count })
        });
        for way in ways.iter().flatten() {
            self.ask(way.count, way.place, self.first_slot, way.slot);
        }
        let mut go_on = true;
        while go_on {
            go_on = false;
            for way in ways.iter_mut().flatten() {
                if way.time_s <= self.clock.end_s {
                    self.follow(way);
                    go_on = true;
                }
            }
        }
        for way in ways.iter().flatten() {
            self.ask(way.count, way.place, way.slot, self.clock.slots);
        }
    }

    /// Takes the next decision on a way.
    #[inline]
    fn follow(&mut self, way: &mut Way) {
        let Way { kind, place, time_s, level, slot, count } = *way;
        self.decisions += count;
        // The best choice is taken from the nearest boundary.
        let near = ((time_s - self.clock.start_s + SLOT_S / 2) / SLOT_S) as usize;
        let best = self.values.best(kind, place, level, near.min(self.clock.slots - 1));
        if best == HOLD {
            let at = kind.at() * self.vertiports + place.at();
            let hold = self.holds[at * self.levels.count + usize::from(level)];
            (way.time_s, way.level) = (time_s + hold.time_s, hold.level);
        } else {
            let pair = place.at() * self.vertiports + usize::from(best);
            let flight = self.hops.flight(kind, pair, level);
            let interval = self.hops.intervals.of_slot[slot];
            let passengers = self.hops.passengers(interval, flight.hop as usize);
            let period = self.hops.intervals.all[interval].period;
            let cell = period * self.vertiports * self.vertiports + pair;
            if passengers > 0.0 && period >= self.first_period {
                self.passenger_excess[cell] += f64::from(count) * passengers;
                self.wanted.add(cell);
            }
            way.place = VertiportIx(best);
            (way.time_s, way.level) = (time_s + flight.block_s, flight.level);
        }
        way.slot = self.clock.slot(way.time_s);
        self.ask(count, way.place, slot, way.slot);
    }

    /// Records that a number of stands are asked for from one slot until another: the number is
    /// added from the first on, and subtracted from the second on.
    #[inline]
    fn ask(&mut self, count: u32, place: VertiportIx, from: usize, until: usize) {
        let number = f64::from(count);
        for (slot, more) in [(from, number), (until, -number)] {
            // Prices end with the last slot.
            if let Some(excess) = self.stand_excess.get_mut(slot * self.vertiports + place.at()) {
                *excess += more;
            }
        }
    }

    /// Turns the recorded changes into the number of stands asked for in each slot less the number
    /// available.
    fn count_stands(&mut self) {
        let first = self.first_slot * self.vertiports;
        let (mut before, mut rest) = self.stand_excess[first..].split_at_mut(self.vertiports);
        for (excess, stands) in before.iter_mut().zip(&self.stands) {
            *excess -= stands;
        }
        while !rest.is_empty() {
            let (row, later) = rest.split_at_mut(self.vertiports);
            for (excess, before) in row.iter_mut().zip(&*before) {
                *excess += before;
            }
            (before, rest) = (row, later);
        }
    }

    /// Number of decisions that the fleet takes on its best ways at the prices of the pass that is
    /// kept.
    pub(super) fn kept_decisions(&self) -> u32 {
        self.kept_decisions
    }

    /// The levels of charge, and what flights do to it.
    pub(super) fn charging(&self) -> (&Levels, &ChargedFlights) {
        (&self.levels, &self.charged_flights)
    }

    /// The worth of being ready, and the price of stands, anywhere at any time, at the prices of
    /// the pass that is kept.
    #[inline]
    pub(super) fn kept_values(&self) -> &ValueTable {
        &self.kept_values
    }

    #[inline]
    pub(super) fn passenger_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.passenger_usd[(period * self.vertiports + from.at()) * self.vertiports + to.at()]
    }
}

/// When the hold of each type at each vertiport and level of charge ends.
fn holds(view: View<'_>, levels: &Levels) -> Vec<ReadyAt> {
    let mut holds = Vec::new();
    for kind in TypeIx::all(view.aircraft_types().len()) {
        for at in VertiportIx::all(view.vertiports()) {
            let ends = (0..).take(levels.count);
            holds.extend(ends.map(|level| ready_after_hold(view, levels, (kind, at), level)));
        }
    }
    holds
}

/// The number of seats of all aircraft types; `None` if there are several.
fn seats_a_flight(view: View<'_>) -> Option<u32> {
    let (first, others) = view.aircraft_types().split_first()?;
    others.iter().all(|kind| kind.seats == first.seats).then_some(first.seats.into())
}
