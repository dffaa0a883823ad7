//! The flights that aircraft of each type may make from each vertiport, and their profit in each
//! interval of the day.

use vertifleet_core::{TypeIx, VertiportIx, whole_mwh};
use vertifleet_sim::View;

use super::clock::{Clock, SLOT_S};
use super::intervals::Intervals;
use super::levels::{Level, Levels, ReadyAt};
use super::quads::Quads;

/// Number of demand periods for which a route that is closed unexpectedly is assumed to stay
/// closed: the current one and the next. The actual duration is not known. On 60 days of
/// `disrupted`, 1, 3 and all periods earned a little less, within chance.
const CLOSED_PERIODS: usize = 2;

/// A flight or a hold, measured in slots from its decision until the aircraft is ready again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stay {
    /// Whole slots, and in `share` the remaining part of a slot. A stay of less than a slot counts
    /// as one slot, because the worth at the boundary before it is not known yet.
    pub(super) slots: usize,
    pub(super) share: f64,
    /// The first boundary from which the stay ends past the end of operations.
    pub(super) first_late: usize,
    /// The first boundary from which it would take off past the end of operations, if it waits for
    /// charge.
    pub(super) first_closed: Option<usize>,
}

impl Stay {
    pub(super) fn of(block_s: u32, clock: &Clock) -> Self {
        let block_s = block_s.max(SLOT_S);
        let last_s = clock.end_s - clock.start_s;
        let first_late = last_s.checked_sub(block_s).map_or(0, |latest_s| latest_s / SLOT_S + 1);
        Self {
            slots: ((block_s / SLOT_S) as usize).min(clock.slots),
            share: f64::from(block_s % SLOT_S) / f64::from(SLOT_S),
            first_late: first_late as usize,
            first_closed: None,
        }
    }

    /// A flight that takes off some seconds after its decision.
    fn taking_off_after(self, wait_s: u32, clock: &Clock) -> Self {
        let last_s = clock.end_s - clock.start_s;
        let first = last_s.checked_sub(wait_s).map_or(0, |latest_s| latest_s / SLOT_S + 1);
        Self { first_closed: (wait_s > 0).then_some(first as usize), ..self }
    }
}

/// A flight from one vertiport to another.
#[derive(Debug, Clone, Copy)]
struct Hop {
    to: VertiportIx,
    flight_s: u32,
    energy_kwh: f64,
    flight_cost_usd: f64,
    seats: u32,
    /// Position of the pair among all pairs of vertiports.
    pair: usize,
}

/// The parts of a hop from a level of charge that are needed to follow an aircraft.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flight {
    /// Seconds from the decision until the aircraft is ready at the level.
    pub(super) block_s: u32,
    pub(super) level: Level,
    /// Position of the hop among all hops, or [`NONE`].
    pub(super) hop: u32,
}

/// In place of the position of a hop: no aircraft of the type makes it.
const NONE: u32 = u32::MAX;

/// All hops of a day, by type, then from.
#[derive(Debug, Clone)]
pub(super) struct Hops {
    vertiports: usize,
    levels: usize,
    all: Vec<Hop>,
    /// The position at which the hops of each type and vertiport begin, and at the end the number
    /// of hops.
    begins: Vec<usize>,
    /// By type, pair, then level.
    flights: Vec<Flight>,
    pub(super) quads: Quads,
    /// By hop, then level: the position of its gain among the gains of an interval.
    gain_at: Vec<u32>,
    pub(super) intervals: Intervals,
    /// By interval, then hop: its profit in dollars before its passengers are paid for, and in
    /// `passengers` the number of its passengers.
    profit_usd: Vec<f64>,
    passengers: Vec<f64>,
    /// By interval, then hop in the order of quads: its profit in dollars at the latest prices of
    /// passengers.
    gain_usd: Vec<f64>,
}

impl Hops {
    /// `stride` is the distance from one level of a vertiport to the next in the tables of worth.
    pub(super) fn of(view: View<'_>, clock: &Clock, levels: &Levels, stride: usize) -> Self {
        let vertiports = view.vertiports();
        let (mut hops, mut begins) = (Vec::new(), vec![0]);
        for kind in TypeIx::all(view.aircraft_types().len()) {
            let seats = view.aircraft_type(kind).seats.into();
            for from in VertiportIx::all(vertiports) {
                hops.extend(view.within_range(kind, from).iter().map(|to| {
                    let leg = view.leg(kind, from, to);
                    Hop {
                        to,
                        flight_s: leg.flight_s,
                        energy_kwh: leg.energy_kwh,
                        flight_cost_usd: view.flight_costs_usd(from)[to.at()],
                        seats,
                        pair: from.at() * vertiports + to.at(),
                    }
                }));
                begins.push(hops.len());
            }
        }
        let intervals = Intervals::of(view, clock);
        let cells = intervals.all.len() * hops.len();
        let kinds = view.aircraft_types().len();
        let (flights, waits_s) = flights(view, &hops, &begins, levels);
        let count = levels.count;
        let quads = Quads::of((kinds, vertiports, count), stride, |kind, row, to| {
            let (from, level) = (row / count, row % count);
            let pair = (kind.at() * vertiports + from) * vertiports + to.at();
            let flight = flights[pair * count + level];
            let takes_off_s = waits_s[pair * count + level];
            let stay = || Stay::of(flight.block_s, clock).taking_off_after(takes_off_s, clock);
            (flight.hop != NONE).then(|| (stay(), flight.level))
        });
        let mut made = Self {
            vertiports,
            levels: count,
            gain_at: Vec::with_capacity(hops.len() * count),
            gain_usd: vec![f64::NEG_INFINITY; intervals.all.len() * quads.gains()],
            flights,
            quads,
            all: hops,
            begins,
            intervals,
            profit_usd: vec![0.0; cells],
            passengers: vec![0.0; cells],
        };
        made.place_gains();
        made
    }

    /// Finds the place of every gain.
    fn place_gains(&mut self) {
        let kinds = (self.begins.len() - 1) / self.vertiports;
        for kind in TypeIx::all(kinds) {
            let all = kind.at() * self.vertiports;
            for hop in &self.all[self.begins[all]..self.begins[all + self.vertiports]] {
                let from = VertiportIx::new(hop.pair / self.vertiports);
                for level in 0..self.levels {
                    let row = from.at() * self.levels + level;
                    let rows = self.vertiports * self.levels;
                    let at = self.quads.gain_at(kind, rows, (row, hop.to));
                    self.gain_at.push(u32::try_from(at).expect("a day has few hops"));
                    for gains_usd in self.gain_usd.chunks_exact_mut(self.quads.gains()) {
                        gains_usd[at] = 0.0;
                    }
                }
            }
        }
    }

    /// Reads the passengers and the profit of every flight from now on.
    pub(super) fn load(&mut self, view: View<'_>) {
        let count = self.all.len();
        let closed_until = view.period() + CLOSED_PERIODS;
        let known = view.known_closures();
        for at in self.intervals.first_of(view.period())..self.intervals.all.len() {
            let interval = self.intervals.all[at];
            let period = interval.period;
            for (cell, hop) in (at * count..).zip(&self.all) {
                let from = VertiportIx::new(hop.pair / self.vertiports);
                if period < closed_until && view.closed_unexpectedly(from).contains(hop.to)
                    || interval.is_closed(known, from, hop.to)
                {
                    self.passengers[cell] = 0.0;
                    self.profit_usd[cell] = f64::NEG_INFINITY;
                    continue;
                }
                let waiting = view.demand_left(period, from, hop.to);
                let passengers = f64::from(waiting.min(hop.seats));
                let margin_usd = view.fares_usd(period, from)[hop.to.at()]
                    - view.passenger_costs_usd(from)[hop.to.at()];
                self.passengers[cell] = passengers;
                self.profit_usd[cell] = passengers * margin_usd
                    - hop.energy_kwh * energy_price_usd(view, period, hop.flight_s)
                    - hop.flight_cost_usd;
            }
        }
    }

    /// Deducts the price of a passenger of a pair from its flights of a demand period.
    #[inline]
    pub(super) fn charge(&mut self, period: usize, pair: usize, price_usd: f64) {
        let pairs = self.vertiports * self.vertiports;
        for interval in self.intervals.of_period(period) {
            for flights in self.flights.chunks_exact(pairs * self.levels) {
                let flight = flights[pair * self.levels];
                if flight.hop != NONE {
                    let hop = flight.hop as usize;
                    let cell = interval * self.all.len() + hop;
                    let gain_usd = self.profit_usd[cell] - self.passengers[cell] * price_usd;
                    let gains = interval * self.quads.gains();
                    for &gain_at in &self.gain_at[hop * self.levels..][..self.levels] {
                        self.gain_usd[gains + gain_at as usize] = gain_usd;
                    }
                }
            }
        }
    }

    /// Deducts the prices of passengers, given by period and then pair, from all flights of the
    /// demand periods from `first` on.
    pub(super) fn charge_all(&mut self, first: usize, price_usd: &[f64]) {
        let (count, pairs) = (self.all.len(), self.vertiports * self.vertiports);
        let first = self.intervals.first_of(first);
        for (at, interval) in self.intervals.all.iter().enumerate().skip(first) {
            let price_usd = &price_usd[interval.period * pairs..][..pairs];
            let row = at * count..(at + 1) * count;
            let earned = self.profit_usd[row.clone()].iter().zip(&self.passengers[row.clone()]);
            let gains_usd = &mut self.gain_usd[at * self.quads.gains()..][..self.quads.gains()];
            for ((hop, gain_at), (profit_usd, passengers)) in
                self.all.iter().zip(self.gain_at.chunks_exact(self.levels)).zip(earned)
            {
                let after_usd = profit_usd - passengers * price_usd[hop.pair];
                for &gain_at in gain_at {
                    gains_usd[gain_at as usize] = after_usd;
                }
            }
        }
    }

    /// Number of hops, counted once for each level of charge.
    pub(super) fn len(&self) -> usize {
        self.all.len() * self.levels
    }

    /// The flight of a type from one vertiport to another, from a level of charge.
    #[inline]
    pub(super) fn flight(&self, kind: TypeIx, pair: usize, level: Level) -> Flight {
        let pair = kind.at() * self.vertiports * self.vertiports + pair;
        self.flights[pair * self.levels + usize::from(level)]
    }

    /// The gains of all hops in an interval, in the order of quads.
    #[inline]
    pub(super) fn gains_usd(&self, interval: usize) -> &[f64] {
        &self.gain_usd[interval * self.quads.gains()..][..self.quads.gains()]
    }

    /// Number of passengers of a hop in an interval.
    #[inline]
    pub(super) fn passengers(&self, interval: usize, at: usize) -> f64 {
        self.passengers[interval * self.all.len() + at]
    }
}

/// The flight of every type and pair, from every level of charge, and the seconds from its decision
/// until take-off.
fn flights(
    view: View<'_>,
    hops: &[Hop],
    begins: &[usize],
    levels: &Levels,
) -> (Vec<Flight>, Vec<u32>) {
    let (vertiports, count) = (view.vertiports(), levels.count);
    let (pairs, kinds) = (vertiports * vertiports, (begins.len() - 1) / vertiports);
    let none = Flight { block_s: 0, level: 0, hop: NONE };
    let mut flights = vec![none; kinds * pairs * count];
    let mut waits_s = vec![0; flights.len()];
    for kind in TypeIx::all(kinds) {
        let of_kind = begins[kind.at() * vertiports]..begins[(kind.at() + 1) * vertiports];
        for (at, hop) in of_kind.clone().zip(&hops[of_kind]) {
            let from = VertiportIx::new(hop.pair / vertiports);
            let first = (kind.at() * pairs + hop.pair) * count;
            let cells = flights[first..][..count].iter_mut().zip(&mut waits_s[first..][..count]);
            for (level, (flight, wait_s)) in (0..).zip(cells) {
                let (takes_off_s, ready) = ready_after(view, levels, kind, (from, hop.to), level);
                let hop = u32::try_from(at).expect("a day has few hops");
                *wait_s = takes_off_s;
                *flight = Flight { block_s: ready.time_s, level: ready.level, hop };
            }
        }
    }
    (flights, waits_s)
}

/// When an aircraft takes off on a flight that is decided at a level of charge, and when and with
/// which charge it is ready afterwards, seconds from the decision.
fn ready_after(
    view: View<'_>,
    levels: &Levels,
    kind: TypeIx,
    (from, to): (VertiportIx, VertiportIx),
    level: Level,
) -> (u32, ReadyAt) {
    let leg = view.leg(kind, from, to);
    if !view.charges_as_needed() {
        return (0, ReadyAt { level, time_s: leg.block_s() });
    }
    let (here, there) = (view.charge_rate(kind, from), view.charge_rate(kind, to));
    let charge_mwh = levels.charge_mwh(kind, level);
    let needed_mwh = view.aircraft_type(kind).needed_mwh(leg.energy_kwh);
    let wait_s = here.needed_s(here.battery(charge_mwh), here.need(needed_mwh));
    let landed_mwh = charge_mwh.max(needed_mwh) - whole_mwh(leg.energy_kwh);
    let to_full_s = there.to_full_s(there.battery(landed_mwh), leg.ground_s);
    let ready = levels.of_kind(kind)[to.at()].nearest(wait_s + leg.block_s(), to_full_s);
    // It may not decide again at once, for ever.
    (wait_s, ready.no_sooner_than(SLOT_S))
}

/// When and with which charge an aircraft is ready after a hold that is decided at a level of
/// charge, seconds from the decision.
pub(super) fn ready_after_hold(
    view: View<'_>,
    levels: &Levels,
    (kind, at): (TypeIx, VertiportIx),
    level: Level,
) -> ReadyAt {
    let hold_s = view.hold_s();
    if !view.charges_as_needed() {
        return ReadyAt { level, time_s: hold_s };
    }
    let rate = view.charge_rate(kind, at);
    let to_full_s = rate.to_full_s(rate.battery(levels.charge_mwh(kind, level)), hold_s);
    levels.of_kind(kind)[at.at()].nearest(hold_s, to_full_s).no_sooner_than(SLOT_S)
}

/// Price of the energy of flights of a given duration that take off in a period, dollars per kWh:
/// the mean, over the take-offs, of the price at arrival.
fn energy_price_usd(view: View<'_>, period: usize, flight_s: u32) -> f64 {
    let (starts, prices) = (view.period_starts(), view.energy_prices_usd());
    let (begin, price_usd) = (starts[period], prices[period]);
    let Some(&end) = starts.get(period + 1) else { return price_usd };
    let (first, last) = (begin + flight_s, end + flight_s);
    let later = (period + 1..starts.len()).take_while(|&later| starts[later] < last);
    let mean_rise_usd = |later: usize| {
        let until = starts.get(later + 1).map_or(last, |&until| until.min(last));
        let arriving_s = until.since(starts[later].max(first));
        f64::from(arriving_s) / f64::from(end.since(begin)) * (prices[later] - price_usd)
    };
    price_usd + later.map(mean_rise_usd).sum::<f64>()
}
