//! What a stand is worth when: prices under which aircraft that plan alone share the stands.
//!
//! Lagrangian relaxation of the stands (Eq. 16). Time is cut into slots and waiting is free; every aircraft takes the way
//! that is worth most to it at the current prices, which one backward pass finds for all aircraft of a type; where more
//! stands are asked for than there are, the price rises. Steps follow the volume algorithm (F. Barahona and R. Anbil,
//! *The volume algorithm: producing primal solutions with a subgradient method*, 2000). The prices guide the search and
//! bound nothing.

use vertifleet_core::{AircraftIx, TypeIx, VertiportIx};

use super::day::{Day, Hop};
use super::fleet_state::FleetState;

/// Length of a slot: so many minutes.
const SLOT_MINUTES: usize = 5;
const MINUTE_S: u32 = 60;
const SLOT_S: u32 = 300;
/// More passes did not make the plans better.
const PASSES: usize = 300;
/// Weight of a pass in the running mean of what is asked for.
const MEAN_WEIGHT: f64 = 0.1;
/// How far below the best bound the prices aim, as a share of it.
const AIM: f64 = 0.05;
/// Passes without a better bound after which steps get shorter, and by what factor.
const PATIENCE: u32 = 20;
const SHORTER: f64 = 0.7;

/// Stand prices over time, summed up, so that the rent of any stay is one subtraction.
#[derive(Debug, Clone)]
pub(super) struct StandPrices {
    origin_s: u32,
    minutes: usize,
    /// By vertiport, then minute: what a stand costs from the first minute until then, dollars.
    until_usd: Vec<f64>,
}

impl StandPrices {
    /// The minute of a time, as [`rent_usd`](Self::rent_usd) takes it. What is outside the prices is free.
    #[inline]
    pub(super) fn minute(&self, time_s: u32) -> usize {
        ((time_s.saturating_sub(self.origin_s) / MINUTE_S) as usize).min(self.minutes)
    }

    /// What a stand costs between two minutes, dollars.
    #[inline]
    pub(super) fn rent_usd(&self, vertiport: VertiportIx, from: usize, until: usize) -> f64 {
        let row = &self.until_usd[vertiport.at() * (self.minutes + 1)..][..=self.minutes];
        row[until] - row[from]
    }

    /// Prices that balance what a fleet asks for against the stands there are, from `origin_s` on.
    pub(super) fn balancing(day: &Day, state: &FleetState, origin_s: u32) -> Self {
        Balance::new(day, state, origin_s).run()
    }
}

/// The relaxation, and how far its prices are.
struct Balance<'a> {
    day: &'a Day,
    state: &'a FleetState,
    origin_s: u32,
    slots: usize,
    /// By vertiport, then slot, dollars; and summed up, by vertiport, then slot boundary.
    price_usd: Vec<f64>,
    until_usd: Vec<f64>,
    /// Stands asked for beyond those there are, by vertiport, then slot: of this pass, and as a running mean.
    excess: Vec<f64>,
    mean_excess: Vec<f64>,
    /// What being ready is worth, by vertiport, then slot boundary, nothing at the last; and the best way on, by vertiport,
    /// then slot.
    value_usd: Vec<f64>,
    way_on: Vec<WayOn>,
}

/// A flight or, to the own vertiport, a wait of one slot; with the slot in which the aircraft is ready again.
#[derive(Clone, Copy)]
struct WayOn {
    to: VertiportIx,
    ready_slot: usize,
}

impl<'a> Balance<'a> {
    fn new(day: &'a Day, state: &'a FleetState, origin_s: u32) -> Self {
        let slots = ((day.end_s - origin_s) / SLOT_S + 1) as usize;
        let cells = day.vertiports * slots;
        let boundaries = day.vertiports * (slots + 1);
        let idle = WayOn { to: VertiportIx(0), ready_slot: 0 };
        Self {
            day,
            state,
            origin_s,
            slots,
            price_usd: vec![0.0; cells],
            until_usd: vec![0.0; boundaries],
            excess: vec![0.0; cells],
            mean_excess: vec![0.0; cells],
            value_usd: vec![0.0; boundaries],
            way_on: vec![idle; cells],
        }
    }

    fn run(mut self) -> StandPrices {
        let mut best_usd = f64::INFINITY;
        let mut best_price_usd = self.price_usd.clone();
        let (mut step, mut worse) = (1.0, 0);
        for pass in 0..PASSES {
            let bound_usd = self.pass();
            if bound_usd < best_usd {
                best_usd = bound_usd;
                best_price_usd.clone_from(&self.price_usd);
                worse = 0;
            } else {
                worse += 1;
                if worse == PATIENCE {
                    step *= SHORTER;
                    worse = 0;
                }
            }
            let weight = if pass == 0 { 1.0 } else { MEAN_WEIGHT };
            let mut norm = 0.0;
            for (mean, &excess) in self.mean_excess.iter_mut().zip(&self.excess) {
                *mean += weight * (excess - *mean);
                norm += *mean * *mean;
            }
            if norm == 0.0 {
                break;
            }
            let length = step * (bound_usd - (1.0 - AIM) * best_usd).max(0.0) / norm;
            let prices = self.price_usd.iter_mut().zip(&best_price_usd);
            for ((price, &best), &excess) in prices.zip(&self.mean_excess) {
                *price = (best + length * excess).max(0.0);
            }
        }
        self.price_usd = best_price_usd;
        self.by_minute()
    }

    /// The prices, a slot's spread evenly over its minutes.
    fn by_minute(&self) -> StandPrices {
        let mut until_usd =
            Vec::with_capacity(self.day.vertiports * (self.slots * SLOT_MINUTES + 1));
        for prices in self.price_usd.chunks_exact(self.slots) {
            let mut sum_usd = 0.0;
            until_usd.push(sum_usd);
            for price in prices {
                for _ in 0..SLOT_MINUTES {
                    sum_usd += price / SLOT_MINUTES as f64;
                    until_usd.push(sum_usd);
                }
            }
        }
        StandPrices { origin_s: self.origin_s, minutes: self.slots * SLOT_MINUTES, until_usd }
    }

    /// Lets every aircraft take its best way at the current prices; sets `excess`. Returns the relaxation's value.
    fn pass(&mut self) -> f64 {
        self.sum_up();
        let slots = self.slots;
        let mut bound_usd = 0.0;
        for (at, price) in self.price_usd.iter().enumerate() {
            let stands = f64::from(self.day.stands[at / slots]);
            bound_usd += price * stands;
            self.excess[at] = -stands;
        }
        for kind in self.day.kinds() {
            self.value_ways_on(kind);
            for aircraft in self.day.fleet().filter(|&aircraft| self.day.kind(aircraft) == kind) {
                bound_usd += self.send(aircraft);
            }
        }
        bound_usd
    }

    /// Sums prices up to each slot boundary.
    fn sum_up(&mut self) {
        let slots = self.slots;
        let sums = self.until_usd.chunks_exact_mut(slots + 1);
        for (sums, prices) in sums.zip(self.price_usd.chunks_exact(slots)) {
            for (slot, price) in prices.iter().enumerate() {
                sums[slot + 1] = sums[slot] + price;
            }
        }
    }

    /// The best way on for aircraft of a type from everywhere, and what it is worth.
    fn value_ways_on(&mut self, kind: TypeIx) {
        let slots = self.slots;
        for slot in (0..slots).rev() {
            let time_s = self.origin_s + slot_seconds(slot);
            let period = self.day.period_from(0, time_s);
            for place in VertiportIx::all(self.day.vertiports) {
                let mut best = WayOn { to: place, ready_slot: slot + 1 };
                let mut best_usd = self.on_arrival_usd(slot, best);
                for hop in self.day.hops(kind, place) {
                    let ready_slot = (slot + slots_of(hop)).min(slots);
                    let way_on = WayOn { to: hop.to, ready_slot };
                    let cell = self.day.cell(period, place, hop.to);
                    let seats = u32::from(self.day.seats_of(kind));
                    let passengers = self.state.demand_left[cell].min(seats);
                    let energy_usd = self.day.energy_cost_usd(hop, period, time_s + hop.flight_s);
                    let value_usd = f64::from(passengers) * self.day.margin_usd(cell) - energy_usd
                        + self.on_arrival_usd(slot, way_on);
                    if value_usd > best_usd {
                        (best, best_usd) = (way_on, value_usd);
                    }
                }
                self.value_usd[place.at() * (slots + 1) + slot] = best_usd;
                self.way_on[place.at() * slots + slot] = best;
            }
        }
    }

    /// What follows a way on that begins in `slot`, less the rent of its stand until then.
    #[inline]
    fn on_arrival_usd(&self, slot: usize, way_on: WayOn) -> f64 {
        let row = way_on.to.at() * (self.slots + 1);
        let until_usd = &self.until_usd[row..];
        self.value_usd[row + way_on.ready_slot] - (until_usd[way_on.ready_slot] - until_usd[slot])
    }

    /// Enters what one aircraft asks for on its best way through the day. Returns what that is worth.
    fn send(&mut self, aircraft: AircraftIx) -> f64 {
        let slots = self.slots;
        let entry = &self.state.aircraft[aircraft.at()];
        let since_s = entry.ready_at.seconds() - self.origin_s;
        let mut place = entry.place;
        let mut slot = ((since_s / SLOT_S) as usize).min(slots);
        let row = place.at() * (slots + 1);
        let worth_usd = self.value_usd[row + slot] - self.until_usd[row + slot];
        self.ask(place, 0, slot);
        while slot < slots {
            let way_on = self.way_on[place.at() * slots + slot];
            self.ask(way_on.to, slot, way_on.ready_slot);
            (place, slot) = (way_on.to, way_on.ready_slot);
        }
        worth_usd
    }

    fn ask(&mut self, place: VertiportIx, from: usize, until: usize) {
        let row = place.at() * self.slots;
        for excess in &mut self.excess[row + from..row + until] {
            *excess += 1.0;
        }
    }
}

/// Seconds from the first slot's beginning to that of another.
fn slot_seconds(slot: usize) -> u32 {
    SLOT_S * u32::try_from(slot).expect("a day has few slots")
}

/// Slots that a flight lasts, to the nearest, at least one.
#[inline]
fn slots_of(hop: &Hop) -> usize {
    ((hop.block_s + SLOT_S / 2) / SLOT_S).max(1) as usize
}
