//! The decisions of the fleet at given prices: every aircraft takes the way through the rest of the day that is worth
//! most to it.
//!
//! One pass from the end of the day back to now computes the worth of being ready anywhere at any time (`values.rs`). A
//! second pass, forwards, follows each aircraft along its best way and counts the stands and passengers that it asks
//! for.

use vertifleet_core::{AircraftIx, TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::clock::{Clock, SLOT_S};
use super::hops::Hops;
use super::values::{HOLD, ValueTable};

/// An aircraft at its next decision.
#[derive(Debug, Clone, Copy)]
struct Ready {
    kind: TypeIx,
    place: VertiportIx,
    at_s: u32,
}

/// The rest of a day with prices, and what the fleet asks for at them.
#[derive(Debug, Clone)]
pub(super) struct Relaxation {
    clock: Clock,
    hops: Hops,
    vertiports: usize,
    hold_s: u32,
    stands: Vec<f64>,
    /// Passengers left, by period, then pair.
    demand: Vec<f64>,
    fleet: Vec<Ready>,
    /// The current slot, and its period.
    first_slot: usize,
    first_period: usize,
    /// Prices in dollars: of a stand by slot, then vertiport, and of a passenger by period, then pair.
    pub(super) stand_usd: Vec<f64>,
    pub(super) passenger_usd: Vec<f64>,
    /// The number asked for less the number available, in the same order.
    pub(super) stand_excess: Vec<f64>,
    pub(super) passenger_excess: Vec<f64>,
    values: ValueTable,
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
        Self {
            hops: Hops::of(view, &clock),
            vertiports,
            hold_s: view.hold_s(),
            stands: stands.collect(),
            demand: vec![0.0; pairs],
            fleet: Vec::with_capacity(view.places().len()),
            first_slot: 0,
            first_period: 0,
            stand_usd: vec![0.0; cells],
            passenger_usd: vec![0.0; pairs],
            stand_excess: vec![0.0; cells],
            passenger_excess: vec![0.0; pairs],
            values: ValueTable::of(view, &clock),
            decisions: 0,
            clock,
        }
    }

    /// Takes the current fleet and demand from a view.
    pub(super) fn load(&mut self, view: View<'_>) {
        let fleet = AircraftIx::all(view.places().len());
        let ready_s = |aircraft| view.ready_at(aircraft).seconds();
        let now_s = fleet.clone().map(ready_s).min().unwrap_or(self.clock.start_s);
        self.first_slot = self.clock.slot(now_s).min(self.clock.slots - 1);
        self.first_period = view.period();
        self.fleet.clear();
        self.fleet.extend(fleet.map(|aircraft| Ready {
            kind: view.kind(aircraft),
            place: view.places()[aircraft.at()],
            at_s: ready_s(aircraft),
        }));
        let pairs = self.vertiports * self.vertiports;
        for (period, left) in self.demand.chunks_exact_mut(pairs).enumerate().skip(view.period()) {
            for (left, &waiting) in left.iter_mut().zip(view.demand_left_in(period)) {
                *left = f64::from(waiting);
            }
        }
        self.hops.load(view);
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

    /// Evaluates the Lagrangian dual at the prices: the profit of the fleet after payments, plus the price of all
    /// stands and passengers available, dollars. Also computes the excess.
    pub(super) fn evaluate(&mut self) -> f64 {
        self.hops.charge(self.first_period, &self.passenger_usd);
        self.values.pay(&self.stand_usd, self.first_slot);
        self.values.value(&self.hops, self.first_slot);
        self.offer_usd() + self.send_fleet()
    }

    /// Sets the excess of passengers to minus their number, as if no aircraft took any, and that of stands to zero.
    /// Returns the price of all stands and passengers available, dollars.
    fn offer_usd(&mut self) -> f64 {
        let (stand, passenger) = self.begins();
        let mut usd = 0.0;
        self.stand_excess[stand..].fill(0.0);
        for (price_usd, stands) in self.stand_usd[stand..].iter().zip(self.stands.iter().cycle()) {
            usd += price_usd * stands;
        }
        let offers = self.passenger_excess[passenger..].iter_mut();
        let prices = self.passenger_usd[passenger..].iter().zip(&self.demand[passenger..]);
        for (excess, (price_usd, demand)) in offers.zip(prices) {
            *excess = -demand;
            usd += price_usd * demand;
        }
        usd
    }

    /// Sends every aircraft along its best way and counts what it asks for. Returns the worth of these ways, dollars.
    fn send_fleet(&mut self) -> f64 {
        let mut usd = 0.0;
        self.decisions = 0;
        for at in 0..self.fleet.len() {
            let Ready { kind, place, at_s } = self.fleet[at];
            // No rent has been paid when the first slot begins.
            usd += self.values.usd(kind, place, self.clock.begin_s(self.first_slot), at_s);
            self.send(kind, place, at_s);
        }
        self.count_stands();
        usd
    }

    fn send(&mut self, kind: TypeIx, mut place: VertiportIx, mut time_s: u32) {
        let (size, slots) = (self.vertiports, self.clock.slots);
        let mut slot = self.clock.slot(time_s);
        self.ask(place, self.first_slot, slot);
        while time_s <= self.clock.end_s {
            self.decisions += 1;
            // The best choice is taken from the nearest boundary.
            let near = ((time_s - self.clock.start_s + SLOT_S / 2) / SLOT_S) as usize;
            let best = self.values.best(kind, place, near.min(slots - 1));
            if best == HOLD {
                time_s += self.hold_s;
            } else {
                let best = usize::try_from(best).expect("made from a position");
                let hop = *self.hops.hop(best);
                let interval = self.hops.intervals.of_slot[slot];
                let period = self.hops.intervals.all[interval].period;
                let cell = period * size * size + hop.pair;
                self.passenger_excess[cell] += self.hops.passengers(interval, best);
                place = hop.to;
                time_s += hop.block_s;
            }
            let until = self.clock.slot(time_s);
            self.ask(place, slot, until);
            slot = until;
        }
        self.ask(place, slot, slots);
    }

    /// Records that a stand is asked for from one slot until another: one more from the first on, one less from the
    /// second on.
    #[inline]
    fn ask(&mut self, place: VertiportIx, from: usize, until: usize) {
        for (slot, more) in [(from, 1.0), (until, -1.0)] {
            // Prices end with the last slot.
            if let Some(excess) = self.stand_excess.get_mut(slot * self.vertiports + place.at()) {
                *excess += more;
            }
        }
    }

    /// Turns the recorded changes into the number of stands asked for in each slot less the number available.
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

    /// Number of decisions that the fleet takes on its best ways at the prices.
    pub(super) fn decisions(&self) -> u32 {
        self.decisions
    }

    /// The worth of being ready, and the price of stands, anywhere at any time.
    #[inline]
    pub(super) fn values(&self) -> &ValueTable {
        &self.values
    }

    #[inline]
    pub(super) fn passenger_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.passenger_usd[(period * self.vertiports + from.at()) * self.vertiports + to.at()]
    }
}
