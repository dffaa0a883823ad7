//! What the fleet would do at given prices: every aircraft takes the way through the rest of the day that is worth most to it.
//!
//! One pass from the end of the day back to now values being ready anywhere at any time; another, forward, follows each
//! aircraft along its best way and counts what is asked for. Worth is known at the boundaries of slots and taken to be linear
//! in between.

use vertifleet_core::{AircraftIx, Time, TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::clock::{Clock, Place, SLOT_S};
use super::hops::Hops;

/// A way on that is no flight.
const HOLD: usize = usize::MAX;

/// An aircraft between two decisions.
#[derive(Debug, Clone, Copy)]
struct Ready {
    kind: TypeIx,
    place: VertiportIx,
    at_s: u32,
}

/// The rest of a day, with prices, and what the fleet does at them.
#[derive(Debug, Clone)]
pub(super) struct Relaxation {
    clock: Clock,
    hops: Hops,
    vertiports: usize,
    hold_s: u32,
    /// The demand period of each slot.
    periods: Vec<usize>,
    stands: Vec<f64>,
    /// Passengers left, by period, then pair.
    demand: Vec<f64>,
    fleet: Vec<Ready>,
    /// The slot of now, and its period.
    first_slot: usize,
    first_period: usize,
    /// Price of a stand by slot, then vertiport; of a passenger by period, then pair; dollars.
    pub(super) stand_usd: Vec<f64>,
    pub(super) passenger_usd: Vec<f64>,
    /// What is asked for beyond what there is, in the same order.
    pub(super) stand_excess: Vec<f64>,
    pub(super) passenger_excess: Vec<f64>,
    /// By boundary, then vertiport: what a stand costs from now until then.
    paid_usd: Vec<f64>,
    /// By type, boundary, vertiport: what it is worth to be ready, *less* `paid_usd`, so that the rent of a stay is one
    /// subtraction.
    worth_less_paid_usd: Vec<f64>,
    /// By type, slot, vertiport: position of the best hop, or [`HOLD`].
    best: Vec<usize>,
}

impl Relaxation {
    /// The day of a view, with prices of zero.
    pub(super) fn of(view: View<'_>) -> Self {
        let clock = Clock::of(view);
        let (vertiports, kinds) = (view.vertiports(), view.aircraft_types().len());
        let period = |slot| view.period_at(Time::from_seconds(clock.begin_s(slot)));
        let cells = clock.slots * vertiports;
        let boundaries = (clock.slots + 1) * vertiports;
        let pairs = view.period_starts().len() * vertiports * vertiports;
        let stands = VertiportIx::all(vertiports).map(|at| f64::from(view.stands(at)));
        Self {
            hops: Hops::of(view),
            vertiports,
            hold_s: view.hold_s(),
            periods: (0..clock.slots).map(period).collect(),
            stands: stands.collect(),
            demand: vec![0.0; pairs],
            fleet: Vec::with_capacity(view.places().len()),
            first_slot: 0,
            first_period: 0,
            stand_usd: vec![0.0; cells],
            passenger_usd: vec![0.0; pairs],
            stand_excess: vec![0.0; cells],
            passenger_excess: vec![0.0; pairs],
            paid_usd: vec![0.0; boundaries],
            worth_less_paid_usd: vec![0.0; kinds * boundaries],
            best: vec![HOLD; kinds * cells],
            clock,
        }
    }

    /// Sets out anew from the fleet and the demand that a view shows.
    pub(super) fn take_up(&mut self, view: View<'_>) {
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
        self.hops.take_up(view);
    }

    /// Where the prices that still matter begin, in `stand_usd` and in `passenger_usd`.
    pub(super) fn begins(&self) -> (usize, usize) {
        let pairs = self.vertiports * self.vertiports;
        (self.first_slot * self.vertiports, self.first_period * pairs)
    }

    /// What the fleet earns for itself at the prices, and what they give back for all that there is; sets the excess.
    pub(super) fn evaluate(&mut self) -> f64 {
        self.hops.charge(self.first_period, &self.passenger_usd);
        self.pay();
        self.value_ways_on();
        self.offer_usd() + self.send_fleet()
    }

    /// Sums the stands' prices up to each boundary.
    fn pay(&mut self) {
        let size = self.vertiports;
        let first = self.first_slot * size;
        self.paid_usd[first..first + size].fill(0.0);
        for at in first..self.stand_usd.len() {
            self.paid_usd[at + size] = self.paid_usd[at] + self.stand_usd[at];
        }
    }

    /// Sets the excess to what there is, with nobody asking. Returns what all of it costs.
    fn offer_usd(&mut self) -> f64 {
        let (stand, passenger) = self.begins();
        let mut usd = 0.0;
        let stands = self.stands.iter().cycle();
        let offers = self.stand_excess[stand..].iter_mut().zip(&self.stand_usd[stand..]);
        for ((excess, price_usd), stands) in offers.zip(stands) {
            *excess = -stands;
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

    /// The best way on from everywhere, and what it is worth, for each type.
    fn value_ways_on(&mut self) {
        let (size, slots) = (self.vertiports, self.clock.slots);
        let table = (slots + 1) * size;
        let mut worths = std::mem::take(&mut self.worth_less_paid_usd);
        for (kind, worth) in worths.chunks_exact_mut(table).enumerate() {
            let kind = TypeIx::new(kind);
            for (worth, paid_usd) in
                worth[slots * size..].iter_mut().zip(&self.paid_usd[slots * size..])
            {
                *worth = -paid_usd;
            }
            for slot in (self.first_slot..slots).rev() {
                for from in VertiportIx::all(size) {
                    let (best_usd, best) = self.best_way_on(worth, kind, slot, from);
                    worth[slot * size + from.at()] =
                        best_usd - self.paid_usd[slot * size + from.at()];
                    self.best[(kind.at() * slots + slot) * size + from.at()] = best;
                }
            }
        }
        self.worth_less_paid_usd = worths;
    }

    #[inline]
    fn best_way_on(
        &self,
        worth: &[f64],
        kind: TypeIx,
        slot: usize,
        from: VertiportIx,
    ) -> (f64, usize) {
        let size = self.vertiports;
        let left_s = self.clock.end_s - self.clock.begin_s(slot).min(self.clock.end_s);
        let past_end = &worth[self.clock.slots * size..];
        let paid_usd = &self.paid_usd[slot * size..][..size];
        let follows = |to: VertiportIx, block_s: u32, slots: usize, share: f64| {
            let usd = if block_s > left_s {
                past_end[to.at()]
            } else {
                let at = (slot + slots) * size + to.at();
                worth[at] + share * (worth[at + size] - worth[at])
            };
            paid_usd[to.at()] + usd
        };
        let hold_share = f64::from(self.hold_s % SLOT_S) / f64::from(SLOT_S);
        let held_usd = follows(from, self.hold_s, (self.hold_s / SLOT_S) as usize, hold_share);
        let mut best = (held_usd, HOLD);
        let range = self.hops.range(kind, from);
        for (at, (hop, gain_usd)) in range.clone().zip(self.hops.gains(self.periods[slot], range)) {
            let usd = gain_usd + follows(hop.to, hop.block_s, hop.slots, hop.share);
            if usd > best.0 {
                best = (usd, at);
            }
        }
        best
    }

    /// Sends every aircraft along its best way and counts what it asks for. Returns what the ways are worth.
    fn send_fleet(&mut self) -> f64 {
        let mut usd = 0.0;
        for at in 0..self.fleet.len() {
            let Ready { kind, place, at_s } = self.fleet[at];
            // Nothing has been paid when the first slot begins.
            usd += self.way_on_usd(kind, place, self.clock.begin_s(self.first_slot), at_s);
            self.send(kind, place, at_s);
        }
        usd
    }

    fn send(&mut self, kind: TypeIx, mut place: VertiportIx, mut time_s: u32) {
        let (size, slots) = (self.vertiports, self.clock.slots);
        let mut slot = self.clock.slot(time_s);
        self.ask(place, self.first_slot, slot);
        while time_s <= self.clock.end_s {
            // The best choice of the boundary that is nearer.
            let near = ((time_s - self.clock.start_s + SLOT_S / 2) / SLOT_S) as usize;
            let best = self.best[(kind.at() * slots + near.min(slots - 1)) * size + place.at()];
            if best == HOLD {
                time_s += self.hold_s;
            } else {
                let hop = *self.hops.hop(best);
                let period = self.periods[slot];
                let cell = period * size * size + hop.pair;
                self.passenger_excess[cell] += self.hops.passengers(period, best);
                place = hop.to;
                time_s += hop.block_s;
            }
            let until = self.clock.slot(time_s);
            self.ask(place, slot, until);
            slot = until;
        }
        self.ask(place, slot, slots);
    }

    #[inline]
    fn ask(&mut self, place: VertiportIx, from: usize, until: usize) {
        let size = self.vertiports;
        let asked = self.stand_excess[from * size..until * size].iter_mut();
        for excess in asked.skip(place.at()).step_by(size) {
            *excess += 1.0;
        }
    }

    /// What it is worth to be ready at `ready_s`, less what the stand costs from `now_s` until then.
    #[inline]
    pub(super) fn way_on_usd(
        &self,
        kind: TypeIx,
        place: VertiportIx,
        now_s: u32,
        ready_s: u32,
    ) -> f64 {
        let row = kind.at() * (self.clock.slots + 1) * self.vertiports;
        let table = &self.worth_less_paid_usd[row..];
        let worth_usd = if ready_s > self.clock.end_s {
            table[self.clock.slots * self.vertiports + place.at()]
        } else {
            self.between(table, place, ready_s)
        };
        worth_usd + self.between(&self.paid_usd, place, now_s)
    }

    pub(super) fn worth_usd(&self, kind: TypeIx, place: VertiportIx, time_s: u32) -> f64 {
        if time_s > self.clock.end_s { 0.0 } else { self.way_on_usd(kind, place, time_s, time_s) }
    }

    pub(super) fn rent_usd(&self, place: VertiportIx, from_s: u32, until_s: u32) -> f64 {
        self.between(&self.paid_usd, place, until_s) - self.between(&self.paid_usd, place, from_s)
    }

    #[inline]
    pub(super) fn passenger_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.passenger_usd[(period * self.vertiports + from.at()) * self.vertiports + to.at()]
    }

    #[inline]
    fn between(&self, table: &[f64], place: VertiportIx, time_s: u32) -> f64 {
        let size = self.vertiports;
        let Place { slot, share } = self.clock.place(time_s);
        let at = slot * size + place.at();
        table[at] + share * (table[at + size] - table[at])
    }
}
